//! What never changes while the RLS pipeline runs: the synthesis-time constants.

use crate::fpga::check::{check_positive, check_tap_count};
use crate::fpga::error::FpgaError;
use crate::fpga::float_unit::Fp;
use crate::fpga::timing::Units;
use crate::vocabulary::{Division, UpdateSign};

/// Settings of an RLS pipeline in plain numbers, before any check.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RlsSettings {
    /// Number of weights p, 1 to 64.
    pub tap_count: usize,
    /// Forgetting factor alpha, (0, 1].
    pub forgetting_factor: f64,
    /// Initial inverse correlation delta, > 0, in the inverse square of the input words' unit.
    pub initial_inverse_correlation: f64,
    /// Division mode.
    pub division: Division,
    /// Sign of the weight update.
    pub update_sign: UpdateSign,
}

/// Checked constants of an RLS pipeline, in its word format.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RlsConfig<F> {
    pub(crate) tap_count: usize,
    pub(crate) alpha: F,
    pub(crate) inverse_alpha: F,
    pub(crate) delta: F,
    pub(crate) division: Division,
    pub(crate) update_sign: UpdateSign,
    pub(crate) units: Units,
}

impl<F: Fp> RlsConfig<F> {
    /// Rounds the settings to the word format and checks the rounded values.
    ///
    /// # Errors
    /// [`FpgaError::TapCount`] unless 1 <= p <= 64; [`FpgaError::OutOfRange`] unless alpha is in
    /// (0, 1] with a finite reciprocal, and delta is finite and > 0, both in the word format.
    pub fn new(settings: RlsSettings) -> Result<Self, FpgaError> {
        check_tap_count(settings.tap_count)?;
        let alpha = F::from_f64(settings.forgetting_factor);
        let inverse_alpha = F::ONE.div(alpha);
        // Comparisons are written so that a NaN fails them.
        if !(alpha > F::ZERO && alpha <= F::ONE && inverse_alpha.is_finite()) {
            return Err(FpgaError::OutOfRange {
                name: "forgetting factor",
                value: settings.forgetting_factor,
                range: "> 0 and <= 1",
                format: F::NAME,
            });
        }
        let delta = F::from_f64(settings.initial_inverse_correlation);
        check_positive::<F>(
            "initial inverse correlation",
            settings.initial_inverse_correlation,
        )?;
        Ok(Self {
            tap_count: settings.tap_count,
            alpha,
            inverse_alpha,
            delta,
            division: settings.division,
            update_sign: settings.update_sign,
            units: Units::ONE_CLOCK,
        })
    }

    /// The same with units of other latencies: same words, more clocks.
    ///
    /// # Errors
    /// [`FpgaError::CountOutOfRange`] naming the unit.
    pub fn with_units(self, units: Units) -> Result<Self, FpgaError> {
        units.check()?;
        Ok(Self { units, ..self })
    }

    /// Latencies of the units; their intervals do not count, as the control waits for each result.
    #[must_use]
    pub fn units(&self) -> Units {
        self.units
    }

    /// Number of weights p.
    #[must_use]
    pub fn tap_count(&self) -> usize {
        self.tap_count
    }

    /// Forgetting factor as the hardware holds it.
    #[must_use]
    pub fn alpha(&self) -> F {
        self.alpha
    }

    /// `RN(1 / alpha)`, the constant the update multiplies by.
    #[must_use]
    pub fn inverse_alpha(&self) -> F {
        self.inverse_alpha
    }

    /// Initial diagonal of the inverse correlation matrix.
    #[must_use]
    pub fn delta(&self) -> F {
        self.delta
    }

    /// Division mode.
    #[must_use]
    pub fn division(&self) -> Division {
        self.division
    }

    /// Sign of the weight update.
    #[must_use]
    pub fn update_sign(&self) -> UpdateSign {
        self.update_sign
    }
}
