//! What exports, timing and the bench must know of LMS and NLMS in fixed point.

use super::config::{FixedLmsConfig, Step};
use super::engine::FixedLmsEngine;
use super::machine::FixedLmsPipeline;
use crate::fpga::fixed::pipeline::{FixedEngine, FixedKind, FixedParameters, FixedPipeline};
use crate::fpga::fixed::sequencer::FixedClocked;
use crate::fpga::fixed::signal::Signal;
use crate::fpga::fixed::taps::TapFormats;
use crate::fpga::lms::{LmsState, lms_clocks_per_sample, lms_latency_clocks};
use crate::fpga::registers::ControlState as _;

/// Least mean squares, normalised or not.
pub const LMS_FIXED: FixedKind = FixedKind {
    name: "lms_fixed",
    tap_parameter: "N",
    states: LmsState::NAMES,
    sources: &[
        ("lms_ctrl.v", include_str!("../../export/rtl/lms_ctrl.v")),
        (
            "lms_fixed_core.v",
            include_str!("../../export/rtl/lms_fixed_core.v"),
        ),
    ],
    control: "dut.ctrl",
    memories: "RAMA N words (ring of L), then RAMB N words (W)",
    has_gain_registers: true,
    has_matrix: false,
};

impl FixedPipeline for FixedLmsConfig {
    fn kind(&self) -> &'static FixedKind {
        &LMS_FIXED
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
        [self.formats.input.width(), self.formats.weight.width()]
    }

    fn clocks_per_sample(&self) -> usize {
        lms_clocks_per_sample(self.tap_count, self.is_normalised())
    }

    fn latency_clocks(&self) -> usize {
        lms_latency_clocks(self.tap_count, self.is_normalised())
    }

    fn divisions(&self) -> usize {
        usize::from(self.is_normalised())
    }

    fn parameters(&self) -> FixedParameters {
        let (code, fraction_bits) = match self.step {
            Step::Given(code) => (code, self.formats.gain.fraction_bits),
            Step::OverEnergy(step) => (step.code, step.fraction_bits),
        };
        let regularisation = self.regularisation();
        let normalised = u8::from(self.is_normalised());
        FixedParameters {
            core: vec![
                ("MU", format!("64'sh{code:016x}")),
                ("NM", fraction_bits.to_string()),
                ("EPS", format!("128'sh{regularisation:032x}")),
                ("NLMS", normalised.to_string()),
            ],
            constants: vec![
                ("normalised", normalised.to_string()),
                ("mu_code", code.to_string()),
                ("mu_fraction_bits", fraction_bits.to_string()),
                ("eps_code", regularisation.to_string()),
                (
                    "eps_fraction_bits",
                    (2 * self.formats.input.fraction_bits).to_string(),
                ),
            ],
        }
    }

    fn clocked(&self) -> Box<dyn FixedClocked> {
        Box::new(FixedLmsPipeline::new(*self))
    }

    fn engine(&self) -> Box<dyn FixedEngine + Send> {
        Box::new(FixedLmsEngine::new(*self))
    }
}
