//! The line enhancer without clocks: same words, no control machine.

use super::config::FixedSignLmsConfig;
use crate::fpga::fixed::CodePair;
use crate::fpga::fixed::exact::dot;
use crate::fpga::fixed::pipeline::{FixedEngine, FixedHealth};
use crate::fpga::fixed::signal::SignalName;
use crate::fpga::line::DelayLine;

/// Clock-less engine of the line enhancer in fixed point.
#[derive(Clone, Debug)]
pub struct FixedSignLmsEngine {
    config: FixedSignLmsConfig,
    line: DelayLine<i64>,
    weights: Vec<i64>,
    held_samples: usize,
    health: FixedHealth,
}

impl FixedSignLmsEngine {
    /// An engine in the pipeline's reset state.
    #[must_use]
    pub fn new(config: FixedSignLmsConfig) -> Self {
        Self {
            config,
            line: DelayLine::new(config.tap_count, 0),
            weights: vec![config.initial_weight; config.tap_count],
            held_samples: 0,
            health: FixedHealth::default(),
        }
    }

    /// The words RAMA holds after the last sample: the ring of L.
    #[must_use]
    pub fn rama(&self) -> Vec<i64> {
        self.line.ring()
    }

    fn is_held(&mut self, error: i64) -> bool {
        if !self.config.is_beyond(error) {
            self.held_samples = 0;
            return false;
        }
        let is_held = self.held_samples < self.config.hold_samples;
        self.held_samples += usize::from(is_held);
        is_held
    }
}

impl FixedEngine for FixedSignLmsEngine {
    fn process(&mut self, pair: CodePair) -> i64 {
        let config = self.config;
        let formats = config.formats;
        let taps = formats.of_taps();
        self.line.shift(pair.input);
        // The recursion of the hardware is exact, and so the sum itself.
        let norm = dot(0, self.line.words(), self.line.words());
        let overflows = &mut self.health.overflows;
        let denominator = overflows.counted(SignalName::Den, config.denominator(norm));
        let gain = overflows.counted(SignalName::K, config.step.gain(&formats, denominator));
        let sum = dot(0, self.line.words(), &self.weights);
        let output = overflows.counted(SignalName::Y, taps.output(sum));
        let error = overflows.counted(SignalName::Y, taps.error(pair.desired, output));
        let step = if self.is_held(error) {
            0
        } else {
            let stored = config.step_of(error, gain);
            self.health.overflows.counted(SignalName::T, stored)
        };
        let overflows = &mut self.health.overflows;
        formats.correct(&mut self.weights, self.line.words(), step, overflows);
        self.health.close(denominator > 0);
        output
    }

    fn weights(&self) -> &[i64] {
        &self.weights
    }

    fn health(&self) -> FixedHealth {
        self.health
    }
}
