//! One sequencer under every pipeline: memories, clock edge, strobes, run and test points.
//!
//! ```text
//!              +---------------------------------------+
//!  in_valid -->|  Sequencer   handshake, clock edge    |--> out_valid
//!  x, d ------>|  Machine     states, registers, steps |--> y
//!  in_ready <--|  Datapath    RAMA  RAMB   x  +  /     |
//!              +---------------------------------------+
//! ```
//!
//! | port | direction | word | meaning |
//! |---|---|---|---|
//! | `input` | in | `Option<Pair>`: strobe, `x`, `d` | held until `accepted` |
//! | `accepted` | out | bit | the pair is taken in this clock (state [`Machine::LOADING`]) |
//! | `output` | out | `Option`: strobe, `y` | register Y, while [`Machine::strobes_output`] |
//!
//! A strobe wakes an idle machine into its loading state. A strobe withdrawn before that state puts
//! it back to idle. The last clock of a sample goes straight to loading if the next strobe is up.
//!
//! Units may take several clocks ([`Machine::units`]). A clock of the machine is then a step: it
//! lasts as long as the slowest unit that it uses, and nothing moves before its last clock.
//!
//! A reset, in any clock, sets all registers and begins to clear: [`Machine::CLEARING`] writes every
//! word of both memories anew, one of each a clock, and takes no sample meanwhile. Clocks are
//! counted from where that ends.

use super::datapath::Datapath;
use super::float_unit::Fp;
use super::front_end::Pair;
use super::memory::SinglePortRam;
use super::probe::{NoProbe, PortView, Probe, Tick};
use super::registers::{ControlState, Registers};
use super::timing::Units;

/// Control machine of a pipeline with its registers: what each state does in its clock.
///
/// A step reads registers and memories first and assigns after: all values read are those before
/// the edge. Operand order is that of the RTL.
pub trait Machine: Clone {
    /// Word format.
    type Word: Fp;
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
    fn memories(config: &Self::Config) -> [SinglePortRam<Self::Word>; 2];

    /// Synthesis-time constants.
    fn config(&self) -> &Self::Config;

    /// Registers that every pipeline has.
    fn registers(&self) -> &Registers<Self::State, Self::Word>;

    /// The same, for the sequencer's handshake.
    fn registers_mut(&mut self) -> &mut Registers<Self::State, Self::Word>;

    /// Latencies of the units.
    #[inline]
    fn units(&self) -> Units {
        Units::ONE_CLOCK
    }

    /// Whether the output strobe is up in the first clock of this step.
    fn strobes_output(&self) -> bool;

    /// Clock of the loading state, in which `pair` is taken.
    fn load<Q: Probe<Self::Word>>(
        &mut self,
        pair: Pair<Self::Word>,
        datapath: &mut Datapath<'_, Self::Word, Q>,
    );

    /// Step of any state but idle and loading; clearing is one.
    ///
    /// * `next_waits`: whether the input strobe is up.
    fn step<Q: Probe<Self::Word>>(
        &mut self,
        next_waits: bool,
        datapath: &mut Datapath<'_, Self::Word, Q>,
    );

    /// State after the last clock of a sample. Passing through idle would cost a clock, and with
    /// it the paper's 370 kHz.
    #[inline]
    fn after_sample(next_waits: bool) -> Self::State {
        if next_waits {
            Self::LOADING
        } else {
            Self::State::IDLE
        }
    }
}

/// Clocked pipeline: a machine, its two memories, and one clock at a time.
///
/// ```
/// use fogbench::fpga::front_end::Pair;
/// use fogbench::fpga::lms::{DesiredSource, LmsConfig, LmsPipeline, LmsSettings};
/// use fogbench::vocabulary::UpdateSign;
///
/// # fn main() -> Result<(), fogbench::fpga::FpgaError> {
/// let config = LmsConfig::<f64>::new(LmsSettings {
///     tap_count: 2,
///     step_size: 0.25,
///     regularisation: None,
///     desired: DesiredSource::Port,
///     update_sign: UpdateSign::Corrected,
/// })?;
/// let mut pipeline = LmsPipeline::new(config);
/// let mut words = Vec::new();
/// pipeline.run(&[Pair::from_f64(1.0, 1.0); 3], &mut words);
/// // W begins at zero; each step adds mu e x: 0, then 0.25, then a second tap that has seen a word.
/// assert_eq!(words, [0.0, 0.25, 0.625]);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Sequencer<M: Machine> {
    machine: M,
    /// RAMA, RAMB.
    memories: [SinglePortRam<M::Word>; 2],
    /// Whether some unit takes more than a clock.
    waits: bool,
    /// Clocks that the step under way still takes; none in its first one.
    left: u64,
}

impl<M: Machine> Sequencer<M> {
    /// A pipeline just out of reset, its memories cleared.
    #[must_use]
    pub fn new(config: M::Config) -> Self {
        let machine = M::new(config);
        Self {
            memories: M::memories(&config),
            waits: machine.units().wait(),
            machine,
            left: 0,
        }
    }

    /// A clock edge with the reset up: registers as after reset, memories still as they were. The
    /// clocks that follow clear them.
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

    /// Latencies of the units.
    #[inline]
    #[must_use]
    pub fn units(&self) -> Units {
        self.machine.units()
    }

    /// The control machine with all its registers, between two clocks.
    #[must_use]
    pub fn machine(&self) -> &M {
        &self.machine
    }

    /// The registers that every pipeline has, between two clocks.
    #[must_use]
    pub fn registers(&self) -> &Registers<M::State, M::Word> {
        self.machine.registers()
    }

    /// The words of RAMA; the pipeline's own page states their order.
    #[must_use]
    pub fn rama(&self) -> &[M::Word] {
        self.memories[0].words()
    }

    /// The words of RAMB; the pipeline's own page states their order.
    #[must_use]
    pub fn ramb(&self) -> &[M::Word] {
        self.memories[1].words()
    }

    /// Advances one clock. A strobe must be held until it is accepted; withdrawn before, the
    /// sample is not taken.
    #[inline]
    pub fn tick(&mut self, input: Option<Pair<M::Word>>) -> Tick<M::Word> {
        self.tick_probed(input, &mut NoProbe)
    }

    /// Advances one clock under the eyes of a probe.
    #[inline]
    pub fn tick_probed<Q: Probe<M::Word>>(
        &mut self,
        input: Option<Pair<M::Word>>,
        probe: &mut Q,
    ) -> Tick<M::Word> {
        let state = self.machine.registers().state;
        let accepted = state == M::LOADING && input.is_some();
        let strobes = self.left == 0 && self.machine.strobes_output();
        let output = strobes.then_some(self.machine.registers().output);
        if self.waits && self.unit_is_busy(state, input.is_some()) {
            probe.wait(state.code(), output.is_some());
            return Tick { accepted, output };
        }
        if Q::WATCHES {
            let ports = PortView {
                input_valid: input.is_some(),
                input_ready: accepted,
                input: input.map_or(M::Word::ZERO, |pair| pair.input),
                desired: input.map_or(M::Word::ZERO, |pair| pair.desired),
                output_valid: output.is_some(),
            };
            probe.clock(&self.machine.registers().view(), &ports);
        }
        let datapath = &mut Datapath::new(&mut self.memories, probe);
        if state != M::LOADING && state != M::State::IDLE {
            self.machine.step(input.is_some(), datapath);
        } else if state == M::LOADING {
            match input {
                Some(pair) => self.machine.load(pair, datapath),
                None => self.machine.registers_mut().state = M::State::IDLE,
            }
        } else if input.is_some() {
            self.machine.registers_mut().state = M::LOADING;
        }
        let [rama, ramb] = &mut self.memories;
        rama.edge();
        ramb.edge();
        Tick { accepted, output }
    }

    /// Counts a clock of the step under way; whether a unit that it uses needs another one. Kept out of the
    /// clock of machines that never wait, which it would slow.
    #[cold]
    #[inline(never)]
    fn unit_is_busy(&mut self, state: M::State, next_waits: bool) -> bool {
        if state == M::LOADING || state == M::State::IDLE || state == M::CLEARING {
            return false;
        }
        if self.left == 0 {
            self.left = self.step_clocks(next_waits);
        }
        self.left -= 1;
        self.left > 0
    }

    /// Clocks of the step that begins. The units that it uses are those that it uses in fact: a copy of the
    /// machine is sent ahead to see, and what it wrote is taken back.
    fn step_clocks(&mut self, next_waits: bool) -> u64 {
        let mut uses = UnitsInUse {
            units: self.machine.units(),
            clocks: 1,
            written: [None; 2],
        };
        let datapath = &mut Datapath::new(&mut self.memories, &mut uses);
        self.machine.clone().step(next_waits, datapath);
        for (memory, written) in self.memories.iter_mut().zip(uses.written) {
            memory.edge();
            if let Some((address, word)) = written {
                memory.preload(address, word);
            }
        }
        uses.clocks
    }

    /// Runs back-to-back samples to completion, appending one output word per pair.
    pub fn run(&mut self, pairs: &[Pair<M::Word>], outputs: &mut Vec<M::Word>) {
        self.run_probed(pairs, outputs, &mut NoProbe);
    }

    /// [`Self::run`] under the eyes of a probe. Ends in the first idle clock, not ticked.
    pub fn run_probed<Q: Probe<M::Word>>(
        &mut self,
        pairs: &[Pair<M::Word>],
        outputs: &mut Vec<M::Word>,
        probe: &mut Q,
    ) {
        let mut next = 0;
        while next < pairs.len() || self.machine.registers().state != M::State::IDLE {
            let tick = self.tick_probed(pairs.get(next).copied(), probe);
            next += usize::from(tick.accepted);
            outputs.extend(tick.output);
        }
    }
}

/// Notes how long the slowest unit in use takes, and what stood where a memory is written.
struct UnitsInUse<F> {
    units: Units,
    clocks: u64,
    /// Address and word before, of RAMA and RAMB.
    written: [Option<(usize, F)>; 2],
}

impl<F: Fp> Probe<F> for UnitsInUse<F> {
    fn rama(&mut self, address: usize, write: Option<F>, read: F) {
        self.written[0] = write.map(|_| (address, read));
    }
    fn ramb(&mut self, address: usize, write: Option<F>, read: F) {
        self.written[1] = write.map(|_| (address, read));
    }
    fn multiply(&mut self, _a: F, _b: F, _q: F) {
        self.clocks = self.clocks.max(self.units.multiplier.latency_clocks);
    }
    fn add(&mut self, _a: F, _b: F, _subtract: bool, _q: F) {
        self.clocks = self.clocks.max(self.units.adder.latency_clocks);
    }
    fn divide(&mut self, _a: F, _b: F, _q: F) {
        self.clocks = self.clocks.max(self.units.divider.latency_clocks);
    }
}
