//! Clocks per state and port use, counted on the running model.

use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::Pair;
use crate::fpga::machine::{Machine, Sequencer};
use crate::fpga::probe::{PortView, Probe, RegisterView};
use crate::fpga::registers::ControlState;

/// Clocks spent in one state per sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct StateClocks {
    /// State name.
    pub state: &'static str,
    /// Clocks per sample.
    pub clocks: u64,
}

/// What one back-to-back sample uses, as counted.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
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
    fn wait(&mut self, state: u8, output_valid: bool) {
        if output_valid {
            self.finished.push(self.clock);
        }
        if self.counts() {
            self.states[usize::from(state)] += 1;
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

/// Counts one back-to-back sample of a pipeline just out of reset: the second of three.
///
/// A line enhancer is counted in a sample in which its norm is not replaced.
#[must_use]
pub fn measure<M: Machine>(mut pipeline: Sequencer<M>) -> Usage {
    let mut counter = Counter::default();
    let pair = Pair {
        input: M::Word::ONE,
        desired: M::Word::ONE,
    };
    while counter.accepted.len() < 3 {
        pipeline.tick_probed(Some(pair), &mut counter);
    }
    Usage {
        clocks_per_sample: counter.accepted[2] - counter.accepted[1],
        latency_clocks: counter.finished[1] - counter.accepted[1],
        wake_up_clocks: counter.accepted[0],
        states: M::State::NAMES
            .iter()
            .zip(counter.states)
            .map(|(state, clocks)| StateClocks { state, clocks })
            .collect(),
        rama_accesses: counter.rama,
        ramb_accesses: counter.ramb,
        multiplies: counter.multiplies,
        additions: counter.additions,
        divisions: counter.divisions,
    }
}
