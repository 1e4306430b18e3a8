//! What exports, timing and the bench must know of the line enhancer in fixed point.

use super::config::FixedSignLmsConfig;
use super::engine::FixedSignLmsEngine;
use super::machine::FixedSignLmsPipeline;
use crate::fpga::fixed::pipeline::{FixedEngine, FixedKind, FixedParameters, FixedPipeline};
use crate::fpga::fixed::sequencer::FixedClocked;
use crate::fpga::fixed::signal::Signal;
use crate::fpga::fixed::taps::TapFormats;
use crate::fpga::registers::ControlState as _;
use crate::fpga::sign_lms::{SignLmsState, sign_lms_clocks_per_sample, sign_lms_latency_clocks};

/// Line enhancer, by the sign of the error or normalised.
pub const SIGN_LMS_FIXED: FixedKind = FixedKind {
    name: "sign_lms_fixed",
    tap_parameter: "M",
    states: SignLmsState::NAMES,
    sources: &[
        (
            "sign_lms_ctrl.v",
            include_str!("../../export/rtl/sign_lms_ctrl.v"),
        ),
        (
            "sign_lms_fixed_core.v",
            include_str!("../../export/rtl/sign_lms_fixed_core.v"),
        ),
    ],
    control: "dut.ctrl",
    memories: "RAMA M words (ring of L), then RAMB M words (W)",
    has_gain_registers: true,
    has_matrix: false,
};

impl FixedPipeline for FixedSignLmsConfig {
    fn kind(&self) -> &'static FixedKind {
        &SIGN_LMS_FIXED
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
        sign_lms_clocks_per_sample(self.tap_count)
    }

    fn latency_clocks(&self) -> usize {
        sign_lms_latency_clocks(self.tap_count)
    }

    fn divisions(&self) -> usize {
        1
    }

    fn parameters(&self) -> FixedParameters {
        let step = &self.step;
        let guard = self.guard.unwrap_or(0);
        FixedParameters {
            core: vec![
                ("MU", format!("64'sh{:016x}", step.code)),
                ("NM", step.fraction_bits.to_string()),
                ("ALPHA", format!("128'sh{:032x}", step.regularisation)),
                ("NLMS", u8::from(self.normalised).to_string()),
                ("W0", format!("64'sh{:016x}", self.initial_weight)),
                ("GUARDED", u8::from(self.guard.is_some()).to_string()),
                ("GUARD", format!("64'sh{guard:016x}")),
                ("HOLD", self.hold_samples.to_string()),
            ],
            constants: vec![
                ("normalised", u8::from(self.normalised).to_string()),
                ("mu_code", step.code.to_string()),
                ("mu_fraction_bits", step.fraction_bits.to_string()),
                ("alpha_code", step.regularisation.to_string()),
                (
                    "alpha_fraction_bits",
                    (2 * self.formats.input.fraction_bits).to_string(),
                ),
                ("initial_weight_code", self.initial_weight.to_string()),
                (
                    "guard_code",
                    self.guard
                        .map_or_else(|| "null".to_owned(), |code| code.to_string()),
                ),
                ("hold_samples", self.hold_samples.to_string()),
            ],
        }
    }

    fn clocked(&self) -> Box<dyn FixedClocked> {
        Box::new(FixedSignLmsPipeline::new(*self))
    }

    fn engine(&self) -> Box<dyn FixedEngine + Send> {
        Box::new(FixedSignLmsEngine::new(*self))
    }
}
