//! Clocks of the RLS pipeline: per sample, to the result, and with units that take more
//! than one. The table of states and their clocks stands in `mod.rs`.

use crate::fpga::check::check_tap_count;
use crate::fpga::error::FpgaError;
use crate::fpga::timing::Units;
use crate::vocabulary::Division;

/// Clocks from one accepted sample to the next, back to back: `4 + 6p + 5p^2`.
#[must_use]
pub const fn rls_clocks_per_sample(tap_count: usize) -> usize {
    4 + 6 * tap_count + 5 * tap_count * tap_count
}

/// Clocks from accepting a sample until its result can be read: `3 + 4p + 5p^2`.
#[must_use]
pub const fn rls_latency_clocks(tap_count: usize) -> usize {
    3 + 4 * tap_count + 5 * tap_count * tap_count
}

/// What has to be computed per sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RlsLoad {
    /// Number of weights p, 1 to 64.
    pub tap_count: usize,
    /// Division mode.
    pub division: Division,
    /// Whether alpha differs from 1.
    pub forgets: bool,
}

/// Clocks per RLS sample when the control machine waits for every result.
///
/// ```text
/// mac = Lm + (p-1)max(Lm,La) + La
/// RFR = p^2(2Lm+La+s) + max(0, Ld-Lm)      element division: p^2(Lm+Ld+La+s)
/// T   = 1 + p*mac + mac + RFR + p*mac + mac + La + p(Lm+La)
/// ```
/// with `s` the clocks of the product with `1/alpha`: none at alpha = 1, and none if adder and
/// multiplier take one clock each, however slow the divider is, because the RTL then chains
/// subtraction and product. One clock each gives `4+6p+5p^2`. These are the clocks of the machine: it
/// and the RTL have them for units of any latency.
///
/// # Errors
/// [`FpgaError::TapCount`], [`FpgaError::CountOutOfRange`].
///
/// # Source
/// Derived; agrees with RTL whose divider takes 10, 56 and 58 clocks (117, 163, 165 at p = 4).
pub fn rls_stalled_clocks(load: RlsLoad, units: Units) -> Result<u64, FpgaError> {
    let latency = rls_stalled_latency(load, units)?;
    let p = load.tap_count as u64;
    let (la, lm) = (units.adder.latency_clocks, units.multiplier.latency_clocks);
    Ok(latency + la + p * (lm + la))
}

/// Clocks from accepting a sample until its result can be read when the control machine waits for
/// every result: `T` without its last two terms, the error and the update of the weights.
///
/// # Errors
/// [`FpgaError::TapCount`], [`FpgaError::CountOutOfRange`].
pub fn rls_stalled_latency(load: RlsLoad, units: Units) -> Result<u64, FpgaError> {
    check_tap_count(load.tap_count)?;
    units.check()?;
    let p = load.tap_count as u64;
    let la = units.adder.latency_clocks;
    let lm = units.multiplier.latency_clocks;
    let ld = units.divider.latency_clocks;
    let s = units.forgetting_clocks(load.forgets);
    let correction = match load.division {
        Division::Reciprocal => p * p * (2 * lm + la + s) + ld.saturating_sub(lm),
        Division::Elementwise => p * p * (lm + ld + la + s),
    };
    Ok(1 + 2 * (p + 1) * units.dot_clocks(p) + correction)
}
