//! Settings of a moving average.

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
