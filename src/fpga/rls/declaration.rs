//! What exports, timing and the bench must know of the RLS pipeline.

use super::clocks::{RlsLoad, rls_clocks_per_sample, rls_latency_clocks, rls_stalled_clocks};
use super::config::{RlsConfig, RlsSettings};
use super::engine::RlsEngine;
use super::machine::RlsPipeline;
use super::state::RlsState;
use crate::fpga::error::FpgaError;
use crate::fpga::float_unit::Fp;
use crate::fpga::health::{Warning, gain_first_failure_samples, initial_digits_warning};
use crate::fpga::pipeline::{Clocked, Core, Kind, Macro, Parameters, Pipeline};
use crate::fpga::registers::ControlState;
use crate::fpga::timing::Units;
use crate::vocabulary::{Division, UpdateOrder, UpdateSign};

const RLS: Kind = Kind {
    name: "rls",
    tap_parameter: "P",
    states: RlsState::NAMES,
    sources: [
        ("rls_ctrl.v", include_str!("../export/rtl/rls_ctrl.v")),
        ("rls_core.v", include_str!("../export/rtl/rls_core.v")),
        ("tb_rls.v", include_str!("../export/rtl/tb_rls.v")),
    ],
    fixed_choices: &[
        ("alpha_first", "true"),
        ("update_order", "\"(t_i * t_j) first\""),
        ("gain", "\"R L with the updated R\""),
    ],
    has_matrix: true,
};

/// Settings of recursive least squares and the order of its update, of which only
/// [`UpdateOrder::Schedule`] has hardware.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RlsCore {
    /// Constants.
    pub settings: RlsSettings,
    /// Order of the two products in the correction of R.
    pub order: UpdateOrder,
}

impl RlsCore {
    /// What has to be computed per sample.
    #[must_use]
    pub fn load(&self) -> RlsLoad {
        RlsLoad {
            tap_count: self.settings.tap_count,
            division: self.settings.division,
            forgets: self.settings.forgetting_factor < 1.0,
        }
    }
}

impl Core for RlsCore {
    type Config<F: Fp> = RlsConfig<F>;
    type Engine<F: Fp> = RlsEngine<F>;

    const KIND: &'static Kind = &RLS;

    fn tap_count(&self) -> usize {
        self.settings.tap_count
    }

    fn forgetting_factor(&self) -> Option<f64> {
        Some(self.settings.forgetting_factor)
    }

    fn config<F: Fp>(&self) -> Result<RlsConfig<F>, FpgaError> {
        RlsConfig::new(self.settings)
    }

    fn engine<F: Fp>(&self) -> Result<RlsEngine<F>, FpgaError> {
        Ok(RlsEngine::with_order(self.config()?, self.order))
    }

    fn config_with<F: Fp>(&self, units: Units) -> Result<RlsConfig<F>, FpgaError> {
        self.config()?.with_units(units)
    }

    fn stalled_clocks(&self, units: Units) -> Result<u64, FpgaError> {
        rls_stalled_clocks(self.load(), units)
    }

    fn has_hardware(&self) -> bool {
        self.order == UpdateOrder::Schedule
    }

    fn digits_warning<F: Fp>(&self, input_max: f64) -> Option<Warning> {
        let delta = self.settings.initial_inverse_correlation;
        initial_digits_warning::<F>(delta, self.settings.tap_count, input_max)
    }

    fn failure_samples<F: Fp>(&self) -> Option<f64> {
        match self.order {
            UpdateOrder::Schedule => None,
            UpdateOrder::GainFirst => {
                gain_first_failure_samples::<F>(self.settings.forgetting_factor)
            }
        }
    }
}

impl<F: Fp> Pipeline<F> for RlsConfig<F> {
    fn kind(&self) -> &'static Kind {
        &RLS
    }

    fn tap_count(&self) -> usize {
        self.tap_count
    }

    fn clocks_per_sample(&self) -> usize {
        rls_clocks_per_sample(self.tap_count)
    }

    fn latency_clocks(&self) -> usize {
        rls_latency_clocks(self.tap_count)
    }

    fn units(&self) -> Units {
        self.units
    }

    fn update_sign(&self) -> UpdateSign {
        self.update_sign
    }

    fn parameters(&self) -> Parameters<F> {
        let divides_elements = self.division == Division::Elementwise;
        Parameters {
            macros: vec![
                ("ALPHA", Macro::Word(self.alpha)),
                ("IALPHA", Macro::Word(self.inverse_alpha)),
                ("DELTA", Macro::Word(self.delta)),
                ("DIV_ELEM", Macro::Flag(divides_elements)),
            ],
            choices: vec![
                ("p", self.tap_count),
                ("elem", usize::from(divides_elements)),
            ],
            constants: vec![
                ("alpha", self.alpha),
                ("ialpha", self.inverse_alpha),
                ("delta", self.delta),
            ],
        }
    }

    fn clocked(&self) -> Box<dyn Clocked<F>> {
        Box::new(RlsPipeline::new(*self))
    }
}
