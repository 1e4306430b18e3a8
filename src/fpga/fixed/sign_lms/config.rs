//! What never changes while the line enhancer runs.

use crate::fpga::check::check_tap_count;
use crate::fpga::error::FpgaError;
use crate::fpga::fixed::format::Stored;
use crate::fpga::fixed::step::{EnergyStep, LmsFormats, at_least_a_step};

/// Settings of a fixed-point line enhancer in plain numbers, before any check.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedSignLmsSettings {
    /// Number of weights M, 1 to 64.
    pub tap_count: usize,
    /// Samples by which the front end delays the regressor word, 1 to 64; here it only decides how long the
    /// guard may hold.
    pub delay_samples: usize,
    /// Whether the error itself, not its sign, scales the correction (normalised form).
    pub normalised: bool,
    /// Step mu, > 0: in the full scale in the sign form, else without unit.
    pub step: f64,
    /// Regularisation alpha, >= 0, in the square of the full scale.
    pub regularisation: f64,
    /// Weight in every tap after reset.
    pub initial_weight: f64,
    /// Largest error that corrects the weights, > 0, in the full scale; none: every error does.
    pub guard: Option<f64>,
    /// Formats of the signals.
    pub formats: LmsFormats,
}

/// Checked constants of a fixed-point line enhancer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedSignLmsConfig {
    pub(super) tap_count: usize,
    pub(super) hold_samples: usize,
    pub(super) normalised: bool,
    pub(super) formats: LmsFormats,
    pub(super) step: EnergyStep,
    pub(super) initial_weight: i64,
    /// Code of y.
    pub(super) guard: Option<i64>,
}

impl FixedSignLmsConfig {
    /// Rounds the constants to their formats and checks them.
    ///
    /// # Errors
    /// [`FpgaError::TapCount`]; [`FpgaError::OutOfRange`] for a step or a guard that is not above zero in its
    /// words; [`FpgaError::DoesNotFit`] for constants beyond theirs; [`FpgaError::CountOutOfRange`] for the
    /// delay or a format, or if an exact value would need more than 126 bits.
    pub fn new(settings: FixedSignLmsSettings) -> Result<Self, FpgaError> {
        check_tap_count(settings.tap_count)?;
        if !(1..=64).contains(&settings.delay_samples) {
            return Err(FpgaError::CountOutOfRange {
                name: "delay",
                value: settings.delay_samples as u64,
                range: "1 to 64 samples",
            });
        }
        let formats = settings.formats;
        formats.check(!settings.normalised)?;
        let weight = formats.weight;
        let guard = match settings.guard {
            Some(guard) => {
                let code = formats.output.holding("guard", guard, "y")?;
                at_least_a_step("guard", guard, code)?;
                Some(code)
            }
            None => None,
        };
        Ok(Self {
            tap_count: settings.tap_count,
            hold_samples: settings.delay_samples + settings.tap_count,
            normalised: settings.normalised,
            formats,
            step: EnergyStep::new("step", settings.step, settings.regularisation, &formats)?,
            initial_weight: weight.holding("initial weight", settings.initial_weight, "W")?,
            guard,
        })
    }

    /// Number of weights M.
    #[must_use]
    pub fn tap_count(&self) -> usize {
        self.tap_count
    }

    /// Formats of the signals.
    #[must_use]
    pub fn formats(&self) -> &LmsFormats {
        &self.formats
    }

    /// Whether an error is beyond the guard.
    pub(super) fn is_beyond(&self, error: i64) -> bool {
        self.guard.is_some_and(|guard| error.abs() > guard)
    }

    /// `Q_den` of alpha and the norm.
    pub(super) fn denominator(&self, norm: i128) -> Stored {
        EnergyStep::denominator(&self.formats, self.step.regularisation + norm)
    }

    /// What the taps are multiplied by if the guard does not hold.
    pub(super) fn step_of(&self, error: i64, gain: i64) -> Stored {
        if self.normalised {
            self.formats.step(i128::from(error) * i128::from(gain))
        } else {
            self.formats.signed_step(error, gain)
        }
    }
}
