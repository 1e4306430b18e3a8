//! Clocks, units and rates, whatever the pipeline.
//!
//! * [`Units`]: what real floating-point units take; [`PRESETS`]: typical ones.
//! * [`measure`]: clocks per state and port use counted on the model.
//!
//! Each pipeline has its own count for units with latency beside its control machine; Table 1 of
//! the paper and the interleaved schedule belong to [`crate::fpga::rls`].
//!
//! Checked by `timing`.

mod units;
mod usage;

pub use super::check::check_clock;
pub use units::{PRESETS, Preset, UnitTiming, Units};
pub use usage::{StateClocks, Usage, measure};

/// Sample rate in kHz at which back-to-back samples take `clocks` each.
#[must_use]
pub fn sample_rate_max_khz(clocks: u64, clock_mhz: f64) -> f64 {
    1e3 / sample_period_us(clocks, clock_mhz)
}

/// Time of `clocks` clocks in microseconds.
#[must_use]
#[expect(
    clippy::cast_precision_loss,
    reason = "clock counts stay far below 2^53"
)]
pub fn sample_period_us(clocks: u64, clock_mhz: f64) -> f64 {
    clocks as f64 / clock_mhz
}
