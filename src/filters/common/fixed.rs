//! Filters whose weights are given: the ones a user would reach for before an adaptive one.

use super::core_filter::{Core, CoreFilter, dot};
use super::divergence::Fault;
use super::filter::Output;
use super::front_end::FrontEndConfig;
use crate::signal::WeightRule;
use crate::vocabulary::{DesiredSignal, OutputRegister};

/// Weights that never change.
#[derive(Clone, Debug)]
pub struct FixedCore {
    weights: Vec<f64>,
    weight_sum: f64,
}

/// Given weights behind the common front end.
pub type FixedFilter = CoreFilter<FixedCore>;

impl FixedFilter {
    /// The filter with these weights, newest sample first.
    ///
    /// # Panics
    /// If there are no weights.
    #[must_use]
    pub fn new(weights: Vec<f64>, output_register: OutputRegister) -> Self {
        Self::delayed(weights, 0, output_register)
    }

    /// The filter with these weights, the first of which stands on the sample of age
    /// `delay_samples`.
    ///
    /// # Panics
    /// If there are no weights.
    #[must_use]
    pub fn delayed(
        weights: Vec<f64>,
        delay_samples: usize,
        output_register: OutputRegister,
    ) -> Self {
        assert!(!weights.is_empty(), "a filter has at least one tap");
        let weight_sum = weights.iter().sum();
        let core = FixedCore {
            weights,
            weight_sum,
        };
        let front_end = FrontEndConfig {
            input_lag_samples: delay_samples,
            ..FrontEndConfig::direct(output_register)
        };
        Self::with_core(core, &front_end)
    }
}

impl Core for FixedCore {
    fn update(&mut self, regressors: &[f64], _desired: f64) -> Result<Output, Fault> {
        Ok(Output {
            value_deg_per_h: dot(&self.weights, regressors),
            weight_sum: self.weight_sum,
        })
    }

    fn weights(&self) -> &[f64] {
        &self.weights
    }

    fn given(&self) -> Option<(&[f64], f64)> {
        Some((&self.weights, self.weight_sum))
    }

    fn rule(&self, _desired: DesiredSignal) -> WeightRule {
        WeightRule::Fixed(self.weights.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::filters::common::filter::Filter;

    #[test]
    fn many_samples_at_once_give_the_words_of_one_after_another() {
        // Numbers whose sums round.
        let samples: Vec<f64> = (0..400).map(|k| (f64::from(k * k) * 0.7).sin()).collect();
        for (taps, lag) in [(1, 0), (7, 2), (8, 0), (9, 3), (100, 1)] {
            let weights = samples[..taps].to_vec();
            for register in [OutputRegister::Immediate, OutputRegister::NextSample] {
                let mut one = FixedFilter::delayed(weights.clone(), lag, register);
                let mut many = one.clone();
                let mut outputs = Vec::new();
                for block in samples.chunks(61) {
                    many.step_all(block, &mut outputs).unwrap();
                }
                for (sample, (input, output)) in samples.iter().zip(&outputs).enumerate() {
                    let wanted = one.step(*input).unwrap();
                    let words = [wanted, *output].map(|it| it.value_deg_per_h.to_bits());
                    assert_eq!(words[0], words[1], "{taps} {lag} {sample}");
                }
            }
        }
    }

    #[test]
    fn the_first_word_that_is_none_ends_a_block_where_it_stands() {
        let mut filter = FixedFilter::new(vec![0.1; 10], OutputRegister::Immediate);
        let mut outputs = Vec::new();
        let mut inputs = vec![1.0; 30];
        inputs[17] = f64::NAN;
        let divergence = filter.step_all(&inputs, &mut outputs).unwrap_err();
        assert_eq!((divergence.sample, outputs.len()), (17, 17));
        assert_eq!(filter.step(1.0).unwrap_err(), divergence);
    }
}
