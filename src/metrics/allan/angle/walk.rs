//! The sums of squared second differences at any averaging times without an array of the angles.
//!
//! The angles of a long record are as large as the record itself. Each thread walks along the record at
//! the places k, k + m and k + 2m of several averaging factors m at once, and integrates what it passes;
//! the angles are those of the array to the last bit.

use rayon::prelude::*;

use super::{
    BLOCK, CELL, PART, add, add_squares, integrate, squared_second_differences, starts_of_parts,
};

/// Averaging factors of which two parts of the angles hold all differences that start in the first.
const NEAR: usize = PART / 2;

/// Factors that are walked at once: one addition does not wait for another.
const AT_ONCE: usize = 4;

/// As [`second_difference_sums`](super::second_difference_sums) of
/// [`angle_about_mean`](super::angle_about_mean), of a record that misses nothing.
pub(crate) fn second_difference_sums_by_walking(rates: &[f64], factors: &[usize]) -> Vec<f64> {
    let (mean, starts) = starts_of_parts(rates);
    let parts = rates.par_chunks(PART).zip(&starts);
    let cells = parts.map_init(
        || vec![0.0; PART],
        |angles, (rates, start)| {
            integrate(rates, mean, *start, &mut angles[..rates.len()]);
            let ends = angles[..rates.len()].iter().skip(CELL - 1);
            ends.step_by(CELL).copied().collect::<Vec<f64>>()
        },
    );
    let cells: Vec<Vec<f64>> = cells.collect();
    let angle = Angle {
        rates,
        mean,
        starts,
        cells: cells.concat(),
    };
    let (near, far): (Vec<usize>, Vec<usize>) = factors.iter().partition(|m| **m < NEAR);
    let firsts: Vec<usize> = (0..=rates.len()).step_by(PART).collect();
    let of_parts = firsts.into_par_iter().map_init(Vec::new, |own, first| {
        angle.fill(first, (2 * PART + 1).min(rates.len() + 1 - first), own);
        let mut near_sums = vec![0.0; near.len()];
        for start in (0..own.len().min(PART)).step_by(BLOCK) {
            add_squares(&mut near_sums, &near, own, (start, start + BLOCK));
        }
        let few = far.chunks(AT_ONCE);
        let far_sums = few.flat_map(|few| angle.far_sums(first, own, few));
        (near_sums, far_sums.collect::<Vec<f64>>())
    });
    let of_parts: Vec<(Vec<f64>, Vec<f64>)> = of_parts.collect();
    // In the order of the parts, whichever thread was first.
    let mut sums = (vec![0.0; near.len()], vec![0.0; far.len()]);
    for (near, far) in &of_parts {
        add(&mut sums.0, near);
        add(&mut sums.1, far);
    }
    let (mut near, mut far) = (sums.0.into_iter(), sums.1.into_iter());
    let next = |m: &usize| {
        if *m < NEAR { near.next() } else { far.next() }
    };
    factors.iter().filter_map(next).collect()
}

/// The angles about the mean rate, to be integrated where they are needed.
struct Angle<'a> {
    rates: &'a [f64],
    mean: f64,
    /// At the start of every part.
    starts: Vec<f64>,
    /// Behind every so many samples of a part.
    cells: Vec<f64>,
}

impl Angle<'_> {
    /// Sums of the squared differences that start in the part at `first`, of few factors.
    ///
    /// * `own`: angles from there on.
    fn far_sums(&self, first: usize, own: &[f64], factors: &[usize]) -> Vec<f64> {
        let angles = self.rates.len() + 1;
        let places = factors.iter().flat_map(|m| [first + m, first + 2 * m]);
        let mut walkers: Vec<Walker> = places.map(|index| Walker::at(self, index)).collect();
        let mut ahead = vec![[0.0; BLOCK]; walkers.len()];
        let mut sums = vec![0.0; factors.len()];
        for start in (0..PART).step_by(BLOCK) {
            let lengths = factors.iter().map(|m| {
                let last = angles.saturating_sub(2 * m);
                last.saturating_sub(first + start).min(BLOCK)
            });
            let lengths: Vec<usize> = lengths.collect();
            // The factors are ascending: where the first has no differences left none has.
            if lengths.iter().all(|length| *length == 0) {
                break;
            }
            self.walk(&mut walkers, &mut ahead, &lengths);
            let pairs = ahead.chunks_exact(2).zip(&lengths);
            for (sum, (pair, &length)) in sums.iter_mut().zip(pairs) {
                if length > 0 {
                    let (one, two) = (&pair[0][..length], &pair[1][..length]);
                    *sum += squared_second_differences(&own[start..start + length], one, two);
                }
            }
        }
        sums
    }

    /// The angles of the next block at each walker; `lengths` of them of each pair are needed.
    fn walk(&self, walkers: &mut [Walker], ahead: &mut [[f64; BLOCK]], lengths: &[usize]) {
        let is_plain = lengths.iter().all(|length| *length == BLOCK)
            && walkers.iter().all(|walker| walker.is_within_part());
        if let Ok(walkers) = <&mut [Walker; 2 * AT_ONCE]>::try_from(&mut *walkers)
            && is_plain
        {
            let rates: [&[f64; BLOCK]; 2 * AT_ONCE] =
                std::array::from_fn(|at| self.block(walkers[at].index));
            let mut sums: [f64; 2 * AT_ONCE] = std::array::from_fn(|at| walkers[at].sum);
            for sample in 0..BLOCK {
                for (at, sum) in sums.iter_mut().enumerate() {
                    *sum += rates[at][sample] - self.mean;
                    ahead[at][sample] = *sum;
                }
            }
            for (walker, sum) in walkers.iter_mut().zip(sums) {
                *walker = Walker {
                    index: walker.index + BLOCK,
                    sum,
                };
            }
            return;
        }
        for (at, (walker, ahead)) in walkers.iter_mut().zip(ahead).enumerate() {
            walker.fill(self, &mut ahead[..lengths[at / 2]]);
        }
    }

    /// The rates that lead to the angles of the block at an index.
    fn block(&self, index: usize) -> &[f64; BLOCK] {
        self.rates[index - 1..]
            .first_chunk()
            .unwrap_or(&[0.0; BLOCK])
    }

    /// So many angles from the index `first`, the start of a part, on.
    fn fill(&self, first: usize, count: usize, angles: &mut Vec<f64>) {
        angles.resize(count, 0.0);
        Walker::at(self, first).fill(self, angles);
    }
}

/// A place in the record, and the sum that leads to its angle.
#[derive(Clone, Copy)]
struct Walker {
    /// Index of the next angle.
    index: usize,
    /// The angle before it.
    sum: f64,
}

impl Walker {
    fn at(angle: &Angle, index: usize) -> Self {
        let cell = index.saturating_sub(1) / CELL;
        let known = cell.checked_sub(1).and_then(|last| angle.cells.get(last));
        let mut walker = Self {
            index: cell * CELL + usize::from(index > 0),
            sum: known.copied().unwrap_or(0.0),
        };
        while walker.index < index.min(angle.rates.len() + 1) {
            walker.fill(angle, &mut [0.0]);
        }
        walker
    }

    /// Whether no part ends within the next block, nor begins with it.
    fn is_within_part(&self) -> bool {
        self.index > 0
            && !(self.index - 1).is_multiple_of(PART)
            && (self.index - 1) % PART + BLOCK <= PART
    }

    /// The next angles.
    fn fill(&mut self, angle: &Angle, mut angles: &mut [f64]) {
        if self.index == 0 && !angles.is_empty() {
            angles[0] = 0.0;
            angles = &mut angles[1..];
            self.index = 1;
        }
        while !angles.is_empty() {
            let (part, within) = ((self.index - 1) / PART, (self.index - 1) % PART);
            if within == 0 {
                self.sum = angle.starts[part];
            }
            let (now, later) = angles.split_at_mut(angles.len().min(PART - within));
            let rates = &angle.rates[self.index - 1..self.index - 1 + now.len()];
            integrate(rates, angle.mean, self.sum, now);
            self.sum = now[now.len() - 1];
            self.index += now.len();
            angles = later;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{angle_about_mean, second_difference_sums};
    use super::*;

    #[test]
    fn sums_by_walking_are_those_of_the_array_to_the_bit() {
        let longest: Vec<f64> = (0..5 * PART + 77)
            .map(|k| 15.0 + ((k * k) % 1013) as f64)
            .collect();
        for samples in [
            4,
            300,
            PART - 1,
            PART,
            2 * PART + 1,
            5 * PART,
            5 * PART + 77,
        ] {
            let rates = &longest[..samples];
            let angle = angle_about_mean(rates);
            for factors in [
                &[1, 2, 3, 100][..],
                &[
                    1,
                    9001,
                    NEAR - 1,
                    NEAR,
                    NEAR + 1,
                    PART,
                    PART + 5,
                    2 * PART - 3,
                ],
                &[NEAR + 127, NEAR + 128, NEAR + 129, 2 * PART, 2 * PART + 33],
            ] {
                let factors: Vec<usize> = factors
                    .iter()
                    .copied()
                    .filter(|m| 2 * m <= samples)
                    .collect();
                let wanted = second_difference_sums(&angle, &factors);
                let found = second_difference_sums_by_walking(rates, &factors);
                assert_eq!(found, wanted, "{samples} samples, {factors:?}");
            }
        }
    }
}
