//! From a filter of a scenario to the constants of its hardware pipeline.

use super::line_enhancer;
use super::pipeline_filter::{HardwareFilter, PipelineFilter};
use crate::filters::{FrontEndConfig, adaptive_rule};
use crate::fpga::FpgaError;
use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::FrontEnd;
use crate::fpga::health::Warning;
use crate::fpga::kinds::{CoreSettings, CoreVisitor, PipelineConfig};
use crate::fpga::lms::{DesiredSource, LmsSettings};
use crate::fpga::pipeline::Core;
use crate::fpga::rls::{RlsCore, RlsSettings};
use crate::fpga::sign_lms::SignLmsSettings;
use crate::fpga::timing::{Usage, sample_period_us, sample_rate_max_khz};
use crate::scenario::{FilterKind, LmsFilterConfig, RlsFilterConfig, SignLmsFilterConfig};
use crate::signal::FilterShape;
use crate::vocabulary::{DesiredSignal, NumberFormat, OutputRegister, Pipeline, SignLmsForm};

/// A hardware pipeline with its front end, before any check.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PipelineSettings {
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

/// What one sample costs, counted on the running model.
#[derive(Clone, Debug, PartialEq)]
pub struct PipelineTiming {
    /// Clocks, states, ports and units of one back-to-back sample.
    pub usage: Usage,
    /// Time of all clocks of a sample, us.
    pub sample_period_us: f64,
    /// From the accepting clock to the result, us.
    pub latency_us: f64,
    /// `1 / sample_period_us`, kHz.
    pub sample_rate_max_khz: f64,
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

impl PipelineSettings {
    /// The hardware of a filter of a scenario; none if its arithmetic is the textbook's.
    #[must_use]
    pub fn of(kind: &FilterKind) -> Option<Self> {
        match kind {
            FilterKind::Rls(config) if config.pipeline == Pipeline::Fpga => Some(rls(config)),
            FilterKind::Lms(config) if config.pipeline == Pipeline::Fpga => Some(lms(config)),
            FilterKind::SignLms(config) if config.pipeline == Pipeline::Fpga => {
                Some(sign_lms(config))
            }
            _ => None,
        }
    }

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
        let usage = with_word!(self.format, F => {
            self.constants::<F>()?.as_pipeline().clocked().usage()
        });
        let clock_mhz = self.clock_mhz;
        Ok(PipelineTiming {
            sample_period_us: sample_period_us(usage.clocks_per_sample, clock_mhz),
            latency_us: sample_period_us(usage.latency_clocks, clock_mhz),
            sample_rate_max_khz: sample_rate_max_khz(usage.clocks_per_sample, clock_mhz),
            usage,
        })
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

    /// Regressors, aim and register in the terms of the bench.
    pub(super) fn shape(&self) -> FilterShape {
        let front_end = FrontEndConfig {
            desired: self.desired,
            input_lag_samples: self.input_lag_samples,
            output_register: self.output_register,
        };
        front_end.shape(Some(self.tap_count()), adaptive_rule(self.desired))
    }
}

/// Puts the engine of any kind behind its front end.
struct FilterBuilder<'a> {
    settings: &'a PipelineSettings,
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

fn rls(config: &RlsFilterConfig) -> PipelineSettings {
    let settings = RlsSettings {
        tap_count: config.taps as usize,
        forgetting_factor: config.forgetting_factor,
        initial_inverse_correlation: config.initial_inverse_correlation,
        division: config.division,
        update_sign: config.update_sign,
    };
    PipelineSettings {
        core: CoreSettings::Rls(RlsCore {
            settings,
            order: config.update_order,
        }),
        desired: config.desired,
        input_lag_samples: config.input_lag_samples as usize,
        output_register: config.output_register,
        format: config.number_format,
        clock_mhz: config.clock_mhz,
    }
}

fn lms(config: &LmsFilterConfig) -> PipelineSettings {
    let desired = config.desired;
    let input_lag_samples = config.input_lag_samples as usize;
    let settings = LmsSettings {
        tap_count: config.taps as usize,
        step_size: config.step_size,
        regularisation: config
            .normalised
            .then_some(config.regularisation_deg2_per_h2),
        // The core forms the mean of the two words it holds; behind a lag they are not the newest.
        desired: match input_lag_samples {
            0 => DesiredSource::of(desired),
            _ => DesiredSource::Port,
        },
        update_sign: config.update_sign,
    };
    PipelineSettings {
        core: CoreSettings::Lms(settings),
        desired,
        input_lag_samples,
        output_register: config.output_register,
        format: config.number_format,
        clock_mhz: config.clock_mhz,
    }
}

fn sign_lms(config: &SignLmsFilterConfig) -> PipelineSettings {
    let textbook = line_enhancer::sign_lms(config);
    PipelineSettings {
        core: CoreSettings::SignLms(SignLmsSettings {
            tap_count: textbook.taps,
            delay_samples: textbook.delay_samples,
            // The reader has refused the unity-gain form, which is no hardware's.
            normalised: textbook.form != SignLmsForm::Sign,
            step: textbook.step,
            regularisation: textbook.regularisation,
            initial_weight: textbook.initial_weight,
            guard: textbook.guard,
            norm_recompute_samples: config.norm_recompute_samples,
        }),
        desired: DesiredSignal::Current,
        input_lag_samples: textbook.delay_samples,
        output_register: config.output_register,
        format: config.number_format,
        clock_mhz: config.clock_mhz,
    }
}
