//! Clocks of the line enhancer: per sample, to the result, and with units that take more
//! than one.

use crate::fpga::check::check_tap_count;
use crate::fpga::error::FpgaError;
use crate::fpga::timing::Units;

/// Clocks from one accepted sample to the next, back to back: `3M + 7`.
#[must_use]
pub const fn sign_lms_clocks_per_sample(tap_count: usize) -> usize {
    3 * tap_count + 7
}

/// Clocks from accepting a sample until its result can be read: `M + 5`.
#[must_use]
pub const fn sign_lms_latency_clocks(tap_count: usize) -> usize {
    tap_count + 5
}

/// Clocks per sample of the line enhancer when the control machine waits for every result.
///
/// ```text
/// T = Lm + La + max(La,Lm) + La + (max(La,Lm) + M*La) + max(La,Ld) + (Lm or 1) + M(Lm+La)
/// ```
/// GAIN takes Lm clocks in the normalised form, one in the sign form. One clock each: `3M + 7`.
///
/// # Errors
/// [`FpgaError::TapCount`], [`FpgaError::CountOutOfRange`].
pub fn sign_lms_stalled_clocks(
    tap_count: usize,
    normalised: bool,
    units: Units,
) -> Result<u64, FpgaError> {
    check_tap_count(tap_count)?;
    units.check()?;
    let m = tap_count as u64;
    let la = units.adder.latency_clocks;
    let lm = units.multiplier.latency_clocks;
    let ld = units.divider.latency_clocks;
    let norm = lm + la + la.max(lm) + la;
    let output = la.max(lm) + m * la;
    let gain = if normalised { lm } else { 1 };
    Ok(norm + output + la.max(ld) + gain + m * (lm + la))
}
