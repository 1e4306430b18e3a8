//! The LMS recursion without clocks: same words, no control machine.

use super::config::{FixedLmsConfig, Step};
use crate::fpga::fixed::CodePair;
use crate::fpga::fixed::exact::{dot, ring};
use crate::fpga::fixed::pipeline::{FixedEngine, FixedHealth};
use crate::fpga::fixed::signal::SignalName;

/// Clock-less engine of LMS and NLMS in fixed point.
#[derive(Clone, Debug)]
pub struct FixedLmsEngine {
    config: FixedLmsConfig,
    head: usize,
    /// Regressors, newest first.
    line: Vec<i64>,
    weights: Vec<i64>,
    health: FixedHealth,
}

impl FixedLmsEngine {
    /// An engine in the pipeline's reset state.
    #[must_use]
    pub fn new(config: FixedLmsConfig) -> Self {
        Self {
            config,
            head: config.tap_count - 1,
            line: vec![0; config.tap_count],
            weights: vec![0; config.tap_count],
            health: FixedHealth::default(),
        }
    }

    /// The words RAMA holds after the last sample: the ring of L.
    #[must_use]
    pub fn rama(&self) -> Vec<i64> {
        ring(&self.line, self.head)
    }

    /// The gain of this sample, and whether its denominator is above zero.
    fn gain(&mut self) -> (i64, bool) {
        let step = match self.config.step {
            Step::Given(code) => return (code, true),
            Step::OverEnergy(step) => step,
        };
        let overflows = &mut self.health.overflows;
        let energy = dot(step.regularisation, &self.line, &self.line);
        let stored = self.config.denominator(energy);
        let denominator = overflows.counted(SignalName::Den, stored);
        let stored = step.gain(&self.config.formats, denominator);
        let gain = overflows.counted(SignalName::K, stored);
        (gain, denominator > 0)
    }
}

impl FixedEngine for FixedLmsEngine {
    fn process(&mut self, pair: CodePair) -> i64 {
        let formats = self.config.formats;
        self.head = (self.head + 1) % self.config.tap_count;
        self.line.rotate_right(1);
        self.line[0] = pair.input;
        let (gain, is_definite) = self.gain();
        let overflows = &mut self.health.overflows;
        let sum = dot(0, &self.line, &self.weights);
        let output = overflows.counted(SignalName::Y, formats.output(sum));
        let error = overflows.counted(SignalName::Y, formats.error(pair.desired, output));
        let product = i128::from(error) * i128::from(gain);
        let step = overflows.counted(SignalName::T, formats.step(product));
        for (l_j, w_j) in self.line.iter().zip(&mut self.weights) {
            let product = i128::from(*l_j) * i128::from(step);
            *w_j = overflows.counted(SignalName::W, formats.weight(*w_j, product));
        }
        self.health.close(is_definite);
        output
    }

    fn weights(&self) -> &[i64] {
        &self.weights
    }

    fn health(&self) -> FixedHealth {
        self.health
    }
}
