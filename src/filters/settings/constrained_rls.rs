//! Settings of recursive least squares held to unit DC gain.

use crate::declare::table;
use crate::vocabulary::{DesiredSignal, OutputRegister};

table! {
    /// Recursive least squares held to unit DC gain: the mean rate cannot enter its weights.
    pub struct ConstrainedRlsFilterConfig {
        /// Number of weights, one more than are free. Source of the default: that of the plain filter.
        taps: u32 = 4, in 2..=64;
        /// Forgetting factor. Source of the default: that of the plain filter.
        forgetting_factor: f64 = 1.0, in 1e-3..=1.0;
        /// Initial inverse correlation. Source of the default: that of the plain filter.
        initial_inverse_correlation: f64 = 7.716e-4, in 1e-18..=1e12, "(deg/h)^-2";
        /// What the filter aims at.
        desired: DesiredSignal = "current";
        /// Samples by which the regressors lag the newest sample of the desired signal.
        input_lag_samples: u32 = 1, in 0..=64;
        /// When the result appears: at the next sample tick, or as soon as it is computed.
        output_register: OutputRegister = "next-sample";
    }
}
