//! The LMS recursion without clocks: same words, no control machine.
//!
//! ```text
//! d    = (x + x_previous) * 0.5                      or the port
//! den  = ((eps + L0*L0) + L1*L1) + ...               NLMS only
//! y    = ((+0 + L0*W0) + L1*W1) + ...
//! e    = (d - y) * mu                                NLMS: (d - y) * (mu / den)
//! W[j] = W[j] + L[j]*e
//! ```

use super::config::{DesiredSource, LmsConfig};
use crate::fpga::engine::Engine;
use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::Pair;
use crate::fpga::line::DelayLine;
use crate::vocabulary::UpdateSign;

/// Clock-less LMS and NLMS engine.
#[derive(Clone, Debug)]
pub struct LmsEngine<F> {
    config: LmsConfig<F>,
    line: DelayLine<F>,
    weights: Vec<F>,
    previous: F,
}

impl<F: Fp> LmsEngine<F> {
    /// An engine in the pipeline's reset state.
    #[must_use]
    pub fn new(config: LmsConfig<F>) -> Self {
        Self {
            config,
            line: DelayLine::new(config.tap_count, F::ZERO),
            weights: vec![F::ZERO; config.tap_count],
            previous: F::ZERO,
        }
    }

    /// Back to the state after reset.
    pub fn reset(&mut self) {
        *self = Self::new(self.config);
    }

    /// The constants.
    #[must_use]
    pub fn config(&self) -> &LmsConfig<F> {
        &self.config
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
}

impl<F: Fp> Engine<F> for LmsEngine<F> {
    #[inline]
    fn process(&mut self, pair: Pair<F>) -> F {
        self.line.shift(pair.input);
        let desired = match self.config.desired {
            DesiredSource::MeanOfTwoNewest => pair.input.add(self.previous).mul(self.config.half),
            DesiredSource::Port => pair.desired,
        };
        self.previous = pair.input;
        let factor = match self.config.regularisation {
            Some(first) => {
                let mut energy = first;
                for l_j in self.line.words() {
                    energy = energy.add(l_j.mul(*l_j));
                }
                self.config.step_size.div(energy)
            }
            None => self.config.step_size,
        };
        let mut output = F::ZERO;
        for (l_j, w_j) in self.line.words().iter().zip(&self.weights) {
            output = output.add(l_j.mul(*w_j));
        }
        let error = desired.sub(output).mul(factor);
        for (l_j, w_j) in self.line.words().iter().zip(&mut self.weights) {
            let correction = l_j.mul(error);
            *w_j = match self.config.update_sign {
                UpdateSign::Corrected => w_j.add(correction),
                UpdateSign::AsPrinted => w_j.sub(correction),
            };
        }
        output
    }

    #[inline]
    fn weights(&self) -> &[F] {
        &self.weights
    }
}
