//! Intervals of the fitted terms, none of which exceeds what the curve as a whole allows.

use super::covariance::{CORRELATED, INVERSE_SQUARE};
use super::judge::choice::Choice;
use super::least_squares::{Problem, Solution};
use super::noise_fit::Term;
use crate::metrics::estimate::interval;
use crate::metrics::estimate::value::Estimate;

/// Probability with which the band lies above the true curve at all averaging times of the fit.
const BAND_CONFIDENCE: f64 = 0.99;

/// Standard errors by which what a response takes from the curve may be more than fitted: quantile
/// 0.995 of the normal distribution.
const RESPONSE_QUANTILE: f64 = 2.576;

/// Rise of the sum of squares at the ends of a 95 % interval, quantile of chi-square with one degree
/// of freedom.
const RISE: f64 = 3.841_459;

/// Steps in which the ends of a correlation time are sought, and their ratio.
const STEPS: usize = 60;
const RATIO: f64 = 1.05;

/// Intervals of the terms of one fit.
pub(crate) struct Limits<'a> {
    choice: &'a Choice,
    solution: Solution,
    /// Upper end of a simultaneous band of the curve, without what loop or filter take from it.
    band: Vec<f64>,
}

impl<'a> Limits<'a> {
    pub(crate) fn new(choice: &'a Choice) -> Self {
        let problem = &choice.problem;
        let solution = problem.solve(&choice.allowed);
        let points = problem.points();
        // Bonferroni: each point gets its part of the probability, all of it above.
        let tail = (1.0 - BAND_CONFIDENCE) / points as f64;
        // The response is known as well as the record shows it: its error would else cut N short.
        let response = solution.square(INVERSE_SQUARE);
        let error = problem.standard_error(&solution, INVERSE_SQUARE);
        let taken = (response - RESPONSE_QUANTILE * error).min(0.0);
        let band = (0..points).map(|row| {
            let freedom = choice.scatter.freedom()[row];
            let deviation = problem.variance[row].sqrt();
            let upper = interval::deviation_at(deviation, freedom, 1.0 - 2.0 * tail).high;
            upper * upper - taken * problem.column(INVERSE_SQUARE, row)
        });
        Self {
            band: band.collect(),
            choice,
            solution,
        }
    }

    /// The fit of the chosen terms.
    pub(crate) fn solution(&self) -> &Solution {
        &self.solution
    }

    /// Square of a term of the fit and its standard error, in deg/h and s.
    pub(crate) fn square(&self, index: usize) -> [f64; 2] {
        let problem = &self.choice.problem;
        let unit = problem.in_seconds(index, 1.0);
        [
            self.solution.square(index) * unit,
            problem.standard_error(&self.solution, index) * unit,
        ]
    }

    /// A term, its square times `factor`, in deg/h and s.
    ///
    /// Below a `1/tau^2` term that is negative beyond chance, the mark of a loop or a filter, a
    /// quantisation of any size could hide: nothing bounds it. Another square that is, as one in forty of a
    /// term that is not there, leaves no true value; its limit is its standard error, below which no
    /// record tells it from nothing.
    pub(crate) fn term(&self, index: usize, factor: f64) -> Term {
        let problem = &self.choice.problem;
        let own = if self.choice.allowed[index] {
            &self.solution
        } else {
            let mut with = self.choice.allowed;
            with[index] = true;
            &problem.solve(&with)
        };
        let unit = problem.in_seconds(index, 1.0) * factor;
        let [mut low, mut high] = match problem.interval(own, index) {
            Some(interval) => [interval.low, interval.high],
            None => [0.0, f64::INFINITY],
        };
        let most = self.most(problem, index);
        low = low.min(most);
        high = high.min(most);
        let error = problem.standard_error(own, index);
        if high <= 0.0 {
            high = if index == INVERSE_SQUARE {
                f64::INFINITY
            } else {
                error
            };
        }
        let square = own.square(index) * unit;
        let error = error * unit;
        Term::new(square, error, [low * unit, high * unit])
    }

    /// The largest square of a term that does not exceed the band anywhere.
    fn most(&self, problem: &Problem, index: usize) -> f64 {
        let bounds = self.band.iter().enumerate();
        bounds
            .map(|(row, band)| band / problem.column(index, row))
            .fold(f64::INFINITY, f64::min)
    }

    /// The correlation time with the times at which the best fit is so much worse that the true one
    /// is not likely there.
    pub(crate) fn correlation_time_s(&self) -> Estimate {
        let problem = &self.choice.problem;
        let found = problem.correlation().unwrap_or(0.0);
        let misfit = |time: f64| {
            let near = problem.with_near_correlation(time);
            let squares = near.squares_from(&self.choice.allowed, &self.choice.squares);
            let residuals = self
                .choice
                .scatter
                .whitened_column(|row| problem.variance[row] - near.fitted(&squares, row));
            residuals.map_or(f64::INFINITY, |it| it.norm_squared())
        };
        let own = misfit(found);
        let end = |ratio: f64| {
            let mut time = found;
            for _ in 0..STEPS {
                time *= ratio;
                if misfit(time) > own + RISE {
                    break;
                }
            }
            time
        };
        let period = problem.sample_period_s();
        let [value, low, high] = [found, end(1.0 / RATIO), end(RATIO)].map(|time| time * period);
        debug_assert!(self.choice.allowed[CORRELATED]);
        Estimate::with_interval(value, low, high)
    }
}
