//! What exports, timing and the bench must know of recursive least squares in fixed point.

use super::clocks::{fixed_rls_stalled_clocks, fixed_rls_stalled_latency};
use super::config::FixedRlsConfig;
use super::engine::FixedRlsEngine;
use super::machine::{FixedRlsPipeline, FixedRlsState};
use crate::fpga::fixed::pipeline::{FixedEngine, FixedKind, FixedParameters, FixedPipeline};
use crate::fpga::fixed::sequencer::FixedClocked;
use crate::fpga::fixed::signal::Signal;
use crate::fpga::fixed::taps::TapFormats;
use crate::fpga::registers::ControlState as _;
use crate::fpga::timing::Units;

/// Recursive least squares.
pub const RLS_FIXED: FixedKind = FixedKind {
    name: "rls_fixed",
    tap_parameter: "P",
    states: FixedRlsState::NAMES,
    sources: &[(
        "rls_fixed_core.v",
        include_str!("../../export/rtl/rls_fixed_core.v"),
    )],
    control: "dut",
    memories: "RAMA 2p words (ring of L, k), then RAMB 2p+p*p words (W, t, R row by row)",
    has_gain_registers: false,
    has_matrix: true,
};

/// A count of clocks as large as an address; latencies end far below.
fn clocks(count: u64) -> usize {
    usize::try_from(count).unwrap_or(usize::MAX)
}

impl FixedPipeline for FixedRlsConfig {
    fn kind(&self) -> &'static FixedKind {
        &RLS_FIXED
    }

    fn tap_count(&self) -> usize {
        self.tap_count
    }

    fn signals(&self) -> Vec<Signal> {
        self.formats.signals().to_vec()
    }

    fn tap_formats(&self) -> TapFormats {
        self.formats.of_taps()
    }

    fn memory_bits(&self) -> [u32; 2] {
        [self.widest(); 2]
    }

    fn clocks_per_sample(&self) -> usize {
        clocks(self.stalled_clocks(self.units))
    }

    fn latency_clocks(&self) -> usize {
        let forgets = self.inverse_alpha.is_some();
        clocks(fixed_rls_stalled_latency(
            self.tap_count,
            forgets,
            self.units,
        ))
    }

    fn divisions(&self) -> usize {
        self.tap_count
    }

    fn units(&self) -> Units {
        self.units
    }

    fn splits(&self) -> bool {
        Self::splits(self)
    }

    fn stalled_clocks(&self, units: Units) -> u64 {
        fixed_rls_stalled_clocks(self.tap_count, self.inverse_alpha.is_some(), units)
    }

    fn parameters(&self) -> FixedParameters {
        let (factor, factor_bits) = self.inverse_alpha().unwrap_or((0, 0));
        let or_null = |text: String| match self.inverse_alpha {
            Some(_) => text,
            None => "null".to_owned(),
        };
        FixedParameters {
            core: vec![
                ("MW", self.widest().to_string()),
                ("ALPHA", format!("128'sh{:032x}", self.alpha)),
                ("SCALES", u8::from(self.inverse_alpha.is_some()).to_string()),
                ("IALPHA", format!("64'sh{factor:016x}")),
                ("NI", factor_bits.to_string()),
                ("DELTA", format!("64'sh{:016x}", self.delta)),
                ("FLOOR", format!("64'sh{:016x}", self.floor)),
            ],
            constants: vec![
                ("alpha_code", self.alpha.to_string()),
                (
                    "alpha_fraction_bits",
                    self.alpha_fraction_bits().to_string(),
                ),
                ("inverse_alpha_code", or_null(factor.to_string())),
                (
                    "inverse_alpha_fraction_bits",
                    or_null(factor_bits.to_string()),
                ),
                ("delta_code", self.delta.to_string()),
                ("floor_code", self.floor.to_string()),
            ],
        }
    }

    fn clocked(&self) -> Box<dyn FixedClocked> {
        Box::new(FixedRlsPipeline::new(*self))
    }

    fn engine(&self) -> Box<dyn FixedEngine + Send> {
        Box::new(FixedRlsEngine::new(*self))
    }
}
