//! Settings of a one-pole low pass.

use crate::declare::table;
use crate::vocabulary::OutputRegister;

table! {
    /// One-pole low pass.
    pub struct OnePoleFilterConfig {
        /// Half-power frequency, below half the output rate. Source of the default: assumed.
        cutoff_hz: f64 = 100.0, in 1e-9..=1e6, "Hz";
        /// When the result appears: at the next sample tick, or as soon as it is computed.
        output_register: OutputRegister = "next-sample";
    }
}
