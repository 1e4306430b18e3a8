//! Front end: from a stream of gyro words to the `(x, d)` pairs the filter cores take.
//!
//! ```text
//!  sample --+------------------> d   (current) or (sample + XP) * 0.5 (mean of two)
//!           |   +-------------+
//!           +-->| hold chain  |-> x   the sample `lag` samples ago
//!               +-------------+
//! ```
//!
//! The paper does not define the desired signal of its RLS filter. With a hold register (lag 1)
//! and `d` the current sample, the core is a one-step forward predictor, which fits the paper's
//! remark that the delay of about one sample comes from sampling and holding the input; with lag
//! 0 the weights would become `[1, 0, ...]` and nothing would be filtered. The LMS filter
//! compares with the mean of the two newest samples; its core forms that mean itself, in its
//! adder and multiplier, so a stream for it needs no front end (see [`crate::fpga::lms`]).
//!
//! Reset: all registers `+0`.

use super::float_unit::Fp;
use crate::vocabulary::DesiredSignal;

/// One word pair for a filter core.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair<F> {
    /// Regressor word `x`, pushed into the ring of L.
    pub input: F,
    /// Desired word `d`.
    pub desired: F,
}

impl<F: Fp> Pair<F> {
    /// The pair of two binary64 values, each rounded to the format.
    #[must_use]
    pub fn from_f64(input: f64, desired: f64) -> Self {
        Self {
            input: F::from_f64(input),
            desired: F::from_f64(desired),
        }
    }
}

/// The hold registers in front of a core.
#[derive(Clone, Debug)]
pub struct FrontEnd<F> {
    desired: DesiredSignal,
    half: F,
    /// Newest first: `held[0]` is XP, the previous sample.
    held: Vec<F>,
    lag: usize,
}

impl<F: Fp> FrontEnd<F> {
    /// A front end whose regressor is `lag` samples older than the newest one.
    #[must_use]
    pub fn new(desired: DesiredSignal, lag: usize) -> Self {
        Self {
            desired,
            half: F::from_f64(0.5),
            held: vec![F::ZERO; lag.max(1)],
            lag,
        }
    }

    /// The default of the RLS filter: `L` gets `x_{k-1}`, `d = x_k`.
    #[must_use]
    pub fn one_step_predictor() -> Self {
        Self::new(DesiredSignal::Current, 1)
    }

    /// The pair for the next sample of the stream.
    #[inline]
    pub fn pair(&mut self, sample: F) -> Pair<F> {
        let input = if self.lag == 0 {
            sample
        } else {
            self.held[self.lag - 1]
        };
        let desired = match self.desired {
            DesiredSignal::Current => sample,
            DesiredSignal::TwoSampleMean => sample.add(self.held[0]).mul(self.half),
        };
        self.held.rotate_right(1);
        self.held[0] = sample;
        Pair { input, desired }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_predictor_pairs_each_sample_with_the_one_before() {
        let mut front_end = FrontEnd::<f64>::one_step_predictor();
        let pairs: Vec<_> = [1.0, 2.0, 4.0].map(|x| front_end.pair(x)).into();
        let want = [(0.0, 1.0), (1.0, 2.0), (2.0, 4.0)].map(|(x, d)| Pair::from_f64(x, d));
        assert_eq!(pairs, want);
    }

    #[test]
    fn lag_and_mean_follow_their_definition() {
        let mut front_end = FrontEnd::<f64>::new(DesiredSignal::TwoSampleMean, 2);
        let pairs: Vec<_> = [1.0, 2.0, 4.0].map(|x| front_end.pair(x)).into();
        let want = [(0.0, 0.5), (0.0, 1.5), (1.0, 3.0)].map(|(x, d)| Pair::from_f64(x, d));
        assert_eq!(pairs, want);
        let mut direct = FrontEnd::<f64>::new(DesiredSignal::Current, 0);
        assert_eq!(direct.pair(3.0), Pair::from_f64(3.0, 3.0));
    }
}
