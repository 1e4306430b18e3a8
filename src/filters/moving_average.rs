//! Mean of the newest samples.

use serde::Deserialize;

use super::common::{Filter, FixedFilter};
use super::kind::FilterSettings;
use crate::vocabulary::OutputRegister;

/// Mean of the newest samples.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MovingAverageFilterConfig {
    /// Number of samples.
    pub taps: u32,
    /// Age of the newest sample of the mean, samples.
    pub delay_samples: u32,
    /// When the result appears.
    pub output_register: OutputRegister,
}

impl FilterSettings for MovingAverageFilterConfig {
    fn build(&self, _sample_period_s: f64) -> Box<dyn Filter> {
        Box::new(FixedFilter::delayed(
            moving_average(self.taps as usize),
            self.delay_samples as usize,
            self.output_register,
        ))
    }
}

/// Weights of the mean of the newest `taps` samples.
///
/// # Panics
/// If there are no taps.
#[must_use]
pub fn moving_average(taps: usize) -> Vec<f64> {
    assert!(taps > 0, "a mean has at least one sample");
    vec![1.0 / taps as f64; taps]
}
