//! What exports, timing and the bench must know of the line enhancer.

use super::clocks::{sign_lms_clocks_per_sample, sign_lms_latency_clocks, sign_lms_stalled_clocks};
use super::config::{SignLmsConfig, SignLmsSettings};
use super::engine::SignLmsEngine;
use super::machine::SignLmsPipeline;
use super::state::SignLmsState;
use crate::fpga::error::FpgaError;
use crate::fpga::float_unit::Fp;
use crate::fpga::pipeline::{Clocked, Core, Kind, Macro, Parameters, Pipeline};
use crate::fpga::registers::ControlState;
use crate::fpga::timing::Units;

const SIGN_LMS: Kind = Kind {
    name: "sign_lms",
    tap_parameter: "M",
    states: SignLmsState::NAMES,
    sources: [
        (
            "sign_lms_ctrl.v",
            include_str!("../export/rtl/sign_lms_ctrl.v"),
        ),
        (
            "sign_lms_core.v",
            include_str!("../export/rtl/sign_lms_core.v"),
        ),
        ("tb_sign_lms.v", include_str!("../export/rtl/tb_sign_lms.v")),
    ],
    fixed_choices: &[],
    has_matrix: false,
};

impl Core for SignLmsSettings {
    type Config<F: Fp> = SignLmsConfig<F>;
    type Engine<F: Fp> = SignLmsEngine<F>;

    const KIND: &'static Kind = &SIGN_LMS;

    fn tap_count(&self) -> usize {
        self.tap_count
    }

    fn config<F: Fp>(&self) -> Result<SignLmsConfig<F>, FpgaError> {
        SignLmsConfig::new(*self)
    }

    fn engine<F: Fp>(&self) -> Result<SignLmsEngine<F>, FpgaError> {
        Ok(SignLmsEngine::new(self.config()?))
    }

    fn stalled_clocks(&self, units: Units) -> Result<u64, FpgaError> {
        sign_lms_stalled_clocks(self.tap_count, self.normalised, units)
    }
}

impl<F: Fp> Pipeline<F> for SignLmsConfig<F> {
    fn kind(&self) -> &'static Kind {
        &SIGN_LMS
    }

    fn tap_count(&self) -> usize {
        self.tap_count
    }

    fn clocks_per_sample(&self) -> usize {
        sign_lms_clocks_per_sample(self.tap_count)
    }

    fn latency_clocks(&self) -> usize {
        sign_lms_latency_clocks(self.tap_count)
    }

    fn parameters(&self) -> Parameters<F> {
        let guard = self.guard.unwrap_or(F::ZERO);
        let recompute = self.norm_recompute_samples as usize;
        Parameters {
            macros: vec![
                ("MU", Macro::Word(self.step)),
                ("ALPHA", Macro::Word(self.regularisation)),
                ("W0", Macro::Word(self.initial_weight)),
                ("GUARD", Macro::Word(guard)),
                ("GUARDED", Macro::Flag(self.guard.is_some())),
                ("HOLD", Macro::Count(self.hold_samples)),
                ("NLMS", Macro::Flag(self.normalised)),
                ("RECOMPUTE", Macro::Count(recompute)),
            ],
            choices: vec![
                ("m", self.tap_count),
                ("normalised", usize::from(self.normalised)),
                ("guarded", usize::from(self.guard.is_some())),
                ("guard_hold_samples", self.hold_samples),
                ("norm_recompute_samples", recompute),
            ],
            constants: vec![
                ("mu", self.step),
                ("alpha", self.regularisation),
                ("w0", self.initial_weight),
                ("guard", guard),
            ],
        }
    }

    fn clocked(&self) -> Box<dyn Clocked<F>> {
        Box::new(SignLmsPipeline::new(*self))
    }
}
