//! The checks of a plan that concern its filters.

use std::f64::consts::TAU;

use super::line_enhancer;
use super::motion::rate_deg_per_h_max;
use super::pipeline_check;
use super::pipeline_settings::PipelineSettings;
use super::plan::Checker;
use super::textbook::cutoff_complaint;
use crate::filters::{
    constant_eigenvalue_max, covariance_digits_warning, lms_step_bound, sine_eigenvalue_max,
};
use crate::gyro;
use crate::scenario::{FilterKind, LmsFilterConfig, MotionClass};
use crate::signal::GyroFacts;
use crate::vocabulary::Pipeline;

/// Peak of the noise that the digits warning reckons with, standard deviations.
const PEAK_SIGMAS: f64 = 4.0;

impl Checker<'_> {
    /// Refuses filters that cannot be or cannot keep up, and warns of those that will not do well.
    pub(super) fn filters(&mut self, facts: &GyroFacts) {
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
                FilterKind::SignLms(config) => {
                    let scenario = &resolved.scenario;
                    let met = line_enhancer::Situation {
                        rate_max_deg_per_h: rate_max,
                        noise_std_deg_per_h: self.noise_std_deg_per_h(facts),
                        output_rate_hz: facts.output_rate_hz,
                        warm_up_s: scenario.warm_up_s,
                        duration_s: scenario.duration_s,
                    };
                    let notes = line_enhancer::notes(&filter.name, config, met);
                    self.warnings.extend(notes);
                }
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
            // No place, as of the textbook filter: a manifest gives the same results.
            let name = &self.resolved.scenario.filters[index].name;
            self.warnings.push(format!("filter `{name}`: {warning}"));
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
        let eigenvalue_max = match scenario.turntable.motion.class() {
            MotionClass::Swing { frequency_hz, .. } => {
                let phase_step_rad = TAU * frequency_hz * gyro::sample_period_s(&scenario.gyro);
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
}
