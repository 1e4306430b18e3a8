//! Checks across values that need no physics beyond the transit time of the coil.

mod calibration;
pub(in crate::scenario) mod comparison;
mod compensation;
mod gyro;
mod multi_sine;
mod optics;
mod servo;
mod turntable;
mod vibration;

use crate::units::SPEED_OF_LIGHT_M_PER_S;
use crate::wording::{counted, is_misspelling, number};

use crate::scenario::message::error::ScenarioError;
use crate::scenario::read::resolved::Resolved;
use crate::turntable::{MotionConfig, MultiSineConfig};

/// Channel names that mean something else.
pub(crate) const RESERVED: [&str; 4] = ["raw", "truth", "time_s", "encoder_arcsec"];

/// Fewest output samples per cycle of a swing.
pub(in crate::scenario) const SAMPLES_PER_CYCLE_MIN: f64 = 8.0;

/// Relative slack when times are compared, so that `3 x 0.1 s` fits into 0.3 s.
pub(in crate::scenario) const TIME_SLACK: f64 = 1e-9;

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
    checks.motion();
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

pub(in crate::scenario) struct Checks<'a> {
    pub(in crate::scenario) resolved: &'a Resolved,
    errors: Vec<ScenarioError>,
}

impl Checks<'_> {
    pub(in crate::scenario) fn complain(&mut self, key_path: &str, message: String) {
        let location = self.resolved.locate(key_path);
        self.errors.push(ScenarioError::at(location, message));
    }

    fn names(&mut self) {
        let scenario = &self.resolved.scenario;
        if RESERVED.contains(&scenario.name.as_str()) {
            self.complain("name", reserved("name", &scenario.name));
        }
        for (index, filter) in scenario.filters.iter().enumerate() {
            let path = format!("filter[{index}].name");
            if RESERVED.contains(&filter.name.as_str()) {
                self.complain(&path, reserved(&path, &filter.name));
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

    fn motion(&mut self) {
        let scenario = &self.resolved.scenario;
        match &scenario.turntable.motion {
            MotionConfig::Static(_) => {}
            MotionConfig::Swing(swing) => {
                self.soft_start("turntable.swing.soft_start_s", swing.soft_start_s);
                self.frequency("turntable.swing.frequency_hz", swing.frequency_hz);
                self.swing_from_rest(swing);
            }
            MotionConfig::MultiSine(sines) => self.multi_sine("turntable.multi_sine", sines),
            MotionConfig::Rotation(rotation) => {
                self.soft_start("turntable.rotation.soft_start_s", rotation.soft_start_s);
            }
            MotionConfig::Trapezoid(trapezoid) => self.trapezoid(trapezoid),
            MotionConfig::Chirp(chirp) => self.chirp(chirp),
            MotionConfig::Script(script) => self.script(&script.points),
            MotionConfig::ScaleFactorTest(test) => self.scale_factor_test(test),
            MotionConfig::Calibration(campaign) => self.campaign(campaign),
            MotionConfig::Steps(steps) => {
                let count = steps.rates_deg_per_s.len();
                let count_f64 = u32::try_from(count).map_or(f64::INFINITY, f64::from);
                let needed_s = count_f64 * steps.dwell_s;
                if needed_s > scenario.duration_s * (1.0 + TIME_SLACK) {
                    let message = format!(
                        "turntable.steps.dwell_s = {:?} s is too long: {} take {} s, \
                         but duration_s = {:?} s",
                        steps.dwell_s,
                        counted(count, "rate"),
                        number(needed_s),
                        scenario.duration_s
                    );
                    self.complain("turntable.steps.dwell_s", message);
                }
                let settle = "turntable.steps.settle_s";
                // The default is no wish: short dwells merely have no scale factor.
                if steps.settle_s >= steps.dwell_s && self.resolved.is_asked_for(settle) {
                    let message = format!(
                        "{settle} = {:?} s leaves nothing of turntable.steps.dwell_s = {:?} s",
                        steps.settle_s, steps.dwell_s
                    );
                    self.complain(settle, message);
                }
            }
        }
    }

    fn multi_sine(&mut self, table: &str, sines: &MultiSineConfig) {
        self.soft_start(&format!("{table}.soft_start_s"), sines.soft_start_s);
        let found = multi_sine::complaints(
            table,
            sines,
            self.resolved.scenario.duration_s,
            1.0 / self.sample_period_s(),
            SAMPLES_PER_CYCLE_MIN,
        );
        for (key, message) in found {
            self.complain(&key, message);
        }
    }

    fn injection(&mut self) {
        let scenario = &self.resolved.scenario;
        for (key, message) in multi_sine::injection_complaints(scenario) {
            self.complain(key, message);
        }
        if let Some(sines) = scenario.injected_sines() {
            self.multi_sine(multi_sine::INJECTION, &sines);
        }
    }

    pub(in crate::scenario) fn soft_start(&mut self, path: &str, soft_start_s: f64) {
        let warm_up_s = self.resolved.scenario.warm_up_s;
        if soft_start_s > warm_up_s {
            let message = format!(
                "{path} = {soft_start_s:?} s is longer than the warm-up: allowed [0, warm_up_s = {warm_up_s:?}] s"
            );
            let blamed = if self.resolved.is_written(path) {
                path
            } else {
                "warm_up_s"
            };
            self.complain(blamed, message);
        }
    }

    /// Period of the output samples, s, but for errors that the gyro's own check finds.
    pub(in crate::scenario) fn sample_period_s(&self) -> f64 {
        let gyro = &self.resolved.scenario.gyro;
        // A half modulation period is the transit time n L / c of the coil, but for a mismatch.
        let transit_time_s = gyro.coil.group_index * gyro.coil.length_m / SPEED_OF_LIGHT_M_PER_S;
        let half_period_s = transit_time_s * (1.0 + gyro.modulator.half_period_mismatch);
        let word_s = half_period_s * f64::from(gyro.output.half_periods_per_sample);
        word_s * f64::from(gyro.output.average_samples)
    }

    /// Refuses a frequency that the cubics between samples cannot follow.
    pub(in crate::scenario) fn frequency(&mut self, path: &str, frequency_hz: f64) {
        let output_rate_hz = 1.0 / self.sample_period_s();
        let frequency_hz_max = output_rate_hz / SAMPLES_PER_CYCLE_MIN;
        if frequency_hz > frequency_hz_max {
            let message = format!(
                "{path} = {frequency_hz:?} Hz is too fast: allowed up to \
                 {frequency_hz_max:.6} Hz, 8 samples a cycle at the output rate of {output_rate_hz:.6} Hz"
            );
            self.complain(path, message);
        }
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
        let known = [scenario.channel_names(), scenario.calibration_channels()].concat();
        if known.iter().any(|name| name == channel) {
            return;
        }
        let mut alike = known.iter().filter(|name| is_misspelling(channel, name));
        let hint = match (alike.next(), alike.next()) {
            (Some(one), None) => format!(" (did you mean {one}?)"),
            _ => String::new(),
        };
        let message = format!(
            "{path} = \"{written}\": there is no channel {channel}: expected one of {}{hint}",
            known.join(", ")
        );
        self.complain(path, message);
    }
}

/// The complaint about a reserved name.
fn reserved(path: &str, name: &str) -> String {
    format!(
        "{path} = \"{name}\" is a reserved name: {} have a meaning of their own",
        RESERVED.join(", ")
    )
}
