//! Clocks of the fixed-point pipeline: per sample, to the result, and with units that take more than one.

use crate::fpga::timing::Units;

/// Clocks from one accepted sample to the next, back to back: `3p^2 + 7p + 4`.
#[must_use]
pub const fn fixed_rls_clocks_per_sample(tap_count: usize) -> usize {
    3 * tap_count * tap_count + 7 * tap_count + 4
}

/// Clocks from accepting a sample until its result can be read: `3p^2 + 5p + 3`.
#[must_use]
pub const fn fixed_rls_latency_clocks(tap_count: usize) -> usize {
    3 * tap_count * tap_count + 5 * tap_count + 3
}

/// Clocks per sample when the control machine waits for every result of its units.
///
/// ```text
/// mac = Lm + (p-1)max(Lm,La) + La
/// RFR = p(p+1)/2 (Lm + 1 + La + s) + p(p-1)/2
/// T   = 1 + p*mac + mac + p*Ld + RFR + mac + La + p(Lm+La)
/// ```
/// with `s` the clocks of the product with `1/alpha` and of its rounding, `Lm + La`: none at alpha = 1, and none
/// if adder and multiplier take one clock each, as all three then fit one.
#[must_use]
pub fn fixed_rls_stalled_clocks(tap_count: usize, forgets: bool, units: Units) -> u64 {
    let (la, lm) = (units.adder.latency_clocks, units.multiplier.latency_clocks);
    let weights = la + tap_count as u64 * (lm + la);
    fixed_rls_stalled_latency(tap_count, forgets, units) + weights
}

/// Clocks from accepting a sample until its result can be read: `T` without its last two terms, the error and
/// the update of the weights.
#[must_use]
pub fn fixed_rls_stalled_latency(tap_count: usize, forgets: bool, units: Units) -> u64 {
    let p = tap_count as u64;
    let (la, lm) = (units.adder.latency_clocks, units.multiplier.latency_clocks);
    let scaling = if forgets && !units.chain() {
        lm + la
    } else {
        0
    };
    let triangle = p * (p + 1) / 2 * (lm + 1 + la + scaling);
    let mirror = p * (p - 1) / 2;
    1 + (p + 2) * units.dot_clocks(p) + p * units.divider.latency_clocks + triangle + mirror
}
