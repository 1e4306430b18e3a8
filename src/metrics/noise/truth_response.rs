//! What a channel shows of the true rate, taken out by regression, so that noise alone is left.

use nalgebra::{DMatrix, DVector};

use crate::linear_algebra::singular_value_decomposition;
use crate::metrics::estimate::interval;
use crate::metrics::record::{FilterFacts, Record};
use crate::metrics::theory::memory::{cascade, memory_samples};
use crate::signal::{Rates, WeightRule};

/// Shifted copies of a series that the regression weighs, at most.
const COLUMNS: usize = 16;

/// Lags, at least, that the response of a gyro spans, samples.
const GYRO_LAGS: usize = 15;

/// Lags, at most.
const LAGS_MAX: usize = 120;

/// Part of the channel's own scatter below which the motion's is left alone.
const NEGLIGIBLE: f64 = 1e-6;

/// Part of a rate within which it stands still but for rounding.
const STILL: f64 = 1e-9;

/// Eigenvalues below this part of the largest count as zero: a slow motion makes its shifted copies
/// nearly alike.
const RANK_TOLERANCE: f64 = 1e-11;

/// A series in which a channel shows the true rate, and the copies of it that span what it shows.
pub(crate) struct Shown {
    /// One value a sample, deg/h.
    pub(crate) series: Vec<f64>,
    /// Samples by which the copies are late.
    offsets: Vec<isize>,
}

/// What a channel shows of the true rate; `None` where that is not known.
///
/// * Where the answer of the gyro to the motion is known, raw shows that, and a filter of given weights
///   what it makes of it. The copies next to it take up what a linear model of the gyro leaves out.
/// * Weights that adapt, or are hidden, show the answer of the gyro at the ages that they weigh, by
///   their mean.
/// * Else the truth itself is taken, at lags that span any smooth response.
pub(crate) fn shown(record: &Record, filter: Option<&FilterFacts>) -> Option<Shown> {
    let of_gyro = record.response_deg_per_h;
    let samples = record.channel_deg_per_h.len();
    if of_gyro.is_empty() {
        let stride = reach(filter).div_ceil(COLUMNS - 1).max(1);
        return Some(Shown {
            series: record.truth()?.words().into_owned(),
            offsets: spaced(0, stride, COLUMNS),
        });
    }
    let lead = of_gyro.len() - samples;
    let plain = || of_gyro[lead..].to_vec();
    let beside = vec![-1, 0, 1];
    let Some(facts) = filter else {
        return Some(Shown {
            series: plain(),
            offsets: beside,
        });
    };
    let newest = facts.shape.newest_age_samples;
    Some(match &facts.shape.rule {
        WeightRule::Adaptive { .. } | WeightRule::Hidden(_) => {
            let taps = memory_samples(&facts.shape).clamp(1, LAGS_MAX);
            let stride = (taps + 2).div_ceil(COLUMNS).max(1);
            let first = isize::try_from(newest).unwrap_or(0) - 1;
            Shown {
                series: plain(),
                offsets: spaced(first, stride, (taps + 2).div_ceil(stride)),
            }
        }
        WeightRule::Fixed(weights) => Shown {
            series: (lead..of_gyro.len())
                .map(|now| {
                    let ages = weights.iter().zip(newest..);
                    ages.map(|(weight, age)| weight * of_gyro[now.saturating_sub(age)])
                        .sum()
                })
                .collect(),
            offsets: beside,
        },
        WeightRule::Sections(sections) => {
            let answer = cascade(sections, of_gyro.iter().copied());
            Shown {
                series: (lead..of_gyro.len())
                    .map(|now| answer[now.saturating_sub(newest)])
                    .collect(),
                offsets: beside,
            }
        }
    })
}

/// Samples of the truth that reach an output: those of the gyro, and the taps of a filter.
fn reach(filter: Option<&FilterFacts>) -> usize {
    let of_filter = filter.map_or(0, |facts| {
        facts.shape.newest_age_samples + facts.shape.taps.unwrap_or(GYRO_LAGS)
    });
    (GYRO_LAGS + of_filter).min(LAGS_MAX)
}

/// What a gyro's words show of its motion, the mean of the words included.
///
/// * `response`: its answer to the motion without noise, one value a word, where that is known.
/// * `truth`: the true rate, whose lagged copies are taken else.
#[must_use]
pub fn known_motion(words: &[f64], response: Option<&[f64]>, truth: &[f64]) -> Vec<f64> {
    let about = |series: &[f64]| -> Vec<f64> {
        let mean = interval::mean(series);
        series.iter().map(|rate| rate - mean).collect()
    };
    let mut noise = about(words);
    let (motion, offsets) = match response.filter(|answer| answer.len() == words.len()) {
        Some(answer) => (answer, vec![-1, 0, 1]),
        None => (truth, spaced(0, 1, COLUMNS)),
    };
    let shown = Shown {
        series: about(motion),
        offsets,
    };
    shown.remove_from(&mut noise, &shown.series);
    words
        .iter()
        .zip(noise)
        .map(|(word, noise)| word - noise)
        .collect()
}

/// So many offsets from the first on.
fn spaced(first: isize, stride: usize, count: usize) -> Vec<isize> {
    let stride = isize::try_from(stride).unwrap_or(1);
    (0..).take(count).map(|k| first + stride * k).collect()
}

impl Shown {
    /// Takes out of `values` what the copies of `motion` explain: this series about the same fit or mean
    /// as the values.
    ///
    /// The harmonics that friction puts into a table's swing, its unsteadiness, cogging and the Earth's
    /// rate on an axis that turns are no noise of the gyro. The least-squares weights of least norm are
    /// taken. Values are left alone where the motion hardly scatters. Where no weights can be found
    /// (squares beyond binary64) nothing is left of the values, so that no metric rests on them.
    /// Source: derived (linear regression on shifted inputs).
    pub(crate) fn remove_from(&self, values: &mut [f64], motion: &[f64]) {
        let power = |series: &[f64]| series.iter().map(|value| value * value).sum::<f64>();
        let (own, of_motion) = (power(values), power(motion));
        if of_motion <= NEGLIGIBLE * NEGLIGIBLE * own || values.len() < 10 * COLUMNS {
            return;
        }
        let columns = self.offsets.len();
        let last = motion.len() - 1;
        let fill = |index: usize, copies: &mut [f64; COLUMNS]| {
            for (copy, offset) in copies.iter_mut().zip(&self.offsets) {
                let place = index.saturating_add_signed(-offset).min(last);
                *copy = motion[place];
            }
        };
        let mut normal = [[0.0; COLUMNS]; COLUMNS];
        let mut right = [0.0; COLUMNS];
        let mut copies = [0.0; COLUMNS];
        for (index, value) in values.iter().enumerate() {
            fill(index, &mut copies);
            let copies = &copies[..columns];
            for (row, own) in normal.iter_mut().zip(copies) {
                for (entry, other) in row.iter_mut().zip(copies) {
                    *entry += own * other;
                }
            }
            for (entry, own) in right.iter_mut().zip(copies) {
                *entry += own * value;
            }
        }
        let matrix = DMatrix::from_fn(columns, columns, |row, column| normal[row][column]);
        let solved = singular_value_decomposition(matrix, true, true).and_then(|decomposition| {
            let cutoff = RANK_TOLERANCE * decomposition.singular_values.max();
            let right = DVector::from_row_slice(&right[..columns]);
            decomposition.solve(&right, cutoff).ok()
        });
        let Some(weights) = solved else {
            values.fill(f64::NAN);
            return;
        };
        for (index, value) in values.iter_mut().enumerate() {
            fill(index, &mut copies);
            let explained: f64 = weights.iter().zip(&copies).map(|(w, x)| w * x).sum();
            *value -= explained;
        }
    }

    /// Takes what is shown out of a stretch of the channel, both about their means there; the mean of
    /// the stretch stays.
    pub(crate) fn remove_from_stretch(&self, values: &[f64], start: usize) -> Vec<f64> {
        let series = &self.series[start..];
        let middle = interval::mean(series);
        let about: Vec<f64> = series.iter().map(|rate| rate - middle).collect();
        let level = interval::mean(values);
        let mut left: Vec<f64> = values.iter().map(|value| value - level).collect();
        self.remove_from(&mut left, &about);
        let shift = level - interval::mean(&left);
        left.iter().map(|value| value + shift).collect()
    }
}

/// Whether the true rate changes from sample `start` on.
pub(crate) fn moves(record: &Record, start: usize) -> bool {
    let stretch = record.truth_deg_per_h.from(start);
    let Rates::Words([first, rest @ ..]) = stretch else {
        return false;
    };
    rest.iter()
        .any(|rate| (rate - first).abs() > STILL * first.abs())
}

/// Channel and raw from sample `start` on without what they show of a truth that varies there; `None`
/// where it does not. The means stay.
pub(crate) fn without_motion(
    record: &Record,
    start: usize,
    filter: Option<&FilterFacts>,
) -> Option<(Vec<f64>, Vec<f64>)> {
    if !moves(record, start) {
        return None;
    }
    let raw_shown = shown(record, None)?;
    let raw = raw_shown.remove_from_stretch(&record.raw_deg_per_h[start..], start);
    let channel = match filter {
        Some(_) => {
            let own = shown(record, filter)?;
            own.remove_from_stretch(&record.channel_deg_per_h[start..], start)
        }
        None => raw.clone(),
    };
    Some((channel, raw))
}
