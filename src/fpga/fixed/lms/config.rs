//! What never changes while the LMS pipeline runs.

use crate::fpga::check::check_tap_count;
use crate::fpga::error::FpgaError;
use crate::fpga::fixed::format::Stored;
use crate::fpga::fixed::step::{EnergyStep, LmsFormats, at_least_a_step};

/// Settings of a fixed-point LMS pipeline in plain numbers, before any check.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedLmsSettings {
    /// Number of weights N, 1 to 64.
    pub tap_count: usize,
    /// Step size mu, > 0: of plain LMS in the inverse square of the input's full scale.
    pub step_size: f64,
    /// Added to the input's energy, >= 0, in the square of the full scale. `None`: plain LMS.
    pub regularisation: Option<f64>,
    /// Formats of the signals.
    pub formats: LmsFormats,
}

/// Where the gain comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// Plain LMS: a word of k.
    Given(i64),
    /// NLMS.
    OverEnergy(EnergyStep),
}

/// Checked constants of a fixed-point LMS pipeline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedLmsConfig {
    pub(super) tap_count: usize,
    pub(super) formats: LmsFormats,
    pub(super) step: Step,
}

impl FixedLmsConfig {
    /// Rounds the constants to their formats and checks them.
    ///
    /// # Errors
    /// [`FpgaError::TapCount`]; [`FpgaError::OutOfRange`] for a step that is not above zero in its words;
    /// [`FpgaError::DoesNotFit`] if step or regularisation do not fit k and den;
    /// [`FpgaError::CountOutOfRange`] for a format, or if an exact value would need more than 126 bits.
    pub fn new(settings: FixedLmsSettings) -> Result<Self, FpgaError> {
        check_tap_count(settings.tap_count)?;
        let formats = settings.formats;
        formats.check(false)?;
        let mu = settings.step_size;
        let step = match settings.regularisation {
            Some(regularisation) => {
                let name = "step over the energy";
                Step::OverEnergy(EnergyStep::new(name, mu, regularisation, &formats)?)
            }
            None => {
                let name = "step size";
                let code = formats.gain.holding(name, mu, "k")?;
                at_least_a_step(name, mu, code)?;
                Step::Given(code)
            }
        };
        Ok(Self {
            tap_count: settings.tap_count,
            formats,
            step,
        })
    }

    /// Number of weights N.
    #[must_use]
    pub fn tap_count(&self) -> usize {
        self.tap_count
    }

    /// Formats of the signals.
    #[must_use]
    pub fn formats(&self) -> &LmsFormats {
        &self.formats
    }

    /// Whether the step is divided by the input's energy.
    #[must_use]
    pub fn is_normalised(&self) -> bool {
        matches!(self.step, Step::OverEnergy(_))
    }

    /// What the sum of squares starts at.
    pub(super) fn regularisation(&self) -> i128 {
        match self.step {
            Step::Given(_) => 0,
            Step::OverEnergy(step) => step.regularisation,
        }
    }

    /// `Q_den` of eps and a sum of squares.
    pub(super) fn denominator(&self, sum: i128) -> Stored {
        EnergyStep::denominator(&self.formats, sum)
    }
}
