//! The LMS recursion without clocks: same words, no control machine.

use super::config::{FixedLmsConfig, Step};
use crate::fpga::fixed::CodePair;
use crate::fpga::fixed::exact::dot;
use crate::fpga::fixed::pipeline::{FixedEngine, FixedHealth};
use crate::fpga::fixed::signal::SignalName;
use crate::fpga::line::DelayLine;

/// Clock-less engine of LMS and NLMS in fixed point.
#[derive(Clone, Debug)]
pub struct FixedLmsEngine {
    config: FixedLmsConfig,
    line: DelayLine<i64>,
    weights: Vec<i64>,
    health: FixedHealth,
}

impl FixedLmsEngine {
    /// An engine in the pipeline's reset state.
    #[must_use]
    pub fn new(config: FixedLmsConfig) -> Self {
        Self {
            config,
            line: DelayLine::new(config.tap_count, 0),
            weights: vec![0; config.tap_count],
            health: FixedHealth::default(),
        }
    }

    /// The words RAMA holds after the last sample: the ring of L.
    #[must_use]
    pub fn rama(&self) -> Vec<i64> {
        self.line.ring()
    }

    /// The gain of this sample, and whether its denominator is above zero.
    fn gain(&mut self) -> (i64, bool) {
        let step = match self.config.step {
            Step::Given(code) => return (code, true),
            Step::OverEnergy(step) => step,
        };
        let overflows = &mut self.health.overflows;
        let energy = dot(step.regularisation, self.line.words(), self.line.words());
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
        let taps = formats.of_taps();
        self.line.shift(pair.input);
        let (gain, is_definite) = self.gain();
        let overflows = &mut self.health.overflows;
        let sum = dot(0, self.line.words(), &self.weights);
        let output = overflows.counted(SignalName::Y, taps.output(sum));
        let error = overflows.counted(SignalName::Y, taps.error(pair.desired, output));
        let product = i128::from(error) * i128::from(gain);
        let step = overflows.counted(SignalName::T, formats.step(product));
        formats.correct(&mut self.weights, self.line.words(), step, overflows);
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
