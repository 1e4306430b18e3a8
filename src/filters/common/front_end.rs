//! What stands around the weights: delay line, desired signal and output register.

use super::filter::Output;
use crate::signal::{FilterShape, WeightRule};
use crate::vocabulary::{DesiredSignal, OutputRegister};

/// How the weights of a filter that is free to reach its desired signal come about.
#[must_use]
pub fn adaptive_rule(desired: DesiredSignal) -> WeightRule {
    WeightRule::Adaptive {
        desired_weights: desired.weights().to_vec(),
        is_dc_gain_one: false,
        forgetting_factor: None,
    }
}

/// The same of recursive least squares.
#[must_use]
pub fn least_squares_rule(desired: DesiredSignal, forgetting_factor: f64) -> WeightRule {
    WeightRule::Adaptive {
        desired_weights: desired.weights().to_vec(),
        is_dc_gain_one: false,
        forgetting_factor: Some(forgetting_factor),
    }
}

/// Front end and output register of an adaptive filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrontEndConfig {
    /// Desired signal.
    pub desired: DesiredSignal,
    /// Samples by which the newest regressor lags the newest sample: 1 makes a one-step predictor
    /// of `x[k]`, 0 lets the filter see the sample it aims at.
    pub input_lag_samples: usize,
    /// When the result appears.
    pub output_register: OutputRegister,
}

impl FrontEndConfig {
    /// The front end of a filter that has no desired signal and sees the newest sample.
    #[must_use]
    pub fn direct(output_register: OutputRegister) -> Self {
        Self {
            desired: DesiredSignal::Current,
            input_lag_samples: 0,
            output_register,
        }
    }

    /// The outline of a filter behind this front end; `taps` is `None` for an infinite response.
    #[must_use]
    pub fn shape(&self, taps: Option<usize>, rule: WeightRule) -> FilterShape {
        let register_samples = self.output_register.samples();
        FilterShape {
            taps,
            newest_age_samples: self.input_lag_samples + register_samples,
            register_samples,
            rule,
        }
    }
}

/// The newest samples, newest first, zero before the first one.
///
/// Every sample is written twice, one length apart, so that the whole history is one slice
/// wherever the head stands; no sample is ever moved.
#[derive(Clone, Debug)]
pub(super) struct DelayLine {
    twice: Vec<f64>,
    head: usize,
}

impl DelayLine {
    fn new(length: usize) -> Self {
        Self {
            twice: vec![0.0; 2 * length],
            head: 0,
        }
    }

    fn push(&mut self, sample: f64) {
        let length = self.twice.len() / 2;
        self.head = if self.head == 0 { length } else { self.head } - 1;
        self.twice[self.head] = sample;
        self.twice[self.head + length] = sample;
    }

    fn newest_first(&self) -> &[f64] {
        &self.twice[self.head..self.head + self.twice.len() / 2]
    }
}

/// Delay line and desired signal with their state.
#[derive(Clone, Debug)]
pub(super) struct FrontEnd {
    line: DelayLine,
    desired: DesiredSignal,
    lag: usize,
    taps: usize,
}

impl FrontEnd {
    pub(super) fn new(config: &FrontEndConfig, taps: usize) -> Self {
        let lag = config.input_lag_samples;
        Self {
            line: DelayLine::new((lag + taps).max(config.desired.weights().len())),
            desired: config.desired,
            lag,
            taps,
        }
    }

    /// The samples that the next one's regressors reach back to, oldest first.
    pub(super) fn history(&self) -> impl Iterator<Item = f64> {
        let newest_first = &self.line.newest_first()[..self.lag + self.taps - 1];
        newest_first.iter().rev().copied()
    }

    /// Takes a sample; returns the regressors, newest first, and the desired value.
    pub(super) fn push(&mut self, sample: f64) -> (&[f64], f64) {
        self.line.push(sample);
        let history = self.line.newest_first();
        let desired = match self.desired {
            DesiredSignal::Current => history[0],
            DesiredSignal::TwoSampleMean => 0.5 * (history[0] + history[1]),
        };
        (&history[self.lag..self.lag + self.taps], desired)
    }
}

/// Output register with its state.
#[derive(Clone, Debug)]
pub struct Register {
    kind: OutputRegister,
    held: Output,
}

impl Register {
    /// A register after reset.
    #[must_use]
    pub fn new(kind: OutputRegister) -> Self {
        Self {
            kind,
            held: Output::RESET,
        }
    }

    /// Takes the result of this sample; returns the word that is visible at its tick.
    pub fn clock(&mut self, result: Output) -> Output {
        match self.kind {
            OutputRegister::NextSample => std::mem::replace(&mut self.held, result),
            OutputRegister::Immediate => result,
        }
    }
}
