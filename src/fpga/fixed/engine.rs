//! The fixed-point recursion without clocks: same words, no control machine.

use super::CodePair;
use super::config::FixedRlsConfig;
use super::format::Stored;

/// What went beyond the ends of its words, and when R stopped being an inverse correlation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct FixedHealth {
    /// Words of t beyond the ends.
    pub intermediate_overflows: u64,
    /// Denominators beyond the ends.
    pub denominator_overflows: u64,
    /// Gains beyond the ends.
    pub gain_overflows: u64,
    /// Elements of R beyond the ends, each of the two roundings for itself.
    pub inverse_overflows: u64,
    /// Weights beyond the ends.
    pub weight_overflows: u64,
    /// Outputs and errors beyond the ends.
    pub output_overflows: u64,
    /// Diagonal elements of R that the floor held up.
    pub floored: u64,
    /// First sample with a denominator or a diagonal element of R at or below zero.
    pub indefinite_at: Option<u64>,
}

/// Clock-less engine of the fixed-point filter.
#[derive(Clone, Debug)]
pub struct FixedRlsEngine {
    config: FixedRlsConfig,
    head: usize,
    /// Regressors, newest first.
    line: Vec<i64>,
    intermediate: Vec<i64>,
    gain: Vec<i64>,
    weights: Vec<i64>,
    /// R, row by row.
    inverse: Vec<i64>,
    samples: u64,
    health: FixedHealth,
}

/// The code, its overflow counted.
fn counted(stored: Stored, overflows: &mut u64) -> i64 {
    *overflows += u64::from(stored.overflowed);
    stored.code
}

/// `first + a0*b0 + a1*b1 + ...`, exact.
fn dot(first: i128, a: &[i64], b: &[i64]) -> i128 {
    let mut sum = first;
    for (a_j, b_j) in a.iter().zip(b) {
        sum += i128::from(*a_j) * i128::from(*b_j);
    }
    sum
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
            head: p - 1,
            line: vec![0; p],
            intermediate: vec![0; p],
            gain: vec![0; p],
            weights: vec![0; p],
            inverse,
            samples: 0,
            health: FixedHealth::default(),
        }
    }

    /// Filters one pair and returns the code of `y`.
    pub fn process(&mut self, pair: CodePair) -> i64 {
        let config = self.config;
        let p = config.tap_count;
        self.head = (self.head + 1) % p;
        self.line.rotate_right(1);
        self.line[0] = pair.input;
        for i in 0..p {
            let sum = dot(0, &self.line, &self.inverse[i * p..(i + 1) * p]);
            let overflows = &mut self.health.intermediate_overflows;
            self.intermediate[i] = counted(config.intermediate(sum), overflows);
        }
        let sum = dot(config.alpha, &self.line, &self.intermediate);
        let denominator = counted(
            config.denominator(sum),
            &mut self.health.denominator_overflows,
        );
        for i in 0..p {
            let gain = config.gain(self.intermediate[i], denominator);
            self.gain[i] = counted(gain, &mut self.health.gain_overflows);
        }
        self.correct();
        let sum = dot(0, &self.line, &self.weights);
        let output = counted(config.output(sum), &mut self.health.output_overflows);
        let error = counted(
            config.error(pair.desired, output),
            &mut self.health.output_overflows,
        );
        for i in 0..p {
            let product = i128::from(self.gain[i]) * i128::from(error);
            let weight = config.weight(self.weights[i], product);
            self.weights[i] = counted(weight, &mut self.health.weight_overflows);
        }
        self.look(denominator);
        output
    }

    /// Corrects R on and above its diagonal and copies it below.
    fn correct(&mut self) {
        let p = self.config.tap_count;
        for i in 0..p {
            for j in i..p {
                let product = i128::from(self.gain[i]) * i128::from(self.intermediate[j]);
                let [corrected, grown] = self.config.inverse(self.inverse[i * p + j], product);
                let overflows = &mut self.health.inverse_overflows;
                *overflows += u64::from(corrected.overflowed);
                if self.config.inverse_alpha.is_some() {
                    *overflows += u64::from(grown.overflowed);
                }
                let mut code = grown.code;
                if i == j {
                    code = self.config.floored(code);
                    self.health.floored += u64::from(code != grown.code);
                }
                self.inverse[i * p + j] = code;
                self.inverse[j * p + i] = code;
            }
        }
    }

    fn look(&mut self, denominator: i64) {
        let p = self.config.tap_count;
        let is_definite = denominator > 0 && (0..p).all(|i| self.inverse[i * p + i] > 0);
        if !is_definite && self.health.indefinite_at.is_none() {
            self.health.indefinite_at = Some(self.samples);
        }
        self.samples += 1;
    }

    /// Overflows so far, and when R stopped being an inverse correlation.
    #[must_use]
    pub fn health(&self) -> FixedHealth {
        self.health
    }

    /// Codes of the weights, tap 0 (newest regressor word) first.
    #[must_use]
    pub fn weights(&self) -> &[i64] {
        &self.weights
    }

    /// Codes of R, row by row.
    #[must_use]
    pub fn inverse_correlation(&self) -> &[i64] {
        &self.inverse
    }

    /// The words RAMA holds after the last sample: ring of L, then k.
    #[must_use]
    pub fn rama(&self) -> Vec<i64> {
        let p = self.config.tap_count;
        let mut words = vec![0; p];
        for (j, word) in self.line.iter().enumerate() {
            words[(self.head + p - j) % p] = *word;
        }
        [words, self.gain.clone()].concat()
    }

    /// The words RAMB holds after the last sample: W, t, R.
    #[must_use]
    pub fn ramb(&self) -> Vec<i64> {
        let parts: [&[i64]; 3] = [&self.weights, &self.intermediate, &self.inverse];
        parts.concat()
    }
}
