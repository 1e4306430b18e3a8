//! Settings of a Savitzky-Golay filter.

use crate::declare::table;
use crate::vocabulary::OutputRegister;

table! {
    /// Value at the newest sample of a polynomial fitted to the newest samples.
    pub struct SavitzkyGolayFilterConfig {
        /// Number of samples the polynomial is fitted to. Source of the default: assumed.
        taps: u32 = 16, in 2..=4096;
        /// Degree of the polynomial, below the number of samples. Source of the default: a straight line.
        polynomial_order: u32 = 1, in 0..=8;
        /// When the result appears: at the next sample tick, or as soon as it is computed.
        output_register: OutputRegister = "next-sample";
    }
}
