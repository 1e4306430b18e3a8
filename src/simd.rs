//! Eight numbers at once, by the vector instructions that the processor at hand has beyond those the program
//! is built for.
//!
//! Invariant: wider vectors move no bit. No sum is reordered and no product fused with an addition; what is
//! written in lanes is only done in more of them at once.

pub(crate) use fearless_simd::Simd;
use fearless_simd::{f64x4, prelude::*};

/// Numbers that are handled at once.
pub(crate) const LANES: usize = 8;

/// What an expression gives, compiled for the widest vectors of this processor as far as it is inlined; the name
/// before the arrow stands for their instructions in it.
///
/// Worth its few nanoseconds for loops over hundreds of values.
macro_rules! with_wide_vectors {
    ($simd:ident => $work:expr) => {
        fearless_simd::dispatch!(fearless_simd::Level::new(), $simd => $work)
    };
}
pub(crate) use with_wide_vectors;

/// Eight numbers: an operation on them is that operation on each.
#[derive(Clone, Copy)]
pub(crate) struct Lanes<S: Simd>([f64x4<S>; 2]);

impl<S: Simd> Lanes<S> {
    /// One number in every lane.
    #[inline(always)]
    pub(crate) fn splat(simd: S, value: f64) -> Self {
        Self([f64x4::splat(simd, value); 2])
    }

    /// The numbers of a piece of a record.
    #[inline(always)]
    pub(crate) fn of(simd: S, values: &[f64; LANES]) -> Self {
        let (low, high) = values.split_at(LANES / 2);
        Self([f64x4::from_slice(simd, low), f64x4::from_slice(simd, high)])
    }

    #[inline(always)]
    pub(crate) fn to_array(self) -> [f64; LANES] {
        let mut values = [0.0; LANES];
        let (low, high) = values.split_at_mut(LANES / 2);
        self.0[0].store_slice(low);
        self.0[1].store_slice(high);
        values
    }

    #[inline(always)]
    fn with(self, other: Self, operation: impl Fn(f64x4<S>, f64x4<S>) -> f64x4<S>) -> Self {
        let ([a, b], [c, d]) = (self.0, other.0);
        Self([operation(a, c), operation(b, d)])
    }
}

impl<S: Simd> std::ops::Add for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.with(other, |a, b| a + b)
    }
}

impl<S: Simd> std::ops::Sub for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.with(other, |a, b| a - b)
    }
}

impl<S: Simd> std::ops::Mul for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.with(other, |a, b| a * b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_have_the_bits_of_numbers_one_by_one() {
        let of = |factor: f64| -> [f64; LANES] {
            std::array::from_fn(|lane| (factor * (lane as f64 + 0.3)).sin())
        };
        let (a, b, c) = (of(1.7), of(2.9), of(-0.6));
        let found = with_wide_vectors!(simd => {
            let [a, b, c] = [a, b, c].map(|values| Lanes::of(simd, &values));
            ((a + b * c) - Lanes::splat(simd, 0.1)).to_array()
        });
        let wanted: [f64; LANES] = std::array::from_fn(|lane| (a[lane] + b[lane] * c[lane]) - 0.1);
        assert_eq!(found.map(f64::to_bits), wanted.map(f64::to_bits));
    }
}
