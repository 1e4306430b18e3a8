//! The fixed-point recursion without clocks: same words, no control machine.

use super::config::FixedRlsConfig;
use crate::fpga::fixed::CodePair;
use crate::fpga::fixed::exact::dot;
use crate::fpga::fixed::pipeline::{CodeMatrix, FixedEngine, FixedHealth};
use crate::fpga::fixed::signal::SignalName;
use crate::fpga::line::DelayLine;

/// Clock-less engine of the fixed-point filter.
#[derive(Clone, Debug)]
pub struct FixedRlsEngine {
    config: FixedRlsConfig,
    line: DelayLine<i64>,
    intermediate: Vec<i64>,
    gain: Vec<i64>,
    weights: Vec<i64>,
    /// R, row by row.
    inverse: Vec<i64>,
    health: FixedHealth,
}

impl FixedRlsEngine {
    /// An engine in the pipeline's reset state.
    #[must_use]
    pub fn new(config: FixedRlsConfig) -> Self {
        let p = config.tap_count;
        let mut inverse = vec![0; p * p];
        for i in 0..p {
            inverse[i * p + i] = config.delta;
        }
        Self {
            config,
            line: DelayLine::new(p, 0),
            intermediate: vec![0; p],
            gain: vec![0; p],
            weights: vec![0; p],
            inverse,
            health: FixedHealth::default(),
        }
    }

    /// Corrects R on and above its diagonal and copies it below.
    fn correct(&mut self) {
        let p = self.config.tap_count;
        for i in 0..p {
            for j in i..p {
                let product = i128::from(self.gain[i]) * i128::from(self.intermediate[j]);
                let [corrected, grown] = self.config.inverse(self.inverse[i * p + j], product);
                let overflows = &mut self.health.overflows;
                let mut code = overflows.counted(SignalName::R, corrected);
                if self.config.inverse_alpha.is_some() {
                    code = overflows.counted(SignalName::R, grown);
                }
                if i == j {
                    let held = self.config.floored(code);
                    self.health.floored += u64::from(held != code);
                    code = held;
                }
                self.inverse[i * p + j] = code;
                self.inverse[j * p + i] = code;
            }
        }
    }

    fn is_definite(&self, denominator: i64) -> bool {
        let p = self.config.tap_count;
        denominator > 0 && (0..p).all(|i| self.inverse[i * p + i] > 0)
    }

    /// The words RAMA holds after the last sample: ring of L, then k.
    #[must_use]
    pub fn rama(&self) -> Vec<i64> {
        [self.line.ring(), self.gain.clone()].concat()
    }

    /// The words RAMB holds after the last sample: W, t, R.
    #[must_use]
    pub fn ramb(&self) -> Vec<i64> {
        let parts: [&[i64]; 3] = [&self.weights, &self.intermediate, &self.inverse];
        parts.concat()
    }
}

impl FixedEngine for FixedRlsEngine {
    fn process(&mut self, pair: CodePair) -> i64 {
        let config = self.config;
        let p = config.tap_count;
        let taps = config.formats.of_taps();
        self.line.shift(pair.input);
        for i in 0..p {
            let sum = dot(0, self.line.words(), &self.inverse[i * p..(i + 1) * p]);
            let stored = config.intermediate(sum);
            self.intermediate[i] = self.health.overflows.counted(SignalName::T, stored);
        }
        let sum = dot(config.alpha, self.line.words(), &self.intermediate);
        let stored = config.denominator(sum);
        let denominator = self.health.overflows.counted(SignalName::Den, stored);
        for i in 0..p {
            let stored = config.gain(self.intermediate[i], denominator);
            self.gain[i] = self.health.overflows.counted(SignalName::K, stored);
        }
        self.correct();
        let overflows = &mut self.health.overflows;
        let sum = dot(0, self.line.words(), &self.weights);
        let output = overflows.counted(SignalName::Y, taps.output(sum));
        let error = overflows.counted(SignalName::Y, taps.error(pair.desired, output));
        for i in 0..p {
            let product = i128::from(self.gain[i]) * i128::from(error);
            let weight = config.weight(self.weights[i], product);
            self.weights[i] = overflows.counted(SignalName::W, weight);
        }
        self.health.close(self.is_definite(denominator));
        output
    }

    fn weights(&self) -> &[i64] {
        &self.weights
    }

    fn health(&self) -> FixedHealth {
        self.health
    }

    fn inverse_correlation(&self) -> Option<CodeMatrix<'_>> {
        Some(CodeMatrix {
            codes: &self.inverse,
            format: self.config.formats.inverse,
            delta: self.config.initial_inverse_correlation,
            alpha: self.config.forgetting_factor,
        })
    }
}
