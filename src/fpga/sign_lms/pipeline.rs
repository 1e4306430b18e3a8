//! The clock-by-clock line enhancer.

use super::config::{SignLmsConfig, clamp, signed};
use super::state::{SignLmsRegisters, SignLmsState};
use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::Pair;
use crate::fpga::memory::SinglePortRam;
use crate::fpga::probe::{NoProbe, PortView, Probe, Tick, add, divide, multiply, subtract};

/// The line enhancer: memories, registers, and one clock at a time.
#[derive(Clone, Debug)]
pub struct SignLmsPipeline<F> {
    config: SignLmsConfig<F>,
    registers: SignLmsRegisters<F>,
    rama: SinglePortRam<F>,
    ramb: SinglePortRam<F>,
}

impl<F: Fp> SignLmsPipeline<F> {
    /// A pipeline just out of reset, the weights those of reset.
    #[must_use]
    pub fn new(config: SignLmsConfig<F>) -> Self {
        let mut ramb = SinglePortRam::new("RAMB", config.tap_count);
        for j in 0..config.tap_count {
            ramb.preload(j, config.initial_weight);
        }
        Self {
            config,
            registers: SignLmsRegisters::reset(config.tap_count),
            rama: SinglePortRam::new("RAMA", config.tap_count),
            ramb,
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

    /// The registers between two clocks.
    #[must_use]
    pub fn registers(&self) -> &SignLmsRegisters<F> {
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
        let accepted = state == SignLmsState::LReading && input.is_some();
        let output = (state == SignLmsState::Err).then_some(self.registers.output);
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
            SignLmsState::Idle => {
                if input.is_some() {
                    self.registers.state = SignLmsState::LReading;
                }
            }
            SignLmsState::LReading => self.load(input, probe),
            SignLmsState::LWriting => self.enter_ring(probe),
            SignLmsState::NrmAdding => self.norm_add(probe),
            SignLmsState::NrmWriting => self.norm_write(probe),
            SignLmsState::OutReading => self.accumulate_output(probe),
            SignLmsState::OutWriting => self.write_output(probe),
            SignLmsState::Err => self.form_error(probe),
            SignLmsState::Gain => self.scale_error(probe),
            SignLmsState::LmwReading => self.weight_read(probe),
            SignLmsState::LmwWriting => self.weight_write(input.is_some(), probe),
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
        while next < pairs.len() || self.registers.state != SignLmsState::Idle {
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

    /// L_reading: the slot that the new word will take still holds the one that leaves the taps.
    #[inline]
    fn load(&mut self, input: Option<Pair<F>>, probe: &mut impl Probe<F>) {
        let Some(pair) = input else {
            self.registers.state = SignLmsState::Idle;
            return;
        };
        self.registers.read_latch = self.read_a(self.next_slot(), probe);
        self.registers.product = multiply(probe, pair.input, pair.input);
        self.registers.input = pair.input;
        self.registers.desired = pair.desired;
        self.registers.state = SignLmsState::LWriting;
    }

    /// Ring slot after HEAD.
    #[inline]
    fn next_slot(&self) -> usize {
        let next = self.registers.head + 1;
        if next == self.config.tap_count {
            0
        } else {
            next
        }
    }

    /// L_writing: the ring takes the word, and T its square if the norm is soon to be replaced.
    #[inline]
    fn enter_ring(&mut self, probe: &mut impl Probe<F>) {
        let head = self.next_slot();
        let word = self.registers.input;
        probe.rama(head, Some(word), self.rama.words()[head]);
        self.rama.write(head, word);
        self.registers.head = head;
        let interval = self.config.norm_recompute_samples as usize;
        let reach = self.registers.age as usize + self.config.tap_count;
        if interval != 0 && reach >= interval {
            let base = if reach == interval {
                F::ZERO
            } else {
                self.registers.fresh
            };
            self.registers.fresh = add(probe, base, self.registers.product);
        }
        self.registers.state = SignLmsState::NrmAdding;
    }

    /// NRM_adding: the square of the new word joins the norm, that of the old one is formed.
    #[inline]
    fn norm_add(&mut self, probe: &mut impl Probe<F>) {
        let leaving = self.registers.read_latch;
        self.registers.norm = add(probe, self.registers.norm, self.registers.product);
        self.registers.product = multiply(probe, leaving, leaving);
        self.registers.state = SignLmsState::NrmWriting;
    }

    /// NRM_writing: the norm of this sample.
    #[inline]
    fn norm_write(&mut self, probe: &mut impl Probe<F>) {
        let difference = subtract(probe, self.registers.norm, self.registers.product);
        self.registers.norm = clamp(difference);
        if self.config.norm_recompute_samples != 0 {
            self.registers.age += 1;
            if self.registers.age == self.config.norm_recompute_samples {
                self.registers.norm = self.registers.fresh;
                self.registers.age = 0;
            }
        }
        self.registers.j = 0;
        self.registers.state = SignLmsState::OutReading;
    }

    /// Out_reading: `P <- L_j*W_j`; the adder forms the denominator first, then sums.
    #[inline]
    fn accumulate_output(&mut self, probe: &mut impl Probe<F>) {
        let j = self.registers.j;
        let l_j = self.read_a(self.slot(j), probe);
        let w_j = self.read_b(j, probe);
        if j == 0 {
            self.registers.denominator =
                add(probe, self.config.regularisation, self.registers.norm);
            self.registers.accumulator = F::ZERO;
        } else {
            self.registers.accumulator =
                add(probe, self.registers.accumulator, self.registers.product);
        }
        self.registers.product = multiply(probe, l_j, w_j);
        self.registers.j = j + 1;
        if self.registers.j == self.config.tap_count {
            self.registers.j = 0;
            self.registers.state = SignLmsState::OutWriting;
        }
    }

    /// Out_writing: the result is registered.
    #[inline]
    fn write_output(&mut self, probe: &mut impl Probe<F>) {
        self.registers.output = add(probe, self.registers.accumulator, self.registers.product);
        self.registers.state = SignLmsState::Err;
    }

    /// ERR: the error, and the step over the energy, which the divider forms meanwhile.
    #[inline]
    fn form_error(&mut self, probe: &mut impl Probe<F>) {
        self.registers.error = subtract(probe, self.registers.desired, self.registers.output);
        self.registers.reciprocal = divide(probe, self.config.step, self.registers.denominator);
        self.registers.state = SignLmsState::Gain;
    }

    /// GAIN: what the taps are multiplied by, once per sample.
    #[inline]
    fn scale_error(&mut self, probe: &mut impl Probe<F>) {
        let (error, step) = (self.registers.error, self.registers.reciprocal);
        let is_beyond = self.config.is_beyond(error);
        let is_held = is_beyond && self.registers.held_samples < self.config.hold_samples;
        if is_held {
            self.registers.held_samples += 1;
        } else if !is_beyond {
            self.registers.held_samples = 0;
        }
        let scaled = if self.config.normalised {
            multiply(probe, error, step)
        } else {
            signed(step, error)
        };
        self.registers.error = if is_held { F::ZERO } else { scaled };
        self.registers.state = SignLmsState::LmwReading;
    }

    /// LMW_reading: `L_j * e` while `W_j` is latched.
    #[inline]
    fn weight_read(&mut self, probe: &mut impl Probe<F>) {
        let l_j = self.read_a(self.slot(self.registers.j), probe);
        self.registers.read_latch = self.read_b(self.registers.j, probe);
        self.registers.product = multiply(probe, l_j, self.registers.error);
        self.registers.state = SignLmsState::LmwWriting;
    }

    /// LMW_writing: the new weight; after the last one the next sample is loaded at once.
    #[inline]
    fn weight_write(&mut self, next_waits: bool, probe: &mut impl Probe<F>) {
        let SignLmsRegisters {
            j,
            read_latch,
            product,
            ..
        } = self.registers;
        let weight = add(probe, read_latch, product);
        probe.ramb(j, Some(weight), read_latch);
        self.ramb.write(j, weight);
        if j + 1 < self.config.tap_count {
            self.registers.j = j + 1;
            self.registers.state = SignLmsState::LmwReading;
        } else {
            self.registers.j = 0;
            self.registers.state = if next_waits {
                SignLmsState::LReading
            } else {
                SignLmsState::Idle
            };
        }
    }
}
