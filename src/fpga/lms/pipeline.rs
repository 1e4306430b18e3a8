//! The clock-by-clock LMS and NLMS pipeline.

use super::config::{DesiredSource, LmsConfig};
use super::state::{LmsRegisters, LmsState};
use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::{Pair, UpdateSign};
use crate::fpga::memory::SinglePortRam;
use crate::fpga::probe::{NoProbe, PortView, Probe, Tick, add, divide, multiply, subtract};

/// The LMS pipeline: memories, registers, and one clock at a time.
#[derive(Clone, Debug)]
pub struct LmsPipeline<F> {
    config: LmsConfig<F>,
    registers: LmsRegisters<F>,
    rama: SinglePortRam<F>,
    ramb: SinglePortRam<F>,
}

impl<F: Fp> LmsPipeline<F> {
    /// A pipeline just out of reset, memories `+0`.
    #[must_use]
    pub fn new(config: LmsConfig<F>) -> Self {
        Self {
            config,
            registers: LmsRegisters::reset(config.tap_count),
            rama: SinglePortRam::new("RAMA", config.tap_count),
            ramb: SinglePortRam::new("RAMB", config.tap_count),
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

    /// The registers between two clocks.
    #[must_use]
    pub fn registers(&self) -> &LmsRegisters<F> {
        &self.registers
    }

    /// RAMA: ring of L.
    #[must_use]
    pub fn rama(&self) -> &[F] {
        self.rama.words()
    }

    /// RAMB: W, tap 0 first.
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
    #[inline]
    pub fn tick_probed<Q: Probe<F>>(&mut self, input: Option<Pair<F>>, probe: &mut Q) -> Tick<F> {
        let state = self.registers.state;
        let accepted = state == LmsState::LLoading && input.is_some();
        let output = (state == LmsState::Err).then_some(self.registers.output);
        if Q::WATCHES {
            let ports = PortView {
                input_valid: input.is_some(),
                input_ready: accepted,
                input: input.map_or(F::ZERO, |pair| pair.input),
                desired: input.map_or(F::ZERO, |pair| pair.desired),
                output_valid: output.is_some(),
            };
            probe.clock(&self.registers.view(), &ports);
        }
        match state {
            LmsState::Idle => {
                if input.is_some() {
                    self.registers.state = LmsState::LLoading;
                }
            }
            LmsState::LLoading => self.load(input, probe),
            LmsState::LlReading => self.accumulate_energy(probe),
            LmsState::LlWriting => {
                self.registers.denominator = self.last_sum(probe);
                self.registers.state = LmsState::OutReading;
            }
            LmsState::OutReading => self.accumulate_output(probe),
            LmsState::OutWriting => self.write_output(probe),
            LmsState::Err => self.form_error(probe),
            LmsState::Gain => self.scale_error(probe),
            LmsState::LmwReading => self.weight_read(probe),
            LmsState::LmwWriting => self.weight_write(input.is_some(), probe),
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
        while next < pairs.len() || self.registers.state != LmsState::Idle {
            let tick = self.tick_probed(pairs.get(next).copied(), probe);
            next += usize::from(tick.accepted);
            outputs.extend(tick.output);
        }
    }

    /// Ring slot of tap j: `(HEAD - j) mod N`.
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

    /// L_loading: the oldest slot of the ring takes the new word; the adder is free for `x + XP`.
    #[inline]
    fn load(&mut self, input: Option<Pair<F>>, probe: &mut impl Probe<F>) {
        let Some(pair) = input else {
            self.registers.state = LmsState::Idle;
            return;
        };
        let next = self.registers.head + 1;
        let head = if next == self.config.tap_count {
            0
        } else {
            next
        };
        probe.rama(head, Some(pair.input), self.rama.words()[head]);
        self.rama.write(head, pair.input);
        self.registers.desired = match self.config.desired {
            DesiredSource::MeanOfTwoNewest => add(probe, pair.input, self.registers.previous),
            DesiredSource::Port => pair.desired,
        };
        self.registers.previous = pair.input;
        self.registers.head = head;
        self.registers.j = 0;
        self.registers.state = if self.config.is_normalised() {
            LmsState::LlReading
        } else {
            LmsState::OutReading
        };
    }

    /// One clock of a dot product: `P <- a*b`, `ACC <- first` or `ACC + P`.
    #[inline]
    fn accumulate(&mut self, a: F, b: F, first: F, done: LmsState, probe: &mut impl Probe<F>) {
        let sum = if self.registers.j == 0 {
            first
        } else {
            add(probe, self.registers.accumulator, self.registers.product)
        };
        self.registers.product = multiply(probe, a, b);
        self.registers.accumulator = sum;
        self.registers.j += 1;
        if self.registers.j == self.config.tap_count {
            self.registers.j = 0;
            self.registers.state = done;
        }
    }

    /// LL_reading: `L'L`, both factors from one read of RAMA, started at the regularisation.
    #[inline]
    fn accumulate_energy(&mut self, probe: &mut impl Probe<F>) {
        let l_j = self.read_a(self.slot(self.registers.j), probe);
        let first = self.config.regularisation.unwrap_or(F::ZERO);
        self.accumulate(l_j, l_j, first, LmsState::LlWriting, probe);
    }

    /// Out_reading: `W'L`, started at `+0`.
    #[inline]
    fn accumulate_output(&mut self, probe: &mut impl Probe<F>) {
        let l_j = self.read_a(self.slot(self.registers.j), probe);
        let w_j = self.read_b(self.registers.j, probe);
        self.accumulate(l_j, w_j, F::ZERO, LmsState::OutWriting, probe);
    }

    /// The last sum of a dot product, in its writing clock.
    #[inline]
    fn last_sum(&self, probe: &mut impl Probe<F>) -> F {
        add(probe, self.registers.accumulator, self.registers.product)
    }

    /// Out_writing: the result is registered and the desired word halved.
    #[inline]
    fn write_output(&mut self, probe: &mut impl Probe<F>) {
        self.registers.output = self.last_sum(probe);
        // The multiplier is free in this clock.
        if self.config.desired == DesiredSource::MeanOfTwoNewest {
            self.registers.desired = multiply(probe, self.registers.desired, self.config.half);
        }
        self.registers.state = LmsState::Err;
    }

    /// ERR: the error, and for NLMS the step over the energy, which the divider forms meanwhile.
    #[inline]
    fn form_error(&mut self, probe: &mut impl Probe<F>) {
        self.registers.error = subtract(probe, self.registers.desired, self.registers.output);
        if self.config.is_normalised() {
            self.registers.reciprocal =
                divide(probe, self.config.step_size, self.registers.denominator);
        }
        self.registers.state = LmsState::Gain;
    }

    /// GAIN: error times step, once per sample rather than once per tap.
    #[inline]
    fn scale_error(&mut self, probe: &mut impl Probe<F>) {
        let factor = if self.config.is_normalised() {
            self.registers.reciprocal
        } else {
            self.config.step_size
        };
        self.registers.error = multiply(probe, self.registers.error, factor);
        self.registers.state = LmsState::LmwReading;
    }

    /// LMW_reading: `L_j * e` while `W_j` is latched.
    #[inline]
    fn weight_read(&mut self, probe: &mut impl Probe<F>) {
        let l_j = self.read_a(self.slot(self.registers.j), probe);
        self.registers.read_latch = self.read_b(self.registers.j, probe);
        self.registers.product = multiply(probe, l_j, self.registers.error);
        self.registers.state = LmsState::LmwWriting;
    }

    /// LMW_writing: the new weight; after the last one the next sample is loaded at once.
    #[inline]
    fn weight_write(&mut self, next_waits: bool, probe: &mut impl Probe<F>) {
        let LmsRegisters {
            j,
            read_latch,
            product,
            ..
        } = self.registers;
        let weight = match self.config.update_sign {
            UpdateSign::Corrected => add(probe, read_latch, product),
            UpdateSign::AsPrinted => subtract(probe, read_latch, product),
        };
        probe.ramb(j, Some(weight), read_latch);
        self.ramb.write(j, weight);
        if j + 1 < self.config.tap_count {
            self.registers.j = j + 1;
            self.registers.state = LmsState::LmwReading;
        } else {
            self.registers.j = 0;
            self.registers.state = if next_waits {
                LmsState::LLoading
            } else {
                LmsState::Idle
            };
        }
    }
}
