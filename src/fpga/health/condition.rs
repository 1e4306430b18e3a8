//! Condition number of the inverse correlation matrix.
//!
//! Checked by `condition::tests`.

use super::{smallest_pivot, symmetric_part};
use crate::fpga::float_unit::Fp;

/// Largest element beside the diagonal, over the smallest on it, before the last sweep of rotations,
/// which leaves its square: below a rounding error of the smallest eigenvalue.
const OFF_DIAGONAL_MAX: f64 = 1e-12;

/// Extreme eigenvalues of a symmetric matrix by cyclic Jacobi rotations, over its largest element.
fn extreme_eigenvalues(matrix: &[f64], p: usize, scale: f64) -> [f64; 2] {
    let mut work: Vec<f64> = matrix.iter().map(|value| value / scale).collect();
    for _ in 0..30 {
        let mut off_diagonal = 0.0_f64;
        for i in 0..p {
            for j in i + 1..p {
                off_diagonal = off_diagonal.max(work[i * p + j].abs());
                rotate(&mut work, p, i, j);
            }
        }
        // Eigenvalues move by no more than the elements beside the diagonal that are left.
        let smallest = (0..p).fold(f64::INFINITY, |least, i| least.min(work[i * p + i].abs()));
        if off_diagonal <= OFF_DIAGONAL_MAX * smallest {
            break;
        }
    }
    let eigenvalues = (0..p).map(|i| work[i * p + i]);
    let largest = eigenvalues.clone().fold(f64::NEG_INFINITY, f64::max);
    [eigenvalues.fold(f64::INFINITY, f64::min), largest]
}

/// How much the short test adds to the largest eigenvalue of the newest full look, for the change since:
/// first a little, which decides near the worst, then more, which decides far from it.
const CHANGES_SINCE: [f64; 2] = [1e-5, 0.05];

/// Share of the smallest eigenvalue that the short test leaves to rounding.
const ROUNDING_MARGIN: f64 = 1e-5;

/// Condition number from which the rounding of the short test could exceed its margin.
const SHORT_TEST_MAX: f64 = 1e7;

/// Largest condition number of the matrices of a record: ratio of the largest to the smallest eigenvalue
/// of the symmetric part; infinite once the smallest is not positive.
///
/// Rotations cost many times a factorisation, so a matrix that two factorisations show to be better
/// conditioned than the worst so far is passed over: `u I - A` positive definite means that no eigenvalue
/// exceeds `u`, and `A - (u / K) I` that none is below `u / K`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LargestCondition {
    value: f64,
    /// Largest eigenvalue over the trace, at the newest full look.
    share: f64,
}

impl LargestCondition {
    /// Looks at `matrix`, `[p * p]` row by row, of finite words.
    pub fn look<F: Fp>(&mut self, matrix: &[F], tap_count: usize) {
        let values: Vec<f64> = matrix.iter().map(|word| word.to_f64()).collect();
        let symmetric = symmetric_part(&values, tap_count);
        let trace = (0..tap_count).fold(0.0, |sum, i| sum + symmetric[i * tap_count + i]);
        if self.is_larger(&symmetric, tap_count, trace) {
            return;
        }
        let scale = symmetric
            .iter()
            .fold(0.0_f64, |top, value| top.max(value.abs()));
        if scale <= 0.0 {
            self.value = f64::INFINITY;
            return;
        }
        let [smallest, largest] = extreme_eigenvalues(&symmetric, tap_count, scale);
        self.share = largest * scale / trace;
        self.value = self.value.max(match smallest > 0.0 {
            true => largest / smallest,
            false => f64::INFINITY,
        });
    }

    /// The largest so far; 0 before the first.
    #[must_use]
    pub fn value(&self) -> f64 {
        self.value
    }

    /// Whether the largest so far is shown to exceed that of this matrix.
    fn is_larger(&self, symmetric: &[f64], p: usize, trace: f64) -> bool {
        if self.value.is_infinite() {
            return true;
        }
        // Written so that a NaN is looked at in full.
        let takes_the_test = self.value > 1.0 && self.value < SHORT_TEST_MAX && trace > 0.0;
        if !takes_the_test {
            return false;
        }
        let bounds = CHANGES_SINCE.map(|change| self.share * trace * (1.0 + change));
        let above = bounds
            .into_iter()
            .find(|bound| is_definite(symmetric, p, -1.0, *bound));
        above.is_some_and(|above| {
            let below = above / self.value * (1.0 + ROUNDING_MARGIN);
            is_definite(symmetric, p, 1.0, -below)
        })
    }
}

/// Whether `sign * matrix + shift * I` is positive definite.
fn is_definite(matrix: &[f64], p: usize, sign: f64, shift: f64) -> bool {
    let mut work: Vec<f64> = matrix.iter().map(|value| sign * value).collect();
    for i in 0..p {
        work[i * p + i] += shift;
    }
    smallest_pivot(&mut work, p) > 0.0
}

/// One Jacobi rotation that zeroes element (i, j) (Golub, Van Loan, Matrix Computations, 8.5).
fn rotate(work: &mut [f64], p: usize, i: usize, j: usize) {
    let element = work[i * p + j];
    if element.abs() <= 0.0 {
        return;
    }
    let tau = (work[j * p + j] - work[i * p + i]) / (2.0 * element);
    let tangent = if tau.is_infinite() {
        0.0
    } else {
        1.0_f64.copysign(tau) / (tau.abs() + tau.hypot(1.0))
    };
    let cosine = 1.0 / tangent.hypot(1.0);
    let sine = tangent * cosine;
    for k in 0..p {
        let (a, b) = (work[i * p + k], work[j * p + k]);
        work[i * p + k] = cosine * a - sine * b;
        work[j * p + k] = sine * a + cosine * b;
    }
    for k in 0..p {
        let (a, b) = (work[k * p + i], work[k * p + j]);
        work[k * p + i] = cosine * a - sine * b;
        work[k * p + j] = sine * a + cosine * b;
    }
    work[i * p + j] = 0.0;
    work[j * p + i] = 0.0;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_matrices_have_their_conditions() {
        // Eigenvalues of [[2, 1], [1, 2]] are 1 and 3.
        assert!((condition(&[2.0, 1.0, 1.0, 2.0], 2) - 3.0).abs() <= 1e-12);
        assert!(condition(&[1.0, 2.0, 2.0, 1.0], 2).is_infinite());
        assert!(condition(&[0.0], 1).is_infinite());
    }

    #[test]
    fn a_hilbert_matrix_has_its_published_condition() {
        // cond(H4) = 15513.738738929, a classical value.
        let hilbert: Vec<f64> = (0..16)
            .map(|k| 1.0 / f64::from(k / 4 + k % 4 + 1))
            .collect();
        let found = condition(&hilbert, 4);
        assert!((found / 15_513.738_738_929 - 1.0).abs() < 1e-10);
    }

    #[test]
    fn matrices_that_are_passed_over_leave_the_largest_condition_as_it_is() {
        // R of a filter that wakes up: a rank-one update each, as in the pipeline.
        let p = 4;
        let mut state = 5_u64;
        let mut noise = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            f64::from((state >> 32) as u32) / f64::from(u32::MAX) - 0.5
        };
        let mut matrix: Vec<f64> = (0..p * p)
            .map(|k| if k % (p + 1) == 0 { 1e-3 } else { 0.0 })
            .collect();
        let (mut largest, mut plain, mut looks) = (LargestCondition::default(), 0.0_f64, 0);
        for sample in 0..64_000 {
            let taps: [f64; 4] = std::array::from_fn(|k| {
                noise() + 30.0 * (f64::from(sample) * 0.01 + 0.1 * [0.0, 1.0, 2.0, 3.0][k]).sin()
            });
            let mut t = [0.0; 4];
            let mut denominator = 0.999;
            for i in 0..p {
                for j in 0..p {
                    t[i] += matrix[i * p + j] * taps[j];
                }
                denominator += taps[i] * t[i];
            }
            let r = 1.0 / denominator;
            for k in 0..p * p {
                matrix[k] = (matrix[k] - t[k / p] * t[k % p] * r) / 0.999;
            }
            if sample % 64 != 0 {
                continue;
            }
            let before = largest;
            largest.look(&matrix, p);
            looks += i32::from(before != largest);
            plain = plain.max(condition(&matrix, p));
            assert!((largest.value() - plain).abs() <= 0.0, "sample {sample}");
        }
        assert!(looks < 500, "{looks} of 1000 in full");
    }

    fn condition(matrix: &[f64], p: usize) -> f64 {
        let mut largest = LargestCondition::default();
        largest.look(matrix, p);
        largest.value()
    }
}
