//! What is told of words that count pulses.

use super::sawtooth::Sawtooth;
use crate::wording::{counted, plain, to_digits};

/// How the noise below the pulses was found.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum PulseMethod {
    /// From the Allan variance of the words.
    Words,
    /// From the Allan variance of means of the words, over which the pulses lose their phase.
    Means {
        /// Averaging time of a mean, s.
        period_s: f64,
    },
    /// From the times between pulses.
    Times {
        /// Pulses from one time to the next.
        pulses: usize,
        /// Intervals that were measured.
        intervals: usize,
    },
}

impl PulseMethod {
    /// The method in words.
    #[must_use]
    pub fn words(&self) -> String {
        match self {
            Self::Words => "from the curve of the words".to_owned(),
            Self::Means { period_s } => format!(
                "from the curve of means over {} s, in which the pulses lose their phase",
                plain(to_digits(*period_s, 3))
            ),
            Self::Times { pulses, intervals } => format!(
                "from the times between pulses, {} of {}",
                counted(*intervals, "interval"),
                counted(*pulses, "pulse")
            ),
        }
    }
}

/// The quantisation of words that count pulses, and how the noise below it was found.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PulseAnswer {
    /// How N and the slow terms were found.
    pub method: PulseMethod,
    /// Whether the words are the pulses themselves; else a filter made them of such.
    pub counts: bool,
    /// Agreement of the curve with the sawtooth.
    pub(crate) agreement: Agreement,
    /// The sawtooth at the mean rate, dephased by the fitted N.
    pub(crate) sawtooth: Sawtooth,
}

impl PulseAnswer {
    /// Angle of a pulse, arcsec.
    #[must_use]
    pub fn step_arcsec(&self) -> f64 {
        self.sawtooth.step_arcsec
    }
}

/// How the curve agrees with the sawtooth of the pulses where that is a good part of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Agreement {
    /// Root of the ratio of Allan variances found and predicted.
    pub(crate) ratio: f64,
    /// Shortest and longest of these averaging times, s.
    pub(crate) tau_range_s: [f64; 2],
}
