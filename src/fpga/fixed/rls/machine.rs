//! The control machine of the fixed-point pipeline: what each state does in its clock.

use super::config::FixedRlsConfig;
use crate::fpga::fixed::CodePair;
use crate::fpga::fixed::datapath::FixedDatapath;
use crate::fpga::fixed::registers::FixedRegisters;
use crate::fpga::fixed::sequencer::{FixedMachine, FixedSequencer};
use crate::fpga::memory::SinglePortRam;
use crate::fpga::registers::control_states;
use crate::fpga::timing::Units;

control_states! {
    /// States of the control machine.
    pub enum FixedRlsState {
        /// Waiting for a strobe.
        Idle = "Idle",
        /// The new regressor word enters the ring, the desired word its register.
        RiLLoading = "RiL_loading",
        /// `t = R L`: one product per clock.
        RiLReading = "RiL_reading",
        /// The sum of a row, rounded, goes to RAMB.
        RiLWriting = "RiL_writing",
        /// `den = alpha + L't`: one product per clock.
        LrlReading = "LRL_reading",
        /// The sum, rounded, goes to the register DEN.
        LrlWriting = "LRL_writing",
        /// `k = t / den`, one division per tap, goes to RAMA.
        GainDividing = "GAIN_dividing",
        /// Product `k_i t_j` in the first clock, element of R in the second.
        RfrReading = "RFR_reading",
        /// The corrected element is written back; with slow units and 1/alpha the third step of the state,
        /// after the difference and its product with 1/alpha.
        RfrWriting = "RFR_writing",
        /// The same word below the diagonal.
        RfrMirroring = "RFR_mirroring",
        /// `y = W'L`.
        OutReading = "Out_reading",
        /// The sum, rounded, goes to the output register.
        OutWriting = "Out_writing",
        /// Error in the first clock, then product and weight of each tap.
        RfwReading = "RFW_reading",
        /// The new weight is written back.
        RfwWriting = "RFW_writing",
        /// After a reset: the words of both memories are written anew.
        Clearing = "Clearing",
    }
}

/// The clocked pipeline. RAMA: ring of L, k. RAMB: W, t, R row by row.
pub type FixedRlsPipeline = FixedSequencer<FixedRlsMachine>;

/// Control machine and registers of the fixed-point pipeline.
#[derive(Clone, Debug)]
pub struct FixedRlsMachine {
    config: FixedRlsConfig,
    registers: FixedRegisters<FixedRlsState>,
}

impl FixedMachine for FixedRlsMachine {
    type Config = FixedRlsConfig;
    type State = FixedRlsState;

    const LOADING: FixedRlsState = FixedRlsState::RiLLoading;
    const CLEARING: FixedRlsState = FixedRlsState::Clearing;

    fn new(config: FixedRlsConfig) -> Self {
        Self {
            config,
            registers: FixedRegisters::reset(config.tap_count),
        }
    }

    fn memories(config: &FixedRlsConfig) -> [SinglePortRam<i64>; 2] {
        let p = config.tap_count;
        let mut ramb = SinglePortRam::filled("RAMB", 2 * p + p * p, 0);
        for i in 0..p {
            ramb.preload(2 * p + i * p + i, config.delta);
        }
        [SinglePortRam::filled("RAMA", 2 * p, 0), ramb]
    }

    fn config(&self) -> &FixedRlsConfig {
        &self.config
    }

    fn units(&self) -> Units {
        self.config.units
    }

    fn registers(&self) -> &FixedRegisters<FixedRlsState> {
        &self.registers
    }

    fn registers_mut(&mut self) -> &mut FixedRegisters<FixedRlsState> {
        &mut self.registers
    }

    fn strobes_output(&self) -> bool {
        self.registers.state == FixedRlsState::RfwReading && !self.registers.second
    }

    fn load(&mut self, pair: CodePair, datapath: &mut FixedDatapath<'_>) {
        let p = self.config.tap_count;
        self.registers.load_pair(pair, p, datapath);
        self.registers.state = FixedRlsState::RiLReading;
    }

    fn step(&mut self, next_waits: bool, datapath: &mut FixedDatapath<'_>) {
        let p = self.config.tap_count;
        match self.registers.state {
            FixedRlsState::Idle | FixedRlsState::RiLLoading => {}
            FixedRlsState::RiLReading => {
                let (row, done) = ((2 + self.registers.i) * p, FixedRlsState::RiLWriting);
                self.registers.accumulate_taps(row, 0, p, done, datapath);
            }
            FixedRlsState::LrlReading => {
                let (alpha, done) = (self.config.alpha, FixedRlsState::LrlWriting);
                self.registers.accumulate_taps(p, alpha, p, done, datapath);
            }
            FixedRlsState::OutReading => {
                let done = FixedRlsState::OutWriting;
                self.registers.accumulate_taps(0, 0, p, done, datapath);
            }
            FixedRlsState::RiLWriting => {
                let sum = self.registers.last_sum(datapath);
                let word = self.config.intermediate(sum).code;
                datapath.write_b(p + self.registers.i, word);
                self.next_row(FixedRlsState::RiLReading, FixedRlsState::LrlReading);
            }
            FixedRlsState::LrlWriting => {
                let sum = self.registers.last_sum(datapath);
                self.registers.denominator = self.config.denominator(sum).code;
                self.registers.state = FixedRlsState::GainDividing;
            }
            FixedRlsState::GainDividing => {
                let t_i = datapath.read_b(p + self.registers.i);
                datapath.count_quotient();
                let gain = self.config.gain(t_i, self.registers.denominator).code;
                datapath.write_a(p + self.registers.i, gain);
                self.next_row(FixedRlsState::GainDividing, FixedRlsState::RfrReading);
            }
            FixedRlsState::RfrReading => self.correct_read(datapath),
            FixedRlsState::RfrWriting => self.correct_write(datapath),
            FixedRlsState::RfrMirroring => self.correct_mirror(datapath),
            FixedRlsState::OutWriting => {
                let formats = self.config.formats.of_taps();
                let done = FixedRlsState::RfwReading;
                self.registers.write_output(&formats, done, datapath);
            }
            FixedRlsState::RfwReading => self.weight_read(datapath),
            FixedRlsState::RfwWriting => self.weight_write(next_waits, datapath),
            FixedRlsState::Clearing => self.clear(datapath),
        }
    }
}

impl FixedRlsMachine {
    /// Counts the row up; on to `again`, or after the last one to `done`.
    fn next_row(&mut self, again: FixedRlsState, done: FixedRlsState) {
        self.registers.i = (self.registers.i + 1) % self.config.tap_count;
        self.registers.state = if self.registers.i == 0 { done } else { again };
    }

    /// RFR_reading: both memories for the product, then RAMB for the element.
    fn correct_read(&mut self, datapath: &mut FixedDatapath<'_>) {
        let p = self.config.tap_count;
        let FixedRegisters { i, j, .. } = self.registers;
        if self.registers.second {
            self.registers.read_latch = datapath.read_b(2 * p + i * p + j);
            self.registers.second = false;
            self.registers.state = FixedRlsState::RfrWriting;
        } else {
            let k_i = datapath.read_a(p + i);
            let t_j = datapath.read_b(p + j);
            self.registers.product = datapath.multiply(k_i, t_j);
            self.registers.second = true;
        }
    }

    fn corrected(&self) -> i64 {
        let FixedRegisters {
            i,
            j,
            read_latch,
            product,
            ..
        } = self.registers;
        let code = if self.config.splits() {
            self.config.inverse_grown(product).code
        } else {
            self.config.inverse(read_latch, product)[1].code
        };
        if i == j {
            self.config.floored(code)
        } else {
            code
        }
    }

    fn correct_write(&mut self, datapath: &mut FixedDatapath<'_>) {
        let p = self.config.tap_count;
        let FixedRegisters { i, j, .. } = self.registers;
        if self.config.splits() && !self.registers.third {
            return self.correct_early(datapath);
        }
        self.registers.second = false;
        self.registers.third = false;
        datapath.count_sum();
        if self.config.inverse_alpha.is_some() && !self.config.splits() {
            datapath.count_product();
        }
        datapath.write_b(2 * p + i * p + j, self.corrected());
        if i == j {
            self.next_element();
        } else {
            self.registers.state = FixedRlsState::RfrMirroring;
        }
    }

    /// The first two of three steps: the difference, then its product with 1/alpha, both to P.
    fn correct_early(&mut self, datapath: &mut FixedDatapath<'_>) {
        let FixedRegisters {
            read_latch,
            product,
            ..
        } = self.registers;
        if self.registers.second {
            self.registers.third = true;
            // A word of R stands in P, so that nothing is cut off.
            self.registers.product = product * i128::from(self.config.inverse_alpha.unwrap_or(0));
            datapath.count_product();
        } else {
            self.registers.second = true;
            let corrected = self.config.inverse_difference(read_latch, product);
            self.registers.product = i128::from(corrected.code);
            datapath.count_sum();
        }
    }

    fn correct_mirror(&mut self, datapath: &mut FixedDatapath<'_>) {
        let p = self.config.tap_count;
        let FixedRegisters { i, j, .. } = self.registers;
        datapath.write_b(2 * p + j * p + i, self.corrected());
        self.next_element();
    }

    /// On to the next element on or above the diagonal.
    fn next_element(&mut self) {
        let p = self.config.tap_count;
        self.registers.state = FixedRlsState::RfrReading;
        self.registers.j += 1;
        if self.registers.j == p {
            self.registers.i += 1;
            self.registers.j = self.registers.i;
        }
        if self.registers.i == p {
            self.registers.i = 0;
            self.registers.j = 0;
            self.registers.state = FixedRlsState::OutReading;
        }
    }

    fn weight_read(&mut self, datapath: &mut FixedDatapath<'_>) {
        let FixedRegisters {
            i, desired, output, ..
        } = self.registers;
        if !self.registers.second {
            datapath.count_sum();
            let taps = self.config.formats.of_taps();
            self.registers.error = taps.error(desired, output).code;
            self.registers.second = true;
            return;
        }
        let k_i = datapath.read_a(self.config.tap_count + i);
        self.registers.read_latch = datapath.read_b(i);
        self.registers.product = datapath.multiply(k_i, self.registers.error);
        self.registers.state = FixedRlsState::RfwWriting;
    }

    fn weight_write(&mut self, next_waits: bool, datapath: &mut FixedDatapath<'_>) {
        let FixedRegisters {
            i,
            read_latch,
            product,
            ..
        } = self.registers;
        datapath.count_sum();
        let weight = self.config.weight(read_latch, product).code;
        datapath.write_b(i, weight);
        self.next_row(FixedRlsState::RfwReading, Self::after_sample(next_waits));
        self.registers.second = self.registers.i != 0;
    }

    /// Clearing: R row by row, then what stands before it in RAMB, and with it all of RAMA.
    fn clear(&mut self, datapath: &mut FixedDatapath<'_>) {
        let p = self.config.tap_count;
        let FixedRegisters { i, j, second, .. } = self.registers;
        if !second {
            let word = if i == j { self.config.delta } else { 0 };
            datapath.write_b(2 * p + i * p + j, word);
            self.registers.j = (j + 1) % p;
            if self.registers.j == 0 {
                self.registers.i = (i + 1) % p;
                self.registers.second = self.registers.i == 0;
            }
            return;
        }
        // Rows of p words: W and L, then t and k.
        datapath.write_a(i * p + j, 0);
        datapath.write_b(i * p + j, 0);
        self.registers.j = (j + 1) % p;
        if self.registers.j == 0 {
            self.registers.i = i + 1;
        }
        if self.registers.i == 2 {
            self.registers.i = 0;
            self.registers.second = false;
            self.registers.state = FixedRlsState::Idle;
        }
    }
}
