//! The clock-by-clock RLS pipeline.

use super::config::{Division, RlsConfig};
use super::state::{RlsRegisters, RlsState};
use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::{Pair, UpdateSign};
use crate::fpga::memory::SinglePortRam;
use crate::fpga::probe::{NoProbe, PortView, Probe, Tick, add, divide, multiply, subtract};

/// The RLS pipeline: memories, registers, and one clock at a time.
#[derive(Clone, Debug)]
pub struct RlsPipeline<F> {
    config: RlsConfig<F>,
    registers: RlsRegisters<F>,
    rama: SinglePortRam<F>,
    ramb: SinglePortRam<F>,
}

impl<F: Fp> RlsPipeline<F> {
    /// A pipeline just out of reset: memories `+0` but for `R = delta * I`.
    #[must_use]
    pub fn new(config: RlsConfig<F>) -> Self {
        let p = config.tap_count;
        let mut ramb = SinglePortRam::new("RAMB", 2 * p + p * p);
        for i in 0..p {
            ramb.preload(2 * p + i * p + i, config.delta);
        }
        Self {
            config,
            registers: RlsRegisters::reset(p),
            rama: SinglePortRam::new("RAMA", 2 * p),
            ramb,
        }
    }

    /// Back to the state after reset.
    pub fn reset(&mut self) {
        *self = Self::new(self.config);
    }

    /// The constants.
    #[must_use]
    pub fn config(&self) -> &RlsConfig<F> {
        &self.config
    }

    /// The registers between two clocks.
    #[must_use]
    pub fn registers(&self) -> &RlsRegisters<F> {
        &self.registers
    }

    /// RAMA: `0..p` ring of L, `p..2p` t, then M.
    #[must_use]
    pub fn rama(&self) -> &[F] {
        self.rama.words()
    }

    /// RAMB: `0..p` W, `p..2p` t, `2p + i*p + j` R, row by row.
    #[must_use]
    pub fn ramb(&self) -> &[F] {
        self.ramb.words()
    }

    /// Advances one clock. A strobe must be held until it is accepted; withdrawn before, the
    /// sample is not taken.
    #[inline]
    pub fn tick(&mut self, input: Option<Pair<F>>) -> Tick<F> {
        self.tick_probed(input, &mut NoProbe)
    }

    /// Advances one clock under the eyes of a probe.
    ///
    /// Each arm reads registers and memories first and assigns after, so every value read is
    /// the one before the edge.
    #[inline]
    pub fn tick_probed<Q: Probe<F>>(&mut self, input: Option<Pair<F>>, probe: &mut Q) -> Tick<F> {
        let state = self.registers.state;
        let accepted = state == RlsState::RiLLoading && input.is_some();
        let output = (state == RlsState::RfwReading && self.registers.phase == 0)
            .then_some(self.registers.output);
        if Q::WATCHES {
            self.show(input, accepted, output.is_some(), probe);
        }
        match state {
            RlsState::Idle => {
                if input.is_some() {
                    self.registers.state = RlsState::RiLLoading;
                }
            }
            RlsState::RiLLoading => self.load(input, probe),
            RlsState::RiLReading | RlsState::RfmReading => self.accumulate_row(probe),
            RlsState::LrlReading => self.accumulate_denominator(probe),
            RlsState::OutReading => self.accumulate_output(probe),
            RlsState::RiLWriting => self.write_intermediate(probe),
            RlsState::LrlWriting => self.write_denominator(probe),
            RlsState::RfrReading => self.correct_read(probe),
            RlsState::RfrWriting => self.correct_write(probe),
            RlsState::RfmWriting => self.write_gain(probe),
            RlsState::OutWriting => self.write_output(probe),
            RlsState::RfwReading => self.weight_read(probe),
            RlsState::RfwWriting => self.weight_write(input.is_some(), probe),
        }
        self.rama.edge();
        self.ramb.edge();
        Tick { accepted, output }
    }

    /// Runs back-to-back samples to completion, appending one output word per pair.
    pub fn run(&mut self, pairs: &[Pair<F>], outputs: &mut Vec<F>) {
        self.run_probed(pairs, outputs, &mut NoProbe);
    }

    /// [`Self::run`] under the eyes of a probe. Ends in the first idle clock, not ticked.
    pub fn run_probed<Q: Probe<F>>(
        &mut self,
        pairs: &[Pair<F>],
        outputs: &mut Vec<F>,
        probe: &mut Q,
    ) {
        let mut next = 0;
        while next < pairs.len() || self.registers.state != RlsState::Idle {
            let tick = self.tick_probed(pairs.get(next).copied(), probe);
            next += usize::from(tick.accepted);
            outputs.extend(tick.output);
        }
    }

    #[inline]
    fn slot(&self, j: usize) -> usize {
        let head = self.registers.head;
        if head >= j {
            head - j
        } else {
            head + self.config.tap_count - j
        }
    }

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

    #[inline]
    fn load(&mut self, input: Option<Pair<F>>, probe: &mut impl Probe<F>) {
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

    #[inline]
    fn accumulate_row(&mut self, probe: &mut impl Probe<F>) {
        let done = if self.registers.state == RlsState::RiLReading {
            RlsState::RiLWriting
        } else {
            RlsState::RfmWriting
        };
        self.accumulate(self.element(), F::ZERO, done, probe);
    }

    #[inline]
    fn accumulate_denominator(&mut self, probe: &mut impl Probe<F>) {
        let b = self.config.tap_count + self.registers.j;
        self.accumulate(b, self.config.alpha, RlsState::LrlWriting, probe);
    }

    #[inline]
    fn accumulate_output(&mut self, probe: &mut impl Probe<F>) {
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

    #[inline]
    fn write_intermediate(&mut self, probe: &mut impl Probe<F>) {
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

    #[inline]
    fn write_denominator(&mut self, probe: &mut impl Probe<F>) {
        self.registers.denominator = self.last_sum(probe);
        self.registers.state = RlsState::RfrReading;
    }

    #[inline]
    fn correct_read(&mut self, probe: &mut impl Probe<F>) {
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

    #[inline]
    fn correct_write(&mut self, probe: &mut impl Probe<F>) {
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

    #[inline]
    fn write_gain(&mut self, probe: &mut impl Probe<F>) {
        let sum = self.last_sum(probe);
        self.write_a(self.config.tap_count + self.registers.i, sum, probe);
        self.registers.state = if self.row_done() {
            RlsState::OutReading
        } else {
            RlsState::RfmReading
        };
    }

    #[inline]
    fn write_output(&mut self, probe: &mut impl Probe<F>) {
        self.registers.output = self.last_sum(probe);
        self.registers.state = RlsState::RfwReading;
    }

    #[inline]
    fn weight_read(&mut self, probe: &mut impl Probe<F>) {
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

    #[inline]
    fn weight_write(&mut self, next_waits: bool, probe: &mut impl Probe<F>) {
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

    fn show<Q: Probe<F>>(
        &self,
        input: Option<Pair<F>>,
        accepted: bool,
        output_valid: bool,
        probe: &mut Q,
    ) {
        let ports = PortView {
            input_valid: input.is_some(),
            input_ready: accepted,
            input: input.map_or(F::ZERO, |pair| pair.input),
            desired: input.map_or(F::ZERO, |pair| pair.desired),
            output_valid,
        };
        probe.clock(&self.registers.view(), &ports);
    }
}
