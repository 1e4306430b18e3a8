//! Ranges that every pipeline checks.

use super::error::FpgaError;
use super::float_unit::Fp;

/// Refuses tap counts the address ranges cannot hold.
pub(super) fn check_tap_count(value: usize) -> Result<(), FpgaError> {
    if (1..=64).contains(&value) {
        Ok(())
    } else {
        Err(FpgaError::TapCount { value })
    }
}

/// Refuses values that are not finite and positive in the word format.
pub(super) fn check_positive<F: Fp>(name: &'static str, value: f64) -> Result<(), FpgaError> {
    let word = F::from_f64(value);
    if word > F::ZERO && word.is_finite() {
        Ok(())
    } else {
        Err(FpgaError::OutOfRange {
            name,
            value,
            range: "> 0 and finite",
            format: F::NAME,
        })
    }
}

/// Slowest and fastest clock, MHz: below, times in the reports lose their digits and files of
/// waveforms their scale; above, no hardware runs.
const CLOCK_MHZ: std::ops::RangeInclusive<f64> = 1e-3..=1e4;

/// Refuses clocks that no hardware has.
///
/// # Errors
/// [`FpgaError::OutOfRange`].
pub fn check_clock(clock_mhz: f64) -> Result<(), FpgaError> {
    if CLOCK_MHZ.contains(&clock_mhz) {
        Ok(())
    } else {
        Err(FpgaError::OutOfRange {
            name: "clock",
            value: clock_mhz,
            range: "0.001 to 10000 MHz",
            format: "binary64",
        })
    }
}
