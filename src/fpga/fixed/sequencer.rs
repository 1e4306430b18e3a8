//! One sequencer under every fixed-point pipeline: memories, clock edge, strobes.
//!
//! The ports and the handshake are those of [`crate::fpga::machine`], the words codes. Units may take several
//! clocks ([`FixedMachine::units`]): a clock of the machine is then a step, which lasts as long as the slowest
//! unit that it uses, and does all in its last clock.

use super::CodePair;
use super::datapath::{FixedDatapath, PortAccess, UnitUse};
use super::registers::FixedRegisters;
use crate::fpga::memory::SinglePortRam;
use crate::fpga::registers::ControlState;
use crate::fpga::timing::Units;

/// Control machine of a fixed-point pipeline with its registers: what each state does in its clock.
///
/// A step reads registers and memories first and assigns after: all values read are those before the
/// edge.
pub trait FixedMachine: Clone {
    /// Synthesis-time constants.
    type Config: Copy;
    /// States.
    type State: ControlState;

    /// State in which the offered pair is taken.
    const LOADING: Self::State;

    /// State in which the memories are written anew after a reset.
    const CLEARING: Self::State;

    /// Registers just out of reset, the memories cleared.
    fn new(config: Self::Config) -> Self;

    /// RAMA and RAMB just out of reset, cleared.
    fn memories(config: &Self::Config) -> [SinglePortRam<i64>; 2];

    /// Synthesis-time constants.
    fn config(&self) -> &Self::Config;

    /// Latencies of the units.
    fn units(&self) -> Units {
        Units::ONE_CLOCK
    }

    /// Registers that every pipeline has.
    fn registers(&self) -> &FixedRegisters<Self::State>;

    /// The same, for the sequencer's handshake.
    fn registers_mut(&mut self) -> &mut FixedRegisters<Self::State>;

    /// Whether the output strobe is up in the first clock of this step.
    fn strobes_output(&self) -> bool;

    /// Clock of the loading state, in which `pair` is taken.
    fn load(&mut self, pair: CodePair, datapath: &mut FixedDatapath<'_>);

    /// Step of any state but idle and loading; clearing is one.
    ///
    /// * `next_waits`: whether the input strobe is up.
    fn step(&mut self, next_waits: bool, datapath: &mut FixedDatapath<'_>);

    /// State after the last clock of a sample. Passing through idle would cost a clock of the sample
    /// period.
    fn after_sample(next_waits: bool) -> Self::State {
        if next_waits {
            Self::LOADING
        } else {
            Self::State::IDLE
        }
    }
}

/// One clock: registers before its edge, ports, strobes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct FixedClock {
    /// Registers before the edge, the state by its code.
    pub registers: FixedRegisters<u8>,
    /// RAMA.
    pub rama: PortAccess,
    /// RAMB.
    pub ramb: PortAccess,
    /// Units.
    pub units: UnitUse,
    /// A unit is waited for: nothing moves.
    pub waits: bool,
    /// The offered pair was taken.
    pub accepted: bool,
    /// Code of the output, in the one clock in which its strobe is up.
    pub output: Option<i64>,
}

/// Clocked fixed-point pipeline: a machine, its two memories, and one clock at a time.
#[derive(Clone, Debug)]
pub struct FixedSequencer<M> {
    machine: M,
    /// RAMA, RAMB.
    memories: [SinglePortRam<i64>; 2],
    /// Clocks that the step under way still takes; none in its first one.
    left: u64,
}

impl<M: FixedMachine> FixedSequencer<M> {
    /// A pipeline just out of reset, its memories cleared.
    #[must_use]
    pub fn new(config: M::Config) -> Self {
        Self {
            machine: M::new(config),
            memories: M::memories(&config),
            left: 0,
        }
    }

    /// A clock edge with the reset up; the clocks that follow clear the memories.
    pub fn reset(&mut self) {
        self.machine = M::new(*self.machine.config());
        self.machine.registers_mut().state = M::CLEARING;
        self.left = 0;
    }

    /// The constants.
    #[must_use]
    pub fn config(&self) -> &M::Config {
        self.machine.config()
    }

    /// The registers that every pipeline has, between two clocks.
    #[must_use]
    pub fn registers(&self) -> &FixedRegisters<M::State> {
        self.machine.registers()
    }

    /// The words of RAMA; the pipeline's own page states their order.
    #[must_use]
    pub fn rama(&self) -> &[i64] {
        self.memories[0].words()
    }

    /// The words of RAMB; the pipeline's own page states their order.
    #[must_use]
    pub fn ramb(&self) -> &[i64] {
        self.memories[1].words()
    }

    /// Advances one clock. A strobe must be held until it is accepted; withdrawn before, the sample is
    /// not taken.
    pub fn tick(&mut self, input: Option<CodePair>) -> FixedClock {
        let registers = *self.machine.registers();
        let strobes = self.left == 0 && self.machine.strobes_output();
        let output = strobes.then_some(registers.output);
        let is_loading = registers.state == M::LOADING;
        if self.unit_is_busy(registers.state, input.is_some()) {
            return FixedClock {
                registers: registers.coded(),
                rama: PortAccess::default(),
                ramb: PortAccess::default(),
                units: UnitUse::default(),
                waits: true,
                accepted: false,
                output,
            };
        }
        let mut datapath = FixedDatapath::new(&mut self.memories);
        if !is_loading && registers.state != M::State::IDLE {
            self.machine.step(input.is_some(), &mut datapath);
        } else if is_loading {
            match input {
                Some(pair) => self.machine.load(pair, &mut datapath),
                None => self.machine.registers_mut().state = M::State::IDLE,
            }
        } else if input.is_some() {
            self.machine.registers_mut().state = M::LOADING;
        }
        let ([rama, ramb], units) = datapath.used();
        for memory in &mut self.memories {
            memory.edge();
        }
        FixedClock {
            registers: registers.coded(),
            rama,
            ramb,
            units,
            waits: false,
            accepted: is_loading && input.is_some(),
            output,
        }
    }

    /// Counts a clock of the step under way; whether a unit that it uses needs another one. The units are
    /// those that it uses in fact: a copy of the machine is sent ahead to see, and what it wrote is taken back.
    fn unit_is_busy(&mut self, state: M::State, next_waits: bool) -> bool {
        let units = self.machine.units();
        if !units.wait() || [M::LOADING, M::State::IDLE, M::CLEARING].contains(&state) {
            return false;
        }
        if self.left == 0 {
            let mut datapath = FixedDatapath::new(&mut self.memories);
            self.machine.clone().step(next_waits, &mut datapath);
            self.left = datapath.undo().clocks(units);
        }
        self.left -= 1;
        self.left > 0
    }
}

/// Clocked pipeline of any kind.
pub trait FixedClocked {
    /// As [`FixedSequencer::tick`].
    fn tick(&mut self, input: Option<CodePair>) -> FixedClock;

    /// As [`FixedSequencer::reset`].
    fn reset(&mut self);

    /// Whether it waits for a strobe.
    fn is_idle(&self) -> bool;

    /// The words of RAMA and those of RAMB.
    fn memories(&self) -> [&[i64]; 2];
}

impl<M: FixedMachine> FixedClocked for FixedSequencer<M> {
    fn tick(&mut self, input: Option<CodePair>) -> FixedClock {
        Self::tick(self, input)
    }

    fn reset(&mut self) {
        Self::reset(self);
    }

    fn is_idle(&self) -> bool {
        self.registers().state == M::State::IDLE
    }

    fn memories(&self) -> [&[i64]; 2] {
        [self.rama(), self.ramb()]
    }
}
