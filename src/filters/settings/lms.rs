//! Settings of least mean squares.

use crate::declare::table;
use crate::vocabulary::{DesiredSignal, NumberFormat, OutputRegister, Pipeline, UpdateSign};

table! {
    /// Least mean squares, normalised or not.
    pub struct LmsFilterConfig {
        /// Number of weights N. Source of the default: the paper.
        taps: u32 = 10, in 1..=64;
        /// Step size mu; without normalisation in (deg/h)^-2. Source of the default: the paper.
        step_size: f64 = 0.8, in 1e-24..=2.0;
        /// Whether the step is divided by the energy of the input. Source of the default: a step of 0.8 is
        /// only stable so.
        normalised: bool = true;
        /// Added to the energy in the normalised form. Source of the default: assumed.
        regularisation_deg2_per_h2: f64 = 1.0, in 0.0..=1e12, "(deg/h)^2";
        /// Run an un-normalised step beyond its stability bound.
        allow_unstable: bool = false;
        /// What the filter aims at. Source of the default: the paper.
        desired: DesiredSignal = "two-sample-mean";
        /// Samples by which the regressors lag the newest sample of the desired signal.
        input_lag_samples: u32 = 0, in 0..=64;
        /// When the result appears: at the next sample tick, or as soon as it is computed.
        output_register: OutputRegister = "next-sample";
        /// Sign before the error term of the weight update.
        update_sign: UpdateSign = "corrected";
        /// Arithmetic: the recursion of the books, or the pipeline of the hardware with its bits and clocks.
        pipeline: Pipeline = "textbook";
        /// Words of the hardware; -ftz flushes subnormal numbers to zero. This key and those below only
        /// matter with pipeline = "fpga". Source of the default: the paper's double precision.
        number_format: NumberFormat = "binary64";
        /// Clock of the hardware. Source of the default: the paper.
        clock_mhz: f64 = 40.0, in 1e-3..=10000.0, "MHz";
    }
}
