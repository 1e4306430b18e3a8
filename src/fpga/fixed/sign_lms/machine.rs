//! The control machine of the line enhancer in fixed point: what each state does in its clock.

use super::config::FixedSignLmsConfig;
use crate::fpga::fixed::CodePair;
use crate::fpga::fixed::datapath::FixedDatapath;
use crate::fpga::fixed::registers::FixedRegisters;
use crate::fpga::fixed::sequencer::{FixedMachine, FixedSequencer};
use crate::fpga::memory::SinglePortRam;
use crate::fpga::sign_lms::SignLmsState;

/// The clocked line enhancer. RAMA: ring of L. RAMB: W, tap 0 first.
pub type FixedSignLmsPipeline = FixedSequencer<FixedSignLmsMachine>;

/// Control machine and registers of the line enhancer.
#[derive(Clone, Debug)]
pub struct FixedSignLmsMachine {
    config: FixedSignLmsConfig,
    registers: FixedRegisters<SignLmsState>,
    /// Samples on end that the guard has held the weights.
    held_samples: usize,
    /// Input X.
    input: i64,
    /// Norm S, exact.
    norm: i128,
}

impl FixedMachine for FixedSignLmsMachine {
    type Config = FixedSignLmsConfig;
    type State = SignLmsState;

    const LOADING: SignLmsState = SignLmsState::LReading;
    const CLEARING: SignLmsState = SignLmsState::Clearing;

    fn new(config: FixedSignLmsConfig) -> Self {
        Self {
            config,
            registers: FixedRegisters::reset(config.tap_count),
            held_samples: 0,
            input: 0,
            norm: 0,
        }
    }

    fn memories(config: &FixedSignLmsConfig) -> [SinglePortRam<i64>; 2] {
        let taps = config.tap_count;
        [
            SinglePortRam::filled("RAMA", taps, 0),
            SinglePortRam::filled("RAMB", taps, config.initial_weight),
        ]
    }

    fn config(&self) -> &FixedSignLmsConfig {
        &self.config
    }

    fn registers(&self) -> &FixedRegisters<SignLmsState> {
        &self.registers
    }

    fn registers_mut(&mut self) -> &mut FixedRegisters<SignLmsState> {
        &mut self.registers
    }

    fn strobes_output(&self) -> bool {
        self.registers.state == SignLmsState::Err
    }

    /// L_reading: the slot that the new word will take still holds the one that leaves the taps.
    fn load(&mut self, pair: CodePair, datapath: &mut FixedDatapath<'_>) {
        let oldest = self.registers.next_slot(self.config.tap_count);
        self.registers.read_latch = datapath.read_a(oldest);
        self.registers.product = datapath.multiply(pair.input, pair.input);
        self.input = pair.input;
        self.registers.desired = pair.desired;
        self.registers.state = SignLmsState::LWriting;
    }

    fn step(&mut self, next_waits: bool, datapath: &mut FixedDatapath<'_>) {
        let taps = self.config.tap_count;
        match self.registers.state {
            // The sequencer's own: waiting and loading.
            SignLmsState::Idle | SignLmsState::LReading => {}
            SignLmsState::LWriting => {
                self.registers.enter_ring(self.input, taps, datapath);
                self.registers.state = SignLmsState::NrmAdding;
            }
            SignLmsState::NrmAdding => self.norm_add(datapath),
            SignLmsState::NrmWriting => {
                self.norm = datapath.add(self.norm, -self.registers.product);
                self.registers.state = SignLmsState::OutReading;
            }
            SignLmsState::OutReading => self.accumulate_output(datapath),
            SignLmsState::OutWriting => {
                let formats = self.config.formats.of_taps();
                self.registers
                    .write_output(&formats, SignLmsState::Err, datapath);
            }
            SignLmsState::Err => self.form_error(datapath),
            SignLmsState::Gain => self.scale_error(datapath),
            SignLmsState::LmwReading => {
                self.registers
                    .read_weight(taps, SignLmsState::LmwWriting, datapath);
            }
            SignLmsState::LmwWriting => {
                let formats = &self.config.formats;
                // After the last weight the next sample is loaded at once.
                let then = (SignLmsState::LmwReading, Self::after_sample(next_waits));
                self.registers.correct_weight(formats, taps, then, datapath);
            }
            SignLmsState::Clearing => {
                let weight = self.config.initial_weight;
                self.registers.clear_tap(weight, taps, datapath);
            }
        }
    }
}

impl FixedSignLmsMachine {
    /// NRM_adding: the square of the new word joins the norm, that of the old one is formed.
    fn norm_add(&mut self, datapath: &mut FixedDatapath<'_>) {
        let leaving = self.registers.read_latch;
        self.norm = datapath.add(self.norm, self.registers.product);
        self.registers.product = datapath.multiply(leaving, leaving);
        self.registers.state = SignLmsState::NrmWriting;
    }

    /// Out_reading: `P <- L_j*W_j`; the adder forms the denominator first, then sums.
    fn accumulate_output(&mut self, datapath: &mut FixedDatapath<'_>) {
        if self.registers.j == 0 {
            datapath.count_sum();
            self.registers.denominator = self.config.denominator(self.norm).code;
        }
        let (taps, done) = (self.config.tap_count, SignLmsState::OutWriting);
        self.registers.accumulate_taps(0, 0, taps, done, datapath);
    }

    /// ERR: the error, and the gain, which the divider forms meanwhile.
    fn form_error(&mut self, datapath: &mut FixedDatapath<'_>) {
        let FixedRegisters {
            desired,
            output,
            denominator,
            ..
        } = self.registers;
        let formats = &self.config.formats;
        datapath.count_sum();
        datapath.count_quotient();
        self.registers.error = formats.of_taps().error(desired, output).code;
        self.registers.gain = self.config.step.gain(formats, denominator).code;
        self.registers.state = SignLmsState::Gain;
    }

    /// GAIN: what the taps are multiplied by, once per sample.
    fn scale_error(&mut self, datapath: &mut FixedDatapath<'_>) {
        let FixedRegisters { error, gain, .. } = self.registers;
        let is_beyond = self.config.is_beyond(error);
        let is_held = is_beyond && self.held_samples < self.config.hold_samples;
        if is_held {
            self.held_samples += 1;
        } else if !is_beyond {
            self.held_samples = 0;
        }
        if self.config.normalised {
            datapath.count_product();
        }
        self.registers.intermediate = if is_held {
            0
        } else {
            self.config.step_of(error, gain).code
        };
        self.registers.state = SignLmsState::LmwReading;
    }
}
