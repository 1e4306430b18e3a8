//! Checks across values that need no physics beyond the transit time of the coil.

pub(in crate::scenario) mod comparison;
mod compensation;
mod gyro;
mod optics;
mod servo;
mod vibration;

use crate::turntable::MotionChecks;
use crate::units::SPEED_OF_LIGHT_M_PER_S;
use crate::wording::is_misspelling;

use crate::scenario::config::channels::LogChannels;
use crate::scenario::config::{FilterState, Scenario};
use crate::scenario::message::error::ScenarioError;
use crate::scenario::read::purpose::Purpose;
use crate::scenario::read::resolved::Resolved;

/// Channel names that mean something else.
pub(crate) const RESERVED: [&str; 4] = ["raw", "truth", "time_s", "encoder_arcsec"];

/// Where an injected signal stands.
const INJECTION: &str = "gyro.injection";

/// Relative slack when times are compared.
const TIME_SLACK: f64 = 1e-9;

/// Every complaint about a scenario whose single values are all in order.
pub(crate) fn check(resolved: &Resolved) -> Vec<ScenarioError> {
    let mut checks = Checks {
        resolved,
        errors: Vec::new(),
    };
    checks.names();
    for (index, filter) in resolved.scenario.filters.iter().enumerate() {
        for complaint in filter.check(index) {
            checks.complain(&complaint.key, complaint.message);
        }
    }
    checks.motion(|scenario, checks| scenario.turntable.motion.check(checks));
    checks.injection();
    checks.filter_state();
    checks.averaging_time();
    for (key, message) in gyro::check(&resolved.scenario) {
        checks.complain(&key, message);
    }
    for (key, message) in vibration::check(&resolved.scenario.gyro) {
        checks.complain(key, message);
    }
    for (key, message) in compensation::check(&resolved.scenario) {
        checks.complain(&key, message);
    }
    checks.gyro();
    checks.gates();
    checks.published();
    for (key_path, message) in comparison::check(resolved) {
        checks.complain(&key_path, message);
    }
    for (key_path, message) in servo::check(resolved) {
        checks.complain(&key_path, message);
    }
    checks.errors
}

struct Checks<'a> {
    resolved: &'a Resolved,
    errors: Vec<ScenarioError>,
}

impl Checks<'_> {
    fn complain(&mut self, key_path: &str, message: String) {
        let location = self.resolved.locate(key_path);
        self.errors.push(ScenarioError::at(location, message));
    }

    fn names(&mut self) {
        let scenario = &self.resolved.scenario;
        if RESERVED.contains(&scenario.name.as_str()) {
            self.complain("name", reserved(&format!("name = \"{}\"", scenario.name)));
        }
        for (index, filter) in scenario.filters.iter().enumerate() {
            let path = format!("filter[{index}].name");
            if RESERVED.contains(&filter.name.as_str()) {
                self.complain(&path, reserved(&format!("{path} = \"{}\"", filter.name)));
            }
            let earlier = scenario.filters[..index]
                .iter()
                .position(|other| other.name == filter.name);
            if let Some(earlier) = earlier {
                let message = format!(
                    "{path} = \"{}\" is the name of filter[{earlier}] already: give each channel its own",
                    filter.name
                );
                self.complain(&path, message);
            }
        }
    }

    /// Complaints of the motion, or of the sines that are injected in its place, about themselves.
    fn motion(&mut self, check: impl FnOnce(&Scenario, &mut MotionChecks)) {
        let (resolved, sample_period_s) = (self.resolved, self.sample_period_s());
        let scenario = &resolved.scenario;
        let mut checks = MotionChecks {
            duration_s: scenario.duration_s,
            warm_up_s: scenario.warm_up_s,
            sample_period_s,
            has_assembly: scenario.gyro.assembly.is_some(),
            is_written: &|key| resolved.is_written(key),
            is_asked_for: &|key| resolved.is_asked_for(key),
            complaints: Vec::new(),
        };
        check(scenario, &mut checks);
        for (key, message) in checks.complaints {
            self.complain(&key, message);
        }
    }

    fn injection(&mut self) {
        let scenario = &self.resolved.scenario;
        let Some(sines) = scenario.injected_sines() else {
            return;
        };
        if !scenario.turntable.motion.is_at_rest() {
            let text = format!(
                "{INJECTION} needs a table at rest: a motion would add to the response, use turntable.static"
            );
            self.complain(INJECTION, text);
        }
        if scenario.gyro.assembly.is_some() {
            let text = format!("{INJECTION} is for one gyro: leave out gyro.assembly");
            self.complain(INJECTION, text);
        }
        self.motion(|_, checks| sines.check_at(INJECTION, checks));
    }

    /// Refuses to reset filters where twins would go on.
    fn filter_state(&mut self) {
        let scenario = &self.resolved.scenario;
        if scenario.trial.filter_state == FilterState::Carried {
            return;
        }
        let key = "trial.filter_state";
        if scenario.trial.rate_gain {
            let message = format!(
                "{key} = \"reset\" contradicts trial.rate_gain = true, which measures filters \
                 that go on through the record"
            );
            self.complain(key, message);
        }
        if let Some(trial) = scenario.trial.black_box {
            let message = format!(
                "{key} = \"reset\" contradicts trial.black_box = \"{}\", which measures filters \
                 that go on through the record",
                trial.word()
            );
            self.complain(key, message);
        }
    }

    /// Period of the output samples, s, but for errors that the gyro's own check finds.
    fn sample_period_s(&self) -> f64 {
        if let Some(log) = &self.resolved.log {
            return 1.0 / log.sample_rate_hz;
        }
        let gyro = &self.resolved.scenario.gyro;
        // A half modulation period is the transit time n L / c of the coil, but for a mismatch.
        let transit_time_s = gyro.coil.group_index * gyro.coil.length_m / SPEED_OF_LIGHT_M_PER_S;
        let half_period_s = transit_time_s * (1.0 + gyro.modulator.half_period_mismatch);
        let word_s = half_period_s * f64::from(gyro.output.half_periods_per_sample);
        word_s * f64::from(gyro.output.average_samples)
    }

    /// Refuses an averaging time below a sample. The default is no wish: coarse words merely have no
    /// bias stability over it.
    fn averaging_time(&mut self) {
        const KEY: &str = "bias_averaging_time_s";
        let (asked_s, sample_s) = (
            self.resolved.scenario.bias_averaging_time_s,
            self.sample_period_s(),
        );
        if asked_s < sample_s * (1.0 - TIME_SLACK) && self.resolved.is_asked_for(KEY) {
            let message = format!(
                "{KEY} = {asked_s:?} s is shorter than a sample of this gyro: allowed from \
                 {sample_s:.9} s on, or make the samples of gyro.output shorter"
            );
            self.complain(KEY, message);
        }
    }

    fn gyro(&mut self) {
        for (key, message) in optics::contradictions(&self.resolved.scenario.gyro) {
            self.complain(key, message);
        }
    }

    fn gates(&mut self) {
        let scenario = &self.resolved.scenario;
        for (index, gate) in scenario.gates.iter().enumerate() {
            let path = |key: &str| format!("gate[{index}].{key}");
            self.metric(&path("metric"), &gate.metric);
            match (gate.min, gate.max) {
                (None, None) => {
                    let message = format!("gate[{index}] has no limit: give min, max or both");
                    self.complain(&format!("gate[{index}]"), message);
                }
                (Some(min), Some(max)) if min > max => {
                    let message = format!(
                        "{} = {min:?} is greater than {} = {max:?}",
                        path("min"),
                        path("max")
                    );
                    self.complain(&path("min"), message);
                }
                _ => {}
            }
            if let Some(channel) = &gate.relative_to {
                let path = path("relative_to");
                self.channel(&path, channel, channel);
            }
        }
    }

    fn published(&mut self) {
        for (index, published) in self.resolved.scenario.published.iter().enumerate() {
            self.metric(&format!("published[{index}].metric"), &published.metric);
            if let Some(channel) = &published.relative_to {
                let path = format!("published[{index}].relative_to");
                self.channel(&path, channel, channel);
            }
        }
    }

    /// Checks the channel of `<channel>.<metric>`; a name without one is refused where metrics are
    /// known.
    fn metric(&mut self, path: &str, metric: &str) {
        if let Some((channel, name)) = metric.rsplit_once('.')
            && !channel.is_empty()
            && !name.is_empty()
        {
            self.channel(path, metric, channel);
        }
    }

    fn channel(&mut self, path: &str, written: &str, channel: &str) {
        let scenario = &self.resolved.scenario;
        let known = match (self.resolved.purpose, &scenario.log) {
            (Purpose::Filters, _) => return,
            (Purpose::Gates(log), _) => scenario.channels_of_log(log),
            (Purpose::Run, Some(log)) => scenario.channels_of_log(log.into()),
            (Purpose::Run, None) => {
                [scenario.channel_names(), scenario.calibration_channels()].concat()
            }
        };
        if known.iter().any(|name| name == channel) {
            return;
        }
        let mut alike = known.iter().filter(|name| is_misspelling(channel, name));
        let hint = match (alike.next(), alike.next()) {
            (Some(one), None) => format!(" (did you mean {one}?)"),
            _ => match (self.resolved.purpose, LogChannels::option_for(channel)) {
                (Purpose::Gates(_), Some(option)) => format!(" (there is one with {option})"),
                _ => String::new(),
            },
        };
        let message = format!(
            "{path} = \"{written}\": there is no channel {channel}: expected one of {}{hint}",
            known.join(", ")
        );
        self.complain(path, message);
    }
}

/// The complaint about a reserved name, which `said` gives with where it stands.
pub(crate) fn reserved(said: &str) -> String {
    let names = RESERVED.join(", ");
    format!("{said} is a reserved name: {names} have a meaning of their own")
}
