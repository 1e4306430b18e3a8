//! Clocks, ports and units of a sample, counted on the running pipeline.

use super::CodePair;
use super::pipeline::FixedPipeline;
use crate::fpga::timing::{StateClocks, Usage};

/// Counts one back-to-back sample of a pipeline just out of reset: the second of three.
#[must_use]
pub fn fixed_usage(declared: &dyn FixedPipeline) -> Usage {
    let mut pipeline = declared.clocked();
    let names = declared.kind().states;
    let pair = CodePair {
        input: 1,
        desired: 1,
    };
    let (mut clock, mut accepted, mut finished) = (0, Vec::new(), Vec::new());
    let mut states = vec![0; names.len()];
    let [mut rama, mut ramb, mut products, mut sums, mut quotients] = [0; 5];
    while accepted.len() < 3 {
        let tick = pipeline.tick(Some(pair));
        if tick.accepted {
            accepted.push(clock);
        }
        if tick.output.is_some() {
            finished.push(clock);
        }
        // The first sample wakes the machine up.
        if accepted.len() == 2 {
            states[usize::from(tick.registers.state)] += 1;
            rama += u64::from(tick.rama.is_used);
            ramb += u64::from(tick.ramb.is_used);
            products += u64::from(tick.units.products);
            sums += u64::from(tick.units.sums);
            quotients += u64::from(tick.units.quotients);
        }
        clock += 1;
    }
    let states = names.iter().zip(states);
    Usage {
        clocks_per_sample: accepted[2] - accepted[1],
        latency_clocks: finished[1] - accepted[1],
        wake_up_clocks: accepted[0],
        states: states
            .map(|(state, clocks)| StateClocks { state, clocks })
            .collect(),
        rama_accesses: rama,
        ramb_accesses: ramb,
        multiplies: products,
        additions: sums,
        divisions: quotients,
    }
}

/// Counts the clocks in which a reset clears the memories.
#[must_use]
pub fn fixed_clearing_clocks(declared: &dyn FixedPipeline) -> u64 {
    let mut pipeline = declared.clocked();
    pipeline.reset();
    let mut clocks = 0;
    while !pipeline.is_idle() {
        pipeline.tick(None);
        clocks += 1;
    }
    clocks
}
