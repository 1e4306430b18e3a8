//! What never changes while the LMS pipeline runs.

use crate::fpga::check::{check_positive, check_tap_count};
use crate::fpga::error::FpgaError;
use crate::fpga::float_unit::Fp;
use crate::vocabulary::{DesiredSignal, UpdateSign};

/// Where the core takes its desired word from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DesiredSource {
    /// The mean of the two newest inputs, formed in the core: `(x + XP) * 0.5`.
    MeanOfTwoNewest,
    /// The port `d`.
    Port,
}

impl DesiredSource {
    /// The source that needs no front end for this desired signal, at lag 0.
    #[must_use]
    pub fn of(desired: DesiredSignal) -> Self {
        match desired {
            DesiredSignal::Current => Self::Port,
            DesiredSignal::TwoSampleMean => Self::MeanOfTwoNewest,
        }
    }
}

/// Settings of an LMS pipeline in plain numbers, before any check.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LmsSettings {
    /// Number of weights N, 1 to 64.
    pub tap_count: usize,
    /// Step size mu, > 0. Plain LMS is stable below `2 / lambda_max` of the input's correlation
    /// matrix, NLMS below 2.
    pub step_size: f64,
    /// Added to the input's energy, > 0, in the square of the input words' unit. `None`: plain
    /// LMS, whose step is not divided by the energy.
    pub regularisation: Option<f64>,
    /// Source of the desired word.
    pub desired: DesiredSource,
    /// Sign of the weight update.
    pub update_sign: UpdateSign,
}

/// Checked constants of an LMS pipeline, in its word format.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LmsConfig<F> {
    pub(crate) tap_count: usize,
    pub(crate) step_size: F,
    pub(crate) regularisation: Option<F>,
    pub(crate) half: F,
    pub(crate) desired: DesiredSource,
    pub(crate) update_sign: UpdateSign,
}

impl<F: Fp> LmsConfig<F> {
    /// Rounds the settings to the word format and checks the rounded values.
    ///
    /// # Errors
    /// [`FpgaError::TapCount`] unless 1 <= N <= 64; [`FpgaError::OutOfRange`] unless the step
    /// size and the regularisation, if any, are finite and > 0 in the word format.
    pub fn new(settings: LmsSettings) -> Result<Self, FpgaError> {
        check_tap_count(settings.tap_count)?;
        check_positive::<F>("step size", settings.step_size)?;
        if let Some(value) = settings.regularisation {
            check_positive::<F>("regularisation", value)?;
        }
        Ok(Self {
            tap_count: settings.tap_count,
            step_size: F::from_f64(settings.step_size),
            regularisation: settings.regularisation.map(F::from_f64),
            half: F::from_f64(0.5),
            desired: settings.desired,
            update_sign: settings.update_sign,
        })
    }

    /// Number of weights N.
    #[must_use]
    pub fn tap_count(&self) -> usize {
        self.tap_count
    }

    /// Step size as the hardware holds it.
    #[must_use]
    pub fn step_size(&self) -> F {
        self.step_size
    }

    /// Regularisation of the normalised form.
    #[must_use]
    pub fn regularisation(&self) -> Option<F> {
        self.regularisation
    }

    /// Source of the desired word.
    #[must_use]
    pub fn desired(&self) -> DesiredSource {
        self.desired
    }

    /// Sign of the weight update.
    #[must_use]
    pub fn update_sign(&self) -> UpdateSign {
        self.update_sign
    }

    /// Whether the step is divided by the input's energy.
    #[must_use]
    pub fn is_normalised(&self) -> bool {
        self.regularisation.is_some()
    }
}
