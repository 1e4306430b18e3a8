//! A run that has passed every check.

use std::f64::consts::TAU;

use crate::experiment::campaign::CompensationPlan;
use crate::experiment::run::count;
use crate::gyro;
use crate::scenario::{Fidelity, Resolved};
use crate::signal::GyroFacts;

/// One run that has passed every check.
#[derive(Clone, Debug)]
pub struct Plan {
    pub(crate) resolved: Resolved,
    pub(crate) facts: GyroFacts,
    pub(crate) warnings: Vec<String>,
    pub(crate) compensation: Option<CompensationPlan>,
    pub(crate) calibration: Option<String>,
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

    /// What a calibration campaign can determine, in a sentence.
    #[must_use]
    pub fn calibration(&self) -> Option<&str> {
        self.calibration.as_deref()
    }

    /// Channels in order, raw ones first.
    #[must_use]
    pub fn channel_names(&self) -> Vec<String> {
        self.resolved.scenario.channel_names()
    }

    /// What is taken out of the outputs.
    pub(crate) fn compensation(&self) -> Option<&CompensationPlan> {
        self.compensation.as_ref()
    }

    /// Period of the output samples, s.
    pub(crate) fn sample_period_s(&self) -> f64 {
        gyro::sample_period_s(&self.resolved.scenario.gyro)
    }

    /// Shortest averaging time that sees the white noise of the gyro and not the low pass of loop
    /// and averager, s: ten samples and 20 time constants of the loop.
    pub(crate) fn fit_tau_min_s(&self) -> f64 {
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
    pub(crate) fn cost(&self) -> f64 {
        const LOOP_COST: f64 = 10.0;
        let gyros = count(self.resolved.scenario.axis_prefixes().len());
        let words = gyros * self.simulated_s() / gyro::word_period_s(&self.resolved.scenario.gyro);
        match self.resolved.scenario.fidelity {
            Fidelity::Loop => LOOP_COST * words,
            Fidelity::Rate => words,
        }
    }
}
