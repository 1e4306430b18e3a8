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

    fn rule(&self, _desired: DesiredSignal) -> WeightRule {
        WeightRule::Fixed(self.weights.clone())
    }
}
