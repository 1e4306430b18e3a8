//! Sums of squared second differences of a whole record without an array of its angles.
//!
//! The angles of a long record are as large as the record itself, and a fresh page of memory costs
//! more than what is computed with it. Here they exist in pieces that fit into a cache.

use rayon::prelude::*;

use super::walk::second_difference_sums_by_walking;
use super::{
    BLOCK, CELL, PART, add, add_squares, integrate, mean_rate, squared_second_differences,
};

/// From this averaging factor on the angles of a part would be a small share of what it needs.
const FAR: usize = 1 << 15;

/// Angles that a pass over all far averaging times keeps in the cache, 512 kB.
const FAR_CACHE: usize = 1 << 16;

/// Sum of squared second differences of the angle for every averaging factor, each below half the
/// samples. As [`second_difference_sums`] of [`angle_about_mean`], to rounding.
///
/// Short averaging times see the record part by part, with the angles from the part's start on; the
/// origin of an angle cancels in its differences. Far ones that are multiples of the shortest of
/// them, m0, and of [`CELL`] see it column by column: the angles at k, k + m0, k + 2 m0, ... serve all
/// of them. Records without such a set of factors are walked along.
pub(crate) fn second_difference_sums_of_record(rates: &[f64], factors: &[usize]) -> Vec<f64> {
    let far: Vec<usize> = factors.iter().copied().filter(|&m| m >= FAR).collect();
    let spacing = far.iter().copied().min().unwrap_or(rates.len() + 1);
    let rows = (rates.len() + 1).div_ceil(spacing);
    let width = FAR_CACHE / rows / CELL * CELL;
    let fits = spacing.is_multiple_of(CELL) && far.iter().all(|m| m.is_multiple_of(spacing));
    if !far.is_empty() && (!fits || width == 0) {
        return second_difference_sums_by_walking(rates, factors);
    }
    let mean = mean_rate(rates);
    let near: Vec<usize> = factors.iter().copied().filter(|&m| m < FAR).collect();
    let starts: Vec<usize> = (0..=rates.len()).step_by(PART).collect();
    let parts: Vec<Part> = starts
        .into_par_iter()
        .map_init(Vec::new, |angle, start| {
            short_times(rates, start, mean, &near, angle)
        })
        .collect();
    // Angles at the cells, in the order of the parts, whichever thread was first.
    let mut cells = Vec::with_capacity(rates.len() / CELL + 1);
    let mut origin = 0.0;
    let mut near_sums = vec![0.0; near.len()];
    for part in parts {
        cells.extend(part.cells.iter().map(|angle| origin + angle));
        origin += part.end;
        add(&mut near_sums, &part.sums);
    }
    let columns: Vec<usize> = if far.is_empty() {
        Vec::new()
    } else {
        (0..spacing).step_by(width).collect()
    };
    let of_columns: Vec<Vec<f64>> = columns
        .into_par_iter()
        .map_init(Vec::new, |angle, column| {
            let columns = column..(column + width).min(spacing);
            far_times(rates, mean, &cells, (spacing, columns), &far, angle)
        })
        .collect();
    let mut far_sums = vec![0.0; far.len()];
    for sums in of_columns {
        add(&mut far_sums, &sums);
    }
    let (mut near_sums, mut far_sums) = (near_sums.into_iter(), far_sums.into_iter());
    let mut next = |m: usize| {
        if m < FAR {
            near_sums.next()
        } else {
            far_sums.next()
        }
    };
    factors.iter().map(|&m| next(m).unwrap_or(0.0)).collect()
}

/// What one part of the record gives.
struct Part {
    /// Sums of the short averaging times whose differences start in it.
    sums: Vec<f64>,
    /// Angles at its cells from its start on.
    cells: Vec<f64>,
    /// Angle at its end from its start on.
    end: f64,
}

/// Appends the angles behind `sum` after each of the rates.
fn append(rates: &[f64], mean: f64, sum: f64, angle: &mut Vec<f64>) {
    let before = angle.len();
    angle.resize(before + rates.len(), 0.0);
    integrate(rates, mean, sum, &mut angle[before..]);
}

fn short_times(
    rates: &[f64],
    start: usize,
    mean: f64,
    factors: &[usize],
    angle: &mut Vec<f64>,
) -> Part {
    let reach = 2 * factors.iter().copied().max().unwrap_or(0);
    let end = (start + PART + reach).min(rates.len());
    angle.clear();
    angle.push(0.0);
    append(&rates[start..end], mean, 0.0, angle);
    let mut sums = vec![0.0; factors.len()];
    for first in (0..PART).step_by(BLOCK) {
        add_squares(&mut sums, factors, angle, (first, first + BLOCK));
    }
    let own = PART.min(rates.len() - start);
    Part {
        sums,
        cells: angle[..=own.min(PART - 1)]
            .iter()
            .copied()
            .step_by(CELL)
            .collect(),
        end: angle[own],
    }
}

fn far_times(
    rates: &[f64],
    mean: f64,
    cells: &[f64],
    (spacing, columns): (usize, std::ops::Range<usize>),
    factors: &[usize],
    angle: &mut Vec<f64>,
) -> Vec<f64> {
    let width = columns.len();
    angle.clear();
    for row in (columns.start..=rates.len()).step_by(spacing) {
        let first = cells[row / CELL];
        angle.push(first);
        let last = (row + width - 1).min(rates.len());
        append(&rates[row..last], mean, first, angle);
    }
    let of_factor = |&m: &usize| {
        // Rows but the last are whole, so that the angles of a row one tau on are m / spacing rows
        // further.
        let shift = m / spacing * width;
        let count = angle.len().saturating_sub(2 * shift);
        let starts = (0..count).step_by(BLOCK);
        starts
            .map(|first| {
                let last = (first + BLOCK).min(count);
                squared_second_differences(
                    &angle[first..last],
                    &angle[first + shift..last + shift],
                    &angle[first + 2 * shift..last + 2 * shift],
                )
            })
            .sum()
    };
    factors.iter().map(of_factor).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{angle_about_mean, second_difference_sums};
    use super::*;

    #[test]
    fn parts_and_columns_agree_with_the_sums_of_the_angles() {
        let longest: Vec<f64> = (0..7 * FAR + 77)
            .map(|k| 15.0 + ((k * k) % 1013) as f64)
            .collect();
        // Ends before, at and behind a part's and a row's, and a record shorter than a part.
        for samples in [300, PART - 1, PART, 2 * PART + 1, 7 * FAR - 1, 7 * FAR + 77] {
            let rates = &longest[..samples];
            let angle = angle_about_mean(rates);
            for factors in [
                &[1, 2, 3, 100][..],
                &[1, 9001, FAR, 2 * FAR, 3 * FAR],
                &[FAR, FAR + 5, 2 * FAR],
                &[2 * FAR],
            ] {
                let factors: Vec<usize> = factors
                    .iter()
                    .copied()
                    .filter(|m| 2 * m <= samples)
                    .collect();
                let wanted = second_difference_sums(&angle, &factors);
                let found = second_difference_sums_of_record(rates, &factors);
                for ((found, wanted), m) in found.iter().zip(wanted).zip(&factors) {
                    let ratio = found / wanted;
                    assert!((ratio - 1.0).abs() < 1e-11, "{samples} {m}: {ratio}");
                }
            }
        }
    }
}
