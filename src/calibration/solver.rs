//! Least squares of one gyro: batch and recursive, both through orthogonal transformations.

use nalgebra::{DMatrix, DVector};

/// Solution of a weighted least-squares problem and how it depends on each observation.
pub(super) struct Fit {
    /// Coefficients, `[columns]`.
    pub(super) solution: DVector<f64>,
    /// `G = d solution / d observations`, `[columns, groups]`.
    pub(super) gain: DMatrix<f64>,
}

/// Minimises `sum w_i (y_i - a_i x)^2` by Householder QR of the rows times `sqrt(w_i)`.
///
/// * `rows`: `[groups, columns]`; `observations`, `weights`: `[groups]`, weights >= 0.
///
/// Returns nothing if the triangular factor has no inverse.
pub(super) fn weighted_least_squares(
    rows: &DMatrix<f64>,
    observations: &DVector<f64>,
    weights: &[f64],
) -> Option<Fit> {
    let roots = DVector::from_iterator(weights.len(), weights.iter().map(|weight| weight.sqrt()));
    let mut scaled = rows.clone();
    for (mut row, root) in scaled.row_iter_mut().zip(roots.iter()) {
        row *= *root;
    }
    let qr = scaled.qr();
    let (q, r) = (qr.q(), qr.r());
    let mut gain = r.solve_upper_triangular(&q.transpose())?;
    for (mut column, root) in gain.column_iter_mut().zip(roots.iter()) {
        column *= *root;
    }
    let solution = r.solve_upper_triangular(&q.tr_mul(&observations.component_mul(&roots)))?;
    Some(Fit { solution, gain })
}

/// Recursive least squares in square-root information form.
///
/// State: the triangular `R` and `z` with `R^T R = P^-1` and `R x = z`. An update with forgetting
/// factor lambda and row weight w triangularises
///
/// ```text
/// | sqrt(lambda) R   sqrt(lambda) z |
/// | sqrt(w) a        sqrt(w) y      |
/// ```
///
/// which is the recursion of the patent's equation (14) with `P^-1 <- lambda P^-1 + w a^T a`, but
/// never subtracts large numbers: it keeps the digits that the covariance form loses.
pub(super) struct SquareRootInformation {
    /// `[R | z]`, `[columns, columns + 1]`.
    triangle: DMatrix<f64>,
}

impl SquareRootInformation {
    /// `X_0 = 0`, `P_0 = xi I` (equation 18).
    pub(super) fn new(columns: usize, initial_covariance: f64) -> Self {
        let mut triangle = DMatrix::zeros(columns, columns + 1);
        triangle.fill_diagonal(initial_covariance.sqrt().recip());
        Self { triangle }
    }

    /// Takes in one observation `y` of the row `a`.
    pub(super) fn update(&mut self, forgetting: f64, weight: f64, row: &[f64], observation: f64) {
        let columns = row.len();
        let mut stacked = DMatrix::zeros(columns + 1, columns + 1);
        stacked
            .rows_mut(0, columns)
            .copy_from(&(&self.triangle * forgetting.sqrt()));
        let root = weight.sqrt();
        for (index, value) in row.iter().enumerate() {
            stacked[(columns, index)] = root * value;
        }
        stacked[(columns, columns)] = root * observation;
        self.triangle.copy_from(&stacked.qr().r().rows(0, columns));
    }

    /// The coefficients; nothing if `R` has no inverse.
    pub(super) fn solution(&self) -> Option<DVector<f64>> {
        let columns = self.triangle.nrows();
        let z = self.triangle.column(columns).into_owned();
        self.factor().solve_upper_triangular(&z)
    }

    /// `G = P a_i^T w_i` for the groups' rows and their final weights, `[columns, groups]`.
    pub(super) fn gain(&self, rows: &DMatrix<f64>, weights: &[f64]) -> Option<DMatrix<f64>> {
        let factor = self.factor();
        let half = factor.tr_solve_upper_triangular(&rows.transpose())?;
        let mut gain = factor.solve_upper_triangular(&half)?;
        for (mut column, weight) in gain.column_iter_mut().zip(weights) {
            column *= *weight;
        }
        Some(gain)
    }

    fn factor(&self) -> DMatrix<f64> {
        let columns = self.triangle.nrows();
        self.triangle.columns(0, columns).into_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_recursion_is_the_batch_solution_of_its_final_weights() {
        let rows = DMatrix::from_row_slice(5, 2, &[1., 1., 2., 1., 5., 1., 7., 1., -3., 1.]);
        let observations = DVector::from_row_slice(&[1.0, -2.0, 4.0, 0.5, 3.0]);
        let forgetting = [0.9, 0.5, 0.8, 1.0, 0.7];
        let weights: Vec<f64> = (0..5)
            .map(|index| forgetting[index + 1..].iter().product())
            .collect();
        let batch = weighted_least_squares(&rows, &observations, &weights).expect("full rank");
        let mut recursion = SquareRootInformation::new(2, 1e14);
        for (index, factor) in forgetting.iter().enumerate() {
            let row: Vec<f64> = rows.row(index).iter().copied().collect();
            recursion.update(*factor, 1.0, &row, observations[index]);
        }
        let solution = recursion.solution().expect("full rank");
        assert!((&solution - &batch.solution).amax() < 1e-12);
        let gain = recursion.gain(&rows, &weights).expect("full rank");
        assert!((gain - batch.gain).amax() < 1e-12);
    }
}
