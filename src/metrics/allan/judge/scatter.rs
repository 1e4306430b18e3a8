//! How the points of a curve scatter about a fit: scores, their correlation, and the likelihood.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::metrics::allan::covariance::TERMS;
use crate::metrics::allan::least_squares::{NUGGET, Problem};

/// Least fitted variance, as a part of that of the positive terms: signed terms may cancel.
const FITTED_LEAST: f64 = 1e-3;

/// Relative misfit of a deviation that is harmless however sure it is: what is left of a loop's or a
/// word's response, and of the covariance's own errors.
pub(crate) const HARMLESS: f64 = 0.02;

/// The distribution of a curve under fitted squares.
///
/// A point is chi-square about its fitted value, with the degrees of freedom that its variance says;
/// the cube root makes it normal (Wilson and Hilferty), and the normal scores correlate as the
/// points do. Scores are weighed with a hundredth and more of independent scatter (the nugget of the
/// fit): differences of neighbours would else decide, which the covariance knows least.
pub(crate) struct Scatter {
    expected: Vec<f64>,
    freedom: Vec<f64>,
    correlation: DMatrix<f64>,
    weighed: Cholesky<f64, Dyn>,
}

impl Scatter {
    /// Under these squares, in units of the sample period; nothing where their covariance is none.
    pub(crate) fn new(problem: &Problem, squares: &[f64; TERMS]) -> Option<Self> {
        let points = problem.points();
        let positive = problem.positive(squares);
        let mut expected = Vec::with_capacity(points);
        let mut freedom = Vec::with_capacity(points);
        let mut deviations = Vec::with_capacity(points);
        for row in 0..points {
            let level = problem.fitted(&positive, row);
            let variance = problem.point_covariance(row, row, &positive);
            expected.push(problem.fitted(squares, row).max(FITTED_LEAST * level));
            freedom.push((2.0 * level * level / variance).max(1.0));
            deviations.push(variance.sqrt());
        }
        let mut correlation = DMatrix::identity(points, points);
        for row in 0..points {
            for column in 0..row {
                let value = problem.point_covariance(row, column, &positive)
                    / (deviations[row] * deviations[column]);
                correlation[(row, column)] = value;
                correlation[(column, row)] = value;
            }
        }
        let mut weighed = correlation.clone();
        weighed.fill_diagonal(1.0 + NUGGET);
        let weighed = weighed.cholesky()?;
        Some(Self {
            expected,
            freedom,
            correlation,
            weighed,
        })
    }

    /// Fitted variances.
    pub(crate) fn expected(&self) -> &[f64] {
        &self.expected
    }

    /// Degrees of freedom of every point.
    pub(crate) fn freedom(&self) -> &[f64] {
        &self.freedom
    }

    /// Correlation of the scores.
    pub(crate) fn correlation(&self) -> &DMatrix<f64> {
        &self.correlation
    }

    /// Centre and spread of the cube root of a point over its fitted value.
    fn cube_root(freedom: f64) -> (f64, f64) {
        let square = 2.0 / (9.0 * freedom);
        (1.0 - square, square.sqrt())
    }

    /// The variance that has a normal score.
    pub(crate) fn variance(&self, row: usize, score: f64) -> f64 {
        let (centre, spread) = Self::cube_root(self.freedom[row]);
        self.expected[row] * (centre + spread * score).max(0.0).powi(3)
    }

    /// Normal scores of a curve.
    pub(crate) fn scores(&self, variance: &[f64]) -> DVector<f64> {
        DVector::from_fn(variance.len(), |row, _| self.score(row, variance[row]))
    }

    fn score(&self, row: usize, variance: f64) -> f64 {
        let (centre, spread) = Self::cube_root(self.freedom[row]);
        ((variance / self.expected[row]).cbrt() - centre) / spread
    }

    /// The scores that are left when every deviation comes nearer to its fitted one by the harmless
    /// part, or meets it.
    pub(crate) fn harmful_scores(&self, variance: &[f64]) -> DVector<f64> {
        DVector::from_fn(variance.len(), |row, _| {
            let ratio = (variance[row] / self.expected[row]).sqrt();
            let excess = ratio - 1.0;
            if excess.abs() <= HARMLESS {
                return 0.0;
            }
            let nearer = ratio - HARMLESS.copysign(excess);
            self.score(row, nearer * nearer * self.expected[row])
        })
    }

    /// Sum of squares of the scores, made independent.
    pub(crate) fn chi_squared(&self, scores: &DVector<f64>) -> f64 {
        self.whitened(scores)
            .map_or(f64::INFINITY, |it| it.norm_squared())
    }

    /// Scores made independent.
    pub(crate) fn whitened(&self, scores: &DVector<f64>) -> Option<DVector<f64>> {
        self.weighed.l_dirty().solve_lower_triangular(scores)
    }

    /// Minus twice the logarithm of the likelihood of a curve with this sum of squares, up to a
    /// constant of the curve.
    pub(crate) fn deviance(&self, chi_squared: f64) -> f64 {
        let points = self.expected.len();
        let determinant: f64 = (0..points)
            .map(|row| 2.0 * self.weighed.l_dirty()[(row, row)].ln())
            .sum();
        let spread: f64 = self
            .expected
            .iter()
            .zip(&self.freedom)
            .map(|(expected, freedom)| 2.0 / 3.0 * expected.ln() - freedom.ln())
            .sum();
        chi_squared + determinant + spread
    }

    /// A column of Allan variances, or differences of such, in standard errors and made independent.
    pub(crate) fn whitened_column(&self, column: impl Fn(usize) -> f64) -> Option<DVector<f64>> {
        let scaled = DVector::from_fn(self.expected.len(), |row, _| {
            column(row) / (self.expected[row] * (2.0 / self.freedom[row]).sqrt())
        });
        self.whitened(&scaled)
    }
}
