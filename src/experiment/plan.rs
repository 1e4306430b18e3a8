//! From scenario files to checked plans: the checks that need physics or metrics.

use std::f64::consts::TAU;
use std::path::PathBuf;

use super::assembly_motion;
use super::campaign;
use super::motion::{motion, motion_extremes, rate_deg_per_h_max};
use super::pipeline_check;
use super::pipeline_settings::PipelineSettings;
use super::published_check::wrong_unit;
use super::textbook::cutoff_complaint;
use crate::filters::{
    constant_eigenvalue_max, covariance_digits_warning, lms_step_bound, sine_eigenvalue_max,
};
use crate::gyro;
use crate::metrics;
use crate::scenario::{
    Fidelity, FilterKind, LmsFilterConfig, MotionConfig, Pipeline, Resolved, SamplesFormat,
    ScenarioError, load_suite,
};
use crate::signal::GyroFacts;

/// Metric that turns the divergence of a channel into an expected result.
pub(super) const DIVERGED_AT: &str = "diverged_at_s";
/// Longest record held in memory, samples (two hours at 4 kHz).
const SAMPLES_MAX: f64 = 3.0e7;
/// Most words held in memory, truth and channels of every gyro together (1.44 GB): an hour at 4 kHz
/// of three axes with two filters, or two hours of one with four.
const WORDS_MAX: f64 = 1.8e8;

/// One run that has passed every check.
#[derive(Clone, Debug)]
pub struct Plan {
    resolved: Resolved,
    facts: GyroFacts,
    warnings: Vec<String>,
}

impl Plan {
    /// The resolved scenario.
    #[must_use]
    pub fn resolved(&self) -> &Resolved {
        &self.resolved
    }

    /// The gyro in closed form.
    #[must_use]
    pub fn facts(&self) -> &GyroFacts {
        &self.facts
    }

    /// What is allowed but worth saying.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Channels in order, raw ones first.
    #[must_use]
    pub fn channel_names(&self) -> Vec<String> {
        self.resolved.scenario.channel_names()
    }

    /// Period of the output samples, s.
    pub(super) fn sample_period_s(&self) -> f64 {
        gyro::sample_period_s(&self.resolved.scenario.gyro)
    }

    /// Shortest averaging time that sees the white noise of the gyro and not the low pass of loop
    /// and averager, s: ten samples and 20 time constants of the loop.
    pub(super) fn fit_tau_min_s(&self) -> f64 {
        const SAMPLES: f64 = 10.0;
        const TIME_CONSTANTS: f64 = 20.0;
        let time_constant_s = 1.0 / (TAU * self.facts.loop_bandwidth_hz);
        (SAMPLES * self.sample_period_s()).max(TIME_CONSTANTS * time_constant_s)
    }

    /// Gyro time of all repeats, s.
    #[must_use]
    pub fn simulated_s(&self) -> f64 {
        let scenario = &self.resolved.scenario;
        f64::from(scenario.repeats) * (scenario.warm_up_s + scenario.duration_s)
    }

    /// Relative cost of the run, for the order of work only.
    pub(super) fn cost(&self) -> f64 {
        const LOOP_COST: f64 = 10.0;
        let gyros = count(self.resolved.scenario.axis_prefixes().len());
        let words = gyros * self.simulated_s() / gyro::word_period_s(&self.resolved.scenario.gyro);
        match self.resolved.scenario.fidelity {
            Fidelity::Loop => LOOP_COST * words,
            Fidelity::Rate => words,
        }
    }
}

/// Reads and checks everything under `paths`, `--set` overrides applied.
///
/// # Errors
/// Every complaint about every file; then nothing may run.
pub fn plan_suite(paths: &[PathBuf], sets: &[String]) -> Result<Vec<Plan>, Vec<ScenarioError>> {
    let suite = load_suite(paths, sets)?;
    let mut plans = Vec::with_capacity(suite.len());
    let mut errors = Vec::new();
    for resolved in suite {
        match plan(resolved) {
            Ok(plan) => plans.push(plan),
            Err(found) => errors.extend(found),
        }
    }
    // By folder, so that the order of the arguments leaves no trace in the results.
    plans.sort_by_cached_key(|plan: &Plan| plan.resolved.folder());
    if errors.is_empty() {
        Ok(plans)
    } else {
        Err(errors)
    }
}

fn plan(resolved: Resolved) -> Result<Plan, Vec<ScenarioError>> {
    let mut checker = Checker {
        resolved: &resolved,
        errors: Vec::new(),
        warnings: resolved.warnings.clone(),
    };
    let facts = checker.gyro();
    if let Some(facts) = &facts {
        checker.gyro_limits();
        checker.record_length(facts);
        checker.campaign();
        checker.filters(facts);
        checker.metrics(facts);
    }
    let Checker {
        errors, warnings, ..
    } = checker;
    match facts {
        Some(facts) if errors.is_empty() => Ok(Plan {
            resolved,
            facts,
            warnings,
        }),
        _ => Err(errors),
    }
}

/// Collects every complaint about one run.
struct Checker<'a> {
    resolved: &'a Resolved,
    errors: Vec<ScenarioError>,
    warnings: Vec<String>,
}

impl Checker<'_> {
    fn complain(&mut self, key: &str, message: String) {
        self.errors
            .push(ScenarioError::at(self.resolved.locate(key), message));
    }

    fn gyro(&mut self) -> Option<GyroFacts> {
        gyro::facts(&self.resolved.scenario.gyro)
            .map_err(|error| self.complain(error.key(), format!("{}: {error}", error.key())))
            .ok()
    }

    /// Refuses what the gyro model cannot represent, and warns where its budget does not hold.
    fn gyro_limits(&mut self) {
        let scenario = &self.resolved.scenario;
        let extremes = motion_extremes(scenario);
        match gyro::cautions(&scenario.gyro, scenario.fidelity, &extremes) {
            Ok(cautions) => self.warnings.extend(cautions),
            Err(error) => self.complain(error.key(), format!("{}: {error}", error.key())),
        }
    }

    /// Refuses a calibration that leaves parameters open, and says what a sound one hides.
    fn campaign(&mut self) {
        let scenario = &self.resolved.scenario;
        let Some(config) = campaign::campaign(scenario) else {
            return;
        };
        match campaign::check_campaign(scenario, config) {
            Ok(notes) => self.warnings.extend(notes),
            Err((key, message)) => self.complain(key, message),
        }
    }

    fn record_length(&mut self, facts: &GyroFacts) {
        let scenario = &self.resolved.scenario;
        let rate_hz = facts.output_rate_hz;
        let (duration_s, warm_up_s) = (scenario.duration_s, scenario.warm_up_s);
        if duration_s * rate_hz < 1.0 {
            self.complain(
                "duration_s",
                format!(
                    "duration_s = {duration_s} s holds no sample: one sample of this gyro takes \
                     {} s",
                    1.0 / rate_hz
                ),
            );
        }
        let samples = (duration_s + warm_up_s) * rate_hz;
        if samples > SAMPLES_MAX {
            self.complain(
                "duration_s",
                format!(
                    "duration_s + warm_up_s = {} s at {rate_hz:.2} Hz are {samples:.3e} samples: \
                     at most {SAMPLES_MAX:e} are held in memory; use `repeats`, or a larger \
                     gyro.output.average_samples",
                    duration_s + warm_up_s
                ),
            );
        }
        let records = scenario.channel_names().len() + scenario.axis_prefixes().len();
        let words = samples * count(records);
        if samples <= SAMPLES_MAX && words > WORDS_MAX {
            self.complain(
                "duration_s",
                format!(
                    "duration_s + warm_up_s = {} s at {rate_hz:.2} Hz are {words:.3e} words in \
                     {records} records (the true rate and the channels of every gyro): at most \
                     {WORDS_MAX:e} are held in memory; use `repeats`, fewer filters, or a larger \
                     gyro.output.average_samples",
                    duration_s + warm_up_s
                ),
            );
        }
        if scenario.repeats > 1 && scenario.output.samples != SamplesFormat::None {
            self.complain(
                "output.samples",
                format!(
                    "output.samples needs repeats = 1: {} repeats would write as many records to \
                     the same files",
                    scenario.repeats
                ),
            );
        }
    }

    fn filters(&mut self, facts: &GyroFacts) {
        let resolved = self.resolved;
        let rate_max = rate_deg_per_h_max(&resolved.scenario);
        let peak = rate_max + PEAK_SIGMAS * self.noise_std_deg_per_h(facts);
        for (index, filter) in resolved.scenario.filters.iter().enumerate() {
            if let Some(settings) = PipelineSettings::of(&filter.kind) {
                self.pipeline(index, &settings, peak, facts);
            }
            if let Some((key, message)) =
                cutoff_complaint(index, &filter.kind, facts.output_rate_hz)
            {
                self.complain(&key, message);
            }
            match &filter.kind {
                FilterKind::Lms(config) => self.lms(index, config, rate_max),
                FilterKind::Rls(config) if config.pipeline == Pipeline::Textbook => {
                    let delta = config.initial_inverse_correlation;
                    let warning = covariance_digits_warning(delta, config.taps as usize, peak);
                    if let Some(text) = warning {
                        // No place: warnings stand in the results, which name no folder.
                        self.warnings
                            .push(format!("filter `{}`: {text}", filter.name));
                    }
                }
                _ => {}
            }
        }
    }

    /// Refuses hardware that cannot be or cannot keep up; warns of digits lost at the start.
    fn pipeline(
        &mut self,
        index: usize,
        settings: &PipelineSettings,
        peak_deg_per_h: f64,
        facts: &GyroFacts,
    ) {
        let path = format!("filter[{index}].{}", pipeline_check::kind(settings));
        if let Err((key, message)) = pipeline_check::check(settings, &path, facts.output_rate_hz) {
            self.complain(&key, message);
        } else if let Some(warning) = settings.digits_warning(peak_deg_per_h) {
            let place = self.resolved.locate(&path);
            let name = &self.resolved.scenario.filters[index].name;
            self.warnings
                .push(format!("{place}: filter `{name}`: {warning}"));
        }
    }

    /// Standard deviation of white noise with the budget's angle random walk, deg/h.
    fn noise_std_deg_per_h(&self, facts: &GyroFacts) -> f64 {
        let total = facts
            .angle_random_walk_budget_deg_per_sqrt_h
            .iter()
            .find(|(source, _)| *source == "total")
            .map_or(0.0, |(_, value)| *value);
        crate::units::deg_per_sqrt_h_to_deg_per_h_sqrt_s(total) * facts.output_rate_hz.sqrt()
    }

    /// Refuses an un-normalised step that the configured motion alone makes unstable.
    fn lms(&mut self, index: usize, config: &LmsFilterConfig, rate_max: f64) {
        if config.normalised || config.allow_unstable {
            return;
        }
        let taps = config.taps as usize;
        let scenario = &self.resolved.scenario;
        let eigenvalue_max = match &scenario.turntable.motion {
            MotionConfig::Swing(swing) => {
                let phase_step_rad =
                    TAU * swing.frequency_hz * gyro::sample_period_s(&scenario.gyro);
                sine_eigenvalue_max(taps, rate_max, phase_step_rad, 0.0)
            }
            _ => constant_eigenvalue_max(taps, rate_max, 0.0),
        };
        let bound = lms_step_bound(eigenvalue_max);
        if config.step_size >= bound {
            self.complain(
                &format!("filter[{index}].lms.step_size"),
                format!(
                    "filter[{index}].lms.step_size = {} is unstable: with {} taps and up to \
                     {rate_max:.4} deg/h on the axis the un-normalised step must stay below \
                     {bound:.3e} (deg/h)^-2; use normalised = true, a smaller step, or \
                     allow_unstable = true",
                    config.step_size, config.taps
                ),
            );
        }
    }

    /// Refuses gates and published figures that this record can never support.
    fn metrics(&mut self, facts: &GyroFacts) {
        let scenario = &self.resolved.scenario;
        let motion = motion(scenario, 1.0 / facts.output_rate_hz);
        let mut requested: Vec<(String, &str, &str)> = Vec::new();
        for (index, gate) in scenario.gates.iter().enumerate() {
            // The reader has checked that there is a dot and that the channel exists.
            let Some((channel, name)) = gate.metric.rsplit_once('.') else {
                continue;
            };
            requested.push((format!("gate[{index}].metric"), channel, name));
            if let Some(reference) = &gate.relative_to {
                requested.push((format!("gate[{index}].relative_to"), reference, name));
            }
        }
        for (index, figure) in scenario.published.iter().enumerate() {
            let Some((channel, name)) = figure.metric.rsplit_once('.') else {
                continue;
            };
            requested.push((format!("published[{index}].metric"), channel, name));
            if let Some((key, message)) = wrong_unit(index, name, &figure.unit) {
                self.complain(&key, message);
            }
        }
        for (key, channel, name) in requested {
            if name == DIVERGED_AT {
                continue;
            }
            if let Some(estimator) = campaign::estimator_of(scenario, channel) {
                if let Err(reason) = campaign::supports(estimator, name) {
                    self.complain(&key, format!("{key}: {channel}.{name}: {reason}"));
                }
                continue;
            }
            let supported = metrics::support(
                name,
                scenario.duration_s,
                1.0 / facts.output_rate_hz,
                &motion,
                !scenario.is_raw(channel),
                scenario.bias_averaging_time_s,
            );
            let lack = pipeline_check::lacks(scenario, channel, name).map(str::to_owned);
            let across = assembly_motion::lacks(scenario, channel, name)
                .or_else(|| campaign::lacks(scenario, name))
                .map(str::to_owned);
            let has_encoder = scenario.turntable.encoder.resolution_arcsec.is_some();
            let unread = metrics::encoder_lack(name, has_encoder).map(str::to_owned);
            if let Some(reason) = supported.err().or(lack).or(across).or(unread) {
                self.complain(&key, format!("{key}: {channel}.{name}: {reason}"));
            }
        }
    }
}

/// Peak of the noise that the digits warning reckons with, standard deviations.
const PEAK_SIGMAS: f64 = 4.0;

/// A small count as a number.
#[expect(
    clippy::cast_precision_loss,
    reason = "counts of gyros and channels lie far below 2^53"
)]
fn count(things: usize) -> f64 {
    things as f64
}
