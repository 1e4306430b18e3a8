//! A filter: front end, weights and their update, output register, watch.

use super::divergence::{Divergence, Fault, Life, Watch};
use super::filter::{Filter, Output, step_each};
use super::front_end::{FrontEnd, FrontEndConfig, Register, adaptive_rule};
use crate::signal::{FilterShape, WeightRule};
use crate::simd::{LANES, Lanes, Simd, with_wide_vectors};
use crate::vocabulary::DesiredSignal;

/// Weights and the rule that updates them, on regressors and desired values given directly.
pub trait Core: Send {
    /// Predicts with the weights as they are, then updates them: the prediction is *a priori*.
    ///
    /// * `regressors`: `[p]`, newest first.
    /// * `desired`: desired signal of the prediction, in the same unit.
    ///
    /// # Errors
    /// What is wrong with the state of the core, in words; the state is then of no use.
    fn update(&mut self, regressors: &[f64], desired: f64) -> Result<Output, Fault>;

    /// Weights after the newest update, the one on the newest regressor first; none for an
    /// infinite impulse response.
    fn weights(&self) -> &[f64];

    /// Weights that no update changes, with their sum; none of a core that has a state of its own.
    fn given(&self) -> Option<(&[f64], f64)> {
        None
    }

    /// Number of regressors that an update takes.
    fn regressors(&self) -> usize {
        self.weights().len()
    }

    /// How the weights come about.
    fn rule(&self, desired: DesiredSignal) -> WeightRule {
        adaptive_rule(desired)
    }
}

/// A core behind the common front end, with the output register and the watch for divergence.
#[derive(Clone, Debug)]
pub struct CoreFilter<C> {
    front_end: FrontEnd,
    core: C,
    register: Register,
    watch: Watch,
    shape: FilterShape,
    life: Life,
}

impl<C: Core> CoreFilter<C> {
    /// Puts `core` behind a front end.
    #[must_use]
    pub fn with_core(core: C, front_end: &FrontEndConfig) -> Self {
        let taps = Some(core.weights().len()).filter(|taps| *taps > 0);
        let shape = front_end.shape(taps, core.rule(front_end.desired));
        Self {
            front_end: FrontEnd::new(front_end, core.regressors()),
            core,
            register: Register::new(front_end.output_register),
            watch: Watch::new(),
            shape,
            life: Life::default(),
        }
    }

    /// The weights and their update rule.
    #[must_use]
    pub fn core(&self) -> &C {
        &self.core
    }

    /// Takes a sample, with `update` making the word of it.
    #[inline]
    fn step_by(
        &mut self,
        input_deg_per_h: f64,
        update: impl FnOnce(&mut C, &[f64], f64) -> Result<Output, Fault>,
    ) -> Result<Output, Divergence> {
        self.life.goes_on()?;
        let sample = self.life.next_sample();
        let result = self.advance(input_deg_per_h, update);
        self.life.judge(sample, result)
    }

    #[inline]
    fn advance(
        &mut self,
        input: f64,
        update: impl FnOnce(&mut C, &[f64], f64) -> Result<Output, Fault>,
    ) -> Result<Output, Fault> {
        self.watch.check_input(input)?;
        let (regressors, desired) = self.front_end.push(input);
        let result = update(&mut self.core, regressors, desired)?;
        self.watch.check_output(result)?;
        Ok(self.register.clock(result))
    }

    /// Words of coming samples, several side by side, of a filter with many given weights.
    fn words_of(&self, inputs: &[f64]) -> Option<impl Iterator<Item = Output> + use<C>> {
        let (weights, weight_sum) = self.core.given()?;
        if weights.len() < WEIGHTS_MIN {
            return None;
        }
        let history = self.front_end.history();
        let samples: Vec<f64> = history.chain(inputs.iter().copied()).collect();
        let words = convolved(weights, &samples, inputs.len()).into_iter();
        Some(words.map(move |value_deg_per_h| Output {
            value_deg_per_h,
            weight_sum,
        }))
    }
}

/// Vectors of outputs that are summed side by side: each output in the order of [`dot`], without waiting for
/// the sum of another.
const SIDE_BY_SIDE: usize = 2;

/// Weights from which on sums side by side are faster than one by one.
const WEIGHTS_MIN: usize = 8;

/// The `count` inner products of the weights with the samples, oldest first, that begin with the first
/// `weights.len()` of them.
fn convolved(weights: &[f64], samples: &[f64], count: usize) -> Vec<f64> {
    with_wide_vectors!(simd => convolved_in_lanes(simd, weights, samples, count))
}

#[inline(always)]
fn convolved_in_lanes<S: Simd>(
    simd: S,
    weights: &[f64],
    samples: &[f64],
    count: usize,
) -> Vec<f64> {
    let newest = weights.len() - 1;
    let nothing = Lanes::splat(simd, std::iter::empty::<f64>().sum());
    let mut words = Vec::with_capacity(count);
    while words.len() + SIDE_BY_SIDE * LANES <= count {
        let mut sums = [nothing; SIDE_BY_SIDE];
        for (age, weight) in weights.iter().enumerate() {
            let first = newest + words.len() - age;
            let lanes = samples[first..].as_chunks().0;
            for (sum, lanes) in sums.iter_mut().zip(lanes) {
                *sum = *sum + Lanes::splat(simd, *weight) * Lanes::of(simd, lanes);
            }
        }
        words.extend(sums.into_iter().flat_map(Lanes::to_array));
    }
    for word in words.len()..count {
        let newest_first = samples[word..=word + newest].iter().rev();
        words.push(weights.iter().zip(newest_first).map(|(w, x)| w * x).sum());
    }
    words
}

impl<C: Core> Filter for CoreFilter<C> {
    fn step(&mut self, input_deg_per_h: f64) -> Result<Output, Divergence> {
        self.step_by(input_deg_per_h, C::update)
    }

    fn step_all(
        &mut self,
        inputs_deg_per_h: &[f64],
        outputs: &mut Vec<Output>,
    ) -> Result<(), Divergence> {
        let Some(words) = self.words_of(inputs_deg_per_h) else {
            return step_each(self, inputs_deg_per_h, outputs);
        };
        for (&input_deg_per_h, word) in inputs_deg_per_h.iter().zip(words) {
            outputs.push(self.step_by(input_deg_per_h, |_, _, _| Ok(word))?);
        }
        Ok(())
    }

    fn weights(&self) -> &[f64] {
        self.core.weights()
    }

    fn shape(&self) -> FilterShape {
        self.shape.clone()
    }
}

/// Inner product in index order.
#[inline]
pub(in crate::filters) fn dot(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).map(|(l, r)| l * r).sum()
}
