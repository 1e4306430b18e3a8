//! Fixed-point words: signed Qm.n, a rounding and what happens beyond the ends.
//!
//! A word is a code, an integer of m + n bits; its value is `code / 2^n`. The sign counts among the
//! m integer bits. Sums and products are exact, in 128 bits; a value is rounded once, where it is
//! stored into a word.

use crate::fpga::error::FpgaError;
use crate::vocabulary::{Overflow, Rounding};

/// Bits that every exact value of a filter has to fit, sign included.
pub(super) const EXACT_BITS: u32 = 127;

/// Format of a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Format {
    /// Integer bits m, the sign included, at least 1.
    pub integer_bits: u32,
    /// Fraction bits n.
    pub fraction_bits: u32,
    /// Rounding.
    pub rounding: Rounding,
    /// Overflow.
    pub overflow: Overflow,
}

/// A code and whether the value was beyond the ends of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stored {
    /// The code.
    pub code: i64,
    /// Whether it was saturated or wrapped.
    pub overflowed: bool,
}

impl Format {
    /// Bits of a word.
    #[must_use]
    pub const fn width(self) -> u32 {
        self.integer_bits + self.fraction_bits
    }

    /// Largest code.
    #[must_use]
    pub const fn code_max(self) -> i64 {
        (1 << (self.width() - 1)) - 1
    }

    /// Smallest code.
    #[must_use]
    pub const fn code_min(self) -> i64 {
        -(1 << (self.width() - 1))
    }

    /// The value of a code; exact for words of up to 53 bits.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "words have at most 48 bits")]
    pub fn value(self, code: i64) -> f64 {
        code as f64 / power_of_two(self.fraction_bits)
    }

    /// Stores the value `exact / 2^fraction_bits`.
    #[must_use]
    pub fn store(self, exact: i128, fraction_bits: u32) -> Stored {
        let rounded = if fraction_bits <= self.fraction_bits {
            exact << (self.fraction_bits - fraction_bits)
        } else {
            let shift = fraction_bits - self.fraction_bits;
            let below = exact >> shift;
            let rest = exact - (below << shift);
            below + i128::from(self.rounds_up(below, rest, 1 << (shift - 1)))
        };
        self.limit(rounded)
    }

    /// Stores the quotient `numerator / denominator`, both already at the same scale but for
    /// [`Self::fraction_bits`] of the numerator. Division by zero gives the end that the sign of
    /// the numerator points to, whatever the overflow.
    #[must_use]
    pub fn store_quotient(self, numerator: i128, denominator: i128) -> Stored {
        if denominator == 0 {
            let code = if numerator < 0 {
                self.code_min()
            } else {
                self.code_max()
            };
            return Stored {
                code,
                overflowed: true,
            };
        }
        let (numerator, denominator) = if denominator < 0 {
            (-numerator, -denominator)
        } else {
            (numerator, denominator)
        };
        let below = numerator.div_euclid(denominator);
        // Twice the rest against the whole: half a denominator may not be an integer.
        let rest = 2 * numerator.rem_euclid(denominator);
        self.limit(below + i128::from(self.rounds_up(below, rest, denominator)))
    }

    /// Stores the sum of two exact values at scales of their own.
    pub(super) fn store_sum(self, values: [i128; 2], scales: [u32; 2]) -> Stored {
        let scale = scales[0].max(scales[1]);
        let first = values[0] << (scale - scales[0]);
        let second = values[1] << (scale - scales[1]);
        self.store(first + second, scale)
    }

    /// Stores the quotient of two codes at scales of their own.
    pub(super) fn store_ratio(self, codes: [i64; 2], scales: [u32; 2]) -> Stored {
        let [numerator, denominator] = codes.map(i128::from);
        let up = self.fraction_bits + scales[1];
        if up >= scales[0] {
            self.store_quotient(numerator << (up - scales[0]), denominator)
        } else {
            self.store_quotient(numerator, denominator << (scales[0] - up))
        }
    }

    /// Stores a number, rounded as the format rounds; NaN counts as zero.
    #[must_use]
    pub fn of(self, value: f64) -> Stored {
        let bits = value.to_bits();
        let exponent = i32::try_from(bits >> 52 & 0x7ff).unwrap_or(0);
        if exponent == 0 || value.is_nan() {
            // Subnormals are far below half a bit of any format.
            let sign = i128::from(value < 0.0);
            return self.store(-sign, EXACT_BITS - 2);
        }
        let fraction = i128::from(bits & ((1 << 52) - 1) | 1 << 52);
        let signed = if value < 0.0 { -fraction } else { fraction };
        // value = signed * 2^(exponent - 1075)
        match u32::try_from(1075 - exponent) {
            Ok(down) if down < EXACT_BITS - 2 => self.store(signed, down),
            Ok(_) => self.store(signed.signum(), EXACT_BITS - 2),
            // At least 2^53: beyond every format, whatever its lower bits.
            Err(_) => self.limit(signed << 16),
        }
    }

    fn rounds_up(self, below: i128, rest: i128, half: i128) -> bool {
        match self.rounding {
            Rounding::Truncate => false,
            Rounding::HalfUp => rest >= half,
            Rounding::NearestEven => rest > half || (rest == half && below & 1 != 0),
        }
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "cut off on purpose when wrapping; else between the ends"
    )]
    fn limit(self, rounded: i128) -> Stored {
        let (low, high) = (i128::from(self.code_min()), i128::from(self.code_max()));
        if (low..=high).contains(&rounded) {
            return Stored {
                code: rounded as i64,
                overflowed: false,
            };
        }
        let code = match self.overflow {
            Overflow::Saturate if rounded < 0 => self.code_min(),
            Overflow::Saturate => self.code_max(),
            Overflow::Wrap => {
                let unused = 64 - self.width();
                (rounded as i64) << unused >> unused
            }
        };
        Stored {
            code,
            overflowed: true,
        }
    }

    /// The code of a constant that the words have to hold.
    pub(super) fn holding(
        self,
        name: &'static str,
        value: f64,
        signal: &'static str,
    ) -> Result<i64, FpgaError> {
        let stored = self.of(value);
        if stored.overflowed {
            return Err(self.does_not_fit(name, value, signal));
        }
        Ok(stored.code)
    }

    /// A constant is beyond the largest word.
    pub(super) fn does_not_fit(
        self,
        name: &'static str,
        value: f64,
        signal: &'static str,
    ) -> FpgaError {
        FpgaError::DoesNotFit {
            name,
            value,
            signal,
            integer_bits: self.integer_bits,
            fraction_bits: self.fraction_bits,
            limit: 2.0 * self.value(1 << (self.width() - 2)),
        }
    }

    /// Refuses formats that the models do not hold.
    pub(super) fn check(self, name: &'static str) -> Result<(), FpgaError> {
        if self.integer_bits >= 1 && (2..=48).contains(&self.width()) {
            return Ok(());
        }
        Err(FpgaError::CountOutOfRange {
            name,
            value: u64::from(self.width()),
            range: "2 to 48 bits, at least one of them before the point",
        })
    }
}

/// `2^n`, exact.
fn power_of_two(n: u32) -> f64 {
    f64::from_bits(u64::from(1023 + n) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn format(rounding: Rounding, overflow: Overflow) -> Format {
        Format {
            integer_bits: 3,
            fraction_bits: 2,
            rounding,
            overflow,
        }
    }

    #[test]
    fn values_are_rounded_once_by_each_rule() {
        // Eighths into quarters: 1/8, 3/8 and their negatives lie half way.
        for (eighths, truncated, up, even) in [
            (1, 0, 1, 0),
            (3, 1, 2, 2),
            (-1, -1, 0, 0),
            (-3, -2, -1, -2),
            (4, 2, 2, 2),
            (-5, -3, -2, -2),
        ] {
            let code = |rounding| format(rounding, Overflow::Wrap).store(eighths, 3).code;
            assert_eq!(code(Rounding::Truncate), truncated, "{eighths}");
            assert_eq!(code(Rounding::HalfUp), up, "{eighths}");
            assert_eq!(code(Rounding::NearestEven), even, "{eighths}");
        }
    }

    #[test]
    fn ends_saturate_or_wrap() {
        let saturating = format(Rounding::HalfUp, Overflow::Saturate);
        let wrapping = format(Rounding::HalfUp, Overflow::Wrap);
        assert_eq!((saturating.code_min(), saturating.code_max()), (-16, 15));
        for (exact, saturated, wrapped) in [(16, 15, -16), (-17, -16, 15), (40, 15, 8)] {
            let stored = saturating.store(exact, 2);
            assert_eq!((stored.code, stored.overflowed), (saturated, true));
            assert_eq!(wrapping.store(exact, 2).code, wrapped);
        }
        assert!(!saturating.store(15, 2).overflowed);
        // Rounding may carry beyond the end.
        assert_eq!(saturating.store(31, 3).code, 15);
    }

    #[test]
    fn quotients_are_those_of_rational_numbers() {
        for rounding in [Rounding::Truncate, Rounding::HalfUp, Rounding::NearestEven] {
            let format = format(rounding, Overflow::Saturate);
            for numerator in -40..=40_i32 {
                for denominator in (-9..=9_i32).filter(|k| *k != 0) {
                    let exact = f64::from(numerator) / f64::from(denominator);
                    let want = match rounding {
                        Rounding::Truncate => exact.floor(),
                        Rounding::HalfUp => (exact + 0.5).floor(),
                        Rounding::NearestEven => exact.round_ties_even(),
                    };
                    let want = want.clamp(-16.0, 15.0);
                    let got = format.store_quotient(numerator.into(), denominator.into());
                    assert!((format.value(got.code) * 4.0 - want).abs() < 1e-9);
                }
            }
            assert_eq!(format.store_quotient(-1, 0).code, -16);
            assert_eq!(format.store_quotient(0, 0).code, 15);
        }
    }

    #[test]
    fn numbers_are_rounded_from_their_exact_value() {
        let format = format(Rounding::HalfUp, Overflow::Saturate);
        for (value, code) in [
            (0.0, 0),
            (-0.0, 0),
            (0.124_999, 0),
            (0.125, 1),
            (-0.125, 0),
            (-0.126, -1),
            (1e300, 15),
            (-1e300, -16),
            (f64::INFINITY, 15),
            (1e-300, 0),
            (3.75, 15),
        ] {
            assert_eq!(format.of(value).code, code, "{value}");
        }
        let down = super::tests::format(Rounding::Truncate, Overflow::Saturate);
        assert_eq!(down.of(-1e-300).code, -1);
    }
}
