//! Weighted, partly non-negative least squares on an Allan variance curve.

use nalgebra::{DMatrix, DVector};

use super::allan::AllanPoint;
use super::allan_covariance::correlation;
use super::noise_fit::FLICKER_ALLAN_VARIANCE;

/// Rounds of reweighting with the fitted curve.
const REWEIGHTINGS: usize = 4;

/// Terms of the fit, in the order of its columns: N^2, B^2, K^2, R^2 and the signed `1/tau^2`.
pub(crate) const TERMS: usize = 5;
pub(crate) const WHITE: usize = 0;
pub(crate) const FLICKER: usize = 1;
pub(crate) const WALK: usize = 2;
pub(crate) const RAMP: usize = 3;
pub(crate) const INVERSE_SQUARE: usize = 4;

/// Allan variance of a unit coefficient of a term.
pub(crate) fn basis(term: usize, tau_s: f64) -> f64 {
    match term {
        WHITE => 1.0 / tau_s,
        FLICKER => FLICKER_ALLAN_VARIANCE,
        WALK => tau_s / 3.0,
        RAMP => tau_s * tau_s / 2.0,
        _ => 1.0 / (tau_s * tau_s),
    }
}

/// Allan variance of the fitted terms.
pub(crate) fn fitted_variance(squares: &[f64; TERMS], tau_s: f64) -> f64 {
    (0..TERMS)
        .map(|term| squares[term] * basis(term, tau_s))
        .sum()
}

/// The least-squares problem of one curve.
pub(crate) struct Problem {
    tau_s: Vec<f64>,
    variance: Vec<f64>,
    freedom: Vec<f64>,
    /// Correlation matrix of the points.
    correlation: DMatrix<f64>,
}

/// A constrained optimum and the covariance of its coefficients.
pub(crate) struct Solution {
    /// Coefficients of the columns, 0 where a term is not in the model.
    pub(crate) squares: [f64; TERMS],
    standard_errors: [f64; TERMS],
}

impl Solution {
    /// Standard errors of the coefficients, 0 where a term is not in the model.
    pub(crate) fn standard_errors(&self) -> [f64; TERMS] {
        self.standard_errors
            .map(|error| if error.is_finite() { error } else { 0.0 })
    }

    /// Coefficient over its standard error, 0 where it is not positive.
    pub(crate) fn significance(&self, term: usize) -> f64 {
        if self.squares[term] > 0.0 {
            self.squares[term] / self.standard_errors[term]
        } else {
            0.0
        }
    }
}

impl Problem {
    /// The problem of fitting these points.
    pub(crate) fn new(points: &[AllanPoint]) -> Self {
        let tau_s: Vec<f64> = points.iter().map(|point| point.tau_s).collect();
        let correlation = DMatrix::from_fn(tau_s.len(), tau_s.len(), |i, j| {
            correlation(tau_s[i], tau_s[j])
        });
        Self {
            variance: points.iter().map(AllanPoint::variance).collect(),
            freedom: points
                .iter()
                .map(|point| point.degrees_of_freedom)
                .collect(),
            tau_s,
            correlation,
        }
    }

    /// Standard deviation of every point given the curve it scatters about.
    fn standard_deviations(&self, curve: &[f64]) -> Vec<f64> {
        curve
            .iter()
            .zip(&self.freedom)
            .map(|(value, freedom)| value * (2.0 / freedom).sqrt())
            .collect()
    }

    /// The non-negative optimum among the terms allowed, reweighted to its own curve.
    pub(crate) fn solve(&self, allowed: &[bool; TERMS]) -> Solution {
        let mut curve = self.variance.clone();
        let mut best = [0.0; TERMS];
        for _ in 0..REWEIGHTINGS {
            let deviations = self.standard_deviations(&curve);
            best = self.best_active_set(allowed, &deviations).1;
            for ((value, tau), measured) in curve.iter_mut().zip(&self.tau_s).zip(&self.variance) {
                // The signed term can carry the curve below zero at the shortest tau of a poor
                // fit; a weight needs a positive variance.
                *value = fitted_variance(&best, *tau).max(0.1 * measured);
            }
        }
        // Terms that rest at zero keep their columns here: they might have been above it.
        let columns: Vec<usize> = (0..TERMS).filter(|&term| allowed[term]).collect();
        let standard_errors = self.standard_errors(&columns, &curve);
        let squares = best;
        Solution {
            squares,
            standard_errors,
        }
    }

    /// Rows divided by the standard deviation of their point.
    fn weighted_design(&self, columns: &[usize], deviations: &[f64]) -> DMatrix<f64> {
        DMatrix::from_fn(self.tau_s.len(), columns.len(), |row, column| {
            basis(columns[column], self.tau_s[row]) / deviations[row]
        })
    }

    /// Drop of the weighted sum of squares from one model to another, both weighted with the curve
    /// of the first: how much better the second explains what the first is supposed to have made.
    pub(crate) fn improvement(&self, first: &[bool; TERMS], second: &[bool; TERMS]) -> f64 {
        let squares = self.solve(first).squares;
        let curve: Vec<f64> = self
            .tau_s
            .iter()
            .zip(&self.variance)
            .map(|(tau, measured)| fitted_variance(&squares, *tau).max(0.01 * measured))
            .collect();
        let deviations = self.standard_deviations(&curve);
        self.best_active_set(first, &deviations).0 - self.best_active_set(second, &deviations).0
    }

    /// Tries every subset of the allowed terms; the best one with non-negative squares wins.
    fn best_active_set(&self, allowed: &[bool; TERMS], deviations: &[f64]) -> (f64, [f64; TERMS]) {
        let right = DVector::from_fn(self.tau_s.len(), |row, _| {
            self.variance[row] / deviations[row]
        });
        let mut best: Option<(f64, [f64; TERMS])> = None;
        for subset in 0_u32..(1 << INVERSE_SQUARE) {
            let columns: Vec<usize> = (0..TERMS)
                .filter(|&term| {
                    allowed[term] && (term == INVERSE_SQUARE || subset & (1 << term) != 0)
                })
                .collect();
            let design = self.weighted_design(&columns, deviations);
            let Some(solved) = scaled_least_squares(&design, &right) else {
                continue;
            };
            let feasible = columns
                .iter()
                .zip(solved.iter())
                .all(|(&term, &value)| term == INVERSE_SQUARE || value >= 0.0);
            let misfit = (&design * &solved - &right).norm_squared();
            if feasible && best.as_ref().is_none_or(|(least, ..)| misfit < *least) {
                let mut squares = [0.0; TERMS];
                for (&term, &value) in columns.iter().zip(solved.iter()) {
                    squares[term] = value;
                }
                best = Some((misfit, squares));
            }
        }
        best.unwrap_or((f64::INFINITY, [0.0; TERMS]))
    }

    /// Standard errors of the weighted least squares under the correlation of the points.
    ///
    /// With G the pseudo-inverse of the weighted design, the covariance is `G rho G^T`.
    fn standard_errors(&self, columns: &[usize], curve: &[f64]) -> [f64; TERMS] {
        let mut errors = [f64::INFINITY; TERMS];
        let design = self.weighted_design(columns, &self.standard_deviations(curve));
        let scales: Vec<f64> = design.column_iter().map(|column| column.norm()).collect();
        let mut scaled = design;
        for (mut column, scale) in scaled.column_iter_mut().zip(&scales) {
            column /= *scale;
        }
        let Ok(inverse) = scaled.pseudo_inverse(1e-13) else {
            return errors;
        };
        let covariance = &inverse * &self.correlation * inverse.transpose();
        for (index, &term) in columns.iter().enumerate() {
            errors[term] = covariance[(index, index)].max(0.0).sqrt() / scales[index];
        }
        errors
    }
}

/// Least squares by singular values with columns scaled to unit length; `None` without columns.
fn scaled_least_squares(design: &DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
    if design.ncols() == 0 {
        return None;
    }
    let scales: Vec<f64> = design.column_iter().map(|column| column.norm()).collect();
    let mut scaled = design.clone();
    for (mut column, scale) in scaled.column_iter_mut().zip(&scales) {
        column /= *scale;
    }
    let mut solved = scaled.svd(true, true).solve(right, 1e-13).ok()?;
    for (value, scale) in solved.iter_mut().zip(&scales) {
        *value /= scale;
    }
    Some(solved)
}
