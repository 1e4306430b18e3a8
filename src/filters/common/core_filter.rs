//! A filter: front end, weights and their update, output register, watch.

use super::divergence::{Divergence, Fault, Watch};
use super::filter::{Filter, Output};
use super::front_end::{FrontEnd, FrontEndConfig, Register, adaptive_rule};
use crate::signal::{FilterShape, WeightRule};
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
    samples: u64,
    diverged: Option<Divergence>,
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
            samples: 0,
            diverged: None,
        }
    }

    /// The weights and their update rule.
    #[must_use]
    pub fn core(&self) -> &C {
        &self.core
    }

    fn advance(&mut self, input: f64) -> Result<Output, Fault> {
        self.watch.check_input(input)?;
        let (regressors, desired) = self.front_end.push(input);
        let result = self.core.update(regressors, desired)?;
        self.watch.check_output(result)?;
        Ok(self.register.clock(result))
    }
}

impl<C: Core> Filter for CoreFilter<C> {
    fn step(&mut self, input_deg_per_h: f64) -> Result<Output, Divergence> {
        if let Some(divergence) = &self.diverged {
            return Err(divergence.clone());
        }
        let sample = self.samples;
        self.samples += 1;
        self.advance(input_deg_per_h).map_err(|fault| {
            let divergence = fault.at(sample);
            self.diverged = Some(divergence.clone());
            divergence
        })
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
