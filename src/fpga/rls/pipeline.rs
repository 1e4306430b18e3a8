//! The clock-by-clock RLS pipeline.

use super::config::RlsConfig;
use super::state::{RlsRegisters, RlsState};
use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::Pair;
use crate::fpga::memory::SinglePortRam;
use crate::fpga::probe::{NoProbe, PortView, Probe, Tick};

/// The RLS pipeline: memories, registers, and one clock at a time.
#[derive(Clone, Debug)]
pub struct RlsPipeline<F> {
    pub(super) config: RlsConfig<F>,
    pub(super) registers: RlsRegisters<F>,
    pub(super) rama: SinglePortRam<F>,
    pub(super) ramb: SinglePortRam<F>,
}

impl<F: Fp> RlsPipeline<F> {
    /// A pipeline just out of reset: memories `+0` but for `R = delta * I`.
    #[must_use]
    pub fn new(config: RlsConfig<F>) -> Self {
        let p = config.tap_count;
        let mut ramb = SinglePortRam::new("RAMB", 2 * p + p * p);
        for i in 0..p {
            ramb.preload(2 * p + i * p + i, config.delta);
        }
        Self {
            config,
            registers: RlsRegisters::reset(p),
            rama: SinglePortRam::new("RAMA", 2 * p),
            ramb,
        }
    }

    /// Back to the state after reset.
    pub fn reset(&mut self) {
        *self = Self::new(self.config);
    }

    /// The constants.
    #[must_use]
    pub fn config(&self) -> &RlsConfig<F> {
        &self.config
    }

    /// The registers between two clocks.
    #[must_use]
    pub fn registers(&self) -> &RlsRegisters<F> {
        &self.registers
    }

    /// RAMA: `0..p` ring of L, `p..2p` t, then M.
    #[must_use]
    pub fn rama(&self) -> &[F] {
        self.rama.words()
    }

    /// RAMB: `0..p` W, `p..2p` t, `2p + i*p + j` R, row by row.
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
    ///
    /// Each arm reads registers and memories first and assigns after, so every value read is
    /// the one before the edge.
    #[inline]
    pub fn tick_probed<Q: Probe<F>>(&mut self, input: Option<Pair<F>>, probe: &mut Q) -> Tick<F> {
        let state = self.registers.state;
        let accepted = state == RlsState::RiLLoading && input.is_some();
        let output = (state == RlsState::RfwReading && self.registers.phase == 0)
            .then_some(self.registers.output);
        if Q::WATCHES {
            self.show(input, accepted, output.is_some(), probe);
        }
        match state {
            RlsState::Idle => {
                if input.is_some() {
                    self.registers.state = RlsState::RiLLoading;
                }
            }
            RlsState::RiLLoading => self.load(input, probe),
            RlsState::RiLReading | RlsState::RfmReading => self.accumulate_row(probe),
            RlsState::LrlReading => self.accumulate_denominator(probe),
            RlsState::OutReading => self.accumulate_output(probe),
            RlsState::RiLWriting => self.write_intermediate(probe),
            RlsState::LrlWriting => self.write_denominator(probe),
            RlsState::RfrReading => self.correct_read(probe),
            RlsState::RfrWriting => self.correct_write(probe),
            RlsState::RfmWriting => self.write_gain(probe),
            RlsState::OutWriting => self.write_output(probe),
            RlsState::RfwReading => self.weight_read(probe),
            RlsState::RfwWriting => self.weight_write(input.is_some(), probe),
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
        while next < pairs.len() || self.registers.state != RlsState::Idle {
            let tick = self.tick_probed(pairs.get(next).copied(), probe);
            next += usize::from(tick.accepted);
            outputs.extend(tick.output);
        }
    }

    fn show<Q: Probe<F>>(
        &self,
        input: Option<Pair<F>>,
        accepted: bool,
        output_valid: bool,
        probe: &mut Q,
    ) {
        let ports = PortView {
            input_valid: input.is_some(),
            input_ready: accepted,
            input: input.map_or(F::ZERO, |pair| pair.input),
            desired: input.map_or(F::ZERO, |pair| pair.desired),
            output_valid,
        };
        probe.clock(&self.registers.view(), &ports);
    }
}
