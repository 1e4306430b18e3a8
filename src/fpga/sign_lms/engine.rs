//! The line enhancer without clocks: same words, no control machine.
//!
//! ```text
//! T    = T + x*x                                     in the M samples before S is replaced
//! S    = clamp((S + x*x) - o*o)                      or T; o the word that leaves the taps
//! den  = alpha + S
//! y    = ((+0 + L0*W0) + L1*W1) + ...
//! e    = d - y
//! g    = sgn(e) * (mu / den)                         normalised: e * (mu / den); held: +0
//! W[j] = W[j] + L[j]*g
//! ```

use super::config::{SignLmsConfig, clamp, signed};
use crate::fpga::engine::Engine;
use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::Pair;
use crate::fpga::line::DelayLine;

/// Clock-less engine of the line enhancer.
#[derive(Clone, Debug)]
pub struct SignLmsEngine<F> {
    config: SignLmsConfig<F>,
    line: DelayLine<F>,
    weights: Vec<F>,
    norm: F,
    fresh: F,
    age: u32,
    held_samples: usize,
}

impl<F: Fp> SignLmsEngine<F> {
    /// An engine in the pipeline's reset state.
    #[must_use]
    pub fn new(config: SignLmsConfig<F>) -> Self {
        Self {
            config,
            line: DelayLine::new(config.tap_count, F::ZERO),
            weights: vec![config.initial_weight; config.tap_count],
            norm: F::ZERO,
            fresh: F::ZERO,
            age: 0,
            held_samples: 0,
        }
    }

    /// Back to the state after reset.
    pub fn reset(&mut self) {
        *self = Self::new(self.config);
    }

    /// The constants.
    #[must_use]
    pub fn config(&self) -> &SignLmsConfig<F> {
        &self.config
    }

    /// The recursive norm S.
    #[must_use]
    pub fn norm(&self) -> F {
        self.norm
    }

    /// The words RAMA holds after the last sample: the ring of L.
    #[must_use]
    pub fn rama(&self) -> Vec<F> {
        self.line.ring()
    }

    /// The words RAMB holds after the last sample: W.
    #[must_use]
    pub fn ramb(&self) -> Vec<F> {
        self.weights.clone()
    }

    fn slide(&mut self, entering: F, leaving: F) {
        let interval = self.config.norm_recompute_samples as usize;
        let reach = self.age as usize + self.config.tap_count;
        if interval != 0 && reach >= interval {
            let base = if reach == interval {
                F::ZERO
            } else {
                self.fresh
            };
            self.fresh = base.add(entering);
        }
        self.norm = clamp(self.norm.add(entering).sub(leaving));
        if interval == 0 {
            return;
        }
        self.age += 1;
        if self.age as usize == interval {
            self.norm = self.fresh;
            self.age = 0;
        }
    }

    fn is_held(&mut self, error: F) -> bool {
        if !self.config.is_beyond(error) {
            self.held_samples = 0;
            return false;
        }
        let is_held = self.held_samples < self.config.hold_samples;
        self.held_samples += usize::from(is_held);
        is_held
    }
}

impl<F: Fp> Engine<F> for SignLmsEngine<F> {
    #[inline]
    fn process(&mut self, pair: Pair<F>) -> F {
        let leaving = self.line.words()[self.config.tap_count - 1];
        self.line.shift(pair.input);
        self.slide(pair.input.mul(pair.input), leaving.mul(leaving));
        let step = self
            .config
            .step
            .div(self.config.regularisation.add(self.norm));
        let mut output = F::ZERO;
        for (l_j, w_j) in self.line.words().iter().zip(&self.weights) {
            output = output.add(l_j.mul(*w_j));
        }
        let error = pair.desired.sub(output);
        let gain = if self.is_held(error) {
            F::ZERO
        } else if self.config.normalised {
            error.mul(step)
        } else {
            signed(step, error)
        };
        for (l_j, w_j) in self.line.words().iter().zip(&mut self.weights) {
            *w_j = w_j.add(l_j.mul(gain));
        }
        output
    }

    #[inline]
    fn weights(&self) -> &[F] {
        &self.weights
    }
}
