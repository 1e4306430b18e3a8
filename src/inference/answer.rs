//! What points of all readings say together.

use statrs::distribution::{ContinuousCDF, Normal};

use crate::inference::calibration::Levels;
use crate::inference::forecast::{Forecast, Printed, likelihood};
use crate::inference::mixture::Mixture;
use crate::inference::search::{Found, Point, covariance};
use crate::inference::space::{Parameter, Reading};

/// Part of the weight that accepted readings hold together.
const ACCEPTED: f64 = 0.95;
/// Logarithm of a weight below the largest from which a point tells nothing, one figure let go.
const NEGLIGIBLE: f64 = 25.0;
/// Ends of intervals.
const TAIL: f64 = 0.025;
/// Correlation from which two parameters count as a ridge.
const RIDGE: f64 = 0.7;
/// Weight of a reading below which its ridges are not told.
const TOLD: f64 = 0.01;

/// A parameter under a reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Median.
    pub value: f64,
    /// Value of the most likely point.
    pub best: f64,
    /// End of the 95 % interval.
    pub low: f64,
    /// End of the 95 % interval.
    pub high: f64,
    /// Width of the interval over that of the prior's; near 1 the figures say nothing.
    pub share: f64,
}

/// A reading beside the figures.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// Place among the readings of the problem.
    pub reading: usize,
    /// Probability once the figures are known.
    pub weight: f64,
    /// Whether it is one of the fewest that hold the accepted part of the probability.
    pub is_accepted: bool,
    /// Logarithm of the probability of the figures under it.
    pub log_evidence: f64,
    /// Ranges of the parameters.
    pub parameters: Vec<Range>,
    /// Parts of the priors at the most likely point.
    pub best: Point,
}

/// A printed figure beside all that is known from the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Explained {
    /// What the other figures make it, and the standard deviation of that, print included; none where it
    /// has no closed form.
    pub predicted: Option<(f64, f64)>,
    /// What the most likely point makes it, and how far records scatter about that.
    pub at_best: Option<(f64, f64)>,
    /// Unit normal deviate below which as much lies as what the others make of the figure lies below the print.
    pub pull: Option<f64>,
    /// Whether the pull is within the limit.
    pub is_explained: Option<bool>,
}

/// Two parameters of a reading that trade off.
#[derive(Clone, Debug, PartialEq)]
pub struct Ridge {
    /// Place of the reading.
    pub reading: usize,
    /// Places of the parameters.
    pub parameters: [usize; 2],
    /// Correlation by the parts of their priors.
    pub correlation: f64,
    /// Parts of the priors at either end: points of the search, the outermost along the line.
    pub ends: [Vec<f64>; 2],
}

/// What an experiment would tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Told {
    /// Place among the experiments.
    pub experiment: usize,
    /// Expected information, bit.
    pub information_bit: f64,
    /// Least and greatest expected outcome over what is accepted.
    pub outcomes: (f64, f64),
    /// Standard deviation of an outcome.
    pub deviation: f64,
}

/// What the figures say.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// Readings, the most probable first.
    pub readings: Vec<Judged>,
    /// Figures, as the problem has them.
    pub figures: Vec<Explained>,
    /// Ridges of the accepted readings.
    pub ridges: Vec<Ridge>,
    /// Experiments, the most telling first.
    pub experiments: Vec<Told>,
    /// Pull beyond which a figure is not explained.
    pub pull_limit: f64,
    /// Part of the probability that the accepted readings are the fewest to hold.
    pub accepted_part: f64,
    /// Forecasts made.
    pub forecasts: usize,
}

impl Answer {
    /// Readings that are accepted, the most probable first.
    pub fn accepted(&self) -> impl Iterator<Item = &Judged> + Clone {
        self.readings.iter().filter(|judged| judged.is_accepted)
    }

    /// Number of figures that are explained, and of those of which it is told.
    #[must_use]
    pub fn explained(&self) -> (usize, usize) {
        let told = self.figures.iter().filter_map(|own| own.is_explained);
        let explained = told.clone().filter(|is_explained| *is_explained);
        (explained.count(), told.count())
    }
}

/// What is asked.
#[derive(Clone, Copy, Debug)]
pub struct Question<'a> {
    /// Parameters.
    pub parameters: &'a [Parameter],
    /// Readings.
    pub readings: &'a [Reading],
    /// Printed figures.
    pub printed: &'a [Printed],
    /// Probability that a figure is not what its name says.
    pub doubt: f64,
    /// Levels by which readings are accepted and figures explained.
    pub levels: Levels,
}

impl Question<'_> {
    /// Weighs what has been found of every reading.
    #[must_use]
    pub fn answer(&self, found: &[Option<Found>]) -> Answer {
        // A level below holds the truth over the priors, but not where figures leave it in doubt.
        let level = self.levels.accepted.filter(|level| *level >= ACCEPTED);
        let accepted_part = level.unwrap_or(ACCEPTED);
        let weights = self.weights(found);
        let mut order: Vec<usize> = (0..found.len())
            .filter(|reading| found[*reading].is_some())
            .collect();
        order.sort_by(|own, other| weights[*other].total_cmp(&weights[*own]));
        let mut held = 0.0;
        let mut readings = Vec::new();
        for reading in order {
            let Some(found) = &found[reading] else {
                continue;
            };
            // Up to a level, as a mark that is one of the draws itself is among what it holds.
            let is_accepted = match level {
                Some(level) => held <= level,
                None => held < ACCEPTED,
            };
            held += weights[reading];
            readings.push(Judged {
                reading,
                weight: weights[reading],
                is_accepted,
                log_evidence: found.log_evidence,
                parameters: self.ranges(found),
                best: found.best.clone(),
            });
        }
        let ridges = readings
            .iter()
            .filter(|judged| judged.is_accepted && judged.weight > TOLD);
        let ridges = ridges
            .flat_map(|judged| self.ridges(judged.reading, found))
            .collect();
        let pull_limit = self.pull_limit();
        let best = readings.first().map(|judged| &judged.best);
        let figures = (0..self.printed.len())
            .map(|figure| self.explained(figure, found, best, pull_limit))
            .collect();
        Answer {
            figures,
            ridges,
            readings,
            experiments: Vec::new(),
            pull_limit,
            accepted_part,
            forecasts: found.iter().flatten().map(|found| found.forecasts).sum(),
        }
    }

    /// Pull beyond which a figure is not explained.
    fn pull_limit(&self) -> f64 {
        let count = self.printed.len().max(1) as f64;
        let by_chance = || normal().inverse_cdf(0.5 + 0.5 * 0.95_f64.powf(1.0 / count));
        self.levels.pull.unwrap_or_else(by_chance)
    }

    /// One figure beside all that is known from the others.
    #[must_use]
    pub fn explain(&self, figure: usize, found: &[Option<Found>]) -> Explained {
        self.explained(figure, found, None, self.pull_limit())
    }

    /// Logarithm of the largest weight of a point.
    fn top(&self, found: &[Option<Found>]) -> f64 {
        let rows = found.iter().zip(self.readings);
        let tops = rows.filter_map(|(found, reading)| {
            let found = found.as_ref()?;
            let each = reading.weight.ln() - (found.visits as f64).ln();
            let own = found.visited.iter();
            let own = own.map(|own| each + own.point.log_likelihood - own.log_density);
            own.reduce(f64::max)
        });
        tops.fold(f64::NEG_INFINITY, f64::max)
    }

    /// Probability of every reading once the figures are known.
    fn weights(&self, found: &[Option<Found>]) -> Vec<f64> {
        let logarithms: Vec<f64> = found
            .iter()
            .zip(self.readings)
            .map(|(found, reading)| {
                let found = found.as_ref();
                found.map_or(f64::NEG_INFINITY, |found| {
                    found.log_evidence + reading.weight.ln()
                })
            })
            .collect();
        let most = logarithms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let weights: Vec<f64> = logarithms.iter().map(|own| (own - most).exp()).collect();
        let whole: f64 = weights.iter().sum();
        weights.iter().map(|weight| weight / whole).collect()
    }

    fn ranges(&self, found: &Found) -> Vec<Range> {
        let parameters = self.parameters.iter().enumerate();
        parameters
            .map(|(index, parameter)| {
                let mut parts: Vec<f64> = found
                    .points
                    .iter()
                    .map(|point| point.parts[index])
                    .collect();
                parts.sort_by(f64::total_cmp);
                let at = |tail: f64| {
                    let place = tail * (parts.len() as f64 - 1.0);
                    let below = (0..parts.len())
                        .rev()
                        .find(|index| *index as f64 <= place)
                        .unwrap_or(0);
                    let above = (below + 1).min(parts.len() - 1);
                    parts[below] + (place - below as f64) * (parts[above] - parts[below])
                };
                let (low, high) = (at(TAIL), at(1.0 - TAIL));
                Range {
                    value: parameter.at(at(0.5)),
                    best: parameter.at(found.best.parts[index]),
                    low: parameter.at(low),
                    high: parameter.at(high),
                    share: (high - low) / (1.0 - 2.0 * TAIL),
                }
            })
            .collect()
    }

    /// Pairs of parameters that the figures tell together but not apart.
    fn ridges(&self, reading: usize, found: &[Option<Found>]) -> Vec<Ridge> {
        let Some(found) = &found[reading] else {
            return Vec::new();
        };
        let covariance = covariance(&found.points, self.parameters.len());
        let mut ridges = Vec::new();
        for one in 0..self.parameters.len() {
            for other in one + 1..self.parameters.len() {
                let (own, against) = (covariance[(one, one)], covariance[(other, other)]);
                let correlation =
                    covariance[(one, other)] / (own * against).sqrt().max(f64::MIN_POSITIVE);
                if correlation.abs() < RIDGE {
                    continue;
                }
                let along = |point: &&Point| {
                    point.parts[one] / own.sqrt()
                        + correlation.signum() * point.parts[other] / against.sqrt()
                };
                let order = |one: &&Point, other: &&Point| along(one).total_cmp(&along(other));
                let ends = (
                    found.points.iter().min_by(order),
                    found.points.iter().max_by(order),
                );
                let (Some(low), Some(high)) = ends else {
                    continue;
                };
                ridges.push(Ridge {
                    reading,
                    parameters: [one, other],
                    correlation,
                    ends: [low.parts.clone(), high.parts.clone()],
                });
            }
        }
        ridges
    }

    /// A figure forecast from all others.
    fn explained(
        &self,
        figure: usize,
        found: &[Option<Found>],
        best: Option<&Point>,
        pull_limit: f64,
    ) -> Explained {
        let printed = &self.printed[figure];
        let top = self.top(found);
        let mut rows: Vec<(f64, f64, f64)> = Vec::new();
        for (found, reading) in found.iter().zip(self.readings) {
            let Some(found) = found else { continue };
            let each = reading.weight.ln() - (found.visits as f64).ln();
            for visited in &found.visited {
                let point = &visited.point;
                let Some(forecast) = &point.forecasts.figures[figure] else {
                    continue;
                };
                // What may not weigh anything is not worked out.
                let most = each + point.log_likelihood - visited.log_density;
                if most < top - NEGLIGIBLE + self.doubt.ln() {
                    continue;
                }
                let others = likelihood(self.printed, &point.forecasts, self.doubt, Some(figure));
                let Some((mean, variance)) = others.last else {
                    continue;
                };
                let (value, deviation) = figure_of(forecast, mean, variance);
                rows.push((
                    each + others.logarithm - visited.log_density,
                    value,
                    deviation,
                ));
            }
        }
        let at_best = best.and_then(|point| {
            let forecast = point.forecasts.figures[figure]?;
            Some((forecast.value, forecast.deviation))
        });
        if rows.is_empty() {
            return Explained {
                predicted: None,
                at_best,
                pull: None,
                is_explained: None,
            };
        }
        let law = Mixture::of(&rows, printed.deviation());
        let pull = law.pull(printed.value);
        Explained {
            predicted: Some((law.mean, law.deviation)),
            at_best,
            pull: Some(pull),
            is_explained: Some(pull.abs() <= pull_limit),
        }
    }

    /// What experiments would tell, from their forecasts at points of equal weight within each reading.
    ///
    /// A normal outcome with the variance v between points beside w within each tells
    /// `log2(1 + v / w) / 2` bit.
    #[must_use]
    pub fn experiments(outcomes: &[(f64, Vec<Option<Forecast>>)], count: usize) -> Vec<Told> {
        let mut told: Vec<Told> = (0..count)
            .filter_map(|experiment| {
                let rows = outcomes
                    .iter()
                    .filter_map(|(weight, forecasts)| Some((*weight, forecasts[experiment]?)));
                let rows: Vec<(f64, Forecast)> = rows.collect();
                let whole: f64 = rows.iter().map(|row| row.0).sum();
                (whole > 0.0).then_some(())?;
                let mean = rows.iter().map(|row| row.0 * row.1.value).sum::<f64>() / whole;
                let between = rows.iter().map(|row| row.0 * (row.1.value - mean).powi(2));
                let between = between.sum::<f64>() / whole;
                let within = rows
                    .iter()
                    .map(|row| row.0 * row.1.deviation.powi(2))
                    .sum::<f64>()
                    / whole;
                // No instrument reads better than a part in a million.
                let within = within + (1e-6 * mean).powi(2) + f64::MIN_POSITIVE;
                let values = rows.iter().map(|row| row.1.value);
                Some(Told {
                    experiment,
                    information_bit: 0.5 * (1.0 + between / within).log2(),
                    outcomes: (
                        values.clone().fold(f64::INFINITY, f64::min),
                        values.fold(f64::NEG_INFINITY, f64::max),
                    ),
                    deviation: within.sqrt(),
                })
            })
            .collect();
        told.sort_by(|own, other| other.information_bit.total_cmp(&own.information_bit));
        told
    }
}

/// A figure and its deviation of a deviate of the given mean and variance.
fn figure_of(forecast: &Forecast, mean: f64, variance: f64) -> (f64, f64) {
    let spread = variance.max(0.0).sqrt();
    let ends = (
        forecast.figure(mean + spread),
        forecast.figure(mean - spread),
    );
    (forecast.figure(mean), 0.5 * (ends.0 - ends.1))
}

fn normal() -> Normal {
    Normal::standard()
}
