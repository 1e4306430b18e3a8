//! What exports, timing and the bench must know of the LMS and NLMS pipeline.

use super::clocks::{lms_clocks_per_sample, lms_latency_clocks, lms_stalled_clocks};
use super::config::{DesiredSource, LmsConfig, LmsSettings};
use super::engine::LmsEngine;
use super::machine::LmsPipeline;
use super::state::LmsState;
use crate::fpga::error::FpgaError;
use crate::fpga::float_unit::Fp;
use crate::fpga::pipeline::{Clocked, Core, Kind, Macro, Parameters, Pipeline};
use crate::fpga::registers::ControlState;
use crate::fpga::timing::Units;
use crate::vocabulary::UpdateSign;

const LMS: Kind = Kind {
    name: "lms",
    tap_parameter: "N",
    states: LmsState::NAMES,
    sources: [
        ("lms_ctrl.v", include_str!("../export/rtl/lms_ctrl.v")),
        ("lms_core.v", include_str!("../export/rtl/lms_core.v")),
        ("tb_lms.v", include_str!("../export/rtl/tb_lms.v")),
    ],
    fixed_choices: &[],
    has_matrix: false,
};

impl Core for LmsSettings {
    type Config<F: Fp> = LmsConfig<F>;
    type Engine<F: Fp> = LmsEngine<F>;

    const KIND: &'static Kind = &LMS;

    fn tap_count(&self) -> usize {
        self.tap_count
    }

    fn config<F: Fp>(&self) -> Result<LmsConfig<F>, FpgaError> {
        LmsConfig::new(*self)
    }

    fn engine<F: Fp>(&self) -> Result<LmsEngine<F>, FpgaError> {
        Ok(LmsEngine::new(self.config()?))
    }

    fn stalled_clocks(&self, units: Units) -> Result<u64, FpgaError> {
        lms_stalled_clocks(self.tap_count, self.regularisation.is_some(), units)
    }
}

impl<F: Fp> Pipeline<F> for LmsConfig<F> {
    fn kind(&self) -> &'static Kind {
        &LMS
    }

    fn tap_count(&self) -> usize {
        self.tap_count
    }

    fn clocks_per_sample(&self) -> usize {
        lms_clocks_per_sample(self.tap_count, self.is_normalised())
    }

    fn latency_clocks(&self) -> usize {
        lms_latency_clocks(self.tap_count, self.is_normalised())
    }

    fn update_sign(&self) -> UpdateSign {
        self.update_sign
    }

    fn forms_desired(&self) -> bool {
        self.desired == DesiredSource::MeanOfTwoNewest
    }

    fn parameters(&self) -> Parameters<F> {
        let regularisation = self.regularisation.unwrap_or(F::ZERO);
        let forms_mean = self.desired == DesiredSource::MeanOfTwoNewest;
        Parameters {
            macros: vec![
                ("MU", Macro::Word(self.step_size)),
                ("EPS", Macro::Word(regularisation)),
                ("NLMS", Macro::Flag(self.is_normalised())),
                ("D_PORT", Macro::Flag(!forms_mean)),
            ],
            choices: vec![
                ("n", self.tap_count),
                ("normalised", usize::from(self.is_normalised())),
                ("mean", usize::from(forms_mean)),
            ],
            constants: vec![
                ("half", self.half),
                ("mu", self.step_size),
                ("eps", regularisation),
            ],
        }
    }

    fn clocked(&self) -> Box<dyn Clocked<F>> {
        Box::new(LmsPipeline::new(*self))
    }
}
