//! Generalised least squares on an Allan variance curve, and the intervals of its coefficients.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::covariance::{
    CORRELATED, FLICKER, FLICKER_ALLAN_VARIANCE, INVERSE_SQUARE, RAMP, Structure, TERMS, WALK,
    WHITE,
};
use super::overlapping::AllanPoint;
use super::sampling::{Sampling, THIRD_AT};
use crate::metrics::estimate::interval::NORMAL_QUANTILE;
use crate::metrics::estimate::value::Estimate;

/// Rounds of reweighting with the fitted curve.
const REWEIGHTINGS: usize = 4;

/// Rounds of it from a guess that is near.
const REWEIGHTINGS_FROM_NEAR: usize = 1;

/// Share of each point's variance that is taken as its own: neighbours repeat each other so nearly
/// that without it rounding and the model's finest errors would decide between them.
pub(crate) const NUGGET: f64 = 0.02;

/// Rounds in which the other squares follow the end of an interval.
const PROFILE_ROUNDS: usize = 2;

/// Allan variance of a unit coefficient of a term but the correlated one.
pub(crate) fn basis(term: usize, tau_s: f64) -> f64 {
    match term {
        WHITE => 1.0 / tau_s,
        FLICKER => FLICKER_ALLAN_VARIANCE,
        WALK => tau_s / 3.0,
        RAMP => tau_s * tau_s / 2.0,
        _ => 1.0 / (tau_s * tau_s),
    }
}

/// Allan variance of exponentially correlated (Gauss-Markov) noise of unit variance.
///
/// `(2 T/tau) (1 - (T / 2 tau) (3 - 4 exp(-tau/T) + exp(-2 tau/T)))`.
///
/// Source: IEEE Std 952-1997 annex C.
#[must_use]
pub fn correlated_allan_variance(tau: f64, correlation_time: f64) -> f64 {
    let x = tau / correlation_time;
    if x < 0.01 {
        return 2.0 * x / 3.0 * (1.0 - 0.75 * x * (1.0 - 7.0 * x / 15.0));
    }
    // 3 - 4 e + e^2 = 2 (1 - e) + (1 - e)^2.
    let fallen = -(-x).exp_m1();
    2.0 / x * (1.0 - fallen * (2.0 + fallen) / (2.0 * x))
}

/// Squares of the terms with the correlation time of the correlated one, all in one unit of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mix {
    pub(crate) squares: [f64; TERMS],
    /// None without correlated noise.
    pub(crate) correlation_time: Option<f64>,
}

impl Mix {
    /// Allan variance of all terms; signed squares may make it negative.
    pub(crate) fn variance(&self, tau: f64) -> f64 {
        (0..TERMS)
            .map(|term| self.squares[term] * column(term, tau, self.correlation_time))
            .sum()
    }
}

/// Allan variance of a unit coefficient.
pub(crate) fn column(term: usize, tau: f64, correlation_time: Option<f64>) -> f64 {
    match (term, correlation_time) {
        (CORRELATED, Some(time)) => correlated_allan_variance(tau, time),
        (CORRELATED, None) => 0.0,
        _ => basis(term, tau),
    }
}

/// The least-squares problem of one curve, in units of one sample period.
#[derive(Clone)]
pub(crate) struct Problem {
    sample_period_s: f64,
    tau: Arc<[f64]>,
    pub(crate) variance: Vec<f64>,
    structure: Arc<Structure>,
    /// Correlation time of the correlated term, samples.
    correlation: Option<f64>,
    /// Independent records the curve is the mean of.
    records: f64,
    /// Square of the `1/tau^2` term where it is known and not fitted.
    known_inverse_square: Option<f64>,
}

/// An optimum, how it was reached from the points, and what the points scatter like.
#[derive(Clone)]
pub(crate) struct Solution {
    /// Coefficients of the columns as least squares has them, 0 where a term is not in the model.
    pub(crate) squares: [f64; TERMS],
    /// For each term in the model the weights of the points that give its coefficient.
    weights: [Option<Vec<f64>>; TERMS],
    /// Covariance of the coefficients under the fitted mix, 0 for terms not in the model.
    covariance: [[f64; TERMS]; TERMS],
}

impl Problem {
    /// The problem of fitting these points of a curve, the mean of so many independent records.
    pub(crate) fn new(points: &[AllanPoint], records: f64) -> Self {
        let (factors, counts) = lengths(points);
        Self {
            sample_period_s: points
                .first()
                .map_or(1.0, |point| point.tau_s / point.averaged_samples as f64),
            tau: factors.iter().map(|&factor| factor as f64).collect(),
            variance: points.iter().map(AllanPoint::variance).collect(),
            structure: Structure::shared(factors, counts, None),
            correlation: None,
            records,
            known_inverse_square: None,
        }
    }

    /// The same with the `1/tau^2` term of this square, in deg/h and s, known.
    pub(crate) fn with_inverse_square(self, known: Option<f64>) -> Self {
        let unit = self.in_seconds(INVERSE_SQUARE, 1.0);
        Self {
            known_inverse_square: known.map(|square| square / unit),
            ..self
        }
    }

    /// Whether the `1/tau^2` term is known, and not to be fitted.
    pub(crate) fn knows_inverse_square(&self) -> bool {
        self.known_inverse_square.is_some()
    }

    /// The same with exponentially correlated noise of this correlation time, samples, among its
    /// terms.
    pub(crate) fn with_correlation(&self, points: &[AllanPoint], correlation: f64) -> Self {
        let (factors, counts) = lengths(points);
        Self {
            structure: Structure::shared(factors, counts, Some(correlation)),
            correlation: Some(correlation),
            ..self.clone()
        }
    }

    /// The same with a column of another correlation time, whose scatter is near enough.
    pub(crate) fn with_near_correlation(&self, correlation: f64) -> Self {
        Self {
            correlation: Some(correlation),
            ..self.clone()
        }
    }

    /// Number of points.
    pub(crate) fn points(&self) -> usize {
        self.tau.len()
    }

    /// Averaging times, samples.
    pub(crate) fn tau(&self) -> &[f64] {
        &self.tau
    }

    /// Sample period, s.
    pub(crate) fn sample_period_s(&self) -> f64 {
        self.sample_period_s
    }

    /// Correlation time of the correlated term, samples.
    pub(crate) fn correlation(&self) -> Option<f64> {
        self.correlation
    }

    /// Allan variance of a unit coefficient at a point.
    pub(crate) fn column(&self, term: usize, row: usize) -> f64 {
        column(term, self.tau[row], self.correlation)
    }

    /// Fitted Allan variance at a point.
    pub(crate) fn fitted(&self, squares: &[f64; TERMS], row: usize) -> f64 {
        (0..TERMS)
            .map(|term| squares[term] * self.column(term, row))
            .sum()
    }

    /// Squares in SI units from those in units of the sample period.
    pub(crate) fn in_seconds(&self, term: usize, square: f64) -> f64 {
        if term == CORRELATED {
            return square;
        }
        square * basis(term, 1.0) / basis(term, self.sample_period_s)
    }

    /// The optimum among the terms allowed, reweighted to its own curve.
    ///
    /// No square is bound to be positive: a bound would pull the others. Covariances are those of
    /// the positive terms.
    pub(crate) fn solve(&self, allowed: &[bool; TERMS]) -> Solution {
        // A first guess of the mix: every point has its own variance and is independent.
        let covariance = DMatrix::from_diagonal(&DVector::from_fn(self.points(), |row, _| {
            self.variance[row].powi(2) * self.tau[row]
        }));
        let (squares, estimator) = self.iterate(allowed, covariance, REWEIGHTINGS);
        let mut weights: [Option<Vec<f64>>; TERMS] = Default::default();
        if let Some(estimator) = estimator {
            let columns = (0..TERMS).filter(|&term| allowed[term]);
            for (row, term) in columns.enumerate() {
                weights[term] = Some(estimator.row(row).iter().copied().collect());
            }
        }
        let points = self.covariance(&self.positive(&squares));
        let pair = |a: usize, b: usize| match (&weights[a], &weights[b]) {
            (Some(a), Some(b)) => {
                let along = &points * DVector::from_column_slice(b);
                along.dot(&DVector::from_column_slice(a))
            }
            _ => 0.0,
        };
        let covariance = std::array::from_fn(|a| std::array::from_fn(|b| pair(a, b)));
        Solution {
            squares,
            weights,
            covariance,
        }
    }

    /// The squares of [`solve`](Self::solve) alone, from squares that are near.
    pub(crate) fn squares_from(
        &self,
        allowed: &[bool; TERMS],
        near: &[f64; TERMS],
    ) -> [f64; TERMS] {
        let covariance = self.covariance(&self.positive(near));
        self.iterate(allowed, covariance, REWEIGHTINGS_FROM_NEAR).0
    }

    /// Squares, and the matrix that takes the points to them, after rounds of reweighting.
    fn iterate(
        &self,
        allowed: &[bool; TERMS],
        mut covariance: DMatrix<f64>,
        rounds: usize,
    ) -> ([f64; TERMS], Option<DMatrix<f64>>) {
        let columns: Vec<usize> = (0..TERMS).filter(|&term| allowed[term]).collect();
        let design = DMatrix::from_fn(self.points(), columns.len(), |row, column| {
            self.column(columns[column], row)
        });
        let known = self.known_inverse_square;
        let known = known.filter(|_| !allowed[INVERSE_SQUARE]).unwrap_or(0.0);
        let measured = DVector::from_fn(self.points(), |row, _| {
            self.variance[row] - known * self.column(INVERSE_SQUARE, row)
        });
        let mut squares = [0.0; TERMS];
        let mut kept = None;
        for round in 0..=rounds {
            let Some(found) = estimator(&design, covariance) else {
                break;
            };
            let solved = &found * &measured;
            squares = [0.0; TERMS];
            for (&term, &value) in columns.iter().zip(solved.iter()) {
                squares[term] = value;
            }
            if known > 0.0 {
                squares[INVERSE_SQUARE] = known;
            }
            kept = Some(found);
            if round == rounds {
                break;
            }
            covariance = self.covariance(&self.positive(&squares));
        }
        (squares, kept)
    }
}

impl Problem {
    /// Squares that a noise can have; never all zero.
    pub(crate) fn positive(&self, squares: &[f64; TERMS]) -> [f64; TERMS] {
        let mut positive = squares.map(|square| square.max(0.0));
        let least = 1e-3 * self.variance[0] * self.tau[0];
        positive[WHITE] = positive[WHITE].max(least);
        positive
    }

    fn covariance(&self, squares: &[f64; TERMS]) -> DMatrix<f64> {
        let points = self.points();
        let mut covariance = DMatrix::zeros(points, points);
        for row in 0..points {
            for column in 0..=row {
                let value = self.structure.covariance(row, column, squares);
                covariance[(row, column)] = value;
                covariance[(column, row)] = value;
            }
            covariance[(row, row)] *= 1.0 + NUGGET;
        }
        covariance
    }

    /// Covariance of two points of the curve under these squares, none negative.
    pub(crate) fn point_covariance(
        &self,
        row: usize,
        column: usize,
        squares: &[f64; TERMS],
    ) -> f64 {
        self.structure.covariance(row, column, squares) / self.records
    }

    /// What the other squares are if one term's true square is this: those the fit would have with
    /// it given, none negative. Where one term was fitted too high, another was fitted too low.
    fn given(&self, solution: &Solution, term: usize, truth: f64) -> [f64; TERMS] {
        let own = solution.covariance[term][term];
        let excess = solution.squares[term] - truth;
        let squares = std::array::from_fn(|other| {
            let slope = solution.covariance[other][term] / own.max(f64::MIN_POSITIVE);
            solution.squares[other] - slope * excess
        });
        let mut squares = self.positive(&squares);
        squares[term] = truth;
        squares
    }

    /// Variance of a coefficient as a quadratic in its true square, the other squares given.
    fn powers(&self, solution: &Solution, term: usize, others: &[f64; TERMS]) -> Option<[f64; 3]> {
        let weights = solution.weights[term].as_ref()?;
        let powers = self.structure.combined(weights, others, term);
        Some(powers.map(|power| power / self.records))
    }

    /// Coefficient over the standard error it would have if the term did not exist and the others
    /// were as fitted.
    pub(crate) fn significance(&self, solution: &Solution, term: usize) -> f64 {
        let square = solution.squares[term];
        let others = self.given(solution, term, square);
        match self.powers(solution, term, &others) {
            Some(powers) if powers[0] > 0.0 => square / powers[0].sqrt(),
            // Nothing but the term itself scatters.
            Some(_) if square > 0.0 => f64::INFINITY,
            _ => 0.0,
        }
    }

    /// Standard error of a coefficient as fitted, in units of the sample period.
    pub(crate) fn standard_error(&self, solution: &Solution, term: usize) -> f64 {
        (solution.covariance[term][term] / self.records)
            .max(0.0)
            .sqrt()
    }

    /// Ends of the 95 % interval of a square: all true squares, none negative, under which the
    /// fitted one lies between its quantiles 0.025 and 0.975, the other squares being what they
    /// would be fitted as beside that true one.
    pub(crate) fn interval(&self, solution: &Solution, term: usize) -> Option<Estimate> {
        let found = solution.squares[term];
        let end = |normal: f64| -> Option<f64> {
            let mut truth = found.max(0.0);
            for _ in 0..=PROFILE_ROUNDS {
                let others = self.given(solution, term, truth);
                truth = self.sampling(solution, term, &others)?.end(found, normal);
            }
            Some(truth)
        };
        Some(Estimate::with_interval(
            found.max(0.0),
            end(NORMAL_QUANTILE)?,
            end(-NORMAL_QUANTILE)?,
        ))
    }

    /// How a coefficient scatters beside the other squares.
    fn sampling(
        &self,
        solution: &Solution,
        term: usize,
        others: &[f64; TERMS],
    ) -> Option<Sampling> {
        let powers = self.powers(solution, term, others)?;
        let found = solution.squares[term];
        let scale = found.abs().max(powers[0].max(0.0).sqrt());
        let third = |at: f64| {
            let mut squares = *others;
            squares[term] = at * scale;
            self.third_cumulant(solution, term, &squares)
        };
        Some(Sampling {
            powers,
            thirds: THIRD_AT.map(third),
            scale,
        })
    }

    /// Third cumulant of a coefficient under these true squares.
    ///
    /// Chi-square variables that share so many degrees of freedom as their covariances say:
    /// `k3(i,j,k) = 2 (k_ij k_jk k_ki)^(2/3) / (mu_i mu_j mu_k)^(1/3)`, exact where they are one.
    fn third_cumulant(&self, solution: &Solution, term: usize, squares: &[f64; TERMS]) -> f64 {
        let Some(weights) = solution.weights[term].as_ref() else {
            return 0.0;
        };
        let points = self.points();
        let factors: Vec<f64> = (0..points)
            .map(|row| weights[row] / self.fitted(squares, row).cbrt())
            .collect();
        // Covariances are symmetric, and their roots the dearest part: the factors of the rows come last.
        let mut shared = DMatrix::zeros(points, points);
        for column in 0..points {
            for row in column..points {
                let covariance = self.structure.covariance(row, column, squares).max(0.0);
                shared[(row, column)] = covariance.cbrt().powi(2);
            }
        }
        shared.fill_upper_triangle_with_lower_triangle();
        let shared = DMatrix::from_fn(points, points, |row, column| {
            factors[row] * shared[(row, column)]
        });
        let twice = &shared * &shared;
        2.0 * twice.component_mul(&shared.transpose()).sum() / (self.records * self.records)
    }
}

impl Solution {
    /// Coefficient of a term in units of the sample period.
    pub(crate) fn square(&self, term: usize) -> f64 {
        self.squares[term]
    }
}

fn lengths(points: &[AllanPoint]) -> (Vec<usize>, Vec<usize>) {
    points
        .iter()
        .map(|point| (point.averaged_samples, point.count))
        .unzip()
}

/// `(X^T V^-1 X)^-1 X^T V^-1`, points and columns scaled; nothing where V is not positive definite
/// or the columns depend on each other.
fn estimator(design: &DMatrix<f64>, mut covariance: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let deviations: Vec<f64> = covariance.diagonal().iter().map(|v| v.sqrt()).collect();
    let points = deviations.len();
    for row in 0..points {
        for column in 0..points {
            covariance[(row, column)] /= deviations[row] * deviations[column];
        }
    }
    let mut scaled = design.clone();
    for (mut row, deviation) in scaled.row_iter_mut().zip(&deviations) {
        row /= *deviation;
    }
    let factor = covariance.cholesky()?;
    let mut whitened = factor.l_dirty().solve_lower_triangular(&scaled)?;
    let scales: Vec<f64> = whitened.column_iter().map(|c| c.norm()).collect();
    for (mut column, scale) in whitened.column_iter_mut().zip(&scales) {
        column /= *scale;
    }
    let columns = whitened.qr();
    let inverse = columns
        .r()
        .solve_upper_triangular(&columns.q().transpose())?;
    // Back through the whitening: weights of the points as they are.
    let mut weights = factor
        .l_dirty()
        .tr_solve_lower_triangular(&inverse.transpose())?
        .transpose();
    for row in 0..weights.nrows() {
        for column in 0..points {
            weights[(row, column)] /= scales[row] * deviations[column];
        }
    }
    Some(weights)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn correlated_noise_is_a_walk_at_first_and_white_at_last() {
        let close = |got: f64, wanted: f64, rtol: f64| {
            assert!((got / wanted - 1.0).abs() < rtol, "{got} {wanted}");
        };
        // K^2 = 2 / T, N^2 = 2 T; the series meets the closed form.
        close(correlated_allan_variance(1e-3, 1.0), 2e-3 / 3.0, 1e-3);
        close(correlated_allan_variance(1e4, 1.0), 2e-4, 2e-4);
        let closed =
            |x: f64| 2.0 / x * (1.0 - (3.0 - 4.0 * (-x).exp() + (-2.0 * x).exp()) / (2.0 * x));
        close(
            correlated_allan_variance(0.00999, 1.0),
            closed(0.00999),
            1e-6,
        );
        // Its largest deviation, 0.437 q sqrt(T) at 1.89 T to three digits, q^2 T = 2.
        close(
            correlated_allan_variance(1.89, 1.0),
            2.0 * 0.437 * 0.437,
            2.0 * 0.0005 / 0.437,
        );
    }
}
