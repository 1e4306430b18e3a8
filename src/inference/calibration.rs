//! How often answers hold the truth: over settings drawn from the priors, of which it is known.
//!
//! The truth and what is drawn again are exchangeable, so that the k-th smallest of n marks with
//! `k = ceil(0.95 (n + 1))` is not exceeded in 95 % whatever the search is worth.

use nalgebra::DMatrix;

use crate::inference::answer::{Answer, Explained};
use crate::inference::forecast::{Forecasts, Printed, likelihood};
use crate::inference::search::{Found, Point, covariance};

/// Part of the draws that a level holds.
const HELD: f64 = 0.95;
/// Ends of the interval of a parameter.
const TAIL: f64 = 0.025;
/// Distance of forecasts over the deviation of their figures up to which two settings print the same.
const ALIKE: f64 = 0.3;
/// Step of a part of a prior by which derivatives are taken.
const STEP: f64 = 1e-3;
/// Largest pull of a shifted figure from what others make it that excuses that it is not named.
const EXCUSED: f64 = 2.0;
/// Deviations by which a figure is shifted.
pub const SHIFT: f64 = 5.0;

/// Levels by which readings are accepted and figures explained.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Levels {
    /// Probability that more probable readings may hold before one is refused; none for 0.95.
    pub accepted: Option<f64>,
    /// Largest pull of a figure that is explained; none for the largest of so many normal deviates.
    pub pull: Option<f64>,
}

/// What an answer is worth beside settings that are known.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Probability of the readings that are more probable than the true one.
    pub held_before: f64,
    /// Whether the true reading is accepted.
    pub is_accepted: bool,
    /// Number of readings accepted.
    pub accepted: usize,
    /// Those of them, the true one apart, that no point tells apart from the true settings by the figures.
    pub equivalent: usize,
    /// By parameter, whether the 95 % interval under the true reading holds the true value.
    pub is_inside: Vec<bool>,
    /// Whether the 95 % region of all parameters under the true reading, the most likely settings that hold as
    /// much, holds the true ones.
    pub is_in_region: bool,
    /// Volume of the region under the true reading over that of the information bound; none where there
    /// is no region.
    pub volume: Option<f64>,
    /// Largest magnitude of a pull.
    pub largest_pull: f64,
    /// Whether a figure is called unexplained.
    pub has_unexplained: bool,
    /// What is said of a figure that was shifted.
    pub shifted: Shifted,
}

/// What is said of a figure that was shifted by [`SHIFT`] standard deviations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shifted {
    /// It is named.
    Named,
    /// Others leave it as far open as it was shifted.
    Open,
    /// It is not named.
    Missed,
}

/// How often answers hold the truth.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// What came of each draw.
    pub outcomes: Vec<Outcome>,
    /// Number of readings.
    pub readings: usize,
    /// Levels that hold the truth in 95 %.
    pub levels: Levels,
}

impl Calibration {
    /// Gathers what came of draws.
    #[must_use]
    pub fn of(outcomes: Vec<Outcome>, readings: usize) -> Self {
        let level = |mark: fn(&Outcome) -> f64| {
            let mut marks: Vec<f64> = outcomes.iter().map(mark).collect();
            marks.sort_by(f64::total_cmp);
            let place = (HELD * (marks.len() as f64 + 1.0)).ceil();
            let reached = (1..=marks.len()).find(|index| *index as f64 >= place);
            reached.map(|index| marks[index - 1])
        };
        let levels = Levels {
            accepted: level(|outcome| outcome.held_before),
            pull: level(|outcome| outcome.largest_pull),
        };
        Self {
            outcomes,
            readings,
            levels,
        }
    }

    /// Number of draws of which something holds.
    #[must_use]
    pub fn count(&self, holds: impl Fn(&Outcome) -> bool) -> usize {
        self.outcomes
            .iter()
            .filter(|outcome| holds(outcome))
            .count()
    }

    /// Draws in which at most a third of the readings is accepted that can be told apart.
    #[must_use]
    pub fn third(&self) -> usize {
        self.count(|outcome| 3 * (outcome.accepted - outcome.equivalent) <= self.readings.max(3))
    }

    /// Intervals that hold their value, and all there are.
    #[must_use]
    pub fn intervals(&self) -> (usize, usize) {
        let inside = self.outcomes.iter().flat_map(|outcome| &outcome.is_inside);
        (inside.clone().filter(|own| **own).count(), inside.count())
    }

    /// Volumes over that of the bound, least first.
    #[must_use]
    pub fn volumes(&self) -> Vec<f64> {
        let mut volumes: Vec<f64> = self
            .outcomes
            .iter()
            .filter_map(|outcome| outcome.volume)
            .collect();
        volumes.sort_by(f64::total_cmp);
        volumes
    }
}

/// Settings that are known.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// The reading.
    pub reading: usize,
    /// Parts of the priors.
    pub parts: Vec<f64>,
    /// What the figures are expected to be.
    pub forecasts: Forecasts,
    /// The figures as printed.
    pub printed: Vec<Printed>,
}

impl Truth {
    /// What an answer is worth.
    ///
    /// * `doubt`: probability that a figure is not what its name says.
    /// * `bound`: logarithm of the determinant of the covariance that the information allows.
    #[must_use]
    pub fn outcome(
        &self,
        (answer, found): (&Answer, &[Option<Found>]),
        doubt: f64,
        bound: Option<f64>,
        shifted: Shifted,
    ) -> Outcome {
        let before = answer
            .readings
            .iter()
            .take_while(|judged| judged.reading != self.reading);
        // From plus zero: a sum of nothing is minus zero.
        let held_before = before.fold(0.0, |held, judged| held + judged.weight);
        let accepted = answer.accepted();
        let (explained, told) = answer.explained();
        let equivalent = accepted.clone().filter(|judged| {
            let points = found[judged.reading].as_ref().map(|found| &found.points);
            judged.reading != self.reading
                && points.is_some_and(|points| points.iter().any(|point| self.prints_alike(point)))
        });
        let own = found[self.reading].as_ref();
        let points = own.map_or(&[][..], |found| &found.points);
        let largest = |most: f64, pull: f64| most.max(pull.abs());
        Outcome {
            held_before,
            is_accepted: accepted
                .clone()
                .any(|judged| judged.reading == self.reading),
            accepted: accepted.count(),
            equivalent: equivalent.count(),
            is_inside: self.inside(points),
            is_in_region: self.is_in_region(points, doubt),
            volume: bound.and_then(|bound| {
                let spread = logarithm_of_determinant(&covariance(points, self.parts.len()))?;
                Some((0.5 * (spread - bound)).exp())
            }),
            largest_pull: pulls(&answer.figures).fold(0.0, largest),
            has_unexplained: explained < told,
            shifted,
        }
    }

    /// What an answer says of a figure that was shifted.
    #[must_use]
    pub fn shifted(explained: &Explained) -> Shifted {
        match (explained.is_explained, explained.pull) {
            (Some(false), _) => Shifted::Named,
            (_, Some(pull)) if pull.abs() > EXCUSED => Shifted::Missed,
            _ => Shifted::Open,
        }
    }

    /// Standard deviation of a figure, print included; none of one without a forecast.
    #[must_use]
    pub fn deviation(&self, figure: usize) -> Option<f64> {
        let forecast = self.forecasts.figures[figure]?;
        Some(forecast.deviation.hypot(self.printed[figure].deviation()))
    }

    /// Whether the figures do not tell a point from the truth.
    fn prints_alike(&self, point: &Point) -> bool {
        (0..self.printed.len()).all(|figure| {
            let own = self.forecasts.figures[figure];
            let other = point.forecasts.figures[figure];
            match (own, other, self.deviation(figure)) {
                (Some(own), Some(other), Some(deviation)) => {
                    (own.value - other.value).abs() <= ALIKE * deviation
                }
                (None, None, _) => true,
                _ => false,
            }
        })
    }

    /// By parameter, whether the interval of the points holds the true value.
    fn inside(&self, points: &[Point]) -> Vec<bool> {
        if points.is_empty() {
            return vec![false; self.parts.len()];
        }
        let count = points.len() as f64;
        let parts = self.parts.iter().enumerate();
        parts
            .map(|(index, part)| {
                let below = points.iter().filter(|point| point.parts[index] < *part);
                // As a quantile between neighbours: half a point for the truth itself.
                let rank = (below.count() as f64 + 0.5) / (count + 1.0);
                (TAIL..=1.0 - TAIL).contains(&rank)
            })
            .collect()
    }

    /// Whether more than 5 % of the points are less likely than the truth: over the parts of the priors the
    /// density of what is left is the likelihood.
    fn is_in_region(&self, points: &[Point], doubt: f64) -> bool {
        let own = likelihood(&self.printed, &self.forecasts, doubt, None).logarithm;
        let below = points.iter().filter(|point| point.log_likelihood < own);
        let rank = (below.count() as f64 + 0.5) / (points.len() as f64 + 1.0);
        !points.is_empty() && rank >= 1.0 - HELD
    }

    /// Logarithm of the determinant of the least covariance of the parts: that of Fisher's information of
    /// the figures, print included, beside that of the priors.
    ///
    /// * `forecast`: what the figures are expected to be at parts of the priors.
    ///
    /// None where there are no parameters or no gyro nearby.
    pub fn bound(&self, forecast: &mut dyn FnMut(&[f64]) -> Option<Forecasts>) -> Option<f64> {
        let parameters = self.parts.len();
        (parameters > 0).then_some(())?;
        let told: Vec<usize> = (0..self.printed.len())
            .filter(|figure| self.forecasts.figures[*figure].is_some())
            .collect();
        let deviations: Option<Vec<f64>> =
            told.iter().map(|figure| self.deviation(*figure)).collect();
        let deviations = deviations?;
        let mut slopes = DMatrix::zeros(told.len(), parameters);
        for parameter in 0..parameters {
            let mut at = |step: f64| {
                let mut parts = self.parts.clone();
                parts[parameter] = (parts[parameter] + step).clamp(0.0, 1.0);
                Some((parts[parameter], forecast(&parts)?))
            };
            let ((low, below), (high, above)) = (at(-STEP)?, at(STEP)?);
            for (row, figure) in told.iter().enumerate() {
                let rise = above.figures[*figure]?.value - below.figures[*figure]?.value;
                slopes[(row, parameter)] = rise / (high - low) / deviations[row];
            }
        }
        let correlations = self.forecasts.correlation_matrix();
        let scatter =
            |figure: usize| self.forecasts.figures[figure].map_or(0.0, |own| own.deviation);
        let covariance = DMatrix::from_fn(told.len(), told.len(), |row, column| {
            if row == column {
                return 1.0;
            }
            let (one, other) = (told[row], told[column]);
            let common = scatter(one) * scatter(other) / deviations[row] / deviations[column];
            correlations[(one, other)] * common
        });
        // The variance of a uniform prior is 1/12.
        let prior = DMatrix::identity(parameters, parameters) * 12.0;
        let information = slopes.transpose() * covariance.cholesky()?.solve(&slopes) + prior;
        Some(-logarithm_of_determinant(&information)?)
    }
}

fn pulls(figures: &[Explained]) -> impl Iterator<Item = f64> {
    figures.iter().filter_map(|figure| figure.pull)
}

/// None of a matrix that is not positive.
fn logarithm_of_determinant(matrix: &DMatrix<f64>) -> Option<f64> {
    (matrix.nrows() > 0).then_some(())?;
    let factor = matrix.clone().cholesky()?;
    Some(
        2.0 * factor
            .l()
            .diagonal()
            .iter()
            .map(|own| own.ln())
            .sum::<f64>(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome(held_before: f64, largest_pull: f64) -> Outcome {
        Outcome {
            held_before,
            is_accepted: held_before < 0.95,
            accepted: 2,
            equivalent: 1,
            is_inside: vec![true, false],
            is_in_region: true,
            volume: Some(1.0),
            largest_pull,
            has_unexplained: false,
            shifted: Shifted::Named,
        }
    }

    #[test]
    fn levels_are_those_that_19_of_20_draws_and_the_next_do_not_exceed() {
        let outcomes = (0..39).map(|index| outcome(0.01 * f64::from(index), f64::from(index)));
        let calibration = Calibration::of(outcomes.collect(), 3);
        // ceil(0.95 * 40) = 38: the second largest.
        assert_eq!(calibration.levels.accepted, Some(0.37));
        assert_eq!(calibration.levels.pull, Some(37.0));
        assert_eq!(calibration.intervals(), (39, 78));
        assert_eq!(calibration.third(), 39);
        let few = Calibration::of(vec![outcome(0.0, 1.0); 18], 3);
        assert_eq!(few.levels, Levels::default());
    }

    #[test]
    fn the_bound_is_that_of_two_independent_figures() {
        use crate::inference::forecast::{Forecast, Print};
        let mut forecast = |parts: &[f64]| {
            Some(Forecasts {
                figures: parts
                    .iter()
                    .map(|part| Some(Forecast::normal(2.0 * part, 0.03)))
                    .collect(),
                correlations: Vec::new(),
            })
        };
        let printed = Printed {
            value: 1.0,
            print: Print::Stated { deviation: 0.04 },
        };
        let parts = vec![0.5, 0.4];
        let truth = Truth {
            reading: 0,
            forecasts: forecast(&parts).expect("forecasts"),
            parts,
            printed: vec![printed; 2],
        };
        // Slope 2 over the deviation 0.05, squared, and 12 of the prior.
        let expected = -2.0 * (1600.0_f64 + 12.0).ln();
        let found = truth.bound(&mut forecast).expect("a bound");
        assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    }
}
