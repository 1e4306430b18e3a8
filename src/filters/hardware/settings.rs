//! A floating-point pipeline with its front end: constants, checks, timing and the filter they stand for.

use super::filter::{HardwareFilter, PipelineFilter};
use super::timing::PipelineTiming;
use crate::filters::common::{FrontEndConfig, adaptive_rule, least_squares_rule};
use crate::fpga::FpgaError;
use crate::fpga::board::{CodeScale, Surroundings};
use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::FrontEnd;
use crate::fpga::health::Warning;
use crate::fpga::kinds::{CoreSettings, CoreVisitor, PipelineConfig};
use crate::fpga::pipeline::Core;
use crate::signal::FilterShape;
use crate::vocabulary::{DesiredSignal, NumberFormat, OutputRegister};

/// A hardware pipeline of floating-point words with its front end, before any check.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FloatSettings {
    /// The filter.
    pub core: CoreSettings,
    /// What the filter is asked to reproduce.
    pub desired: DesiredSignal,
    /// Samples by which the regressors lag the newest sample.
    pub input_lag_samples: usize,
    /// When the result appears.
    pub output_register: OutputRegister,
    /// Words.
    pub format: NumberFormat,
    /// Clock, MHz.
    pub clock_mhz: f64,
}

/// Runs `$body` with `$word` standing for the word type of a [`NumberFormat`].
macro_rules! with_word {
    ($format:expr, $word:ident => $body:expr) => {
        match $format {
            $crate::vocabulary::NumberFormat::Binary64 => {
                type $word = f64;
                $body
            }
            $crate::vocabulary::NumberFormat::Binary32 => {
                type $word = f32;
                $body
            }
            $crate::vocabulary::NumberFormat::Binary64FlushToZero => {
                type $word = $crate::fpga::float_unit::FlushToZero<f64>;
                $body
            }
            $crate::vocabulary::NumberFormat::Binary32FlushToZero => {
                type $word = $crate::fpga::float_unit::FlushToZero<f32>;
                $body
            }
        }
    };
}
pub(super) use with_word;

impl FloatSettings {
    /// Number of weights.
    #[must_use]
    pub fn tap_count(&self) -> usize {
        self.core.tap_count()
    }

    /// Rounds the constants to the word format, checks them and counts one sample's clocks.
    ///
    /// # Errors
    /// What the pipeline refuses: tap count, forgetting factor, initial inverse correlation, step
    /// or regularisation out of range in the word format.
    pub fn timing(&self) -> Result<PipelineTiming, FpgaError> {
        let (usage, board) = with_word!(self.format, F => {
            let constants = self.constants::<F>()?;
            let around = self.surroundings(&constants, Some(CodeScale::unity()));
            let pipeline = constants.as_pipeline();
            (pipeline.clocked().usage(), pipeline.clocked().board_usage(around))
        });
        Ok(PipelineTiming::of(usage, board, self.clock_mhz))
    }

    /// Warns if the first updates cost the words their digits, for inputs up to `input_max`.
    #[must_use]
    pub fn digits_warning(&self, input_max: f64) -> Option<Warning> {
        with_word!(self.format, F => self.core.digits_warning::<F>(input_max))
    }

    /// Samples after which theory expects the gain-first order to fail; none for the others.
    #[must_use]
    pub fn failure_samples(&self) -> Option<f64> {
        with_word!(self.format, F => self.core.failure_samples::<F>())
    }

    /// The filter in front of the bench, bit for bit the hardware's.
    ///
    /// * `warm_up_samples`: samples before the record; health is summed up from there on.
    ///
    /// # Errors
    /// As [`Self::timing`].
    pub fn filter(&self, warm_up_samples: u64) -> Result<Box<dyn HardwareFilter>, FpgaError> {
        self.core.visit(FilterBuilder {
            settings: self,
            warm_up_samples,
        })
    }

    /// The constants in the word format.
    pub(super) fn constants<F: Fp>(&self) -> Result<PipelineConfig<F>, FpgaError> {
        self.core.config()
    }

    /// The hold registers in front of the core.
    pub(super) fn front_end<F: Fp>(&self) -> FrontEnd<F> {
        FrontEnd::new(self.desired, self.input_lag_samples)
    }

    /// What stands around the core on a board.
    ///
    /// * `scale`: how samples come as integer codes; none: they come as words.
    pub(super) fn surroundings<F: Fp>(
        &self,
        pipeline: &PipelineConfig<F>,
        scale: Option<CodeScale>,
    ) -> Surroundings {
        let desired = if pipeline.as_pipeline().forms_desired() {
            DesiredSignal::Current
        } else {
            self.desired
        };
        Surroundings {
            desired,
            input_lag_samples: self.input_lag_samples,
            output_register: self.output_register,
            scale,
        }
    }

    /// Regressors, desired signal and register in the terms of the bench.
    pub(super) fn shape(&self) -> FilterShape {
        let front_end = FrontEndConfig {
            desired: self.desired,
            input_lag_samples: self.input_lag_samples,
            output_register: self.output_register,
        };
        let rule = match self.core.forgetting_factor() {
            Some(factor) => least_squares_rule(self.desired, factor),
            None => adaptive_rule(self.desired),
        };
        front_end.shape(Some(self.tap_count()), rule)
    }
}

/// Puts the engine of any kind behind its front end.
struct FilterBuilder<'a> {
    settings: &'a FloatSettings,
    warm_up_samples: u64,
}

impl CoreVisitor for FilterBuilder<'_> {
    type Outcome = Result<Box<dyn HardwareFilter>, FpgaError>;

    fn visit<C: Core>(self, core: &C) -> Self::Outcome {
        with_word!(self.settings.format, F => {
            let engine = core.engine::<F>()?;
            Ok(Box::new(PipelineFilter::new(self.settings, engine, self.warm_up_samples)))
        })
    }
}
