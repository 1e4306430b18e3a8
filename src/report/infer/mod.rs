//! What figures say of the settings behind them.

mod json;
pub(super) mod text;

use crate::inference::{
    Answer, Calibration, Confirmation, Found, JudgedGate, Parameter, ProblemConfig, Reading, Ridge,
};

pub use json::infer_json;
pub use text::infer_text;

/// An inference to show.
#[derive(Clone, Copy, Debug)]
pub struct InferenceSheet<'a> {
    /// Its problem.
    pub problem: &'a ProblemConfig,
    /// Bare name of the file.
    pub file: &'a str,
    /// Parameters.
    pub parameters: &'a [Parameter],
    /// Readings.
    pub readings: &'a [Reading],
    /// Why a figure has no closed form, by figure.
    pub lacks: &'a [Option<String>],
    /// What the figures say.
    pub answer: &'a Answer,
    /// How often answers hold the truth; none if that was not asked.
    pub calibration: Option<&'a Calibration>,
    /// Forecasts beside simulated records; none if that was not asked.
    pub confirmation: Option<&'a Confirmation>,
    /// What the search has left of every reading.
    pub found: &'a [Option<Found>],
    /// Gates, judged.
    pub gates: &'a [JudgedGate],
}

impl InferenceSheet<'_> {
    /// Values of both parameters at either end of a ridge.
    pub(super) fn ends(&self, ridge: &Ridge) -> [[f64; 2]; 2] {
        let value =
            |parts: &[f64], parameter: usize| self.parameters[parameter].at(parts[parameter]);
        [0, 1].map(|end| {
            ridge
                .parameters
                .map(|parameter| value(&ridge.ends[end], parameter))
        })
    }
}
