//! Mean of the newest samples.

use super::common::{Filter, FixedFilter};
use super::kind::FilterSettings;
use crate::declare::table;
use crate::vocabulary::OutputRegister;

table! {
    /// Mean of the newest samples.
    pub struct MovingAverageFilterConfig {
        /// Number of samples. Source of the default: as many as the paper's filter has weights.
        taps: u32 = 4, in 1..=4096;
        /// Age of the newest sample of the mean. Source of the default: none.
        delay_samples: u32 = 0, in 0..=4096;
        /// When the result appears: at the next sample tick, or as soon as it is computed.
        output_register: OutputRegister = "next-sample";
    }
}

impl FilterSettings for MovingAverageFilterConfig {
    fn build(&self, _sample_period_s: f64) -> Option<Box<dyn Filter>> {
        Some(Box::new(FixedFilter::delayed(
            moving_average(self.taps as usize),
            self.delay_samples as usize,
            self.output_register,
        )))
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
