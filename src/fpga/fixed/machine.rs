//! The control machine of the fixed-point pipeline: what each state does in its clock.

use super::CodePair;
use super::config::FixedRlsConfig;
use crate::fpga::memory::SinglePortRam;
use crate::fpga::registers::{ControlState as _, control_states};

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
        /// The corrected element is written back.
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

/// Clocks from one accepted sample to the next, back to back: `3p^2 + 7p + 4`.
#[must_use]
pub const fn fixed_rls_clocks_per_sample(tap_count: usize) -> usize {
    3 * tap_count * tap_count + 7 * tap_count + 4
}

/// Clocks from accepting a sample until its result can be read: `3p^2 + 5p + 3`.
#[must_use]
pub const fn fixed_rls_latency_clocks(tap_count: usize) -> usize {
    3 * tap_count * tap_count + 5 * tap_count + 3
}

/// Clocks from one accepted sample to the next with a divider of `divider_clocks`, 1 or more.
#[must_use]
pub const fn fixed_rls_stalled_clocks(tap_count: usize, divider_clocks: u64) -> u64 {
    let taps = tap_count as u64;
    fixed_rls_clocks_per_sample(tap_count) as u64 + taps * (divider_clocks - 1)
}

/// Registers, named as in the RTL.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FixedRegisters {
    /// Control state.
    pub state: FixedRlsState,
    /// Row counter.
    pub i: usize,
    /// Column (tap) counter.
    pub j: usize,
    /// Second reading clock; the error is done; R is cleared.
    pub second: bool,
    /// Ring slot HEAD of the newest regressor word.
    pub head: usize,
    /// Product P, exact.
    pub product: i128,
    /// Accumulator ACC, exact.
    pub accumulator: i128,
    /// Read latch RR.
    pub read_latch: i64,
    /// Denominator DEN.
    pub denominator: i64,
    /// Desired word D.
    pub desired: i64,
    /// Error E.
    pub error: i64,
    /// Output Y.
    pub output: i64,
}

/// Use of a memory port in a clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PortAccess {
    /// Whether the port is used.
    pub is_used: bool,
    /// Address, 0 if unused.
    pub address: usize,
    /// Word written, if any.
    pub write: Option<i64>,
}

/// Use of the units in a clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct UnitUse {
    /// Products, that with 1/alpha among them.
    pub products: u8,
    /// Sums and differences.
    pub sums: u8,
    /// Quotients.
    pub quotients: u8,
}

/// One clock: registers before its edge, ports, strobes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct FixedClock {
    /// Registers before the edge.
    pub registers: FixedRegisters,
    /// RAMA.
    pub rama: PortAccess,
    /// RAMB.
    pub ramb: PortAccess,
    /// Units.
    pub units: UnitUse,
    /// The offered pair was taken.
    pub accepted: bool,
    /// Code of the output, in the one clock in which its strobe is up.
    pub output: Option<i64>,
}

/// The clocked pipeline.
#[derive(Clone, Debug)]
pub struct FixedRlsPipeline {
    config: FixedRlsConfig,
    registers: FixedRegisters,
    rama: SinglePortRam<i64>,
    ramb: SinglePortRam<i64>,
    ports: [PortAccess; 2],
    units: UnitUse,
}

impl FixedRlsPipeline {
    /// A pipeline just out of reset, its memories cleared.
    #[must_use]
    pub fn new(config: FixedRlsConfig) -> Self {
        let p = config.tap_count;
        let mut ramb = SinglePortRam::filled("RAMB", 2 * p + p * p, 0);
        for i in 0..p {
            ramb.preload(2 * p + i * p + i, config.delta);
        }
        Self {
            config,
            registers: FixedRegisters {
                state: FixedRlsState::Idle,
                i: 0,
                j: 0,
                second: false,
                head: p - 1,
                product: 0,
                accumulator: 0,
                read_latch: 0,
                denominator: 0,
                desired: 0,
                error: 0,
                output: 0,
            },
            rama: SinglePortRam::filled("RAMA", 2 * p, 0),
            ramb,
            ports: [PortAccess::default(); 2],
            units: UnitUse::default(),
        }
    }

    /// A clock edge with the reset up; the clocks that follow clear the memories.
    pub fn reset(&mut self) {
        self.registers = Self::new(self.config).registers;
        self.registers.state = FixedRlsState::Clearing;
    }

    /// Constants.
    #[must_use]
    pub fn config(&self) -> &FixedRlsConfig {
        &self.config
    }

    /// Registers, between two clocks.
    #[must_use]
    pub fn registers(&self) -> &FixedRegisters {
        &self.registers
    }

    /// The words of RAMA.
    #[must_use]
    pub fn rama(&self) -> &[i64] {
        self.rama.words()
    }

    /// The words of RAMB.
    #[must_use]
    pub fn ramb(&self) -> &[i64] {
        self.ramb.words()
    }

    /// Advances one clock. A strobe must be held until it is accepted; withdrawn before, the
    /// sample is not taken.
    pub fn tick(&mut self, input: Option<CodePair>) -> FixedClock {
        let registers = self.registers;
        self.ports = [PortAccess::default(); 2];
        self.units = UnitUse::default();
        let accepted = registers.state == FixedRlsState::RiLLoading && input.is_some();
        let strobes = registers.state == FixedRlsState::RfwReading && !registers.second;
        match (registers.state, input) {
            (FixedRlsState::Idle, Some(_)) => self.registers.state = FixedRlsState::RiLLoading,
            (FixedRlsState::Idle, None) => {}
            (FixedRlsState::RiLLoading, Some(pair)) => self.load(pair),
            (FixedRlsState::RiLLoading, None) => self.registers.state = FixedRlsState::Idle,
            (_, waiting) => self.step(waiting.is_some()),
        }
        self.rama.edge();
        self.ramb.edge();
        FixedClock {
            registers,
            rama: self.ports[0],
            ramb: self.ports[1],
            units: self.units,
            accepted,
            output: strobes.then_some(registers.output),
        }
    }

    fn read_a(&mut self, address: usize) -> i64 {
        self.ports[0].is_used = true;
        self.ports[0].address = address;
        self.rama.read(address)
    }

    fn read_b(&mut self, address: usize) -> i64 {
        self.ports[1].is_used = true;
        self.ports[1].address = address;
        self.ramb.read(address)
    }

    fn write_a(&mut self, address: usize, word: i64) {
        self.ports[0] = PortAccess {
            is_used: true,
            address,
            write: Some(word),
        };
        self.rama.write(address, word);
    }

    fn write_b(&mut self, address: usize, word: i64) {
        self.ports[1] = PortAccess {
            is_used: true,
            address,
            write: Some(word),
        };
        self.ramb.write(address, word);
    }

    fn load(&mut self, pair: CodePair) {
        let p = self.config.tap_count;
        let head = (self.registers.head + 1) % p;
        self.write_a(head, pair.input);
        self.registers.head = head;
        self.registers.desired = pair.desired;
        self.registers.state = FixedRlsState::RiLReading;
    }

    fn step(&mut self, next_waits: bool) {
        let p = self.config.tap_count;
        match self.registers.state {
            FixedRlsState::Idle | FixedRlsState::RiLLoading => {}
            FixedRlsState::RiLReading => {
                let b = 2 * p + self.registers.i * p + self.registers.j;
                self.accumulate(b, 0, FixedRlsState::RiLWriting);
            }
            FixedRlsState::LrlReading => {
                let b = p + self.registers.j;
                self.accumulate(b, self.config.alpha, FixedRlsState::LrlWriting);
            }
            FixedRlsState::OutReading => {
                self.accumulate(self.registers.j, 0, FixedRlsState::OutWriting);
            }
            FixedRlsState::RiLWriting => {
                let sum = self.last_sum();
                let word = self.config.intermediate(sum).code;
                self.write_b(p + self.registers.i, word);
                self.next_row(FixedRlsState::RiLReading, FixedRlsState::LrlReading);
            }
            FixedRlsState::LrlWriting => {
                let sum = self.last_sum();
                self.registers.denominator = self.config.denominator(sum).code;
                self.registers.state = FixedRlsState::GainDividing;
            }
            FixedRlsState::GainDividing => {
                let t_i = self.read_b(p + self.registers.i);
                self.units.quotients += 1;
                let gain = self.config.gain(t_i, self.registers.denominator).code;
                self.write_a(p + self.registers.i, gain);
                self.next_row(FixedRlsState::GainDividing, FixedRlsState::RfrReading);
            }
            FixedRlsState::RfrReading => self.correct_read(),
            FixedRlsState::RfrWriting => self.correct_write(),
            FixedRlsState::RfrMirroring => self.correct_mirror(),
            FixedRlsState::OutWriting => {
                let sum = self.last_sum();
                self.registers.output = self.config.output(sum).code;
                self.registers.state = FixedRlsState::RfwReading;
            }
            FixedRlsState::RfwReading => self.weight_read(),
            FixedRlsState::RfwWriting => self.weight_write(next_waits),
            FixedRlsState::Clearing => self.clear(),
        }
    }

    /// One clock of a dot product of L with the words of RAMB, that of tap j at address `b`.
    fn accumulate(&mut self, b: usize, first: i128, done: FixedRlsState) {
        let p = self.config.tap_count;
        let j = self.registers.j;
        let l_j = self.read_a((self.registers.head + p - j) % p);
        let b_j = self.read_b(b);
        self.registers.accumulator = if j == 0 { first } else { self.last_sum() };
        self.registers.product = self.multiply(l_j, b_j);
        self.registers.j = (j + 1) % p;
        if self.registers.j == 0 {
            self.registers.state = done;
        }
    }

    fn multiply(&mut self, a: i64, b: i64) -> i128 {
        self.units.products += 1;
        i128::from(a) * i128::from(b)
    }

    fn last_sum(&mut self) -> i128 {
        self.units.sums += 1;
        self.registers.accumulator + self.registers.product
    }

    /// Counts the row up; on to `again`, or after the last one to `done`.
    fn next_row(&mut self, again: FixedRlsState, done: FixedRlsState) {
        self.registers.i = (self.registers.i + 1) % self.config.tap_count;
        self.registers.state = if self.registers.i == 0 { done } else { again };
    }

    /// RFR_reading: both memories for the product, then RAMB for the element.
    fn correct_read(&mut self) {
        let p = self.config.tap_count;
        let FixedRegisters { i, j, .. } = self.registers;
        if self.registers.second {
            self.registers.read_latch = self.read_b(2 * p + i * p + j);
            self.registers.second = false;
            self.registers.state = FixedRlsState::RfrWriting;
        } else {
            let k_i = self.read_a(p + i);
            let t_j = self.read_b(p + j);
            self.registers.product = self.multiply(k_i, t_j);
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
        let code = self.config.inverse(read_latch, product)[1].code;
        if i == j {
            self.config.floored(code)
        } else {
            code
        }
    }

    fn correct_write(&mut self) {
        let p = self.config.tap_count;
        let FixedRegisters { i, j, .. } = self.registers;
        self.units.sums += 1;
        self.units.products += u8::from(self.config.inverse_alpha.is_some());
        self.write_b(2 * p + i * p + j, self.corrected());
        if i == j {
            self.next_element();
        } else {
            self.registers.state = FixedRlsState::RfrMirroring;
        }
    }

    fn correct_mirror(&mut self) {
        let p = self.config.tap_count;
        let FixedRegisters { i, j, .. } = self.registers;
        self.write_b(2 * p + j * p + i, self.corrected());
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

    fn weight_read(&mut self) {
        let FixedRegisters {
            i, desired, output, ..
        } = self.registers;
        if !self.registers.second {
            self.units.sums += 1;
            self.registers.error = self.config.error(desired, output).code;
            self.registers.second = true;
            return;
        }
        let k_i = self.read_a(self.config.tap_count + i);
        self.registers.read_latch = self.read_b(i);
        self.registers.product = self.multiply(k_i, self.registers.error);
        self.registers.state = FixedRlsState::RfwWriting;
    }

    fn weight_write(&mut self, next_waits: bool) {
        let FixedRegisters {
            i,
            read_latch,
            product,
            ..
        } = self.registers;
        self.units.sums += 1;
        let weight = self.config.weight(read_latch, product).code;
        self.write_b(i, weight);
        // Passing through Idle would cost a clock of the sample period.
        let done = if next_waits {
            FixedRlsState::RiLLoading
        } else {
            FixedRlsState::IDLE
        };
        self.next_row(FixedRlsState::RfwReading, done);
        self.registers.second = self.registers.i != 0;
    }

    /// Clearing: R row by row, then what stands before it in RAMB, and with it all of RAMA.
    fn clear(&mut self) {
        let p = self.config.tap_count;
        let FixedRegisters { i, j, second, .. } = self.registers;
        if !second {
            let word = if i == j { self.config.delta } else { 0 };
            self.write_b(2 * p + i * p + j, word);
            self.registers.j = (j + 1) % p;
            if self.registers.j == 0 {
                self.registers.i = (i + 1) % p;
                self.registers.second = self.registers.i == 0;
            }
            return;
        }
        // Rows of p words: W and L, then t and k.
        self.write_a(i * p + j, 0);
        self.write_b(i * p + j, 0);
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
