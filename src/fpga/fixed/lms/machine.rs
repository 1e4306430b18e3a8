//! The control machine of LMS and NLMS in fixed point: what each state does in its clock.

use super::config::{FixedLmsConfig, Step};
use crate::fpga::fixed::CodePair;
use crate::fpga::fixed::datapath::FixedDatapath;
use crate::fpga::fixed::registers::FixedRegisters;
use crate::fpga::fixed::sequencer::{FixedMachine, FixedSequencer};
use crate::fpga::lms::LmsState;
use crate::fpga::memory::SinglePortRam;

/// The clocked pipeline. RAMA: ring of L. RAMB: W, tap 0 first.
pub type FixedLmsPipeline = FixedSequencer<FixedLmsMachine>;

/// Control machine and registers of the pipeline.
#[derive(Clone, Debug)]
pub struct FixedLmsMachine {
    config: FixedLmsConfig,
    registers: FixedRegisters<LmsState>,
}

impl FixedMachine for FixedLmsMachine {
    type Config = FixedLmsConfig;
    type State = LmsState;

    const LOADING: LmsState = LmsState::LLoading;
    const CLEARING: LmsState = LmsState::Clearing;

    fn new(config: FixedLmsConfig) -> Self {
        Self {
            config,
            registers: FixedRegisters::reset(config.tap_count),
        }
    }

    fn memories(config: &FixedLmsConfig) -> [SinglePortRam<i64>; 2] {
        ["RAMA", "RAMB"].map(|name| SinglePortRam::filled(name, config.tap_count, 0))
    }

    fn config(&self) -> &FixedLmsConfig {
        &self.config
    }

    fn registers(&self) -> &FixedRegisters<LmsState> {
        &self.registers
    }

    fn registers_mut(&mut self) -> &mut FixedRegisters<LmsState> {
        &mut self.registers
    }

    fn strobes_output(&self) -> bool {
        self.registers.state == LmsState::Err
    }

    fn load(&mut self, pair: CodePair, datapath: &mut FixedDatapath<'_>) {
        let taps = self.config.tap_count;
        self.registers.load_pair(pair, taps, datapath);
        self.registers.state = if self.config.is_normalised() {
            LmsState::LlReading
        } else {
            LmsState::OutReading
        };
    }

    fn step(&mut self, next_waits: bool, datapath: &mut FixedDatapath<'_>) {
        let taps = self.config.tap_count;
        match self.registers.state {
            // The sequencer's own: waiting and loading.
            LmsState::Idle | LmsState::LLoading => {}
            LmsState::LlReading => {
                let first = self.config.regularisation();
                let done = LmsState::LlWriting;
                self.registers
                    .accumulate_squares(first, taps, done, datapath);
            }
            LmsState::LlWriting => {
                let sum = self.registers.last_sum(datapath);
                self.registers.denominator = self.config.denominator(sum).code;
                self.registers.state = LmsState::OutReading;
            }
            LmsState::OutReading => {
                let done = LmsState::OutWriting;
                self.registers.accumulate_taps(0, 0, taps, done, datapath);
            }
            LmsState::OutWriting => {
                let formats = self.config.formats.of_taps();
                self.registers
                    .write_output(&formats, LmsState::Err, datapath);
            }
            LmsState::Err => self.form_error(datapath),
            LmsState::Gain => self.scale_error(datapath),
            LmsState::LmwReading => {
                self.registers
                    .read_weight(taps, LmsState::LmwWriting, datapath);
            }
            LmsState::LmwWriting => {
                let formats = &self.config.formats;
                // After the last weight the next sample is loaded at once.
                let then = (LmsState::LmwReading, Self::after_sample(next_waits));
                self.registers.correct_weight(formats, taps, then, datapath);
            }
            LmsState::Clearing => self.registers.clear_tap(0, taps, datapath),
        }
    }
}

impl FixedLmsMachine {
    /// ERR: the error, and for NLMS the gain, which the divider forms meanwhile.
    fn form_error(&mut self, datapath: &mut FixedDatapath<'_>) {
        let FixedRegisters {
            desired, output, ..
        } = self.registers;
        datapath.count_sum();
        let taps = self.config.formats.of_taps();
        self.registers.error = taps.error(desired, output).code;
        if let Step::OverEnergy(step) = self.config.step {
            datapath.count_quotient();
            let denominator = self.registers.denominator;
            self.registers.gain = step.gain(&self.config.formats, denominator).code;
        }
        self.registers.state = LmsState::Gain;
    }

    /// GAIN: what the taps are multiplied by.
    fn scale_error(&mut self, datapath: &mut FixedDatapath<'_>) {
        let gain = match self.config.step {
            Step::Given(code) => code,
            Step::OverEnergy(_) => self.registers.gain,
        };
        let product = datapath.multiply(self.registers.error, gain);
        self.registers.intermediate = self.config.formats.step(product).code;
        self.registers.state = LmsState::LmwReading;
    }
}
