//! A hardware pipeline whatever its words: what the bench asks of it.

use super::filter::HardwareFilter;
use super::fixed::FixedSettings;
use super::settings::FloatSettings;
use super::timing::PipelineTiming;
use crate::filters::common::Complaints;
use crate::filters::words::HardwareWords;
use crate::fpga::FpgaError;
use crate::fpga::fixed::SignalName;
use crate::fpga::health::Warning;
use crate::fpga::kinds::{CoreSettings, KINDS};
use crate::fpga::timing::Units;
use crate::units::s_to_us;
use crate::vocabulary::{DesiredSignal, NumberFormat, OutputRegister};

/// A hardware pipeline with its front end, before any check.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PipelineSettings {
    /// On floating-point words.
    Float(FloatSettings),
    /// On fixed-point words.
    Fixed(FixedSettings),
}

/// What stands around a core, and its clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Around {
    /// What the filter is asked to reproduce.
    pub desired: DesiredSignal,
    /// Samples by which the regressors lag the newest sample.
    pub input_lag_samples: usize,
    /// When the result appears.
    pub output_register: OutputRegister,
    /// Clock, MHz.
    pub clock_mhz: f64,
}

/// Names of the kinds of filters that have a hardware pipeline.
pub fn kind_names() -> impl Iterator<Item = &'static str> {
    KINDS.iter().map(|kind| kind.name)
}

/// Whether filters of a kind have a hardware pipeline.
#[must_use]
pub fn has_hardware(kind: &str) -> bool {
    kind_names().any(|name| name == kind)
}

impl PipelineSettings {
    /// A core on some words.
    #[must_use]
    pub fn of(core: CoreSettings, around: Around, words: &HardwareWords) -> Self {
        let float = |format| FloatSettings {
            core,
            desired: around.desired,
            input_lag_samples: around.input_lag_samples,
            output_register: around.output_register,
            format,
            clock_mhz: around.clock_mhz,
        };
        match words {
            HardwareWords::Float(format) => Self::Float(float(*format)),
            HardwareWords::Fixed(words) => {
                Self::Fixed(FixedSettings::of(float(NumberFormat::Binary64), words))
            }
        }
    }

    /// Number of weights.
    #[must_use]
    pub fn tap_count(&self) -> usize {
        match self {
            Self::Float(settings) => settings.tap_count(),
            Self::Fixed(settings) => settings.core.tap_count(),
        }
    }

    /// When the result appears.
    #[must_use]
    pub fn output_register(&self) -> OutputRegister {
        match self {
            Self::Float(settings) => settings.output_register,
            Self::Fixed(settings) => settings.twin.output_register,
        }
    }

    /// Clock, MHz.
    #[must_use]
    pub fn clock_mhz(&self) -> f64 {
        match self {
            Self::Float(settings) => settings.clock_mhz,
            Self::Fixed(settings) => settings.twin.clock_mhz,
        }
    }

    /// Whether its words are fixed point.
    #[must_use]
    pub fn is_fixed(&self) -> bool {
        matches!(self, Self::Fixed(_))
    }

    /// Whether the filter keeps an inverse correlation matrix.
    #[must_use]
    pub fn has_matrix(&self) -> bool {
        match self {
            Self::Float(settings) => settings.core.kind().has_matrix,
            Self::Fixed(settings) => settings.core.kind().has_matrix,
        }
    }

    /// Whether its fixed-point words have a signal; floating-point words have none of them.
    #[must_use]
    pub fn has_signal(&self, name: SignalName) -> bool {
        match self {
            Self::Float(_) => false,
            Self::Fixed(settings) => settings.format_of(name).is_some(),
        }
    }

    /// Whether there is hardware with the engine's words.
    #[must_use]
    pub fn has_hardware(&self) -> bool {
        match self {
            Self::Float(settings) => settings.core.has_hardware(),
            Self::Fixed(_) => true,
        }
    }

    /// Rounds the constants to their words, checks them and counts one sample's clocks.
    ///
    /// # Errors
    /// What the pipeline refuses: tap count, constants or formats out of range.
    pub fn timing(&self) -> Result<PipelineTiming, FpgaError> {
        match self {
            Self::Float(settings) => settings.timing(),
            Self::Fixed(settings) => settings.timing(),
        }
    }

    /// Clocks per sample when the control machine waits for every result of these units.
    ///
    /// # Errors
    /// [`FpgaError::TapCount`], [`FpgaError::CountOutOfRange`].
    pub fn stalled_clocks(&self, units: Units) -> Result<u64, FpgaError> {
        match self {
            Self::Float(settings) => settings.core.stalled_clocks(units),
            Self::Fixed(settings) => {
                units.check()?;
                let config = settings.config()?;
                Ok(config.as_pipeline().stalled_clocks(units))
            }
        }
    }

    /// Checks that its machine takes units of these latencies.
    ///
    /// # Errors
    /// What the pipeline refuses.
    pub fn check_units(&self, units: Units) -> Result<(), FpgaError> {
        match self {
            Self::Float(settings) => settings.core.config_with::<f64>(units).map(drop),
            Self::Fixed(settings) => settings.config()?.with_units(units).map(drop),
        }
    }

    /// Checks the constants in their words, and that a sample is done before the next arrives.
    pub(in crate::filters) fn check(&self, sample_rate_hz: f64, complaints: &mut Complaints) {
        let timing = match (self.timing(), self) {
            (Ok(timing), _) => timing,
            (Err(error), Self::Fixed(settings)) => return settings.complain(&error, complaints),
            (Err(error), Self::Float(_)) => return complaints.table(&error.to_string()),
        };
        let period_us = s_to_us(1.0 / sample_rate_hz);
        if timing.sample_period_us > period_us {
            let clock_mhz = self.clock_mhz();
            let message = format!(
                "= {clock_mhz} is too slow: {} clocks a sample take {:.3} us, the gyro gives one every \
                 {period_us:.3} us; use {:.3} MHz or more, or fewer taps",
                timing.usage.clocks_per_sample,
                timing.sample_period_us,
                clock_mhz * timing.sample_period_us / period_us
            );
            complaints.key("clock_mhz", &message);
        }
    }

    /// Warns if the first updates cost the words their digits, for inputs up to `input_max`.
    #[must_use]
    pub fn digits_warning(&self, input_max: f64) -> Option<Warning> {
        match self {
            Self::Float(settings) => settings.digits_warning(input_max),
            Self::Fixed(_) => None,
        }
    }

    /// Samples after which theory expects the gain-first order to fail; none for the others.
    #[must_use]
    pub fn failure_samples(&self) -> Option<f64> {
        match self {
            Self::Float(settings) => settings.failure_samples(),
            Self::Fixed(_) => None,
        }
    }

    /// The filter in front of the bench, bit for bit the hardware's.
    ///
    /// * `warm_up_samples`: samples before the record; health is summed up from there on.
    ///
    /// # Errors
    /// As [`Self::timing`].
    pub fn filter(&self, warm_up_samples: u64) -> Result<Box<dyn HardwareFilter>, FpgaError> {
        match self {
            Self::Float(settings) => settings.filter(warm_up_samples),
            Self::Fixed(settings) => settings.filter(warm_up_samples),
        }
    }
}
