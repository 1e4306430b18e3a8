//! The control machine of the LMS and NLMS pipeline: what each state does in its clock.

use super::config::{DesiredSource, LmsConfig};
use super::state::LmsState;
use crate::fpga::datapath::Datapath;
use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::Pair;
use crate::fpga::machine::{Machine, Sequencer};
use crate::fpga::memory::SinglePortRam;
use crate::fpga::probe::Probe;
use crate::fpga::registers::Registers;
use crate::vocabulary::UpdateSign;

/// The clocked LMS and NLMS pipeline. RAMA: ring of L. RAMB: W, tap 0 first.
pub type LmsPipeline<F> = Sequencer<LmsMachine<F>>;

/// Control machine and registers of the LMS pipeline.
#[derive(Clone, Debug)]
pub struct LmsMachine<F> {
    config: LmsConfig<F>,
    registers: Registers<LmsState, F>,
    /// Previous input XP.
    previous: F,
}

impl<F: Fp> Machine for LmsMachine<F> {
    type Word = F;
    type Config = LmsConfig<F>;
    type State = LmsState;

    const LOADING: LmsState = LmsState::LLoading;
    const CLEARING: LmsState = LmsState::Clearing;

    fn new(config: LmsConfig<F>) -> Self {
        Self {
            config,
            registers: Registers::reset(config.tap_count),
            previous: F::ZERO,
        }
    }

    fn memories(config: &LmsConfig<F>) -> [SinglePortRam<F>; 2] {
        ["RAMA", "RAMB"].map(|name| SinglePortRam::new(name, config.tap_count))
    }

    #[inline]
    fn config(&self) -> &LmsConfig<F> {
        &self.config
    }

    #[inline]
    fn registers(&self) -> &Registers<LmsState, F> {
        &self.registers
    }

    #[inline]
    fn registers_mut(&mut self) -> &mut Registers<LmsState, F> {
        &mut self.registers
    }

    #[inline]
    fn strobes_output(&self) -> bool {
        self.registers.state == LmsState::Err
    }

    /// L_loading: the oldest slot of the ring takes the new word; the adder is free for `x + XP`.
    #[inline]
    fn load<Q: Probe<F>>(&mut self, pair: Pair<F>, datapath: &mut Datapath<'_, F, Q>) {
        let head = self.registers.next_slot(self.config.tap_count);
        datapath.write_a(head, pair.input);
        self.registers.desired = match self.config.desired {
            DesiredSource::MeanOfTwoNewest => datapath.add(pair.input, self.previous),
            DesiredSource::Port => pair.desired,
        };
        self.previous = pair.input;
        self.registers.head = head;
        self.registers.j = 0;
        self.registers.state = if self.config.is_normalised() {
            LmsState::LlReading
        } else {
            LmsState::OutReading
        };
    }

    #[inline]
    fn step<Q: Probe<F>>(&mut self, next_waits: bool, datapath: &mut Datapath<'_, F, Q>) {
        match self.registers.state {
            // The sequencer's own: waiting and loading.
            LmsState::Idle | LmsState::LLoading => {}
            LmsState::LlReading => self.accumulate_energy(datapath),
            LmsState::LlWriting => {
                self.registers.denominator = self.registers.last_sum(datapath);
                self.registers.state = LmsState::OutReading;
            }
            LmsState::OutReading => self.accumulate_output(datapath),
            LmsState::OutWriting => self.write_output(datapath),
            LmsState::Err => self.form_error(datapath),
            LmsState::Gain => self.scale_error(datapath),
            LmsState::LmwReading => self.weight_read(datapath),
            LmsState::LmwWriting => self.weight_write(next_waits, datapath),
            LmsState::Clearing => self.clear(datapath),
        }
    }
}

impl<F: Fp> LmsMachine<F> {
    /// Clearing: a word of each memory.
    #[inline]
    fn clear(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        let (taps, weight) = (self.config.tap_count, F::ZERO);
        datapath.write_a(self.registers.j, F::ZERO);
        if self.registers.write_weight(weight, taps, datapath) {
            self.registers.state = LmsState::Idle;
        }
    }

    /// LL_reading: `L'L`, both factors from one read of RAMA, started at the regularisation.
    #[inline]
    fn accumulate_energy(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        let l_j = datapath.read_a(self.registers.slot(self.registers.j, self.config.tap_count));
        let first = self.config.regularisation.unwrap_or(F::ZERO);
        let taps = self.config.tap_count;
        self.registers
            .accumulate((l_j, l_j), first, taps, LmsState::LlWriting, datapath);
    }

    /// Out_reading: `W'L`, started at `+0`.
    #[inline]
    fn accumulate_output(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        let l_j = datapath.read_a(self.registers.slot(self.registers.j, self.config.tap_count));
        let w_j = datapath.read_b(self.registers.j);
        let taps = self.config.tap_count;
        self.registers
            .accumulate((l_j, w_j), F::ZERO, taps, LmsState::OutWriting, datapath);
    }

    /// Out_writing: the result is registered and the desired word halved.
    #[inline]
    fn write_output(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        self.registers.output = self.registers.last_sum(datapath);
        // The multiplier is free in this clock.
        if self.config.desired == DesiredSource::MeanOfTwoNewest {
            self.registers.desired = datapath.multiply(self.registers.desired, self.config.half);
        }
        self.registers.state = LmsState::Err;
    }

    /// ERR: the error, and for NLMS the step over the energy, which the divider forms meanwhile.
    #[inline]
    fn form_error(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        self.registers.error = datapath.subtract(self.registers.desired, self.registers.output);
        if self.config.is_normalised() {
            self.registers.reciprocal =
                datapath.divide(self.config.step_size, self.registers.denominator);
        }
        self.registers.state = LmsState::Gain;
    }

    /// GAIN: error times step, once per sample rather than once per tap.
    #[inline]
    fn scale_error(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        let factor = if self.config.is_normalised() {
            self.registers.reciprocal
        } else {
            self.config.step_size
        };
        self.registers.error = datapath.multiply(self.registers.error, factor);
        self.registers.state = LmsState::LmwReading;
    }

    /// LMW_reading: `L_j * e` while `W_j` is latched.
    #[inline]
    fn weight_read(&mut self, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        self.registers.read_weight(self.config.tap_count, datapath);
        self.registers.state = LmsState::LmwWriting;
    }

    /// LMW_writing: the new weight; after the last one the next sample is loaded at once.
    #[inline]
    fn weight_write(&mut self, next_waits: bool, datapath: &mut Datapath<'_, F, impl Probe<F>>) {
        let Registers {
            read_latch,
            product,
            ..
        } = self.registers;
        let weight = match self.config.update_sign {
            UpdateSign::Corrected => datapath.add(read_latch, product),
            UpdateSign::AsPrinted => datapath.subtract(read_latch, product),
        };
        let taps = self.config.tap_count;
        self.registers.state = if self.registers.write_weight(weight, taps, datapath) {
            Self::after_sample(next_waits)
        } else {
            LmsState::LmwReading
        };
    }
}
