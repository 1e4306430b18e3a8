//! The control machine of the RLS pipeline: what each state does in its clock.

use super::config::RlsConfig;
use super::state::RlsState;
use crate::fpga::datapath::Datapath;
use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::Pair;
use crate::fpga::machine::{Machine, Sequencer};
use crate::fpga::memory::SinglePortRam;
use crate::fpga::probe::Probe;
use crate::fpga::registers::Registers;
use crate::fpga::timing::Units;
use crate::vocabulary::{Division, UpdateSign};

/// The clocked RLS pipeline. RAMA: `0..p` ring of L, `p..2p` t, then M. RAMB: `0..p` W, `p..2p` t,
/// `2p + i*p + j` R, row by row.
pub type RlsPipeline<F> = Sequencer<RlsMachine<F>>;

/// Control machine and registers of the RLS pipeline.
#[derive(Clone, Debug)]
pub struct RlsMachine<F> {
    config: RlsConfig<F>,
    registers: Registers<RlsState, F>,
    /// Words before R that are cleared.
    cleared: usize,
}

impl<F: Fp> Machine for RlsMachine<F> {
    type Word = F;
    type Config = RlsConfig<F>;
    type State = RlsState;

    const LOADING: RlsState = RlsState::RiLLoading;
    const CLEARING: RlsState = RlsState::Clearing;

    fn new(config: RlsConfig<F>) -> Self {
        Self {
            config,
            registers: Registers::reset(config.tap_count),
            cleared: 0,
        }
    }

    fn memories(config: &RlsConfig<F>) -> [SinglePortRam<F>; 2] {
        let p = config.tap_count;
        let mut ramb = SinglePortRam::new("RAMB", 2 * p + p * p);
        for i in 0..p {
            ramb.preload(2 * p + i * p + i, config.delta);
        }
        [SinglePortRam::new("RAMA", 2 * p), ramb]
    }

    #[inline]
    fn config(&self) -> &RlsConfig<F> {
        &self.config
    }

    #[inline]
    fn registers(&self) -> &Registers<RlsState, F> {
        &self.registers
    }

    #[inline]
    fn registers_mut(&mut self) -> &mut Registers<RlsState, F> {
        &mut self.registers
    }

    #[inline]
    fn units(&self) -> Units {
        self.config.units
    }

    #[inline]
    fn strobes_output(&self) -> bool {
        self.registers.state == RlsState::RfwReading && self.registers.phase == 0
    }

    /// RiL_loading: the oldest slot of the ring takes the new word, so nothing has to shift.
    #[inline]
    fn load<Q: Probe<F>>(&mut self, pair: Pair<F>, datapath: &mut Datapath<'_, F, Q>) {
        let head = self.registers.next_slot(self.config.tap_count);
        datapath.write_a(head, pair.input);
        self.registers.head = head;
        self.registers.desired = pair.desired;
        self.registers.i = 0;
        self.registers.j = 0;
        self.registers.phase = 0;
        self.registers.state = RlsState::RiLReading;
    }

    #[inline]
    fn step<Q: Probe<F>>(&mut self, next_waits: bool, datapath: &mut Datapath<'_, F, Q>) {
        match self.registers.state {
            // The sequencer's own: waiting and loading.
            RlsState::Idle | RlsState::RiLLoading => {}
            RlsState::RiLReading | RlsState::RfmReading => self.accumulate_row(datapath),
            RlsState::LrlReading => self.accumulate_denominator(datapath),
            RlsState::OutReading => self.accumulate_output(datapath),
            RlsState::RiLWriting => self.write_intermediate(datapath),
            RlsState::LrlWriting => self.write_denominator(datapath),
            RlsState::RfrReading => self.correct_read(datapath),
            RlsState::RfrWriting => self.correct_write(datapath),
            RlsState::RfmWriting => self.write_gain(datapath),
            RlsState::OutWriting => self.write_output(datapath),
            RlsState::RfwReading => self.weight_read(datapath),
            RlsState::RfwWriting => self.weight_write(next_waits, datapath),
            RlsState::Clearing => self.clear(datapath),
        }
    }
}

impl<F: Fp> RlsMachine<F> {
    /// RAMB address of `R[i][j]`.
    #[inline]
    fn element(&self) -> usize {
        let p = self.config.tap_count;
        2 * p + self.registers.i * p + self.registers.j
    }

    /// Clearing: R row by row, with the counters of its correction; then what stands before it in
    /// RAMB, and with it all of RAMA.
    #[inline]
    fn clear(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        let p = self.config.tap_count;
        if self.registers.phase == 0 {
            let is_diagonal = self.registers.i == self.registers.j;
            let word = if is_diagonal {
                self.config.delta
            } else {
                F::ZERO
            };
            datapath.write_b(self.element(), word);
            self.registers.j += 1;
            if self.registers.j == p {
                self.registers.j = 0;
                self.registers.phase = u8::from(self.row_done());
            }
            return;
        }
        let address = self.cleared;
        datapath.write_a(address, F::ZERO);
        datapath.write_b(address, F::ZERO);
        self.cleared += 1;
        if self.cleared == 2 * p {
            self.cleared = 0;
            self.registers.phase = 0;
            self.registers.state = RlsState::Idle;
        }
    }

    /// One clock of a dot product of L with the words of RAMB, that of tap j at address `b`.
    #[inline]
    fn accumulate(
        &mut self,
        b: usize,
        first: F,
        done: RlsState,
        datapath: &mut Datapath<'_, F, impl Probe<F>>,
    ) {
        let taps = self.config.tap_count;
        let l_j = datapath.read_a(self.registers.slot(self.registers.j, taps));
        let b_j = datapath.read_b(b);
        self.registers
            .accumulate((l_j, b_j), first, taps, done, datapath);
    }

    /// RiL_reading and RFM_reading: a row of R times L, started at `+0`.
    #[inline]
    fn accumulate_row(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        let done = if self.registers.state == RlsState::RiLReading {
            RlsState::RiLWriting
        } else {
            RlsState::RfmWriting
        };
        self.accumulate(self.element(), F::ZERO, done, datapath);
    }

    /// LRL_reading: `L't`, started at alpha, since the adder has no clock left to add it later.
    #[inline]
    fn accumulate_denominator(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        let b = self.config.tap_count + self.registers.j;
        self.accumulate(b, self.config.alpha, RlsState::LrlWriting, datapath);
    }

    /// Out_reading: `W'L` with the weights before this sample's update.
    #[inline]
    fn accumulate_output(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        let b = self.registers.j;
        self.accumulate(b, F::ZERO, RlsState::OutWriting, datapath);
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
    fn write_intermediate(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        let sum = self.registers.last_sum(datapath);
        let address = self.config.tap_count + self.registers.i;
        datapath.write_a(address, sum);
        datapath.write_b(address, sum);
        self.registers.state = if self.row_done() {
            RlsState::LrlReading
        } else {
            RlsState::RiLReading
        };
    }

    /// LRL_writing: DEN has no word in a memory.
    #[inline]
    fn write_denominator(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        self.registers.denominator = self.registers.last_sum(datapath);
        self.registers.state = RlsState::RfrReading;
    }

    /// RFR_reading: `t_i * t_j`, then its quotient, while `R[i][j]` is latched. The product of the
    /// two t comes first: it commutes, which keeps R symmetric to the bit.
    #[inline]
    fn correct_read(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        let Registers {
            i,
            j,
            product,
            denominator,
            ..
        } = self.registers;
        if self.registers.phase == 0 {
            let t_i = datapath.read_a(self.config.tap_count + i);
            let t_j = datapath.read_b(self.config.tap_count + j);
            if i == 0 && j == 0 && self.config.division == Division::Reciprocal {
                self.registers.reciprocal = datapath.divide(F::ONE, denominator);
            }
            self.registers.product = datapath.multiply(t_i, t_j);
            self.registers.phase = 1;
        } else {
            self.registers.read_latch = datapath.read_b(self.element());
            self.registers.product = match self.config.division {
                Division::Reciprocal => datapath.multiply(product, self.registers.reciprocal),
                Division::Elementwise => datapath.divide(product, denominator),
            };
            self.registers.phase = 2;
            self.registers.state = RlsState::RfrWriting;
        }
    }

    /// RFR_writing: `(R - correction) * ialpha`, the only clock that chains two operations. At
    /// alpha = 1 the multiplier is by-passed: `x * 1 = x` for every word that leaves a unit. Units of
    /// more than a clock are not chained: the difference stays in P for a step.
    #[inline]
    fn correct_write(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        let scales = self.config.inverse_alpha != F::ONE;
        let difference = if self.registers.phase == 3 {
            self.registers.product
        } else {
            datapath.subtract(self.registers.read_latch, self.registers.product)
        };
        if scales && self.registers.phase == 2 && !self.config.units.chain() {
            self.registers.product = difference;
            self.registers.phase = 3;
            return;
        }
        let corrected = if scales {
            datapath.multiply(difference, self.config.inverse_alpha)
        } else {
            difference
        };
        datapath.write_b(self.element(), corrected);
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
    fn write_gain(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        let sum = self.registers.last_sum(datapath);
        datapath.write_a(self.config.tap_count + self.registers.i, sum);
        self.registers.state = if self.row_done() {
            RlsState::OutReading
        } else {
            RlsState::RfmReading
        };
    }

    /// Out_writing: the result is registered.
    #[inline]
    fn write_output(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        self.registers.output = self.registers.last_sum(datapath);
        self.registers.state = RlsState::RfwReading;
    }

    /// RFW_reading: the error in the first clock, then `M_i * e` while `W_i` is latched.
    #[inline]
    fn weight_read(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        if self.registers.phase == 0 {
            let error = datapath.subtract(self.registers.desired, self.registers.output);
            self.registers.error = error;
            self.registers.phase = 1;
            return;
        }
        let i = self.registers.i;
        let gain = datapath.read_a(self.config.tap_count + i);
        self.registers.read_latch = datapath.read_b(i);
        self.registers.product = datapath.multiply(gain, self.registers.error);
        self.registers.phase = 2;
        self.registers.state = RlsState::RfwWriting;
    }

    /// RFW_writing: the new weight; after the last one the next sample is loaded at once.
    #[inline]
    fn weight_write(&mut self, next_waits: bool, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        let Registers {
            i,
            read_latch,
            product,
            ..
        } = self.registers;
        let weight = match self.config.update_sign {
            UpdateSign::Corrected => datapath.add(read_latch, product),
            UpdateSign::AsPrinted => datapath.subtract(read_latch, product),
        };
        datapath.write_b(i, weight);
        if self.row_done() {
            self.registers.phase = 0;
            self.registers.state = Self::after_sample(next_waits);
        } else {
            self.registers.phase = 1;
            self.registers.state = RlsState::RfwReading;
        }
    }
}
