//! The control machine of the line enhancer: what each state does in its clock.

use super::config::{SignLmsConfig, clamp, signed};
use super::state::SignLmsState;
use crate::fpga::datapath::Datapath;
use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::Pair;
use crate::fpga::machine::{Machine, Sequencer};
use crate::fpga::memory::SinglePortRam;
use crate::fpga::probe::Probe;
use crate::fpga::registers::Registers;

/// The clocked line enhancer. RAMA: ring of L. RAMB: W, tap 0 first.
pub type SignLmsPipeline<F> = Sequencer<SignLmsMachine<F>>;

/// Control machine and registers of the line enhancer.
#[derive(Clone, Debug)]
pub struct SignLmsMachine<F> {
    config: SignLmsConfig<F>,
    registers: Registers<SignLmsState, F>,
    /// Samples since the norm was replaced.
    age: u32,
    /// Samples on end that the guard has held the weights.
    held_samples: usize,
    /// Input X.
    input: F,
    /// Norm S.
    norm: F,
    /// Fresh sum T of the norm.
    fresh: F,
}

impl<F: Fp> Machine for SignLmsMachine<F> {
    type Word = F;
    type Config = SignLmsConfig<F>;
    type State = SignLmsState;

    const LOADING: SignLmsState = SignLmsState::LReading;
    const CLEARING: SignLmsState = SignLmsState::Clearing;

    fn new(config: SignLmsConfig<F>) -> Self {
        Self {
            config,
            registers: Registers::reset(config.tap_count),
            age: 0,
            held_samples: 0,
            input: F::ZERO,
            norm: F::ZERO,
            fresh: F::ZERO,
        }
    }

    fn memories(config: &SignLmsConfig<F>) -> [SinglePortRam<F>; 2] {
        let mut ramb = SinglePortRam::new("RAMB", config.tap_count);
        for j in 0..config.tap_count {
            ramb.preload(j, config.initial_weight);
        }
        [SinglePortRam::new("RAMA", config.tap_count), ramb]
    }

    #[inline]
    fn config(&self) -> &SignLmsConfig<F> {
        &self.config
    }

    #[inline]
    fn registers(&self) -> &Registers<SignLmsState, F> {
        &self.registers
    }

    #[inline]
    fn registers_mut(&mut self) -> &mut Registers<SignLmsState, F> {
        &mut self.registers
    }

    #[inline]
    fn strobes_output(&self) -> bool {
        self.registers.state == SignLmsState::Err
    }

    /// L_reading: the slot that the new word will take still holds the one that leaves the taps.
    #[inline]
    fn load<Q: Probe<F>>(&mut self, pair: Pair<F>, datapath: &mut Datapath<'_, F, Q>) {
        self.registers.read_latch =
            datapath.read_a(self.registers.next_slot(self.config.tap_count));
        self.registers.product = datapath.multiply(pair.input, pair.input);
        self.input = pair.input;
        self.registers.desired = pair.desired;
        self.registers.state = SignLmsState::LWriting;
    }

    #[inline]
    fn step<Q: Probe<F>>(&mut self, next_waits: bool, datapath: &mut Datapath<'_, F, Q>) {
        match self.registers.state {
            // The sequencer's own: waiting and loading.
            SignLmsState::Idle | SignLmsState::LReading => {}
            SignLmsState::LWriting => self.enter_ring(datapath),
            SignLmsState::NrmAdding => self.norm_add(datapath),
            SignLmsState::NrmWriting => self.norm_write(datapath),
            SignLmsState::OutReading => self.accumulate_output(datapath),
            SignLmsState::OutWriting => self.write_output(datapath),
            SignLmsState::Err => self.form_error(datapath),
            SignLmsState::Gain => self.scale_error(datapath),
            SignLmsState::LmwReading => self.weight_read(datapath),
            SignLmsState::LmwWriting => self.weight_write(next_waits, datapath),
            SignLmsState::Clearing => self.clear(datapath),
        }
    }
}

impl<F: Fp> SignLmsMachine<F> {
    /// Clearing: a word of each memory.
    #[inline]
    fn clear(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        let (taps, weight) = (self.config.tap_count, self.config.initial_weight);
        datapath.write_a(self.registers.j, F::ZERO);
        if self.registers.write_weight(weight, taps, datapath) {
            self.registers.state = SignLmsState::Idle;
        }
    }

    /// The recursive norm S.
    #[must_use]
    pub fn norm(&self) -> F {
        self.norm
    }

    /// L_writing: the ring takes the word, and T its square if the norm is soon to be replaced.
    #[inline]
    fn enter_ring(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        let head = self.registers.next_slot(self.config.tap_count);
        let word = self.input;
        datapath.write_a(head, word);
        self.registers.head = head;
        let interval = self.config.norm_recompute_samples as usize;
        let reach = self.age as usize + self.config.tap_count;
        if interval != 0 && reach >= interval {
            let base = if reach == interval {
                F::ZERO
            } else {
                self.fresh
            };
            self.fresh = datapath.add(base, self.registers.product);
        }
        self.registers.state = SignLmsState::NrmAdding;
    }

    /// NRM_adding: the square of the new word joins the norm, that of the old one is formed.
    #[inline]
    fn norm_add(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        let leaving = self.registers.read_latch;
        self.norm = datapath.add(self.norm, self.registers.product);
        self.registers.product = datapath.multiply(leaving, leaving);
        self.registers.state = SignLmsState::NrmWriting;
    }

    /// NRM_writing: the norm of this sample.
    #[inline]
    fn norm_write(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        let difference = datapath.subtract(self.norm, self.registers.product);
        self.norm = clamp(difference);
        if self.config.norm_recompute_samples != 0 {
            self.age += 1;
            if self.age == self.config.norm_recompute_samples {
                self.norm = self.fresh;
                self.age = 0;
            }
        }
        self.registers.j = 0;
        self.registers.state = SignLmsState::OutReading;
    }

    /// Out_reading: `P <- L_j*W_j`; the adder forms the denominator first, then sums.
    #[inline]
    fn accumulate_output(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        let j = self.registers.j;
        let l_j = datapath.read_a(self.registers.slot(j, self.config.tap_count));
        let w_j = datapath.read_b(j);
        if j == 0 {
            self.registers.denominator = datapath.add(self.config.regularisation, self.norm);
        }
        let (taps, done) = (self.config.tap_count, SignLmsState::OutWriting);
        self.registers
            .accumulate((l_j, w_j), F::ZERO, taps, done, datapath);
    }

    /// Out_writing: the result is registered.
    #[inline]
    fn write_output(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        self.registers.output = self.registers.last_sum(datapath);
        self.registers.state = SignLmsState::Err;
    }

    /// ERR: the error, and the step over the energy, which the divider forms meanwhile.
    #[inline]
    fn form_error(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        self.registers.error = datapath.subtract(self.registers.desired, self.registers.output);
        self.registers.reciprocal = datapath.divide(self.config.step, self.registers.denominator);
        self.registers.state = SignLmsState::Gain;
    }

    /// GAIN: what the taps are multiplied by, once per sample.
    #[inline]
    fn scale_error(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        let (error, step) = (self.registers.error, self.registers.reciprocal);
        let is_beyond = self.config.is_beyond(error);
        let is_held = is_beyond && self.held_samples < self.config.hold_samples;
        if is_held {
            self.held_samples += 1;
        } else if !is_beyond {
            self.held_samples = 0;
        }
        let scaled = if self.config.normalised {
            datapath.multiply(error, step)
        } else {
            signed(step, error)
        };
        self.registers.error = if is_held { F::ZERO } else { scaled };
        self.registers.state = SignLmsState::LmwReading;
    }

    /// LMW_reading: `L_j * e` while `W_j` is latched.
    #[inline]
    fn weight_read(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        self.registers.read_weight(self.config.tap_count, datapath);
        self.registers.state = SignLmsState::LmwWriting;
    }

    /// LMW_writing: the new weight; after the last one the next sample is loaded at once.
    #[inline]
    fn weight_write(&mut self, next_waits: bool, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        let weight = datapath.add(self.registers.read_latch, self.registers.product);
        let taps = self.config.tap_count;
        self.registers.state = if self.registers.write_weight(weight, taps, datapath) {
            Self::after_sample(next_waits)
        } else {
            SignLmsState::LmwReading
        };
    }
}
