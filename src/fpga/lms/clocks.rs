//! Clocks of the LMS and NLMS pipeline: per sample, to the result, and with units that take more
//! than one.

use crate::fpga::check::check_tap_count;
use crate::fpga::error::FpgaError;
use crate::fpga::timing::Units;

/// Clocks from one accepted sample to the next, back to back: `3N + 4`, NLMS `4N + 5`.
#[must_use]
pub const fn lms_clocks_per_sample(tap_count: usize, normalised: bool) -> usize {
    if normalised {
        4 * tap_count + 5
    } else {
        3 * tap_count + 4
    }
}

/// Clocks from accepting a sample until its result can be read: `N + 2`, NLMS `2N + 3`.
#[must_use]
pub const fn lms_latency_clocks(tap_count: usize, normalised: bool) -> usize {
    if normalised {
        2 * tap_count + 3
    } else {
        tap_count + 2
    }
}

/// Clocks per LMS or NLMS sample when the control machine waits for every result.
///
/// ```text
/// LMS  = 1 + (Lm+N*La) + La + Lm + N(Lm+La)
/// NLMS = 1 + 2(Lm+N*La) + max(La,Ld) + Lm + N(Lm+La)
/// ```
///
/// # Errors
/// [`FpgaError::TapCount`], [`FpgaError::CountOutOfRange`].
pub fn lms_stalled_clocks(
    tap_count: usize,
    normalised: bool,
    units: Units,
) -> Result<u64, FpgaError> {
    check_tap_count(tap_count)?;
    units.check()?;
    let n = tap_count as u64;
    let la = units.adder.latency_clocks;
    let lm = units.multiplier.latency_clocks;
    let mac = lm + n * la;
    let head = if normalised {
        2 * mac + la.max(units.divider.latency_clocks)
    } else {
        mac + la
    };
    Ok(1 + head + lm + n * (lm + la))
}
