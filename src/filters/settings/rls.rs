//! Settings of recursive least squares.

use crate::declare::table;
use crate::vocabulary::{
    DesiredSignal, Division, NumberFormat, OutputRegister, Pipeline, UpdateOrder, UpdateSign,
};

table! {
    /// Recursive least squares.
    pub struct RlsFilterConfig {
        /// Number of weights p. Source of the default: the paper.
        taps: u32 = 4, in 1..=64;
        /// Forgetting factor alpha; 1 forgets nothing. Source of the default: the paper, section 4.1.
        forgetting_factor: f64 = 1.0, in 1e-3..=1.0;
        /// Initial inverse correlation. Source of the default: 1e4 (deg/s)^-2, assumed.
        initial_inverse_correlation: f64 = 7.716e-4, in 1e-18..=1e12, "(deg/h)^-2";
        /// What the filter aims at. Source of the default: one-step prediction; the paper does not say.
        desired: DesiredSignal = "current";
        /// Samples by which the regressors lag the newest sample of the desired signal.
        input_lag_samples: u32 = 1, in 0..=64;
        /// When the result appears: at the next sample tick, or as soon as it is computed. Source of the
        /// default: the sample-and-hold of the paper.
        output_register: OutputRegister = "next-sample";
        /// Sign before the error term of the weight update: the one that converges, or the minus that the
        /// paper's equations (6) and (9) print, which diverges.
        update_sign: UpdateSign = "corrected";
        /// Arithmetic: the recursion of the books, or the pipeline of the hardware with its bits and clocks.
        pipeline: Pipeline = "textbook";
        /// Words of the hardware; -ftz flushes subnormal numbers to zero. This key and those below only
        /// matter with pipeline = "fpga". Source of the default: the paper's double precision.
        number_format: NumberFormat = "binary64";
        /// Clock of the hardware. Source of the default: the paper.
        clock_mhz: f64 = 40.0, in 1e-3..=10000.0, "MHz";
        /// One division per sample, or one for each element of the matrix. Source of the default: derived,
        /// the paper counts one divider even where everything is done at once.
        division: Division = "reciprocal";
        /// Order of the products in the update of the matrix: (t_i t_j) r, which keeps it symmetric to the
        /// bit, or (t_i r) t_j, which fails below a forgetting factor of 1. Source of the default: derived
        /// from the clocks of the paper's states.
        update_order: UpdateOrder = "schedule";
    }
}
