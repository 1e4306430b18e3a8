//! How a filter notices that it has diverged.

use thiserror::Error;

use super::filter::Output;

/// An output above this multiple of the largest input seen is an overflow. No run of weights that
/// track anything comes near it, start-up on nearly collinear samples included.
const OVERFLOW_RATIO: f64 = 1e9;
/// An output above this is an overflow whatever the input, in the unit of the words.
const OVERFLOW_ABSOLUTE: f64 = 1e15;
/// An output above this multiple of the largest input seen is suspect; one alone is a start-up
/// transient, but [`SUSPECT_SAMPLES`] of them are a filter that creeps away, as recursive least
/// squares without forgetting does under the wrong sign: its error grows with k, not by powers.
const SUSPECT_RATIO: f64 = 100.0;
/// Surplus of suspect over sound outputs at which a filter counts as diverged.
const SUSPECT_SAMPLES: u32 = 1000;

/// Why a filter counts as diverged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DivergenceKind {
    /// An input, an output or a weight is infinite or not a number.
    NotFinite,
    /// The output is absurd beside the input: above 1e9 times the largest input seen, above 1e15,
    /// or above 100 times the largest input in a surplus of 1000 samples.
    Overflow,
    /// The inverse correlation matrix is no longer positive definite.
    LostPositiveDefiniteness,
    /// The inverse correlation matrix is no longer symmetric.
    LostSymmetry,
    /// Fixed-point words have led the output away from that of the same filter in binary64.
    WordsTooShort,
}

/// A filter has diverged.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("the filter diverged at sample {sample}: {message}")]
#[non_exhaustive]
pub struct Divergence {
    /// Index of the input sample, from 0, in which it was seen.
    pub sample: u64,
    /// What was seen.
    pub kind: DivergenceKind,
    /// What was seen, in words, with the values.
    pub message: String,
}

/// What a core or the watch finds wrong, before the filter adds when.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// What was seen.
    pub kind: DivergenceKind,
    /// What was seen, in words, with the values.
    pub message: String,
}

impl Fault {
    /// The fault as it is reported: in which sample it was seen.
    #[must_use]
    pub fn at(self, sample: u64) -> Divergence {
        Divergence {
            sample,
            kind: self.kind,
            message: self.message,
        }
    }
}

/// Samples that a filter has taken, and what ended it: the first divergence stays.
#[derive(Clone, Debug, Default)]
pub(in crate::filters) struct Life {
    samples: u64,
    diverged: Option<Divergence>,
}

impl Life {
    /// Whether it goes on.
    ///
    /// # Errors
    /// What has ended it.
    #[inline]
    pub(in crate::filters) fn goes_on(&self) -> Result<(), Divergence> {
        self.diverged.clone().map_or(Ok(()), Err)
    }

    /// Index of the sample that comes, which counts as taken.
    #[inline]
    pub(in crate::filters) fn next_sample(&mut self) -> u64 {
        let sample = self.samples;
        self.samples += 1;
        sample
    }

    /// Index of the newest sample.
    #[must_use]
    pub(in crate::filters) fn newest_sample(&self) -> u64 {
        self.samples.saturating_sub(1)
    }

    /// What came of a sample; of a filter that has ended, its end.
    ///
    /// # Errors
    /// What has ended it, now or before.
    #[inline]
    pub(in crate::filters) fn judge<T>(
        &mut self,
        sample: u64,
        result: Result<T, Fault>,
    ) -> Result<T, Divergence> {
        self.goes_on()?;
        result.map_err(|fault| {
            let divergence = fault.at(sample);
            self.diverged = Some(divergence.clone());
            divergence
        })
    }
}

/// Watches the words that enter and leave a core.
#[derive(Clone, Debug, Default)]
pub struct Watch {
    input_max: f64,
    suspects: u32,
}

impl Watch {
    /// A watch that has seen nothing yet.
    #[must_use]
    pub fn new() -> Self {
        Self {
            input_max: 0.0,
            suspects: 0,
        }
    }

    /// Checks a word that enters.
    ///
    /// # Errors
    /// [`DivergenceKind::NotFinite`].
    pub fn check_input(&mut self, input: f64) -> Result<(), Fault> {
        if !input.is_finite() {
            let message = format!("the input word is {input}");
            return Err(Fault {
                kind: DivergenceKind::NotFinite,
                message,
            });
        }
        self.input_max = self.input_max.max(input.abs());
        Ok(())
    }

    /// Checks a result that leaves.
    ///
    /// # Errors
    /// [`DivergenceKind::NotFinite`] or [`DivergenceKind::Overflow`].
    pub fn check_output(&mut self, output: Output) -> Result<(), Fault> {
        let Output {
            value_deg_per_h: value,
            weight_sum,
        } = output;
        if !(value.is_finite() && weight_sum.is_finite()) {
            let message = format!("the output is {value}, the sum of the weights {weight_sum}");
            return Err(Fault {
                kind: DivergenceKind::NotFinite,
                message,
            });
        }
        let magnitude = value.abs();
        let input_max = self.input_max;
        if magnitude <= SUSPECT_RATIO * input_max && magnitude <= OVERFLOW_ABSOLUTE {
            self.suspects = self.suspects.saturating_sub(1);
            return Ok(());
        }
        self.suspects += 1;
        let message = if magnitude > OVERFLOW_RATIO * input_max || magnitude > OVERFLOW_ABSOLUTE {
            format!("the output is {value:e} with no input above {input_max}")
        } else if self.suspects >= SUSPECT_SAMPLES {
            format!(
                "the output, now {value:e}, keeps above {SUSPECT_RATIO} times the largest input, \
                 {input_max}"
            )
        } else {
            return Ok(());
        };
        Err(Fault {
            kind: DivergenceKind::Overflow,
            message,
        })
    }
}
