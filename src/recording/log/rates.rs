//! From the numbers of a column to rates, deg/h.

use std::borrow::Cow;
use std::ops::Range;
use std::path::Path;

use rayon::prelude::*;

use super::record::Stretch;
use crate::recording::bounds::{OutOfBounds, check_rate};
use crate::recording::column::Columns;
use crate::recording::error::LogError;
use crate::recording::time::timing::Spacing;
use crate::recording::unit::convert::Conversion;
use crate::recording::unit::kinds::{AngleUnit, RateUnit};
use crate::signal::Bridge;
use crate::wording::plain;

/// Lag-one correlation of words from which on they may be a running angle.
const ANGLE_CORRELATION: f64 = 0.999;
/// Largest lag-one correlation of the steps of an angle whose rate is noise.
const STEP_CORRELATION: f64 = 0.5;
/// Words on either side of a gap whose mean is taken for that over the gap, if it is no longer itself.
const BESIDE_MIN: usize = 8;
/// Fewest words of which that is asked.
const CORRELATED_MIN: usize = 100;
/// Numbers that one thread turns into rates at a time.
const PART: usize = 1 << 16;

/// Numbers of a column on their way to words.
pub(super) struct Words<'a> {
    pub(super) path: &'a Path,
    pub(super) columns: &'a Columns,
    pub(super) conversion: Conversion,
    pub(super) spacing: &'a Spacing,
    /// Most samples of a gap that differences span.
    pub(super) gap_aware: usize,
}

/// Words, and what is missing between them.
#[derive(Default)]
pub(super) struct Taken {
    /// Rates, deg/h; NaN where one is missing.
    pub(super) words: Vec<f64>,
    pub(super) stretches: Vec<Stretch>,
    pub(super) bridges: Vec<Bridge>,
}

/// Numbers of some rows on the grid of the samples: NaN where one is missing.
struct Grid<'a> {
    numbers: Cow<'a, [f64]>,
    rows: &'a Range<usize>,
    spanned: &'a [(usize, usize)],
}

impl Grid<'_> {
    /// Row of a number, that behind it where it is missing.
    fn row(&self, index: usize) -> usize {
        let mut row = self.rows.start + index;
        for (behind, missing) in self.spanned {
            if row >= behind + missing {
                row -= missing;
            } else if row > *behind {
                row = *behind;
            }
        }
        row
    }
}

impl Words<'_> {
    /// The words of every stretch, a missing one between two, and where they stand.
    pub(super) fn of(&self, mut values: Vec<f64>) -> Result<Taken, LogError> {
        let rows = &self.spacing.stretches;
        if matches!(&rows[..], [all] if *all == (0..values.len()))
            && self.conversion.running.is_none()
            && self.spacing.spanned.is_empty()
        {
            self.to_rates(&mut values)?;
            return Ok(Taken {
                stretches: vec![Stretch::of(&values, 0..values.len())],
                bridges: self.assumed(&values, 0),
                words: values,
            });
        }
        let mut all = Taken::default();
        for rows in rows {
            let first = all.words.len() + usize::from(!all.words.is_empty());
            let grid = self.grid(&values, rows);
            let (taken, bridges) = match self.conversion.running {
                Some(angle) => self.of_angle(&grid, angle, &values, first)?,
                None => {
                    let words = grid.numbers.iter().enumerate();
                    let words = words.map(|(index, number)| self.rate(*number, grid.row(index)));
                    let words = words.collect::<Result<Vec<f64>, _>>()?;
                    let bridges = self.assumed(&words, first);
                    (words, bridges)
                }
            };
            if taken.is_empty() {
                continue;
            }
            if first > all.words.len() {
                all.words.push(f64::NAN);
            }
            all.words.extend(taken);
            all.bridges.extend(bridges);
            all.stretches
                .push(Stretch::of(&all.words, first..all.words.len()));
        }
        Ok(all)
    }

    /// Makes rates of the numbers of all rows.
    fn to_rates(&self, values: &mut [f64]) -> Result<(), LogError> {
        let parts = values.par_chunks_mut(PART).enumerate();
        let parts = parts.map(|(index, values)| {
            let mut rows = (index * PART..).zip(values);
            rows.try_for_each(|(row, value)| {
                *value = self.rate(*value, row)?;
                Ok(())
            })
        });
        let parts: Vec<Result<(), LogError>> = parts.collect();
        // The first complaint of the file, whichever thread was first.
        parts.into_iter().collect()
    }

    /// Some rows with the samples that are missing between them.
    fn grid<'a>(&'a self, values: &'a [f64], rows: &'a Range<usize>) -> Grid<'a> {
        let all = &self.spacing.spanned;
        let from = all.partition_point(|(row, _)| *row <= rows.start);
        let end = all.partition_point(|(row, _)| *row < rows.end);
        let spanned = &all[from..end];
        let mut numbers = Cow::Borrowed(&values[rows.clone()]);
        if !spanned.is_empty() {
            let mut first = rows.start;
            let mut filled = Vec::new();
            for (row, missing) in spanned {
                filled.extend_from_slice(&values[first..*row]);
                filled.resize(filled.len() + missing, f64::NAN);
                first = *row;
            }
            filled.extend_from_slice(&values[first..rows.end]);
            numbers = Cow::Owned(filled);
        }
        Grid {
            numbers,
            rows,
            spanned,
        }
    }

    /// The words of an angle that runs on, one less than it has numbers, and the gaps that are spanned: over
    /// these the mean rate is known.
    fn of_angle(
        &self,
        grid: &Grid<'_>,
        angle: AngleUnit,
        values: &[f64],
        first: usize,
    ) -> Result<(Vec<f64>, Vec<Bridge>), LogError> {
        let turn = angle.turn() / self.conversion.scale.abs();
        let turns_over = is_within_turn(values, turn);
        let turned = |step: f64| match turns_over && step.abs() > 0.5 * turn {
            true => step - turn * step.signum(),
            false => step,
        };
        let numbers = &grid.numbers;
        let steps = numbers.windows(2).enumerate();
        let words =
            steps.map(|(index, pair)| self.rate(turned(pair[1] - pair[0]), grid.row(index + 1)));
        let words = words.collect::<Result<Vec<f64>, _>>()?;
        let mut bridges = Vec::new();
        for gap in inner_gaps(numbers, self.gap_aware) {
            let step = turned(numbers[gap.end] - numbers[gap.start - 1]);
            let mean = step / as_float(gap.len() + 1);
            bridges.push(Bridge {
                words: first + gap.start - 1..first + gap.end,
                mean_deg_per_h: self.rate(mean, grid.row(gap.end))?,
                is_known: true,
            });
        }
        Ok((words, bridges))
    }

    /// The gaps between words that are spanned, with the mean of words on both sides.
    fn assumed(&self, words: &[f64], first: usize) -> Vec<Bridge> {
        let gaps = inner_gaps(words, self.gap_aware).into_iter();
        let bridges = gaps.map(|gap| {
            let reach = gap.len().max(BESIDE_MIN);
            let present = |word: &&f64| !word.is_nan();
            let before = words[..gap.start].iter().rev().take(reach).filter(present);
            let behind = words[gap.end..].iter().take(reach).filter(present);
            let both = before.chain(behind);
            let (sum, count) =
                both.fold((0.0, 0.0), |(sum, count), word| (sum + word, count + 1.0));
            Bridge {
                words: first + gap.start..first + gap.end,
                mean_deg_per_h: sum / count,
                is_known: false,
            }
        });
        bridges.collect()
    }

    /// The rate of a number, deg/h.
    fn rate(&self, number: f64, row: usize) -> Result<f64, LogError> {
        rate_of(&self.conversion, self.spacing.sample_rate_hz, number)
            .map_err(|error| LogError::at(self.path, self.columns.place(row), error))
    }
}

/// The rate of a number, deg/h; that of a missing one is missing.
///
/// # Errors
/// One that no gyro has.
pub(super) fn rate_of(
    conversion: &Conversion,
    sample_rate_hz: f64,
    number: f64,
) -> Result<f64, RateError> {
    let rate = conversion.rate_deg_per_h(number, sample_rate_hz);
    match check_rate(rate) {
        Ok(()) => Ok(rate),
        Err(_) if number.is_nan() => Ok(number),
        Err(bounds) => Err(RateError {
            number,
            unit: conversion.unit,
            bounds: rate.is_finite().then_some(bounds),
        }),
    }
}

/// A number whose rate no gyro has.
#[derive(Debug, thiserror::Error)]
#[error("{number:?} {unit}{}", .bounds.as_ref().map_or_else(
    || " is not a finite rate in deg/h".to_owned(),
    |bounds| format!(": {bounds}")
))]
pub(super) struct RateError {
    number: f64,
    unit: RateUnit,
    bounds: Option<OutOfBounds>,
}

/// Runs of missing numbers, so many at most, with numbers on both sides.
fn inner_gaps(numbers: &[f64], most: usize) -> Vec<Range<usize>> {
    let mut gaps: Vec<Range<usize>> = Vec::new();
    if most == 0 {
        return gaps;
    }
    for (index, _) in numbers.iter().enumerate().filter(|(_, it)| it.is_nan()) {
        match gaps.last_mut() {
            Some(gap) if gap.end == index => gap.end += 1,
            _ => gaps.push(index..index + 1),
        }
    }
    gaps.retain(|gap| gap.len() <= most && gap.start > 0 && gap.end < numbers.len());
    gaps
}

#[expect(
    clippy::cast_precision_loss,
    reason = "sample counts are far below 2^53"
)]
fn as_float(count: usize) -> f64 {
    count as f64
}

/// Whether all angles lie within one turn, as those of an encoder do.
fn is_within_turn(angles: &[f64], turn: f64) -> bool {
    let present = angles.iter().filter(|angle| !angle.is_nan());
    let (least, most) = present.fold(
        (f64::INFINITY, f64::NEG_INFINITY),
        |(least, most), angle| (least.min(*angle), most.max(*angle)),
    );
    most - least <= turn
}

/// What is said of numbers that were called rates and look like an angle that runs on.
pub(super) fn angle_remark(neighbours: Neighbours, conversion: &Conversion) -> Option<String> {
    if conversion.running.is_some() {
        return None;
    }
    let Neighbours { words, steps } = neighbours;
    let (words, steps) = (words?, steps?);
    (words > ANGLE_CORRELATION && steps.abs() < STEP_CORRELATION).then(|| {
        format!(
            "each number follows the one before it (correlation {}) and the steps do not: this may be a \
             running angle rather than a rate; --kind angle with a unit of angle takes it for one",
            plain((words * 1e6).round() / 1e6)
        )
    })
}

/// Correlations of neighbours; nothing of a few numbers, and of those that do not vary.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Neighbours {
    words: Option<f64>,
    /// Of the steps from each number to the next.
    steps: Option<f64>,
}

impl Neighbours {
    pub(super) fn of(values: &[f64]) -> Self {
        if values.len() < CORRELATED_MIN {
            return Self::default();
        }
        let steps = values.windows(2).map(|pair| pair[1] - pair[0]);
        Self {
            words: lag_one(values.iter().copied()),
            steps: lag_one(steps),
        }
    }
}

/// Correlation of neighbours about the mean; nothing of numbers that do not vary.
fn lag_one(values: impl Iterator<Item = f64> + Clone) -> Option<f64> {
    let (sum, count) = values
        .clone()
        .fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    let mean = sum / count;
    let square: f64 = values.clone().map(|value| (value - mean).powi(2)).sum();
    // By the steps, as the ends of an angle that runs on are far from its mean.
    let pairs = values.clone().zip(values.skip(1));
    let steps: f64 = pairs.map(|(one, next)| (next - one).powi(2)).sum();
    (square > 0.0).then(|| 1.0 - 0.5 * steps / square)
}
