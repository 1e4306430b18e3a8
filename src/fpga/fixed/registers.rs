//! Registers of a fixed-point control machine, and the steps that the machines share.

use super::CodePair;
use super::datapath::FixedDatapath;
use super::step::LmsFormats;
use super::taps::TapFormats;
use crate::fpga::registers::ControlState;

/// Registers, named as in the RTL. One that a pipeline has not built stays at zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FixedRegisters<S> {
    /// Control state.
    pub state: S,
    /// Row counter.
    pub i: usize,
    /// Column (tap) counter.
    pub j: usize,
    /// Second clock of a state that has two kinds of them.
    pub second: bool,
    /// Third one.
    pub third: bool,
    /// Ring slot HEAD of the newest regressor word.
    pub head: usize,
    /// Product P, exact.
    pub product: i128,
    /// Accumulator ACC, exact.
    pub accumulator: i128,
    /// Read latch RR.
    pub read_latch: i64,
    /// Denominator DEN.
    pub denominator: i64,
    /// Gain K, where it is no word of a memory.
    pub gain: i64,
    /// Intermediate T, where it is no word of a memory.
    pub intermediate: i64,
    /// Desired word D.
    pub desired: i64,
    /// Error E.
    pub error: i64,
    /// Output Y.
    pub output: i64,
}

impl<S: ControlState> FixedRegisters<S> {
    /// Values after reset: all zero, HEAD p-1 so that sample 0 goes to slot 0.
    #[must_use]
    pub fn reset(tap_count: usize) -> Self {
        Self {
            state: S::IDLE,
            i: 0,
            j: 0,
            second: false,
            third: false,
            head: tap_count - 1,
            product: 0,
            accumulator: 0,
            read_latch: 0,
            denominator: 0,
            gain: 0,
            intermediate: 0,
            desired: 0,
            error: 0,
            output: 0,
        }
    }

    /// The same with the code of the state on the state bus of the RTL.
    pub(super) fn coded(self) -> FixedRegisters<u8> {
        FixedRegisters {
            state: self.state.code(),
            i: self.i,
            j: self.j,
            second: self.second,
            third: self.third,
            head: self.head,
            product: self.product,
            accumulator: self.accumulator,
            read_latch: self.read_latch,
            denominator: self.denominator,
            gain: self.gain,
            intermediate: self.intermediate,
            desired: self.desired,
            error: self.error,
            output: self.output,
        }
    }

    /// Ring slot of tap j: `(HEAD - j) mod p`.
    pub(super) fn slot(&self, j: usize, tap_count: usize) -> usize {
        (self.head + tap_count - j) % tap_count
    }

    /// Ring slot after HEAD, which holds the oldest word: `(HEAD + 1) mod p`.
    pub(super) fn next_slot(&self, tap_count: usize) -> usize {
        (self.head + 1) % tap_count
    }

    /// Loading clock: the regressor word enters the ring of L, the desired word its register.
    pub(super) fn load_pair(
        &mut self,
        pair: CodePair,
        tap_count: usize,
        datapath: &mut FixedDatapath<'_>,
    ) {
        self.enter_ring(pair.input, tap_count, datapath);
        self.desired = pair.desired;
    }

    /// Writing clock of the ring of L: the word takes the slot of the oldest one.
    pub(super) fn enter_ring(
        &mut self,
        word: i64,
        tap_count: usize,
        datapath: &mut FixedDatapath<'_>,
    ) {
        self.head = self.next_slot(tap_count);
        datapath.write_a(self.head, word);
    }

    /// One clock of a dot product of L with the words of RAMB: `P <- L_j*B_j`, `ACC <- first` or `ACC + P`.
    ///
    /// * `start`: address of `B_0`. * `first`: what the sum starts at. * `done`: state after the last tap.
    pub(super) fn accumulate_taps(
        &mut self,
        start: usize,
        first: i128,
        tap_count: usize,
        done: S,
        datapath: &mut FixedDatapath<'_>,
    ) {
        let l_j = datapath.read_a(self.slot(self.j, tap_count));
        let b_j = datapath.read_b(start + self.j);
        self.accumulate((l_j, b_j), first, tap_count, done, datapath);
    }

    /// One clock of the sum of squares `L'L`, both factors from one read of RAMA.
    ///
    /// * `first`: what the sum starts at. * `done`: state after the last tap.
    pub(super) fn accumulate_squares(
        &mut self,
        first: i128,
        tap_count: usize,
        done: S,
        datapath: &mut FixedDatapath<'_>,
    ) {
        let l_j = datapath.read_a(self.slot(self.j, tap_count));
        self.accumulate((l_j, l_j), first, tap_count, done, datapath);
    }

    /// One clock of a dot product over the taps: `P <- a*b`, `ACC <- first` or `ACC + P`.
    fn accumulate(
        &mut self,
        (a, b): (i64, i64),
        first: i128,
        tap_count: usize,
        done: S,
        datapath: &mut FixedDatapath<'_>,
    ) {
        self.accumulator = if self.j == 0 {
            first
        } else {
            self.last_sum(datapath)
        };
        self.product = datapath.multiply(a, b);
        self.next_tap(tap_count, done);
    }

    /// The last sum of a dot product, in its writing clock: `ACC + P`.
    pub(super) fn last_sum(&self, datapath: &mut FixedDatapath<'_>) -> i128 {
        datapath.add(self.accumulator, self.product)
    }

    /// Writing clock of the dot product of L and W: `Y <- Q_y(ACC + P)`, on to `done`.
    pub(super) fn write_output(
        &mut self,
        formats: &TapFormats,
        done: S,
        datapath: &mut FixedDatapath<'_>,
    ) {
        let sum = self.last_sum(datapath);
        self.output = formats.output(sum).code;
        self.state = done;
    }

    /// Reading clock of a weight behind the ring of L: `P <- L_j*T`, `RR <- W_j`, on to `writing`.
    pub(super) fn read_weight(
        &mut self,
        tap_count: usize,
        writing: S,
        datapath: &mut FixedDatapath<'_>,
    ) {
        let l_j = datapath.read_a(self.slot(self.j, tap_count));
        self.read_latch = datapath.read_b(self.j);
        self.product = datapath.multiply(l_j, self.intermediate);
        self.state = writing;
    }

    /// Writing clock of a weight: `W_j <- Q_W(RR + P)`.
    ///
    /// * `again`: state before the next tap. * `done`: state after the last one.
    pub(super) fn correct_weight(
        &mut self,
        formats: &LmsFormats,
        tap_count: usize,
        (again, done): (S, S),
        datapath: &mut FixedDatapath<'_>,
    ) {
        datapath.count_sum();
        let weight = formats.weight(self.read_latch, self.product).code;
        datapath.write_b(self.j, weight);
        self.state = again;
        self.next_tap(tap_count, done);
    }

    /// One clock of clearing: a word of the ring of L and `W_j <- weight`; idle after the last tap.
    pub(super) fn clear_tap(
        &mut self,
        weight: i64,
        tap_count: usize,
        datapath: &mut FixedDatapath<'_>,
    ) {
        datapath.write_a(self.j, 0);
        datapath.write_b(self.j, weight);
        self.next_tap(tap_count, S::IDLE);
    }

    /// On to the next tap, after the last one to `done`.
    fn next_tap(&mut self, tap_count: usize, done: S) {
        self.j = (self.j + 1) % tap_count;
        if self.j == 0 {
            self.state = done;
        }
    }
}
