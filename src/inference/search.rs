//! Points of the space of parameters, spread as the figures make them likely.

use nalgebra::DMatrix;

use crate::inference::drawing::lower_factor;
use crate::inference::forecast::{Forecasts, Printed, likelihood};
use crate::random::{Stream, Streams};

/// First points for each that is kept: the prior is looked over more finely than what follows.
const FIRST_PER_POINT: usize = 4;
/// Part of the points whose weight may stand for all before the next step of the likelihood.
const EFFECTIVE_PART: f64 = 0.5;
/// Moves of every point between two steps, again and again until enough were taken: whether along one
/// direction of the spread or along all, and how long beside it.
const MOVES: [(bool, f64); 6] = [
    (false, 1.0),
    (true, 1.0),
    (false, 0.3),
    (true, 1.0),
    (true, 0.3),
    (false, 0.1),
];
/// Moves taken by a point, in the mean, that are enough; most rounds in which they are looked for.
const MOVES_TAKEN: usize = 2;
const ROUNDS_MAX: usize = 4;
/// Most steps: far more than any figures need.
const STEPS_MAX: usize = 400;
/// Logarithm of the likelihood, below the most likely point, from which a point tells nothing with any one
/// figure left out.
const SILENT: f64 = 50.0;
/// A point of the space of parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Parts of the prior below the value of each parameter.
    pub parts: Vec<f64>,
    /// What the figures are expected to be there.
    pub forecasts: Forecasts,
    /// Logarithm of the probability of the printed figures.
    pub log_likelihood: f64,
}

/// A point that was met on the way, beside how densely the search has drawn points there.
#[derive(Clone, Debug, PartialEq)]
pub struct Visited {
    /// The point.
    pub point: Point,
    /// Logarithm of the density of what was drawn over that of the prior.
    pub log_density: f64,
}

/// What a search has found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Points, equally likely.
    pub points: Vec<Point>,
    /// The most likely point met.
    pub best: Point,
    /// Points of all steps, from the prior to the last, without those of no likelihood: they reach where one
    /// figure less would let them.
    pub visited: Vec<Visited>,
    /// Number of points of all steps, those of no likelihood included.
    pub visits: usize,
    /// Logarithm of the probability of the figures, all parameters weighed by their priors.
    pub log_evidence: f64,
    /// Forecasts made.
    pub forecasts: usize,
}

/// What is searched.
pub struct Search<'a> {
    /// Printed figures.
    pub printed: &'a [Printed],
    /// Probability that a figure is not what its name says.
    pub doubt: f64,
    /// Number of parameters.
    pub parameters: usize,
    /// Points to keep.
    pub points: usize,
}

impl Search<'_> {
    /// Spreads points by sequential Monte Carlo: the likelihood is let in by steps, after each of which
    /// the points are drawn anew by their weights and moved as Metropolis has it.
    ///
    /// * `forecast`: what the figures are expected to be at parts of the priors; none where no instrument
    ///   has those values.
    ///
    /// Nothing is found where no point has a forecast.
    ///
    /// # Source
    /// Del Moral, Doucet and Jasra, J. R. Stat. Soc. B 68 (2006) 411.
    pub fn run(
        &self,
        streams: &Streams,
        forecast: &mut dyn FnMut(&[f64]) -> Option<Forecasts>,
    ) -> Option<Found> {
        let mut made = 0;
        let mut look = |parts: Vec<f64>| {
            made += 1;
            let forecasts = forecast(&parts)?;
            let log_likelihood = likelihood(self.printed, &forecasts, self.doubt, None).logarithm;
            Some(Point {
                parts,
                forecasts,
                log_likelihood,
            })
        };
        let first = if self.parameters == 0 {
            1
        } else {
            FIRST_PER_POINT * self.points
        };
        let first_points = first_points(first, self.parameters).into_iter();
        let mut points: Vec<Point> = first_points.filter_map(&mut look).collect();
        let mut log_evidence = (points.len() as f64 / first as f64).ln();
        let mut best = points.iter().max_by(by_likelihood).cloned()?;
        let mut stream = streams.stream("search");
        let mut power = 0.0;
        let mut steps = vec![Step::of(&points, power, log_evidence)];
        let mut visits = points.len();
        let mut met = self.weighty(&points, &best);
        for _ in 0..STEPS_MAX {
            if power >= 1.0 {
                break;
            }
            let step = next_step(&points, 1.0 - power);
            let weights = weights(&points, step);
            let most = points
                .iter()
                .map(|point| step * point.log_likelihood)
                .fold(f64::NEG_INFINITY, f64::max);
            log_evidence += most + (weights.iter().sum::<f64>() / weights.len() as f64).ln();
            let kept = if self.parameters == 0 { 1 } else { self.points };
            points = drawn(&points, &weights, kept, stream.uniform());
            power += step;
            let moved = self.move_all(&mut points, power, &mut stream, &mut look);
            best = moved.into_iter().fold(best, |best, point| {
                if point.log_likelihood > best.log_likelihood {
                    point
                } else {
                    best
                }
            });
            steps.push(Step::of(&points, power, log_evidence));
            visits += points.len();
            // The best point only becomes better: what tells nothing beside this one never does.
            met.extend(self.weighty(&points, &best));
        }
        let met = self.weighty(&met, &best).into_iter();
        let visited = met.map(|point| Visited {
            log_density: log_density(&steps, visits, point.log_likelihood),
            point,
        });
        Some(Found {
            visited: visited.collect(),
            visits,
            points,
            best,
            log_evidence,
            forecasts: made,
        })
    }

    /// Points that tell something with any one figure left out.
    fn weighty(&self, points: &[Point], best: &Point) -> Vec<Point> {
        let least = best.log_likelihood - SILENT + self.doubt.ln();
        let of_weight = points.iter().filter(|point| point.log_likelihood > least);
        of_weight.cloned().collect()
    }

    /// Moves every point a few times; returns the most likely ones met.
    fn move_all(
        &self,
        points: &mut [Point],
        power: f64,
        stream: &mut Stream,
        look: &mut dyn FnMut(Vec<f64>) -> Option<Point>,
    ) -> Option<Point> {
        let count = self.parameters;
        if count == 0 {
            return None;
        }
        // The spread of points that came together is taken as a little.
        let factor = lower_factor(covariance(points, count), |own| 1e-6 * own + 1e-18);
        let mut best: Option<Point> = None;
        for _ in 0..ROUNDS_MAX {
            let mut taken = 0;
            for (is_along_one, length) in MOVES {
                for point in points.iter_mut() {
                    let parts = proposed(point, &factor, (is_along_one, length), stream);
                    let chance = stream.uniform();
                    // Beyond the prior: a mirror there would not be as likely both ways, as parts
                    // move together.
                    if parts.iter().any(|part| !(0.0..=1.0).contains(part)) {
                        continue;
                    }
                    let Some(proposed) = look(parts) else {
                        continue;
                    };
                    let gain = power * (proposed.log_likelihood - point.log_likelihood);
                    if chance.ln() >= gain {
                        continue;
                    }
                    taken += 1;
                    let known = best.as_ref().map(|best| best.log_likelihood);
                    if known.is_none_or(|known| proposed.log_likelihood > known) {
                        best = Some(proposed.clone());
                    }
                    *point = proposed;
                }
            }
            if taken >= MOVES_TAKEN * points.len() {
                break;
            }
        }
        best
    }
}

/// Where a point might move: along one direction of the spread of all points, or along all.
fn proposed(
    point: &Point,
    factor: &DMatrix<f64>,
    (is_along_one, length): (bool, f64),
    stream: &mut Stream,
) -> Vec<f64> {
    let count = point.parts.len();
    let (reach, only) = if is_along_one {
        let only = (0..count).find(|index| stream.uniform() * (count - index) as f64 <= 1.0);
        (2.38, only)
    } else {
        (2.38 / (count as f64).sqrt(), None)
    };
    let normals: Vec<f64> = (0..count)
        .map(|column| {
            let normal = stream.normal();
            if only.is_none_or(|only| only == column) {
                normal
            } else {
                0.0
            }
        })
        .collect();
    let parts = (0..count).map(|row| {
        let along: f64 = (0..=row)
            .map(|column| factor[(row, column)] * normals[column])
            .sum();
        point.parts[row] + length * reach * along
    });
    parts.collect()
}

/// A step of a search: what its points were drawn from.
struct Step {
    power: f64,
    /// Logarithm of the mean likelihood to that power over the prior.
    log_evidence: f64,
    count: usize,
}

impl Step {
    fn of(points: &[Point], power: f64, log_evidence: f64) -> Self {
        Self {
            power,
            log_evidence,
            count: points.len(),
        }
    }
}

/// Logarithm of the density of the points of all steps over that of the prior.
///
/// # Source
/// Owen and Zhou, J. Am. Stat. Assoc. 95 (2000) 135: the mixture that all were drawn from weighs each.
fn log_density(steps: &[Step], visits: usize, log_likelihood: f64) -> f64 {
    let parts = steps.iter().map(|step| {
        let share = step.count as f64 / visits as f64;
        share.ln() + step.power * log_likelihood - step.log_evidence
    });
    let parts: Vec<f64> = parts.collect();
    let most = parts.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    most + parts
        .iter()
        .map(|part| (part - most).exp())
        .sum::<f64>()
        .ln()
}

fn by_likelihood(own: &&Point, other: &&Point) -> std::cmp::Ordering {
    own.log_likelihood.total_cmp(&other.log_likelihood)
}

/// The first points of Halton's sequence: parts of the priors, spread evenly.
pub(crate) fn first_points(points: usize, parameters: usize) -> Vec<Vec<f64>> {
    (0..points).map(|index| halton(index, parameters)).collect()
}

/// A point of Halton's sequence.
fn halton(index: usize, count: usize) -> Vec<f64> {
    const PRIMES: [usize; 16] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53];
    let digit = |dimension: usize| {
        let base = PRIMES[dimension % PRIMES.len()];
        let mut left = index + 1 + dimension / PRIMES.len() * 7919;
        let (mut part, mut place) = (0.0, 1.0);
        while left > 0 {
            place /= base as f64;
            part += place * (left % base) as f64;
            left /= base;
        }
        part
    };
    (0..count).map(digit).collect()
}

/// Weights of the points for a step of the likelihood, the largest 1.
fn weights(points: &[Point], step: f64) -> Vec<f64> {
    let most = points
        .iter()
        .map(|point| point.log_likelihood)
        .fold(f64::NEG_INFINITY, f64::max);
    let own = |point: &Point| (step * (point.log_likelihood - most)).exp();
    points.iter().map(own).collect()
}

/// The longest step that leaves enough points of weight.
fn next_step(points: &[Point], most: f64) -> f64 {
    let is_enough = |step: f64| {
        let weights = weights(points, step);
        let sum: f64 = weights.iter().sum();
        let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
        sum * sum / squares >= EFFECTIVE_PART * points.len() as f64
    };
    if is_enough(most) {
        return most;
    }
    let (mut low, mut high) = (0.0, most);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if is_enough(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low.max(1e-6 * most)
}

/// Points drawn by their weights, at equal distances.
fn drawn(points: &[Point], weights: &[f64], count: usize, offset: f64) -> Vec<Point> {
    let step = weights.iter().sum::<f64>() / count as f64;
    let mut found = Vec::with_capacity(count);
    let (mut reached, mut index) = (weights[0], 0);
    for place in 0..count {
        let target = (place as f64 + offset) * step;
        while reached < target && index + 1 < points.len() {
            index += 1;
            reached += weights[index];
        }
        found.push(points[index].clone());
    }
    found
}

/// Covariance of the parts of points.
pub(crate) fn covariance(points: &[Point], parameters: usize) -> DMatrix<f64> {
    let count = points.len().max(1) as f64;
    let mean = |index: usize| points.iter().map(|point| point.parts[index]).sum::<f64>() / count;
    let means: Vec<f64> = (0..parameters).map(mean).collect();
    DMatrix::from_fn(parameters, parameters, |row, column| {
        let products = points
            .iter()
            .map(|point| (point.parts[row] - means[row]) * (point.parts[column] - means[column]));
        products.sum::<f64>() / count
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inference::forecast::{Forecast, Print};

    /// One figure, the sum of two parameters, each uniform from 0 to 1.
    const SEARCH: Search<'_> = Search {
        printed: &[Printed {
            value: 1.0,
            print: Print::Stated { deviation: 0.02 },
        }],
        doubt: 1e-9,
        parameters: 2,
        points: 512,
    };

    fn sum_of_parts(parts: &[f64]) -> Option<Forecasts> {
        Some(Forecasts {
            figures: vec![Some(Forecast::normal(parts[0] + parts[1], 1e-6))],
            correlations: Vec::new(),
        })
    }

    #[test]
    fn a_search_finds_mean_spread_and_evidence_of_a_normal_posterior() {
        let found = SEARCH
            .run(&Streams::new(1, 0), &mut sum_of_parts)
            .expect("points");
        let count = found.points.len() as f64;
        let sum: f64 = found
            .points
            .iter()
            .map(|point| point.parts.iter().sum::<f64>())
            .sum();
        assert!((sum / count - 1.0).abs() < 4e-3, "{}", sum / count);
        let first = found.points.iter().map(|point| point.parts[0]);
        let mean = first.clone().sum::<f64>() / count;
        let spread = (first.map(|part| (part - mean).powi(2)).sum::<f64>() / count).sqrt();
        // Along the ridge the prior is all there is: a uniform deviate, 1/sqrt(12).
        assert!((spread - 0.2887).abs() < 0.03, "{spread}");
        // The density of the sum is 1 there; times the width 0.02 sqrt(2 pi).
        let expected = (0.02 * std::f64::consts::TAU.sqrt()).ln();
        assert!(
            (found.log_evidence - expected).abs() < 0.1,
            "{} {expected}",
            found.log_evidence
        );
        // The points of all steps weigh the same evidence, and where one figure less would let them.
        let weigh = |logarithm: &dyn Fn(&Point) -> f64| {
            let rows = found.visited.iter();
            let each = rows.map(|own| (logarithm(&own.point) - own.log_density).exp());
            each.sum::<f64>() / found.visits as f64
        };
        let whole = weigh(&|point| point.log_likelihood).ln();
        assert!((whole - expected).abs() < 0.1, "{whole} {expected}");
        let without = weigh(&|_| 0.0);
        assert!((without - 1.0).abs() < 0.1, "{without}");
        let again = SEARCH.run(&Streams::new(1, 0), &mut sum_of_parts);
        assert_eq!(again, Some(found));
    }

    #[test]
    fn the_evidence_of_parts_that_move_together_has_no_bias() {
        let seeds = 24_u32;
        let evidence = (0..seeds).map(|seed| {
            let found = SEARCH.run(&Streams::new(u64::from(seed), 0), &mut sum_of_parts);
            found.expect("points").log_evidence / f64::from(seeds)
        });
        let mean: f64 = evidence.sum();
        let expected = (0.02 * std::f64::consts::TAU.sqrt()).ln();
        // One search scatters by 0.06. A mirror at the ends of the prior made it 0.11 too much.
        assert!((mean - expected).abs() < 0.06, "{mean} {expected}");
    }
}
