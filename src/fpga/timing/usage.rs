//! Clocks per state and port use, counted on the running model.

use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::Pair;
use crate::fpga::lms::{LmsConfig, LmsPipeline, LmsState};
use crate::fpga::probe::{PortView, Probe, RegisterView, Tick};
use crate::fpga::registers::ControlState;
use crate::fpga::rls::{RlsConfig, RlsPipeline, RlsState};
use crate::fpga::sign_lms::{SignLmsConfig, SignLmsPipeline, SignLmsState};

/// Clocks spent in one state per sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateClocks {
    /// State name.
    pub state: &'static str,
    /// Clocks per sample.
    pub clocks: u64,
}

/// What one back-to-back sample uses, as counted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Usage {
    /// Clocks from one accepted sample to the next.
    pub clocks_per_sample: u64,
    /// Clocks from accepting a sample until its result can be read.
    pub latency_clocks: u64,
    /// Extra clocks when the machine was idle before.
    pub wake_up_clocks: u64,
    /// Clocks per state, in the order of the state codes.
    pub states: Vec<StateClocks>,
    /// Clocks in which RAMA's port is used.
    pub rama_accesses: u64,
    /// Clocks in which RAMB's port is used.
    pub ramb_accesses: u64,
    /// Clocks in which the multiplier is used.
    pub multiplies: u64,
    /// Clocks in which the adder is used.
    pub additions: u64,
    /// Clocks in which the divider is used.
    pub divisions: u64,
}

#[derive(Default)]
struct Counter {
    clock: u64,
    accepted: Vec<u64>,
    finished: Vec<u64>,
    states: [u64; 16],
    rama: u64,
    ramb: u64,
    multiplies: u64,
    additions: u64,
    divisions: u64,
}

impl Counter {
    /// Only the second sample is counted: the first one wakes the machine up.
    fn counts(&self) -> bool {
        self.accepted.len() == 2
    }
}

impl<F: Fp> Probe<F> for Counter {
    fn clock(&mut self, registers: &RegisterView<F>, ports: &PortView<F>) {
        if ports.input_ready {
            self.accepted.push(self.clock);
        }
        if ports.output_valid {
            self.finished.push(self.clock);
        }
        if self.counts() {
            self.states[usize::from(registers.state)] += 1;
        }
        self.clock += 1;
    }
    fn rama(&mut self, _address: usize, _write: Option<F>, _read: F) {
        self.rama += u64::from(self.counts());
    }
    fn ramb(&mut self, _address: usize, _write: Option<F>, _read: F) {
        self.ramb += u64::from(self.counts());
    }
    fn multiply(&mut self, _a: F, _b: F, _q: F) {
        self.multiplies += u64::from(self.counts());
    }
    fn add(&mut self, _a: F, _b: F, _subtract: bool, _q: F) {
        self.additions += u64::from(self.counts());
    }
    fn divide(&mut self, _a: F, _b: F, _q: F) {
        self.divisions += u64::from(self.counts());
    }
}

impl Counter {
    /// Feeds three back-to-back samples and counts the second.
    fn run<F: Fp>(
        mut self,
        names: &[&'static str],
        mut tick: impl FnMut(Pair<F>, &mut Self) -> Tick<F>,
    ) -> Usage {
        let pair = Pair {
            input: F::ONE,
            desired: F::ONE,
        };
        while self.accepted.len() < 3 {
            tick(pair, &mut self);
        }
        Usage {
            clocks_per_sample: self.accepted[2] - self.accepted[1],
            latency_clocks: self.finished[1] - self.accepted[1],
            wake_up_clocks: self.accepted[0],
            states: names
                .iter()
                .zip(self.states)
                .map(|(state, clocks)| StateClocks { state, clocks })
                .collect(),
            rama_accesses: self.rama,
            ramb_accesses: self.ramb,
            multiplies: self.multiplies,
            additions: self.additions,
            divisions: self.divisions,
        }
    }
}

/// Counts one back-to-back sample of the RLS pipeline.
#[must_use]
pub fn measure_rls<F: Fp>(config: RlsConfig<F>) -> Usage {
    let mut pipeline = RlsPipeline::new(config);
    Counter::default().run(RlsState::NAMES, |pair, counter| {
        pipeline.tick_probed(Some(pair), counter)
    })
}

/// Counts one back-to-back sample of the LMS pipeline.
#[must_use]
pub fn measure_lms<F: Fp>(config: LmsConfig<F>) -> Usage {
    let mut pipeline = LmsPipeline::new(config);
    Counter::default().run(LmsState::NAMES, |pair, counter| {
        pipeline.tick_probed(Some(pair), counter)
    })
}

/// Counts one back-to-back sample of the line enhancer, one in which the norm is not replaced.
#[must_use]
pub fn measure_sign_lms<F: Fp>(config: SignLmsConfig<F>) -> Usage {
    let mut pipeline = SignLmsPipeline::new(config);
    Counter::default().run(SignLmsState::NAMES, |pair, counter| {
        pipeline.tick_probed(Some(pair), counter)
    })
}
