//! Floating-point units: the number formats of the pipelines.
//!
//! ```text
//!          +-----------+
//!  a ----->|           |
//!          | + - * /   |-----> q     combinational, one result per clock
//!  b ----->|           |
//!          +-----------+
//! ```
//!
//! Every operation takes two words and returns `RN(a op b)`: the exact result, rounded once, to
//! nearest with ties to even. A multiply followed by an add rounds twice; nothing is fused or
//! reordered. Overflow gives an infinity, an invalid operation gives a NaN, neither traps.
//!
//! Four formats share the trait [`Fp`]:
//!
//! | type | word | subnormals |
//! |---|---|---|
//! | `f64` | IEEE 754 binary64 | kept |
//! | `f32` | IEEE 754 binary32 | kept |
//! | [`FlushToZero<f64>`] | binary64 | operands and results become a zero of the same sign |
//! | [`FlushToZero<f32>`] | binary32 | the same |
//!
//! IEEE 754 leaves the payload of a NaN to the implementation, so [`Fp::to_bits`] writes every
//! NaN as the canonical quiet one (sign 0, top fraction bit 1). That is also what vendor
//! operators return, and it makes words comparable between machines.
//!
//! Source: IEEE Std 754-2019, clauses 3.4, 4.3.1, 5.4.1, 6.2. Flushing as in the AMD
//! Floating-Point Operator and the Intel ALTFP functions, which treat subnormal operands as zero.
//!
//! Checked by `float_unit::tests` and `bit_exact`.

use std::fmt::Debug;

use crate::vocabulary::NumberFormat;

/// A floating-point word with the four operations the pipelines own a unit for.
pub trait Fp: Copy + Debug + PartialEq + PartialOrd + Send + Sync + 'static {
    /// The format.
    const FORMAT: NumberFormat;
    /// Its name, as written into exports.
    const NAME: &'static str = Self::FORMAT.word();
    /// Bits of a word.
    const WIDTH: u32;
    /// Spacing of the numbers just above one.
    const EPSILON: f64;
    /// Whether subnormal operands and results are replaced by zero.
    const FLUSHES_SUBNORMALS: bool;
    /// Positive zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;

    /// `RN(self + other)`.
    #[must_use]
    fn add(self, other: Self) -> Self;
    /// `RN(self - other)`.
    #[must_use]
    fn sub(self, other: Self) -> Self;
    /// `RN(self * other)`.
    #[must_use]
    fn mul(self, other: Self) -> Self;
    /// `RN(self / other)`.
    #[must_use]
    fn div(self, other: Self) -> Self;
    /// The word whose low [`Self::WIDTH`] bits are given; higher bits are ignored.
    #[must_use]
    fn from_bits(bits: u64) -> Self;
    /// The bits of the word, right-aligned; every NaN as the canonical quiet NaN.
    #[must_use]
    fn to_bits(self) -> u64;
    /// `RN(value)`, flushed where the format flushes. Exact for binary64 that keeps subnormals.
    #[must_use]
    fn from_f64(value: f64) -> Self;
    /// The value in binary64; exact for every format.
    #[must_use]
    fn to_f64(self) -> f64;
    /// Whether the word is neither infinite nor NaN.
    #[must_use]
    fn is_finite(self) -> bool {
        self.to_f64().is_finite()
    }
}

/// The four operations of a format that the machine computes by itself, subnormals kept.
macro_rules! native_operations {
    () => {
        #[inline]
        fn add(self, other: Self) -> Self {
            self + other
        }
        #[inline]
        fn sub(self, other: Self) -> Self {
            self - other
        }
        #[inline]
        fn mul(self, other: Self) -> Self {
            self * other
        }
        #[inline]
        fn div(self, other: Self) -> Self {
            self / other
        }
    };
}

impl Fp for f64 {
    const FORMAT: NumberFormat = NumberFormat::Binary64;
    const WIDTH: u32 = 64;
    const EPSILON: f64 = f64::EPSILON;
    const FLUSHES_SUBNORMALS: bool = false;
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;

    native_operations!();

    #[inline]
    fn from_bits(bits: u64) -> Self {
        f64::from_bits(bits)
    }
    #[inline]
    fn to_bits(self) -> u64 {
        if self.is_nan() {
            0x7ff8_0000_0000_0000
        } else {
            f64::to_bits(self)
        }
    }
    #[inline]
    fn from_f64(value: f64) -> Self {
        value
    }
    #[inline]
    fn to_f64(self) -> f64 {
        self
    }
}

impl Fp for f32 {
    const FORMAT: NumberFormat = NumberFormat::Binary32;
    const WIDTH: u32 = 32;
    const EPSILON: f64 = 1.192_092_895_507_812_5e-7; // 2^-23
    const FLUSHES_SUBNORMALS: bool = false;
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;

    native_operations!();

    #[inline]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the word is the low half by definition"
    )]
    fn from_bits(bits: u64) -> Self {
        f32::from_bits(bits as u32)
    }
    #[inline]
    fn to_bits(self) -> u64 {
        if self.is_nan() {
            0x7fc0_0000
        } else {
            u64::from(f32::to_bits(self))
        }
    }
    #[inline]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the cast rounds to nearest even, which is what the method states"
    )]
    fn from_f64(value: f64) -> Self {
        value as f32
    }
    #[inline]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
}

/// A format whose unit reads subnormal operands as zero and returns zero for subnormal results.
///
/// The zero keeps the sign of what it replaces. A result is judged after rounding: one that
/// rounds up to the smallest normal number is kept.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct FlushToZero<T>(T);

/// Formats that know their subnormal numbers.
trait Flush: Fp {
    /// The word itself, or a zero of its sign if it is subnormal.
    fn flush(self) -> Self;
}

impl Flush for f64 {
    #[inline]
    fn flush(self) -> Self {
        if self.is_subnormal() {
            0.0_f64.copysign(self)
        } else {
            self
        }
    }
}

impl Flush for f32 {
    #[inline]
    fn flush(self) -> Self {
        if self.is_subnormal() {
            0.0_f32.copysign(self)
        } else {
            self
        }
    }
}

macro_rules! flush_to_zero {
    ($word:ty, $format:expr) => {
        impl Fp for FlushToZero<$word> {
            const FORMAT: NumberFormat = $format;
            const WIDTH: u32 = <$word as Fp>::WIDTH;
            const EPSILON: f64 = <$word as Fp>::EPSILON;
            const FLUSHES_SUBNORMALS: bool = true;
            const ZERO: Self = Self(0.0);
            const ONE: Self = Self(1.0);

            // Operands are flushed as well as results: a raw subnormal word can arrive from a
            // memory image or a port, and the hardware would read it as zero.
            #[inline]
            fn add(self, other: Self) -> Self {
                Self(self.0.flush().add(other.0.flush()).flush())
            }
            #[inline]
            fn sub(self, other: Self) -> Self {
                Self(self.0.flush().sub(other.0.flush()).flush())
            }
            #[inline]
            fn mul(self, other: Self) -> Self {
                Self(self.0.flush().mul(other.0.flush()).flush())
            }
            #[inline]
            fn div(self, other: Self) -> Self {
                Self(self.0.flush().div(other.0.flush()).flush())
            }
            #[inline]
            fn from_bits(bits: u64) -> Self {
                Self(<$word as Fp>::from_bits(bits))
            }
            #[inline]
            fn to_bits(self) -> u64 {
                Fp::to_bits(self.0)
            }
            #[inline]
            fn from_f64(value: f64) -> Self {
                Self(<$word as Fp>::from_f64(value).flush())
            }
            #[inline]
            fn to_f64(self) -> f64 {
                Fp::to_f64(self.0)
            }
        }
    };
}

flush_to_zero!(f64, NumberFormat::Binary64FlushToZero);
flush_to_zero!(f32, NumberFormat::Binary32FlushToZero);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_round_once_to_nearest_even() {
        // 0.1 + 0.2 in binary64 is the textbook case of a correctly rounded sum.
        let sum = Fp::add(0.1_f64, 0.2);
        assert_eq!(Fp::to_bits(sum), 0x3fd3_3333_3333_3334);
        // 1 + 2^-53 is a tie and goes to even; 1 + 3*2^-53 is a tie and goes up to even.
        let half_ulp = f64::EPSILON / 2.0;
        assert_eq!(Fp::to_bits(Fp::add(1.0, half_ulp)), Fp::to_bits(1.0_f64));
        let above = 1.0 + f64::EPSILON;
        assert_eq!(
            Fp::to_bits(Fp::add(above, half_ulp)),
            Fp::to_bits(1.0 + 2.0 * f64::EPSILON)
        );
    }

    #[test]
    fn a_product_and_a_sum_are_not_fused() {
        // (1+e)(1-e) = 1 - e^2 rounds to 1, so the difference to 1 is +0. Fused it would be -e^2.
        let e = f64::EPSILON;
        let separate = Fp::sub(Fp::mul(1.0 + e, 1.0 - e), 1.0);
        assert_eq!(Fp::to_bits(separate), 0);
        assert_ne!(Fp::to_bits(separate), Fp::to_bits(-e * e));
    }

    #[test]
    fn flushing_removes_subnormals_and_keeps_their_sign() {
        type Word = FlushToZero<f64>;
        let smallest = Word::from_f64(f64::MIN_POSITIVE);
        let negative_half = Word::from_f64(-0.5);
        assert_eq!(smallest.mul(negative_half).to_bits(), 1 << 63);
        assert_ne!(Fp::to_bits(Fp::mul(f64::MIN_POSITIVE, -0.5)), 1 << 63);
        // A subnormal operand counts as zero: 1/0 is infinite, 1/5e-324 would overflow anyway,
        // so use a quotient that is finite when subnormals are kept.
        let subnormal = Word::from_bits(1 << 51);
        assert_eq!(subnormal.div(smallest).to_bits(), 0);
        assert_ne!(
            Fp::to_bits(Fp::div(f64::from_bits(1 << 51), f64::MIN_POSITIVE)),
            0
        );
        assert_eq!(FlushToZero::<f32>::from_f64(-1e-40).to_bits(), 1 << 31);
    }

    #[test]
    fn every_nan_is_written_as_the_canonical_one() {
        let nan = Fp::div(0.0_f64, 0.0);
        assert_eq!(Fp::to_bits(nan), 0x7ff8_0000_0000_0000);
        assert_eq!(Fp::to_bits(-nan), 0x7ff8_0000_0000_0000);
        assert_eq!(
            Fp::to_bits(Fp::sub(f32::INFINITY, f32::INFINITY)),
            0x7fc0_0000
        );
    }

    #[test]
    fn binary32_rounds_a_binary64_constant_once() {
        assert_eq!(Fp::to_bits(f32::from_f64(0.99)), 0x3f7d_70a4);
        assert_eq!(
            <f32 as Fp>::EPSILON.to_bits(),
            f64::from(f32::EPSILON).to_bits()
        );
    }
}
