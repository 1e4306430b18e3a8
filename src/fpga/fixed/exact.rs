//! Exact values on their way into words: constants, dot products, and the bits that they need.

use super::format::{EXACT_BITS, Format};
use crate::fpga::error::FpgaError;
use crate::vocabulary::{Overflow, Rounding};

/// Most bits of a word of a constant.
pub(super) const CONSTANT_BITS_MAX: u32 = 48;

/// `first + a0*b0 + a1*b1 + ...`, exact.
pub(super) fn dot(first: i128, a: &[i64], b: &[i64]) -> i128 {
    let mut sum = first;
    for (a_j, b_j) in a.iter().zip(b) {
        sum += i128::from(*a_j) * i128::from(*b_j);
    }
    sum
}

/// `value * 2^fraction_bits` for a value from 0 below 2^52, nearest, ties to even.
pub(super) fn scaled(value: f64, fraction_bits: u32) -> i128 {
    let bits = value.to_bits();
    let exponent = u32::try_from(bits >> 52 & 0x7ff).unwrap_or(0);
    if exponent == 0 {
        // Subnormals are far below half a bit.
        return 0;
    }
    let fraction = i128::from(bits & ((1 << 52) - 1) | 1 << 52);
    // value = fraction * 2^(exponent - 1075)
    let down = 1075_u32.saturating_sub(exponent);
    if down <= fraction_bits {
        return fraction << (fraction_bits - down);
    }
    let shift = down - fraction_bits;
    if shift > 100 {
        return 0;
    }
    let below = fraction >> shift;
    let rest = fraction - (below << shift);
    let half = 1 << (shift - 1);
    below + i128::from(rest > half || (rest == half && below & 1 != 0))
}

/// Code and fraction bits of a constant in a word of `width` bits with as few integer bits as hold it.
pub(super) fn constant(
    name: &'static str,
    value: f64,
    width: u32,
    signal: &'static str,
) -> Result<(i64, u32), FpgaError> {
    let mut format = Format {
        integer_bits: 2,
        fraction_bits: width.min(CONSTANT_BITS_MAX).saturating_sub(2),
        rounding: Rounding::NearestEven,
        overflow: Overflow::Saturate,
    };
    while format.of(value).overflowed {
        if format.fraction_bits == 0 {
            return Err(format.does_not_fit(name, value, signal));
        }
        format.integer_bits += 1;
        format.fraction_bits -= 1;
    }
    Ok((format.of(value).code, format.fraction_bits))
}

/// Bits and scale of an exact value.
#[derive(Clone, Copy)]
pub(super) struct Exact {
    pub(super) bits: u32,
    pub(super) scale: u32,
}

impl Exact {
    /// Bits that a sum of products of up to 64 taps and a constant may gain.
    const GROWTH: u32 = 7;

    /// A word.
    pub(super) fn word(format: Format) -> Self {
        Self {
            bits: format.width(),
            scale: format.fraction_bits,
        }
    }

    /// A product of two words.
    pub(super) fn product(a: Format, b: Format) -> Self {
        Self {
            bits: a.width() + b.width(),
            scale: a.fraction_bits + b.fraction_bits,
        }
    }

    /// A sum of such products over the taps, beside which a constant of `integer_bits` stands.
    pub(super) fn dot(a: Format, b: Format, integer_bits: u32) -> Self {
        let Self { bits, scale } = Self::product(a, b);
        Self {
            bits: (bits + Self::GROWTH).max(scale + integer_bits),
            scale,
        }
    }

    /// A sum of two exact values at the finer of their scales.
    pub(super) fn plus(self, other: Self) -> Self {
        let scale = self.scale.max(other.scale);
        let own = self.bits + scale - self.scale;
        Self {
            bits: own.max(other.bits + scale - other.scale) + 1,
            scale,
        }
    }

    /// The larger of numerator and denominator once they stand at the scale of a quotient's steps.
    pub(super) fn quotient(numerator: Self, denominator: Self, into: Format) -> Self {
        let up = into.fraction_bits + denominator.scale;
        let numerator_bits = numerator.bits + up.saturating_sub(numerator.scale);
        let denominator_bits = denominator.bits + numerator.scale.saturating_sub(up);
        Self {
            bits: numerator_bits.max(denominator_bits) + 1,
            scale: into.fraction_bits,
        }
    }

    /// Refuses a value that needs more bits on its way into a word than the models hold.
    pub(super) fn check(self, name: &'static str, into: Format) -> Result<(), FpgaError> {
        let needed = self.bits + into.fraction_bits.saturating_sub(self.scale);
        if needed < EXACT_BITS {
            return Ok(());
        }
        Err(FpgaError::CountOutOfRange {
            name,
            value: u64::from(needed),
            range: "at most 126 bits before it is rounded",
        })
    }
}
