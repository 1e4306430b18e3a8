//! Singular values within a bound of work.
//!
//! The iteration behind a singular value decomposition has no end of its own: on a matrix that holds
//! an infinity or no number it never converges.

use nalgebra::linalg::SVD;
use nalgebra::{DMatrix, Dyn};

/// Iterations after which a decomposition is given up; a matrix of 64 columns takes some two hundred.
const ITERATIONS_MAX: usize = 10_000;

/// Off-diagonal part of a singular value that counts as nothing, the same as nalgebra's own.
const TOLERANCE: f64 = 5.0 * f64::EPSILON;

/// Singular value decomposition, values descending, with the vectors that are asked for; nothing if
/// the matrix is empty, holds what is no finite number, or the iteration does not converge.
pub(crate) fn singular_value_decomposition(
    matrix: DMatrix<f64>,
    with_left_vectors: bool,
    with_right_vectors: bool,
) -> Option<SVD<f64, Dyn, Dyn>> {
    let is_finite = matrix.iter().all(|entry| entry.is_finite());
    if matrix.is_empty() || !is_finite {
        return None;
    }
    matrix.try_svd(
        with_left_vectors,
        with_right_vectors,
        TOLERANCE,
        ITERATIONS_MAX,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_that_is_not_finite_has_no_decomposition_and_comes_to_an_end() {
        for broken in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
            let mut matrix = DMatrix::identity(4, 4);
            matrix[(2, 1)] = broken;
            assert!(singular_value_decomposition(matrix, true, true).is_none());
        }
        assert!(singular_value_decomposition(DMatrix::zeros(0, 3), true, true).is_none());
    }

    #[test]
    fn values_and_vectors_are_those_of_the_unbounded_iteration_to_the_bit() {
        let matrix = DMatrix::from_fn(6, 4, |row, column| {
            ((3 * row + 7 * column) as f64).sin() * 10_f64.powf(row as f64)
        });
        let bounded = singular_value_decomposition(matrix.clone(), true, true).unwrap();
        let plain = matrix.svd(true, true);
        assert_eq!(bounded.singular_values, plain.singular_values);
        assert_eq!(bounded.u, plain.u);
        assert_eq!(bounded.v_t, plain.v_t);
    }
}
