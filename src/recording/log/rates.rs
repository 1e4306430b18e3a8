//! From the numbers of a column to rates, deg/h.

use std::ops::Range;
use std::path::Path;

use super::record::Stretch;
use crate::recording::bounds::{OutOfBounds, check_rate};
use crate::recording::column::Columns;
use crate::recording::error::LogError;
use crate::recording::time::timing::Spacing;
use crate::recording::unit::convert::Conversion;
use crate::recording::unit::kinds::RateUnit;
use crate::wording::plain;

/// Lag-one correlation of words from which on they may be a running angle.
const ANGLE_CORRELATION: f64 = 0.999;
/// Largest lag-one correlation of the steps of an angle whose rate is noise.
const STEP_CORRELATION: f64 = 0.5;
/// Fewest words of which that is asked.
const CORRELATED_MIN: usize = 100;

/// Numbers of a column on their way to words.
pub(super) struct Words<'a> {
    pub(super) path: &'a Path,
    pub(super) columns: &'a Columns,
    pub(super) conversion: Conversion,
    pub(super) spacing: &'a Spacing,
}

impl Words<'_> {
    /// The words of every stretch, a missing one between two, and where they stand.
    pub(super) fn of(&self, mut values: Vec<f64>) -> Result<(Vec<f64>, Vec<Stretch>), LogError> {
        let rows = &self.spacing.stretches;
        if matches!(&rows[..], [all] if *all == (0..values.len()))
            && self.conversion.running.is_none()
        {
            for (row, value) in values.iter_mut().enumerate() {
                *value = self.rate(*value, row)?;
            }
            let stretches = vec![Stretch::of(&values, 0..values.len())];
            return Ok((values, stretches));
        }
        let (mut words, mut stretches) = (Vec::new(), Vec::new());
        for rows in rows {
            let first = words.len() + usize::from(!words.is_empty());
            let taken = self.taken(&values, rows)?;
            if taken.is_empty() {
                continue;
            }
            if first > words.len() {
                words.push(f64::NAN);
            }
            words.extend(taken);
            stretches.push(Stretch::of(&words, first..words.len()));
        }
        Ok((words, stretches))
    }

    /// The words of some rows: one less of a running angle.
    fn taken(&self, values: &[f64], rows: &Range<usize>) -> Result<Vec<f64>, LogError> {
        let numbers = &values[rows.clone()];
        let Some(angle) = self.conversion.running else {
            let words = numbers.iter().zip(rows.clone());
            return words.map(|(number, row)| self.rate(*number, row)).collect();
        };
        let turn = angle.turn() / self.conversion.scale.abs();
        let turns_over = is_within_turn(values, turn);
        let steps = numbers.windows(2).zip(rows.clone().skip(1));
        let words = steps.map(|(pair, row)| {
            let step = pair[1] - pair[0];
            let step = match turns_over && step.abs() > 0.5 * turn {
                true => step - turn * step.signum(),
                false => step,
            };
            self.rate(step, row)
        });
        words.collect()
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
pub(super) fn angle_remark(values: &[f64], conversion: &Conversion) -> Option<String> {
    if conversion.running.is_some() || values.len() < CORRELATED_MIN {
        return None;
    }
    let steps = values.windows(2).map(|pair| pair[1] - pair[0]);
    let (words, steps) = (lag_one(values.iter().copied())?, lag_one(steps)?);
    (words > ANGLE_CORRELATION && steps.abs() < STEP_CORRELATION).then(|| {
        format!(
            "each number follows the one before it (correlation {}) and the steps do not: this may be a \
             running angle rather than a rate; --kind angle with a unit of angle takes it for one",
            plain((words * 1e6).round() / 1e6)
        )
    })
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
