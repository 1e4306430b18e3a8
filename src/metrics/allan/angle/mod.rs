//! The angle of a record of rates and the sums of its squared second differences.
//!
//! Work is cut into parts of fixed size and summed in their order: the number of threads leaves no
//! trace in the result.

pub(crate) mod sums;
mod walk;

use rayon::prelude::*;

use crate::simd::{LANES, Lanes, Simd, with_wide_vectors};

/// Samples that one thread integrates at a time.
const PART: usize = 1 << 16;

/// Second differences handled per pass over the cache: every tau visits a block before the next
/// block is read, so that short ones read memory once altogether.
const BLOCK: usize = 2048;

/// Angle about the mean rate, `[n + 1]`, in units of (deg/h) times one sample period, from zero on.
///
/// The mean cancels in every second difference; leaving it out keeps the digits of the rest. A
/// missing sample (NaN) counts as the mean, so that it adds nothing.
pub(crate) fn angle_about_mean(rate_deg_per_h: &[f64]) -> Vec<f64> {
    let (mean, starts) = starts_of_parts(rate_deg_per_h);
    let mut angle = vec![0.0; rate_deg_per_h.len() + 1];
    angle[1..]
        .par_chunks_mut(PART)
        .zip(rate_deg_per_h.par_chunks(PART))
        .zip(starts)
        .for_each(|((angles, rates), start)| integrate(rates, mean, start, angles));
    angle
}

/// Those of the same angles that lie at multiples of an averaging factor, 0 included, for each factor.
///
/// * `mean`, `starts`: of the record, by [`starts_of_parts`].
/// * `blocks`: most multiples that are wanted beside 0.
///
/// All angles of a long record are as large as the record itself: here they exist part by part.
pub(crate) fn angles_at_multiples(
    rates: &[f64],
    (mean, starts): (f64, &[f64]),
    factors: &[usize],
    blocks: usize,
) -> Vec<Vec<f64>> {
    let parts = rates.par_chunks(PART).zip(starts).enumerate();
    let found: Vec<Vec<Vec<f64>>> = parts
        .map_init(
            || vec![0.0; PART],
            |angle, (part, (rates, start))| {
                let angle = &mut angle[..rates.len()];
                integrate(rates, mean, *start, angle);
                // Behind the first rate of the part stands the angle of index `before + 1`.
                let before = part * PART;
                let of_factor = |&m: &usize| -> Vec<f64> {
                    let first = (before / m + 1) * m;
                    let last = (before + angle.len()).min(m.saturating_mul(blocks));
                    let multiples = (first..=last).step_by(m);
                    multiples.map(|index| angle[index - before - 1]).collect()
                };
                factors.iter().map(of_factor).collect()
            },
        )
        .collect();
    let of_factor = |at: usize| {
        let parts = found.iter().map(|part| part[at].as_slice());
        let parts: Vec<&[f64]> = std::iter::once(&[0.0][..]).chain(parts).collect();
        parts.concat()
    };
    (0..factors.len()).map(of_factor).collect()
}

/// Mean rate, and the angle about it at the start of every part.
pub(crate) fn starts_of_parts(rates: &[f64]) -> (f64, Vec<f64>) {
    let (near, sums) = sums_of_parts(rates);
    let rest = rest_of_mean(&sums);
    let mut starts = Vec::with_capacity(sums.len());
    let mut start = 0.0;
    for (sum, present) in &sums {
        starts.push(start);
        start += sum - *present as f64 * rest;
    }
    (near + rest, starts)
}

/// Samples from one known angle to the next, where not all of them are held.
const CELL: usize = 128;

/// The angles behind `sum` after each rate of a part.
fn integrate(rates: &[f64], mean: f64, mut sum: f64, angles: &mut [f64]) {
    for (angle, rate) in angles.iter_mut().zip(rates) {
        let step = rate - mean;
        sum += if step.is_nan() { 0.0 } else { step };
        *angle = sum;
    }
}

/// Adds the sums of a part to those of the parts before it.
fn add(sums: &mut [f64], more: &[f64]) {
    for (sum, more) in sums.iter_mut().zip(more) {
        *sum += more;
    }
}

/// A rate near the mean, and sums about it of every part with the number of rates in it: they do not
/// cancel against the mean.
fn sums_of_parts(rates: &[f64]) -> (f64, Vec<(f64, usize)>) {
    let near = rates.iter().find(|rate| !rate.is_nan());
    let near = near.copied().unwrap_or(0.0);
    let parts = rates.par_chunks(PART);
    (near, parts.map(|part| sum_about(part, near)).collect())
}

/// Mean of all parts about the rate that their sums are about.
fn rest_of_mean(sums: &[(f64, usize)]) -> f64 {
    let present: usize = sums.iter().map(|(_, present)| present).sum();
    sums.iter().map(|(sum, _)| sum).sum::<f64>() / present.max(1) as f64
}

/// Mean rate; missing samples (NaN) are left out.
pub(crate) fn mean_rate(rates: &[f64]) -> f64 {
    let (near, sums) = sums_of_parts(rates);
    near + rest_of_mean(&sums)
}

/// Sum of the rates about one of them in eight interleaved sums, and the number there is.
fn sum_about(rates: &[f64], near: f64) -> (f64, usize) {
    const LANES: usize = 8;
    let mut lanes = [0.0; LANES];
    let (chunks, rest) = rates.as_chunks::<LANES>();
    for chunk in chunks {
        for lane in 0..LANES {
            lanes[lane] += chunk[lane] - near;
        }
    }
    let sum = lanes.iter().sum::<f64>() + rest.iter().map(|rate| rate - near).sum::<f64>();
    if !sum.is_nan() {
        return (sum, rates.len());
    }
    let present = rates.iter().filter(|rate| !rate.is_nan());
    present.fold((0.0, 0), |(sum, count), rate| {
        (sum + (rate - near), count + 1)
    })
}

/// Sum of squared second differences `x[k+2m] - 2x[k+m] + x[k]` of an array for every averaging factor m,
/// part by part: what all that goes without the array is held against.
#[cfg(test)]
pub(crate) fn second_difference_sums(angle: &[f64], factors: &[usize]) -> Vec<f64> {
    let mut sums = vec![0.0; factors.len()];
    for first in (0..angle.len()).step_by(PART) {
        let mut part = vec![0.0; factors.len()];
        for start in (first..angle.len().min(first + PART)).step_by(BLOCK) {
            add_squares(&mut part, factors, angle, (start, start + BLOCK));
        }
        add(&mut sums, &part);
    }
    sums
}

/// Averaging factors whose sums are taken side by side, so that none waits for the addition of another.
const SIDE_BY_SIDE: usize = 4;

/// Adds the squared second differences that start from `first` on and before `end`, as far as there
/// are such, to the sum of each averaging factor.
pub(crate) fn add_squares(
    sums: &mut [f64],
    factors: &[usize],
    angle: &[f64],
    (first, end): (usize, usize),
) {
    with_wide_vectors!(simd => {
        let sums = sums.chunks_mut(SIDE_BY_SIDE);
        for (sums, factors) in sums.zip(factors.chunks(SIDE_BY_SIDE)) {
            add_squares_of_few(simd, sums, factors, angle, (first, end));
        }
    });
}

#[inline(always)]
fn add_squares_of_few<S: Simd>(
    simd: S,
    sums: &mut [f64],
    factors: &[usize],
    angle: &[f64],
    (first, end): (usize, usize),
) {
    let last = |m: usize| end.min(angle.len().saturating_sub(2 * m));
    if let Ok(few) = <[usize; SIDE_BY_SIDE]>::try_from(factors)
        && few.iter().all(|&m| last(m) == end)
    {
        let squares = squares_in_lanes(simd, few.map(|m| differing(angle, first, end, m)));
        for (sum, squares) in sums.iter_mut().zip(squares) {
            *sum += squares;
        }
        return;
    }
    for (sum, &m) in sums.iter_mut().zip(factors) {
        if first < last(m) {
            let [squares] = squares_in_lanes(simd, [differing(angle, first, last(m), m)]);
            *sum += squares;
        }
    }
}

/// The three angles of the second differences that start in a range.
#[inline(always)]
fn differing(angle: &[f64], first: usize, last: usize, m: usize) -> [&[f64]; 3] {
    [0, m, 2 * m].map(|later| &angle[first + later..last + later])
}

/// `sum (c - 2b + a)^2` in eight interleaved sums.
pub(crate) fn squared_second_differences(a: &[f64], b: &[f64], c: &[f64]) -> f64 {
    let [squares] = with_wide_vectors!(simd => squares_in_lanes(simd, [[a, b, c]]));
    squares
}

/// The same of several a, b, c, all of one length.
#[inline(always)]
fn squares_in_lanes<S: Simd, const N: usize>(simd: S, parts: [[&[f64]; 3]; N]) -> [f64; N] {
    let mut lanes = [Lanes::splat(simd, 0.0); N];
    let length = parts[0][0].len();
    let chunks = length / LANES;
    let whole = parts.map(|part| part.map(|angles| &angles.as_chunks::<LANES>().0[..chunks]));
    for chunk in 0..chunks {
        for (lanes, angles) in lanes.iter_mut().zip(&whole) {
            let [a, b, c] = angles.map(|angles| Lanes::of(simd, &angles[chunk]));
            let difference = (a + c) - Lanes::splat(simd, 2.0) * b;
            *lanes = *lanes + difference * difference;
        }
    }
    let mut sums = [0.0; N];
    for ((sum, lanes), [a, b, c]) in sums.iter_mut().zip(lanes).zip(parts) {
        let rest: f64 = (chunks * LANES..length)
            .map(|at| {
                let difference = (a[at] + c[at]) - 2.0 * b[at];
                difference * difference
            })
            .sum();
        *sum = lanes.to_array().iter().sum::<f64>() + rest;
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_at_multiples_are_those_of_the_array() {
        let longest: Vec<f64> = (0..2 * PART + 77)
            .map(|k| 15.0 + ((k * k) % 1013) as f64)
            .collect();
        let factors = [1, 2, 3, 100, PART - 1, PART, PART + 1, 2 * PART];
        for samples in [1, 300, PART - 1, PART, PART + 1, 2 * PART, 2 * PART + 77] {
            let rates = &longest[..samples];
            let angle = angle_about_mean(rates);
            for blocks in [1, 50, usize::MAX] {
                let (mean, starts) = starts_of_parts(rates);
                let found = angles_at_multiples(rates, (mean, &starts), &factors, blocks);
                for (found, m) in found.iter().zip(factors) {
                    let multiples = angle.iter().step_by(m).take(blocks.saturating_add(1));
                    let wanted: Vec<f64> = multiples.copied().collect();
                    assert_eq!(found, &wanted, "{samples} samples, every {m}th");
                }
            }
        }
    }

    #[test]
    fn blocks_agree_with_the_plain_sum() {
        let angle: Vec<f64> = (0..3 * BLOCK + 7)
            .map(|k| ((k * k) % 1013) as f64)
            .collect();
        let factors = [1, 2, 3, 100, BLOCK, 3001];
        for (m, sum) in factors
            .into_iter()
            .zip(second_difference_sums(&angle, &factors))
        {
            let plain: f64 = (0..angle.len() - 2 * m)
                .map(|k| (angle[k + 2 * m] - 2.0 * angle[k + m] + angle[k]).powi(2))
                .sum();
            assert!((sum / plain - 1.0).abs() < 1e-12, "m = {m}: {sum} {plain}");
        }
    }

    #[test]
    fn the_angle_is_the_running_sum_about_the_mean() {
        let mut rates: Vec<f64> = (0..2 * PART + 5)
            .map(|k| 15.0 + ((k * k) % 101) as f64 / 50.0)
            .collect();
        for gap in [0, PART + 3] {
            if gap > 0 {
                rates[gap] = f64::NAN;
            }
            let present: Vec<f64> = rates.iter().copied().filter(|x| !x.is_nan()).collect();
            let above = present.iter().map(|rate| rate - 15.0);
            let mean = 15.0 + above.sum::<f64>() / present.len() as f64;
            let angle = angle_about_mean(&rates);
            let mut plain = 0.0;
            for (k, rate) in rates.iter().enumerate() {
                assert!((angle[k] - plain).abs() < 1e-7, "{k}: {} {plain}", angle[k]);
                plain += if rate.is_nan() { 0.0 } else { rate - mean };
            }
            assert!(angle[rates.len()].abs() < 1e-7);
        }
    }
}
