//! What never changes while the line enhancer runs.

use crate::fpga::check::{check_positive, check_tap_count};
use crate::fpga::error::FpgaError;
use crate::fpga::float_unit::Fp;

/// Largest interval between two fresh sums of the norm, samples; the counter has 20 bits.
const RECOMPUTE_MAX: u32 = 1_000_000;

/// Settings of a line enhancer in plain numbers, before any check. Constants in the words' unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignLmsSettings {
    /// Number of weights M, 1 to 64.
    pub tap_count: usize,
    /// Samples by which the front end delays the regressor word, 1 to 64; here it only decides how
    /// long the guard may hold.
    pub delay_samples: usize,
    /// Whether the error itself, not its sign, scales the correction (normalised form).
    pub normalised: bool,
    /// Step mu, > 0: in the words' unit in the sign form, else without unit and below 2.
    pub step: f64,
    /// Regularisation alpha, > 0, in the square of the words' unit.
    pub regularisation: f64,
    /// Weight in every tap after reset.
    pub initial_weight: f64,
    /// Largest error that corrects the weights, > 0; none: every error does.
    pub guard: Option<f64>,
    /// Samples between two fresh sums of the norm, at least M; 0 = never.
    pub norm_recompute_samples: u32,
}

/// Checked constants of a line enhancer, in its word format.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignLmsConfig<F> {
    pub(crate) tap_count: usize,
    pub(crate) hold_samples: usize,
    pub(crate) normalised: bool,
    pub(crate) step: F,
    pub(crate) regularisation: F,
    pub(crate) initial_weight: F,
    pub(crate) guard: Option<F>,
    pub(crate) norm_recompute_samples: u32,
}

impl<F: Fp> SignLmsConfig<F> {
    /// Rounds the settings to the word format and checks the rounded values.
    ///
    /// # Errors
    /// [`FpgaError::TapCount`] unless 1 <= M <= 64; [`FpgaError::CountOutOfRange`] for the delay
    /// and the interval; [`FpgaError::OutOfRange`] unless step, regularisation and guard, if any,
    /// are finite and > 0 in the word format, and the initial weight is finite.
    pub fn new(settings: SignLmsSettings) -> Result<Self, FpgaError> {
        check_tap_count(settings.tap_count)?;
        check_positive::<F>("step", settings.step)?;
        check_positive::<F>("regularisation", settings.regularisation)?;
        if let Some(guard) = settings.guard {
            check_positive::<F>("guard", guard)?;
        }
        let initial_weight = F::from_f64(settings.initial_weight);
        if !initial_weight.is_finite() {
            return Err(FpgaError::OutOfRange {
                name: "initial weight",
                value: settings.initial_weight,
                range: "a finite number",
                format: F::NAME,
            });
        }
        if !(1..=64).contains(&settings.delay_samples) {
            return Err(FpgaError::CountOutOfRange {
                name: "delay",
                value: settings.delay_samples as u64,
                range: "1 to 64 samples",
            });
        }
        let interval = settings.norm_recompute_samples;
        let is_long_enough = u64::from(interval) >= settings.tap_count as u64;
        if interval != 0 && !(is_long_enough && interval <= RECOMPUTE_MAX) {
            return Err(FpgaError::CountOutOfRange {
                name: "samples between two fresh sums of the norm",
                value: u64::from(interval),
                range: "0, or the tap count to 1000000",
            });
        }
        Ok(Self {
            tap_count: settings.tap_count,
            hold_samples: settings.delay_samples + settings.tap_count,
            normalised: settings.normalised,
            step: F::from_f64(settings.step),
            regularisation: F::from_f64(settings.regularisation),
            initial_weight,
            guard: settings.guard.map(F::from_f64),
            norm_recompute_samples: interval,
        })
    }

    /// Number of weights M.
    #[must_use]
    pub fn tap_count(&self) -> usize {
        self.tap_count
    }

    /// Samples on end that the guard may hold the weights.
    #[must_use]
    pub fn hold_samples(&self) -> usize {
        self.hold_samples
    }

    /// Whether the error itself scales the correction.
    #[must_use]
    pub fn is_normalised(&self) -> bool {
        self.normalised
    }

    /// Step as the hardware holds it.
    #[must_use]
    pub fn step(&self) -> F {
        self.step
    }

    /// Regularisation as the hardware holds it.
    #[must_use]
    pub fn regularisation(&self) -> F {
        self.regularisation
    }

    /// Weight in every tap after reset.
    #[must_use]
    pub fn initial_weight(&self) -> F {
        self.initial_weight
    }

    /// Largest error that corrects the weights.
    #[must_use]
    pub fn guard(&self) -> Option<F> {
        self.guard
    }

    /// Samples between two fresh sums of the norm; 0 = never.
    #[must_use]
    pub fn norm_recompute_samples(&self) -> u32 {
        self.norm_recompute_samples
    }

    /// Whether an error is beyond the guard, told from the bits without the sign: an infinity and
    /// a NaN are.
    pub(crate) fn is_beyond(&self, error: F) -> bool {
        let magnitude = |word: F| word.to_bits() & (sign_bit::<F>() - 1);
        self.guard
            .is_some_and(|guard| magnitude(error) > magnitude(guard))
    }
}

/// The sign of a word alone.
fn sign_bit<F: Fp>() -> u64 {
    1 << (F::WIDTH - 1)
}

/// `+0` in place of a word whose sign is set: rounding can leave a sum of squares below zero.
pub(crate) fn clamp<F: Fp>(word: F) -> F {
    if word.to_bits() & sign_bit::<F>() == 0 {
        word
    } else {
        F::ZERO
    }
}

/// The step over the energy with the sign of the error: no arithmetic, `+0` for an error of zero
/// or one that is not a number.
pub(crate) fn signed<F: Fp>(step: F, error: F) -> F {
    if error > F::ZERO {
        step
    } else if error < F::ZERO {
        F::from_bits(step.to_bits() ^ sign_bit::<F>())
    } else {
        F::ZERO
    }
}
