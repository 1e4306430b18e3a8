//! Curves drawn at random under a fit.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::scatter::Scatter;
use crate::random::{Stream, Streams};

/// Seed of all draws: results depend on the record alone.
const SEED: u64 = 952;

/// Curves as a record of the fitted terms would give.
pub(crate) struct Draws<'a> {
    scatter: &'a Scatter,
    factor: DMatrix<f64>,
    stream: Stream,
}

impl<'a> Draws<'a> {
    pub(crate) fn new(scatter: &'a Scatter) -> Self {
        Self {
            scatter,
            factor: square_root(scatter.correlation()),
            stream: Streams::new(SEED, 0).stream("allan curves"),
        }
    }

    /// The next curve, as variances.
    pub(crate) fn next(&mut self) -> Vec<f64> {
        let points = self.factor.nrows();
        let mut normals = vec![0.0; points];
        self.stream.fill_normal(&mut normals);
        let scores = &self.factor * DVector::from_vec(normals);
        (0..points)
            .map(|row| self.scatter.variance(row, scores[row]))
            .collect()
    }
}

/// A square root of a correlation matrix, of which quadrature may leave an eigenvalue below zero.
fn square_root(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let decomposed = SymmetricEigen::new(matrix.clone());
    let roots = decomposed.eigenvalues.map(|value| value.max(0.0).sqrt());
    decomposed.eigenvectors * DMatrix::from_diagonal(&roots)
}
