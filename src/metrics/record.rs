//! What a measurement is given: samples, motion and the filter's outline.

use std::ops::Range;

use super::allan::variants::AllanOptions;
use super::estimate::blocks::RATIO_BLOCKS;
use super::estimate::influence::Learned;
use super::estimate::interval::{self, round_to_count};
use super::estimate::two_runs::TwoRuns;
use super::estimate::value::Estimate;
use super::theory::learning::{LearnedWeights, Learning, NOT_FROM_ONE_RECORD};
use super::theory::memory::impulse_response;
use super::theory::prediction::Prediction;
use crate::signal::{Bridge, FilterShape, Rates, SlowDrift, WeightRule};

/// Fewest samples worth measuring.
pub(crate) const SAMPLES_MIN: usize = 64;

/// The samples of one channel with the two references it is compared to.
///
/// All slices have the same length and are cut to the measured window; the truth may be empty.
#[derive(Clone, Copy, Debug)]
pub struct Record<'a> {
    /// The channel, deg/h.
    pub channel_deg_per_h: &'a [f64],
    /// The unfiltered gyro, deg/h; the channel itself when raw is measured.
    pub raw_deg_per_h: &'a [f64],
    /// The true rate at the stamps, deg/h; empty where nobody knows it, as of a recorded log.
    pub truth_deg_per_h: Rates<'a>,
    /// What the gyro makes of the motion without noise, deg/h: it ends with the record and may begin
    /// before it, by what the filters saw; empty where nobody knows it.
    pub response_deg_per_h: &'a [f64],
    /// What the table's encoder shows at the stamps, rad; none if the table has none.
    pub encoder_rad: Option<&'a [f64]>,
    /// Sample period, s.
    pub sample_period_s: f64,
    /// Stamp of the first sample, s.
    pub first_stamp_s: f64,
    /// How the slow noise of the gyro scatters over seeds; none where nobody knows it, as of a
    /// recorded log.
    pub drift: Option<&'a SlowDrift>,
}

impl<'a> Record<'a> {
    /// The true rate at the stamps, deg/h, where it is known.
    #[must_use]
    pub fn truth(&self) -> Option<Rates<'a>> {
        (!self.truth_deg_per_h.is_empty()).then_some(self.truth_deg_per_h)
    }

    /// Covariance over seeds of the slow noise in the means over two ranges of samples, (deg/h)^2;
    /// 0 where it is not known.
    pub(crate) fn drift_covariance(&self, one: &Range<usize>, other: &Range<usize>) -> f64 {
        let stretch = |samples: &Range<usize>| {
            [samples.start, samples.end].map(|at| {
                let before_first = self.first_stamp_s - self.sample_period_s;
                before_first + at as f64 * self.sample_period_s
            })
        };
        let (one, other) = (stretch(one), stretch(other));
        self.drift
            .map_or(0.0, |drift| drift.mean_covariance(one, other))
    }

    /// Variance over seeds of the slow noise in the mean of the record, (deg/h)^2.
    pub(crate) fn drift_variance(&self) -> f64 {
        let all = 0..self.channel_deg_per_h.len();
        self.drift_covariance(&all, &all)
    }
}

/// What the table did during the record.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// At rest or turning at a constant rate.
    Steady,
    /// Sine swing.
    Swing {
        /// Swing frequency, Hz.
        frequency_hz: f64,
    },
    /// Sine swing that begins with the record, after rest.
    SwingFromRest {
        /// Swing frequency, Hz.
        frequency_hz: f64,
    },
    /// Any other known motion, such as trapezoids or a sweep.
    General,
    /// Sum of sines of rate.
    MultiSine {
        /// Frequencies of the tones, Hz, ascending.
        frequencies_hz: Vec<f64>,
    },
    /// Steps of rate.
    Steps {
        /// First sample of the last rate, counted within the record.
        last_step_index: usize,
        /// Height of the last step, deg/h.
        step_deg_per_h: f64,
        /// All rates, for the scale factor.
        staircase: Staircase,
    },
}

/// The rates of a staircase as the scale factor needs them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Staircase {
    /// The dwells in order.
    pub dwells: Vec<Dwell>,
    /// Time left out at the start of each dwell, s.
    pub settle_s: f64,
    /// Rate of the input axis when the table rests, deg/h.
    pub rest_deg_per_h: f64,
    /// Whether the first and the last dwell are rest, whose mean is the zero of all others.
    pub has_static_zeros: bool,
    /// Whether they were found in a reference: its transitions are no steps, and its zero is not known.
    pub is_found: bool,
}

/// One rate of a staircase.
#[derive(Clone, Debug, PartialEq)]
pub struct Dwell {
    /// Samples that count, settling left out, within the record.
    pub samples: Range<usize>,
    /// Rate the input axis is to have, deg/h.
    pub rate_deg_per_h: f64,
}

/// What a filter, free to adapt, makes of a constant rate added from the first sample on.
#[derive(Clone, Debug, PartialEq)]
pub struct RateGain {
    /// The added rate, deg/s.
    pub rate_deg_per_s: f64,
    /// Response over the added rate in each of equally long blocks of the measured record: mean
    /// output minus that without the rate. Beyond 1 where the weights grow with the rate.
    pub block_gains: Vec<f64>,
    /// Mean output over mean input, both with everything else on the axis, in the same blocks.
    pub block_mean_ratios: Vec<f64>,
}

/// What is known of a filter besides its output.
#[derive(Clone, Debug, PartialEq)]
pub struct FilterFacts {
    /// Samples weighed and aim.
    pub shape: FilterShape,
    /// Response to a small added rate with the weight sequence replayed.
    pub dc_gain: Option<f64>,
    /// The same with the filter free to adapt.
    pub dc_gain_adapted: Option<f64>,
    /// Time mean of every weight over the measured record, newest sample first.
    pub mean_weights: Option<Vec<f64>>,
    /// The same over consecutive blocks of the record; empty where the weights are given.
    pub block_weights: Vec<Vec<f64>>,
    /// DC gain adapted over the same blocks; empty where it is not known.
    pub block_dc_gains_adapted: Vec<f64>,
    /// What it has learned from each stretch of its words, if it is a least-squares filter that
    /// remembers more than a tenth of the record.
    pub learning: Option<Learning>,
    /// Mean weights of runs from its initial state on the same motion and other noise, if these differ
    /// by more than the blocks of the record show; else empty.
    pub weights_of_other_runs: Vec<Vec<f64>>,
    /// How its output differs from that of a run on the same motion and other noise, if it adapts and the
    /// table moves.
    pub two_runs: Option<TwoRuns>,
    /// The added rate, deg/h.
    pub added_rate_deg_per_h: f64,
    /// Gains for constant rates of other sizes; empty where none was asked for.
    pub rate_gains: Vec<RateGain>,
    /// How long after their sample's stamp the outputs appear, s: the latency of a pipeline whose
    /// result is used at once; 0 where a register holds it until the next stamp.
    pub latency_s: f64,
}

/// How the weights of a filter scatter from seed to seed.
#[derive(Clone, Debug)]
pub(crate) enum WeightScatter {
    /// They are given, or forget so soon that the blocks of a record show it.
    Blocks,
    /// They forget nothing, and what they learned is known.
    Learned(LearnedWeights),
    /// They are what noise made of them before the record.
    Runs {
        /// Those of runs on other noise, over a block.
        runs: Vec<Vec<f64>>,
        /// Those of the blocks of the record.
        blocks: Vec<Vec<f64>>,
    },
    /// They forget nothing, and one record does not tell; why.
    Unknown(&'static str),
}

impl WeightScatter {
    /// What each stretch adds to a function of the mean weights.
    pub(crate) fn of(
        &self,
        weights: Option<&[f64]>,
        of: impl Fn(&[f64]) -> f64,
    ) -> Option<Learned> {
        match (self, weights) {
            (Self::Learned(learned), Some(weights)) => Some(learned.scatter(weights, of)),
            (Self::Runs { runs, blocks }, _) => Some(beyond_blocks(runs, blocks, of)),
            _ => None,
        }
    }

    /// The estimate, or its value alone where one record does not tell the scatter of the weights.
    pub(crate) fn unless_unknown(&self, estimate: Estimate) -> Estimate {
        match self {
            Self::Unknown(reason) => Estimate::without_interval(estimate.value, reason),
            _ => estimate,
        }
    }
}

/// Variance of a function of the weights over runs on that over blocks, from which it is told to be greater:
/// of seven runs and ten blocks it is exceeded by chance in one case of thirty.
const RUNS_OVER_BLOCKS: f64 = 4.0;

/// What each of two runs or more adds to the scatter of a function of the weights, a record being one,
/// beyond what differs from block to block, which the blocks themselves tell.
fn beyond_blocks(runs: &[Vec<f64>], blocks: &[Vec<f64>], of: impl Fn(&[f64]) -> f64) -> Learned {
    let values = |weights: &[Vec<f64>]| weights.iter().map(|own| of(own)).collect::<Vec<f64>>();
    let (values, of_blocks) = (values(runs), interval::sample_variance(&values(blocks)));
    let variance = interval::sample_variance(&values);
    let share = if variance > RUNS_OVER_BLOCKS * of_blocks {
        1.0 - of_blocks / variance
    } else {
        0.0
    };
    let mean = interval::mean(&values);
    let freedom = values.len() as f64 - 1.0;
    let scale = (share / freedom).sqrt();
    Learned {
        parts: values.iter().map(|value| (value - mean) * scale).collect(),
        warm_up: runs.len(),
        freedom,
    }
}

impl FilterFacts {
    /// How the weights scatter that the filter has in the mean over a record of so many samples,
    /// from the part `from` of it on.
    pub(crate) fn weight_scatter(&self, samples: usize, from: f64) -> WeightScatter {
        if self.weights_of_other_runs.len() > 1 {
            return WeightScatter::Runs {
                runs: self.weights_of_other_runs.clone(),
                blocks: self.block_weights.clone(),
            };
        }
        if !Learning::is_of(&self.shape, samples) {
            return WeightScatter::Blocks;
        }
        let learned = self.learning.as_ref().and_then(|learning| {
            let stretches = learning.stretches() as f64;
            let first = round_to_count((from * stretches).floor());
            learning.weights_from(first.min(learning.stretches() - 1))
        });
        learned.map_or(
            WeightScatter::Unknown(NOT_FROM_ONE_RECORD),
            WeightScatter::Learned,
        )
    }

    /// Whether the sum of its weights is held at 1 while they adapt.
    pub(crate) fn dc_gain_is_held(&self) -> bool {
        let rule = &self.shape.rule;
        matches!(
            rule,
            WeightRule::Adaptive {
                is_dc_gain_one: true,
                ..
            }
        )
    }

    /// Blocks that a record of this filter is cut into: the stretches in which it learned, if that
    /// is known, else as many as tell how a ratio scatters.
    pub(crate) fn blocks(&self) -> usize {
        let stretches = self.learning.as_ref().map(Learning::stretches);
        stretches.unwrap_or(RATIO_BLOCKS)
    }

    /// The filter frozen: at the mean of its weights, or as given; `None` without weights.
    #[must_use]
    pub fn frozen(&self) -> Option<Prediction> {
        let newest = self.shape.newest_age_samples;
        match (&self.shape.rule, &self.mean_weights) {
            (WeightRule::Sections(sections), _) => {
                Some(Prediction::of_sections(sections.clone(), newest))
            }
            (WeightRule::Fixed(weights), _) | (WeightRule::Adaptive { .. }, Some(weights)) => {
                Some(Prediction::of_weights(weights.clone(), newest))
            }
            (WeightRule::Adaptive { .. }, None) | (WeightRule::Hidden(_), _) => None,
        }
    }

    /// The filter, if its weights are given.
    pub(crate) fn given(&self) -> Option<Prediction> {
        match self.shape.rule {
            WeightRule::Adaptive { .. } => None,
            _ => self.frozen(),
        }
    }

    /// What the filter frozen makes of an impulse, by the age of it, samples; `None` without weights.
    pub(crate) fn response(&self) -> Option<Vec<f64>> {
        let weights = match (&self.shape.rule, &self.mean_weights) {
            (WeightRule::Sections(sections), _) => impulse_response(sections),
            (WeightRule::Fixed(weights), _) | (WeightRule::Adaptive { .. }, Some(weights)) => {
                weights.clone()
            }
            (WeightRule::Adaptive { .. }, None) | (WeightRule::Hidden(_), _) => return None,
        };
        let before = std::iter::repeat_n(0.0, self.shape.newest_age_samples);
        Some(before.chain(weights).collect())
    }

    /// Delay at DC of the filter frozen, samples; 0 where it has none.
    pub(crate) fn delay_at_dc_samples(&self) -> f64 {
        let delay = self.frozen().map(|frozen| frozen.delay_at_dc_samples());
        delay.filter(|delay| delay.is_finite()).unwrap_or(0.0)
    }

    /// Delay at DC of the mean weights, samples: `sum age w / sum w`, the register included; `None`
    /// without weights or DC gain.
    #[must_use]
    pub fn mean_delay_at_dc_samples(&self) -> Option<f64> {
        let weights = self.mean_weights.as_ref()?;
        let newest = self.shape.newest_age_samples;
        let (first_moment, sum) = weights
            .iter()
            .enumerate()
            .fold((0.0, 0.0), |(moment, sum), (tap, weight)| {
                (moment + (newest + tap) as f64 * weight, sum + weight)
            });
        let delay = first_moment / sum;
        delay.is_finite().then_some(delay)
    }
}

/// How to measure.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Motion of the table.
    pub motion: Motion,
    /// Averaging time of the plain `bias_stability_deg_per_h`, s.
    pub bias_averaging_time_s: f64,
    /// Shortest averaging time the noise fit uses, s: longer than the correlation of the channel's
    /// noise (ten samples or some twenty time constants of the loop). What a filter remembers is seen
    /// to by [`measure`](fn@super::measure::measure).
    pub fit_tau_min_s: f64,
    /// Estimator and averaging times of the curve `allan`; the noise is fitted to the overlapping
    /// Allan variance whatever they are.
    pub allan: AllanOptions,
    /// Gaps of the record that Allan differences span; none where its words are all there.
    pub bridges: Vec<Bridge>,
}
