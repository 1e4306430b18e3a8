//! Clocks, units and rates: the paper's Table 1 beside an honest count, and what real
//! floating-point units do to it.
//!
//! * [`table`]: parallel, serial and pipeline for any tap count and clock.
//! * [`stalled_clocks`]: the paper's control machine waiting for units with latency.
//! * [`schedule_clocks`]: the same operations, same bits, interleaved by a list scheduler.
//! * [`measure_rls`], [`measure_lms`], [`measure_sign_lms`]: clocks per state and port use counted on the model.
//!
//! Source: Ma et al., Chinese J. Lasers 49(21) 2106004 (2022), Table 1; the rest derived.
//!
//! Checked by `timing`.

mod latency;
mod schedule;
mod table;
mod usage;

pub use latency::{
    Bound, PRESETS, Preset, RlsLoad, UnitTiming, Units, lms_stalled_clocks,
    sign_lms_stalled_clocks, stalled_clocks,
};
pub use schedule::{ScheduleReport, ScheduleSettings, schedule_clocks};
pub(super) use table::check_clock;
pub use table::{Basis, Design, TimingRow, table};
pub use usage::{StateClocks, Usage, measure_lms, measure_rls, measure_sign_lms};

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
