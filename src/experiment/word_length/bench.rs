//! One trial of word lengths.

use std::ops::RangeInclusive;

use crate::experiment::plan::Plan;
use crate::experiment::run::{first_words, motion, stamp_s};
use crate::filters::{FilterKind, FixedWords, HardwareWords};
use crate::fpga::FpgaError;
use crate::gyro::GyroError;
use crate::metrics::{Motion, SwingClock, fit_swing, overlapping_allan_at};
use crate::units::s_to_us;
use crate::vocabulary::NumberFormat;

/// Averaging time at which noise is compared, s.
const ALLAN_S: f64 = 0.1;

/// What words have to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WordLengthLimits {
    /// Largest ratio of the Allan deviation at 0.1 s to that of binary64, and of that to it: words that are much
    /// quieter than those of binary64 have lost the signal.
    pub arw_ratio_max: f64,
    /// Largest change of the delay against binary64, us.
    pub delay_change_max_us: f64,
    /// Time that the filter has to live, s; none: the scenario's.
    pub survive_s: Option<f64>,
}

impl WordLengthLimits {
    /// Ratios of the Allan deviation to that of binary64 that words may have.
    #[must_use]
    pub fn arw_ratios(&self) -> RangeInclusive<f64> {
        self.arw_ratio_max.recip()..=self.arw_ratio_max
    }
}

/// Why there is nothing to try.
#[derive(Debug, thiserror::Error)]
pub enum WordLengthError {
    /// No such filter.
    #[error("there is no filter `{name}` with fixed-point hardware: expected one of {known}")]
    NoFilter {
        /// Name that was given.
        name: String,
        /// Names of those that are there.
        known: String,
    },
    /// The filter refuses its constants.
    #[error(transparent)]
    Pipeline(#[from] FpgaError),
    /// The gyro has no words.
    #[error(transparent)]
    Gyro(#[from] GyroError),
    /// The filter fails in binary64.
    #[error("the filter fails in binary64: {0}")]
    Twin(String),
}

/// What some word lengths make of the filter.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct WordLengthTrial {
    /// The words.
    pub words: FixedWords,
    /// Ratio of the Allan deviations at 0.1 s to that of binary64; none of a filter that failed.
    pub arw_ratio: Option<f64>,
    /// Delay minus that of binary64, us; none without a swing and of a filter that failed.
    pub delay_change_us: Option<f64>,
    /// When R was no longer definite, s.
    pub indefinite_at_s: Option<f64>,
    /// When the output failed, s.
    pub diverged_at_s: Option<f64>,
    /// Whether the words do what they have to.
    pub does: bool,
}

/// The words of the gyro and what the filter makes of them in binary64.
pub(super) struct Bench {
    kind: FilterKind,
    words: FixedWords,
    input: Vec<f64>,
    warm_up: usize,
    period_s: f64,
    motion: Motion,
    limits: WordLengthLimits,
    twin: Figures,
}

/// Noise and phase of some output words; none of a filter that failed.
#[derive(Clone, Copy, Debug, Default)]
struct Figures {
    allan_deg_per_h: Option<f64>,
    phase_rad: Option<f64>,
}

/// What a filter made of the words.
struct Filtered {
    outputs: Vec<f64>,
    /// In which sample it failed, and why.
    failure: Option<(u64, String)>,
    /// When R was no longer definite.
    indefinite_at: Option<u64>,
}

impl Bench {
    pub(super) fn new(
        plan: &Plan,
        name: &str,
        limits: WordLengthLimits,
    ) -> Result<Self, WordLengthError> {
        let scenario = &plan.resolved().scenario;
        let fixed = scenario.filters.iter().filter_map(|filter| {
            let words = filter.kind.settings().fixed_words()?;
            Some((filter, words))
        });
        let found = fixed.clone().find(|(filter, _)| filter.name == name);
        let Some((filter, words)) = found else {
            let known: Vec<&str> = fixed.map(|(filter, _)| filter.name.as_str()).collect();
            return Err(WordLengthError::NoFilter {
                name: name.to_owned(),
                known: match known.as_slice() {
                    [] => "none of this scenario".to_owned(),
                    known => known.join(", "),
                },
            });
        };
        let period_s = plan.sample_period_s();
        let length = plan.record_length();
        let asked = limits
            .survive_s
            .map_or(0, |life_s| samples(life_s / period_s));
        let input = first_words(scenario, asked.max(length.total()))?;
        let mut bench = Self {
            kind: filter.kind.clone(),
            words,
            input,
            warm_up: length.warm_up,
            period_s,
            motion: motion(scenario, period_s),
            limits,
            twin: Figures::default(),
        };
        let filtered = bench.run(&HardwareWords::Float(NumberFormat::Binary64))?;
        if let Some((_, message)) = filtered.failure {
            return Err(WordLengthError::Twin(message));
        }
        bench.twin = bench.figures(&filtered.outputs);
        Ok(bench)
    }

    /// The words that the filter has, or those of the reference.
    pub(super) fn words(&self) -> FixedWords {
        self.words.clone()
    }

    /// Table of the filter's kind in a scenario.
    pub(super) fn kind(&self) -> &'static str {
        self.kind.name()
    }

    /// Samples that every trial filters.
    pub(super) fn samples(&self) -> usize {
        self.input.len()
    }

    /// Time of the last of them, s.
    pub(super) fn filtered_s(&self) -> f64 {
        stamp_s((self.input.len() as u64).saturating_sub(1), self.period_s)
    }

    /// Tries some words.
    pub(super) fn trial(&self, words: FixedWords) -> Result<WordLengthTrial, WordLengthError> {
        let filtered = self.run(&HardwareWords::Fixed(words.clone()))?;
        let stamp_s = |sample: u64| stamp_s(sample, self.period_s);
        let diverged_at_s = filtered.failure.map(|(sample, _)| stamp_s(sample));
        let figures = match diverged_at_s {
            None => self.figures(&filtered.outputs),
            Some(_) => Figures::default(),
        };
        let noise = figures.allan_deg_per_h.zip(self.twin.allan_deg_per_h);
        let arw_ratio = noise.map(|(own, twin)| own / twin);
        let phases = figures.phase_rad.zip(self.twin.phase_rad);
        let delay_change_us = phases.map(|(own, twin)| {
            let later = (twin - own) / std::f64::consts::TAU;
            // The nearest turn.
            s_to_us((later - later.round()) / self.frequency_hz())
        });
        let does = diverged_at_s.is_none()
            && arw_ratio.is_some_and(|ratio| self.limits.arw_ratios().contains(&ratio))
            && delay_change_us.is_none_or(|us| us.abs() <= self.limits.delay_change_max_us);
        Ok(WordLengthTrial {
            words,
            arw_ratio,
            delay_change_us,
            indefinite_at_s: filtered.indefinite_at.map(stamp_s),
            diverged_at_s,
            does,
        })
    }

    /// Filters the words, as far as the filter goes.
    fn run(&self, words: &HardwareWords) -> Result<Filtered, FpgaError> {
        let settings = self.kind.settings().hardware_on(words);
        let settings = settings.expect("a filter with fixed-point words has hardware");
        let mut filter = settings.filter(self.warm_up as u64)?;
        let mut outputs = Vec::with_capacity(self.input.len());
        let mut failure = None;
        for word in &self.input {
            match filter.step(*word) {
                Ok(output) => outputs.push(output.value_deg_per_h),
                Err(divergence) => {
                    failure = Some((divergence.sample, divergence.message));
                    break;
                }
            }
        }
        let indefinite_at = filter.fixed().and_then(|fixed| fixed.indefinite_at);
        Ok(Filtered {
            outputs,
            failure,
            indefinite_at,
        })
    }

    /// Noise beside the swing, and the phase of the swing.
    fn figures(&self, outputs: &[f64]) -> Figures {
        let record = &outputs[self.warm_up.min(outputs.len())..];
        let frequency_hz = self.frequency_hz();
        let clock = SwingClock {
            frequency_hz,
            sample_period_s: self.period_s,
            first_stamp_s: 0.0,
        };
        let fit = if frequency_hz > 0.0 {
            fit_swing(record, &clock).ok().map(|fit| fit.whole)
        } else {
            None
        };
        let noise: Vec<f64> = match &fit {
            None => record.to_vec(),
            Some(sine) => {
                let values = record.iter().enumerate();
                values
                    .map(|(index, value)| {
                        let phase = clock.phase_rad(index) + sine.phase_rad;
                        value - sine.amplitude * phase.cos()
                    })
                    .collect()
            }
        };
        let factor = samples(ALLAN_S / self.period_s).max(1);
        let points = overlapping_allan_at(&noise, self.period_s, &[factor]);
        Figures {
            allan_deg_per_h: points.first().map(|point| point.deviation_deg_per_h.value),
            phase_rad: fit.map(|sine| sine.phase_rad),
        }
    }

    /// Frequency of the swing, Hz; 0 without one.
    fn frequency_hz(&self) -> f64 {
        match self.motion {
            Motion::Swing { frequency_hz } | Motion::SwingFromRest { frequency_hz } => frequency_hz,
            _ => 0.0,
        }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a count of samples of a positive time"
)]
fn samples(count: f64) -> usize {
    count.round() as usize
}
