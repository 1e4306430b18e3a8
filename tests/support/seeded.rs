//! Draws of a seed, for the campaigns that generate and mutate inputs.

use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng as _, SeedableRng as _};

/// A stream of draws; the same seed gives the same draws on every machine.
pub(crate) struct Draws(Xoshiro256PlusPlus);

impl Draws {
    /// The stream of a seed.
    pub(crate) fn new(seed: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(seed))
    }

    /// Sixty-four random bits.
    pub(crate) fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// Uniform in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * 2.0_f64.powi(-53)
    }

    /// Whether something of probability `probability` happens.
    pub(crate) fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// A whole number from 0 to `count - 1`; the bias of the remainder is below 2^-32.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        let count = u64::try_from(count).expect("a count fits into 64 bits");
        usize::try_from(self.bits() % count).expect("it is below a usize")
    }

    /// A whole number of a closed interval.
    pub(crate) fn between(&mut self, low: i64, high: i64) -> i64 {
        let span = high.abs_diff(low);
        let offset = match span.checked_add(1) {
            Some(count) => self.bits() % count,
            None => self.bits(),
        };
        low.wrapping_add_unsigned(offset)
    }

    /// One of several things.
    pub(crate) fn pick<'a, T>(&mut self, things: &'a [T]) -> &'a T {
        &things[self.below(things.len())]
    }

    /// Uniform in the logarithm between two positive numbers.
    pub(crate) fn log_uniform(&mut self, low: f64, high: f64) -> f64 {
        let (low_ln, high_ln) = (low.ln(), high.ln());
        let value = (low_ln + (high_ln - low_ln) * self.unit()).exp();
        value.clamp(low, high)
    }

    /// An order of `count` things.
    pub(crate) fn order(&mut self, count: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..count).collect();
        for last in (1..count).rev() {
            order.swap(last, self.below(last + 1));
        }
        order
    }
}

/// Seed of case `index` of a campaign: neighbouring cases are unrelated, and any of them can be
/// drawn again alone.
pub(crate) fn case_seed(campaign_seed: u64, index: u64) -> u64 {
    Draws::new(campaign_seed ^ index.wrapping_mul(0x9e37_79b9_7f4a_7c15)).bits()
}
