//! What each state of the pipeline does in its clock.
//!
//! Every step reads registers and memories first and assigns after: all values read are those
//! before the edge. Operand order is that of the RTL.

use super::config::Division;
use super::pipeline::RlsPipeline;
use super::state::{RlsRegisters, RlsState};
use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::{Pair, UpdateSign};
use crate::fpga::probe::{Probe, add, divide, multiply, subtract};

impl<F: Fp> RlsPipeline<F> {
    /// Ring slot of tap j: `(HEAD - j) mod p`.
    #[inline]
    fn slot(&self, j: usize) -> usize {
        let head = self.registers.head;
        if head >= j {
            head - j
        } else {
            head + self.config.tap_count - j
        }
    }

    /// RAMB address of `R[i][j]`.
    #[inline]
    fn element(&self) -> usize {
        let p = self.config.tap_count;
        2 * p + self.registers.i * p + self.registers.j
    }

    #[inline]
    fn read_a(&mut self, address: usize, probe: &mut impl Probe<F>) -> F {
        let word = self.rama.read(address);
        probe.rama(address, None, word);
        word
    }

    #[inline]
    fn read_b(&mut self, address: usize, probe: &mut impl Probe<F>) -> F {
        let word = self.ramb.read(address);
        probe.ramb(address, None, word);
        word
    }

    #[inline]
    fn write_a(&mut self, address: usize, word: F, probe: &mut impl Probe<F>) {
        probe.rama(address, Some(word), self.rama.words()[address]);
        self.rama.write(address, word);
    }

    #[inline]
    fn write_b(&mut self, address: usize, word: F, probe: &mut impl Probe<F>) {
        probe.ramb(address, Some(word), self.ramb.words()[address]);
        self.ramb.write(address, word);
    }

    /// RiL_loading: the oldest slot of the ring takes the new word, so nothing has to shift.
    #[inline]
    pub(super) fn load(&mut self, input: Option<Pair<F>>, probe: &mut impl Probe<F>) {
        let Some(pair) = input else {
            self.registers.state = RlsState::Idle;
            return;
        };
        let next = self.registers.head + 1;
        let head = if next == self.config.tap_count {
            0
        } else {
            next
        };
        self.write_a(head, pair.input, probe);
        self.registers.head = head;
        self.registers.desired = pair.desired;
        self.registers.i = 0;
        self.registers.j = 0;
        self.registers.phase = 0;
        self.registers.state = RlsState::RiLReading;
    }

    /// One clock of a dot product: `P <- A*B`, `ACC <- first` or `ACC + P`.
    #[inline]
    fn accumulate(&mut self, b: usize, first: F, done: RlsState, probe: &mut impl Probe<F>) {
        let j = self.registers.j;
        let l_j = self.read_a(self.slot(j), probe);
        let b_j = self.read_b(b, probe);
        let sum = if j == 0 {
            first
        } else {
            add(probe, self.registers.accumulator, self.registers.product)
        };
        self.registers.product = multiply(probe, l_j, b_j);
        self.registers.accumulator = sum;
        if j + 1 == self.config.tap_count {
            self.registers.j = 0;
            self.registers.state = done;
        } else {
            self.registers.j = j + 1;
        }
    }

    /// RiL_reading and RFM_reading: a row of R times L, started at `+0`.
    #[inline]
    pub(super) fn accumulate_row(&mut self, probe: &mut impl Probe<F>) {
        let done = if self.registers.state == RlsState::RiLReading {
            RlsState::RiLWriting
        } else {
            RlsState::RfmWriting
        };
        self.accumulate(self.element(), F::ZERO, done, probe);
    }

    /// LRL_reading: `L't`, started at alpha, since the adder has no clock left to add it later.
    #[inline]
    pub(super) fn accumulate_denominator(&mut self, probe: &mut impl Probe<F>) {
        let b = self.config.tap_count + self.registers.j;
        self.accumulate(b, self.config.alpha, RlsState::LrlWriting, probe);
    }

    /// Out_reading: `W'L` with the weights before this sample's update.
    #[inline]
    pub(super) fn accumulate_output(&mut self, probe: &mut impl Probe<F>) {
        let b = self.registers.j;
        self.accumulate(b, F::ZERO, RlsState::OutWriting, probe);
    }

    /// The last sum of a dot product.
    #[inline]
    fn last_sum(&self, probe: &mut impl Probe<F>) -> F {
        add(probe, self.registers.accumulator, self.registers.product)
    }

    /// Counts the row up; `true` after the last one, with the counter back at zero.
    #[inline]
    fn row_done(&mut self) -> bool {
        let next = self.registers.i + 1;
        let done = next == self.config.tap_count;
        self.registers.i = if done { 0 } else { next };
        done
    }

    /// RiL_writing: `t_i` goes to both memories, so that LRL and RFR find both factors in one clock.
    #[inline]
    pub(super) fn write_intermediate(&mut self, probe: &mut impl Probe<F>) {
        let sum = self.last_sum(probe);
        let address = self.config.tap_count + self.registers.i;
        self.write_a(address, sum, probe);
        self.write_b(address, sum, probe);
        self.registers.state = if self.row_done() {
            RlsState::LrlReading
        } else {
            RlsState::RiLReading
        };
    }

    /// LRL_writing: DEN has no word in a memory.
    #[inline]
    pub(super) fn write_denominator(&mut self, probe: &mut impl Probe<F>) {
        self.registers.denominator = self.last_sum(probe);
        self.registers.state = RlsState::RfrReading;
    }

    /// RFR_reading: `t_i * t_j`, then its quotient, while `R[i][j]` is latched. The product of the
    /// two t comes first: it commutes, which keeps R symmetric to the bit.
    #[inline]
    pub(super) fn correct_read(&mut self, probe: &mut impl Probe<F>) {
        let RlsRegisters {
            i,
            j,
            product,
            denominator,
            ..
        } = self.registers;
        if self.registers.phase == 0 {
            let t_i = self.read_a(self.config.tap_count + i, probe);
            let t_j = self.read_b(self.config.tap_count + j, probe);
            if i == 0 && j == 0 && self.config.division == Division::Reciprocal {
                self.registers.reciprocal = divide(probe, F::ONE, denominator);
            }
            self.registers.product = multiply(probe, t_i, t_j);
            self.registers.phase = 1;
        } else {
            self.registers.read_latch = self.read_b(self.element(), probe);
            self.registers.product = match self.config.division {
                Division::Reciprocal => multiply(probe, product, self.registers.reciprocal),
                Division::Element => divide(probe, product, denominator),
            };
            self.registers.phase = 2;
            self.registers.state = RlsState::RfrWriting;
        }
    }

    /// RFR_writing: `(R - correction) * ialpha`, the only clock that chains two operations.
    #[inline]
    pub(super) fn correct_write(&mut self, probe: &mut impl Probe<F>) {
        let difference = subtract(probe, self.registers.read_latch, self.registers.product);
        let corrected = multiply(probe, difference, self.config.inverse_alpha);
        self.write_b(self.element(), corrected, probe);
        self.registers.phase = 0;
        self.registers.state = RlsState::RfrReading;
        if self.registers.j + 1 == self.config.tap_count {
            self.registers.j = 0;
            if self.row_done() {
                self.registers.state = RlsState::RfmReading;
            }
        } else {
            self.registers.j += 1;
        }
    }

    /// RFM_writing: `M_i` replaces `t_i` in RAMA; t stays in RAMB.
    #[inline]
    pub(super) fn write_gain(&mut self, probe: &mut impl Probe<F>) {
        let sum = self.last_sum(probe);
        self.write_a(self.config.tap_count + self.registers.i, sum, probe);
        self.registers.state = if self.row_done() {
            RlsState::OutReading
        } else {
            RlsState::RfmReading
        };
    }

    /// Out_writing: the result is registered.
    #[inline]
    pub(super) fn write_output(&mut self, probe: &mut impl Probe<F>) {
        self.registers.output = self.last_sum(probe);
        self.registers.state = RlsState::RfwReading;
    }

    /// RFW_reading: the error in the first clock, then `M_i * e` while `W_i` is latched.
    #[inline]
    pub(super) fn weight_read(&mut self, probe: &mut impl Probe<F>) {
        if self.registers.phase == 0 {
            let error = subtract(probe, self.registers.desired, self.registers.output);
            self.registers.error = error;
            self.registers.phase = 1;
            return;
        }
        let i = self.registers.i;
        let gain = self.read_a(self.config.tap_count + i, probe);
        self.registers.read_latch = self.read_b(i, probe);
        self.registers.product = multiply(probe, gain, self.registers.error);
        self.registers.phase = 2;
        self.registers.state = RlsState::RfwWriting;
    }

    /// RFW_writing: the new weight; after the last one the next sample is loaded at once.
    #[inline]
    pub(super) fn weight_write(&mut self, next_waits: bool, probe: &mut impl Probe<F>) {
        let RlsRegisters {
            i,
            read_latch,
            product,
            ..
        } = self.registers;
        let weight = match self.config.update_sign {
            UpdateSign::Corrected => add(probe, read_latch, product),
            UpdateSign::AsPrinted => subtract(probe, read_latch, product),
        };
        self.write_b(i, weight, probe);
        if self.row_done() {
            self.registers.phase = 0;
            // Passing through Idle would cost a clock and the paper's 370 kHz.
            self.registers.state = if next_waits {
                RlsState::RiLLoading
            } else {
                RlsState::Idle
            };
        } else {
            self.registers.phase = 1;
            self.registers.state = RlsState::RfwReading;
        }
    }
}
