//! A run that has passed every check.

use std::f64::consts::TAU;

use crate::experiment::campaign::CompensationPlan;
use crate::experiment::run::{RecordLength, count, sample_period_s};
use crate::gyro;
use crate::scenario::LogFacts;
use crate::scenario::{Fidelity, Resolved};
use crate::signal::GyroFacts;

/// One run that has passed every check.
#[derive(Clone, Debug)]
pub struct Plan {
    pub(crate) resolved: Resolved,
    /// None of a log.
    pub(crate) facts: Option<GyroFacts>,
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

    /// The gyro in closed form; none of a log.
    #[must_use]
    pub fn facts(&self) -> Option<&GyroFacts> {
        self.facts.as_ref()
    }

    /// The log that takes the place of table and gyro; none of a simulation.
    #[must_use]
    pub fn log(&self) -> Option<&LogFacts> {
        self.resolved.log.as_ref()
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
        sample_period_s(&self.resolved)
    }

    /// Samples of warm-up and record.
    pub(crate) fn record_length(&self) -> RecordLength {
        RecordLength::of(&self.resolved)
    }

    /// Shortest averaging time that sees the white noise of the gyro and not the low pass of loop
    /// and averager, s: ten samples and 20 time constants of the loop.
    pub(crate) fn fit_tau_min_s(&self) -> f64 {
        const SAMPLES: f64 = 10.0;
        const TIME_CONSTANTS: f64 = 20.0;
        let bandwidth_hz = self.facts.as_ref().map(|facts| facts.loop_bandwidth_hz);
        let time_constant_s = bandwidth_hz.map_or(0.0, |bandwidth_hz| 1.0 / (TAU * bandwidth_hz));
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
        if let Some(log) = self.log() {
            return count(log.samples);
        }
        let gyros = count(self.resolved.scenario.axis_prefixes().len());
        let words = gyros * self.simulated_s() / gyro::word_period_s(&self.resolved.scenario.gyro);
        match self.resolved.scenario.fidelity {
            Fidelity::Loop => LOOP_COST * words,
            Fidelity::Rate => words,
        }
    }
}
