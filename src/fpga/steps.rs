//! Steps that the machines of several pipelines take in a clock.

use super::datapath::Datapath;
use super::float_unit::Fp;
use super::probe::Probe;
use super::registers::{ControlState, Registers};

impl<S: ControlState, F: Fp> Registers<S, F> {
    /// One clock of a dot product over the taps: `P <- a*b`, `ACC <- first` or `ACC + P`.
    ///
    /// * `first`: what the sum starts at.
    /// * `done`: state after the last tap.
    #[inline]
    pub(super) fn accumulate(
        &mut self,
        (a, b): (F, F),
        first: F,
        tap_count: usize,
        done: S,
        datapath: &mut Datapath<'_, F, impl Probe<F>>,
    ) {
        self.accumulator = if self.j == 0 {
            first
        } else {
            datapath.add(self.accumulator, self.product)
        };
        self.product = datapath.multiply(a, b);
        self.j += 1;
        if self.j == tap_count {
            self.j = 0;
            self.state = done;
        }
    }

    /// The last sum of a dot product, in its writing clock: `ACC + P`.
    #[inline]
    pub(super) fn last_sum(&self, datapath: &mut Datapath<'_, F, impl Probe<F>>) -> F {
        datapath.add(self.accumulator, self.product)
    }

    /// Reading clock of a weight behind the ring of L: `P <- L_j*E`, `RR <- W_j`.
    #[inline]
    pub(super) fn read_weight(
        &mut self,
        tap_count: usize,
        datapath: &mut Datapath<'_, F, impl Probe<F>>,
    ) {
        let l_j = datapath.read_a(self.slot(self.j, tap_count));
        self.read_latch = datapath.read_b(self.j);
        self.product = datapath.multiply(l_j, self.error);
    }

    /// Writing clock of a weight: `W_j <- weight`, on to the next tap; whether it was the last one.
    #[inline]
    pub(super) fn write_weight(
        &mut self,
        weight: F,
        tap_count: usize,
        datapath: &mut Datapath<'_, F, impl Probe<F>>,
    ) -> bool {
        datapath.write_b(self.j, weight);
        self.j += 1;
        let is_last = self.j == tap_count;
        if is_last {
            self.j = 0;
        }
        is_last
    }
}
