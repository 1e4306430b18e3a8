//! Health of the inverse correlation matrix: what fails, how it shows, and when.
//!
//! The covariance form of RLS loses its meaning in four ways, each with its own sign:
//!
//! | failure | sign | cause |
//! |---|---|---|
//! | asymmetry | `R[i][j] != R[j][i]` | rounding of `(t_i*r)*t_j`; grows as `alpha^-k` |
//! | lost definiteness | smallest pivot <= 0 | asymmetry, or digits lost to a large delta |
//! | wind-up | diagonal above delta | alpha < 1 and an input that does not excite every tap |
//! | poisoning | NaN or infinity | a bad input word, or overflow after one of the above |
//!
//! Source: derived (the antisymmetric part of R obeys `A_{k+1} = A_k / alpha`); the covariance
//! form's conditions as in Haykin, Adaptive Filter Theory, chapter on square-root filters.
//!
//! Checked by `health::tests`, `fpga_health`.

mod condition;

pub use condition::LargestCondition;

use super::float_unit::Fp;

/// Asymmetry of R, relative, from which the matrix counts as failed.
pub const ASYMMETRY_LIMIT: f64 = 0.01;

/// One look at an inverse correlation matrix. Dimensionless but for the diagonal.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MatrixHealth {
    /// Largest `|R[i][j] - R[j][i]|` over the largest `|R[i][j]|`.
    pub asymmetry: f64,
    /// Smallest pivot of the Cholesky (L D L') factorisation of the symmetric part, over the
    /// largest diagonal element. Not positive: R is not a correlation matrix any more.
    pub pivot_min: f64,
    /// Largest diagonal element over delta. Without forgetting it can only fall below 1.
    pub wind_up: f64,
    /// Whether every element is finite.
    pub is_finite: bool,
}

impl MatrixHealth {
    /// Judges `matrix`, `[p * p]` row by row, that started as `delta * I`.
    ///
    /// # Panics
    /// If the length is not `tap_count` squared.
    #[must_use]
    pub fn of<F: Fp>(matrix: &[F], tap_count: usize, delta: F) -> Self {
        assert_eq!(
            matrix.len(),
            tap_count * tap_count,
            "matrix of {tap_count} taps"
        );
        let values: Vec<f64> = matrix.iter().map(|word| word.to_f64()).collect();
        if !values.iter().all(|value| value.is_finite()) {
            return Self {
                asymmetry: f64::NAN,
                pivot_min: f64::NAN,
                wind_up: f64::NAN,
                is_finite: false,
            };
        }
        let p = tap_count;
        let mut largest = 0.0_f64;
        let mut difference = 0.0_f64;
        let mut diagonal = 0.0_f64;
        for i in 0..p {
            diagonal = diagonal.max(values[i * p + i].abs());
            for j in 0..p {
                let (upper, lower) = (values[i * p + j], values[j * p + i]);
                largest = largest.max(upper.abs());
                difference = difference.max((upper - lower).abs());
            }
        }
        let pivot = smallest_pivot(&mut symmetric_part(&values, p), p);
        Self {
            asymmetry: ratio(difference, largest),
            pivot_min: ratio(pivot, diagonal),
            wind_up: diagonal / delta.to_f64(),
            is_finite: true,
        }
    }

    /// Whether the matrix can still serve: finite, symmetric to 1 %, positive definite.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        self.is_finite && self.asymmetry <= ASYMMETRY_LIMIT && self.pivot_min > 0.0
    }
}

fn ratio(numerator: f64, denominator: f64) -> f64 {
    if denominator > 0.0 {
        numerator / denominator
    } else {
        numerator
    }
}

/// Mean of a matrix and its transpose.
fn symmetric_part(matrix: &[f64], p: usize) -> Vec<f64> {
    let mut symmetric = vec![0.0; p * p];
    for i in 0..p {
        for j in 0..p {
            // Halves first, so that the sum of two large elements cannot overflow.
            symmetric[i * p + j] = 0.5 * matrix[i * p + j] + 0.5 * matrix[j * p + i];
        }
    }
    symmetric
}

/// Smallest pivot of L D L' without pivoting, in place; stops at the first that is not positive.
fn smallest_pivot(work: &mut [f64], p: usize) -> f64 {
    let mut smallest = f64::INFINITY;
    for k in 0..p {
        let pivot = work[k * p + k];
        smallest = smallest.min(pivot);
        // A NaN pivot, from elements near overflow, also ends here.
        if pivot.is_nan() || pivot <= 0.0 {
            return pivot;
        }
        for i in k + 1..p {
            let factor = work[i * p + k] / pivot;
            for j in k + 1..p {
                work[i * p + j] -= factor * work[k * p + j];
            }
        }
    }
    smallest
}

/// Samples until the gain-first order fails by asymmetry: `ln(0.01 / eps) / (1 - alpha)`.
///
/// The antisymmetric part starts at one rounding error and grows as `alpha^-k`. `None` without
/// forgetting, where it does not grow.
///
/// Source: derived; for alpha near 1 `ln(1/alpha)` is taken as `1 - alpha`.
#[must_use]
pub fn gain_first_failure_samples<F: Fp>(alpha: f64) -> Option<f64> {
    (alpha > 0.0 && alpha < 1.0).then(|| (ASYMMETRY_LIMIT / F::EPSILON).ln() / (1.0 - alpha))
}

/// Why a set of parameters deserves a warning before it runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Warning {
    /// `delta * p * x_max^2` is so large that the first updates cancel most digits of R.
    InitialDigitsLost {
        /// `delta * p * x_max^2`.
        product: f64,
        /// Limit for the word format.
        limit: f64,
    },
    /// Forgetting without enough excitation: R grows as `alpha^-k` in the silent directions.
    WindUp {
        /// Largest diagonal element over delta.
        wind_up: f64,
    },
    /// The LMS step exceeds what its input allows.
    StepTooLarge {
        /// Step size.
        step_size: f64,
        /// Bound `2 / (N * mean of x^2)`, below which the mean weights converge for any input.
        bound: f64,
    },
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::InitialDigitsLost { product, limit } => write!(
                f,
                "initial inverse correlation times taps times largest input squared is \
                 {product:.3e}, above {limit:.0e}: the covariance form loses its digits in the \
                 first updates; lower the initial inverse correlation or use a wider format"
            ),
            Self::WindUp { wind_up } => write!(
                f,
                "inverse correlation has grown to {wind_up:.3e} of its initial value: the input \
                 does not excite every tap and the forgetting factor is below 1; use 1 or reset"
            ),
            Self::StepTooLarge { step_size, bound } => write!(
                f,
                "step size {step_size} exceeds 2 / (taps x mean square input) = {bound:.3e}: \
                 plain LMS may diverge; scale the input or use the normalised form"
            ),
        }
    }
}

/// Warns if `delta * p * x_max^2` exceeds 1e10 (binary64) or 1e5 (binary32).
///
/// * `delta`: in the inverse square of the words' unit; `input_max`: largest `|x|` expected.
///
/// Source: derived; the first updates subtract nearly equal numbers and the error of the gain
/// grows as `eps * delta * |L|^2`.
#[must_use]
pub fn initial_digits_warning<F: Fp>(
    delta: f64,
    tap_count: usize,
    input_max: f64,
) -> Option<Warning> {
    let limit = if F::WIDTH == 64 { 1e10 } else { 1e5 };
    let product = delta * small_count(tap_count) * input_max * input_max;
    // Written so that a NaN warns.
    let is_safe = product <= limit;
    (!is_safe).then_some(Warning::InitialDigitsLost { product, limit })
}

/// Warns if R has wound up: a diagonal element above its initial value at alpha < 1.
#[must_use]
pub fn wind_up_warning(health: &MatrixHealth, alpha: f64) -> Option<Warning> {
    (alpha < 1.0 && health.is_finite && health.wind_up > 1.0).then_some(Warning::WindUp {
        wind_up: health.wind_up,
    })
}

/// Warns if a plain LMS step exceeds `2 / (N * mean of x^2)`, since `lambda_max` is at most the
/// trace of the input's correlation matrix.
///
/// Source: Widrow, Stearns, Adaptive Signal Processing (1985), chapter 6.
#[must_use]
pub fn step_size_warning(
    step_size: f64,
    tap_count: usize,
    input_mean_square: f64,
) -> Option<Warning> {
    let bound = 2.0 / (small_count(tap_count) * input_mean_square);
    (step_size >= bound).then_some(Warning::StepTooLarge { step_size, bound })
}

/// Tap counts are at most 64, so the conversion is exact.
fn small_count(count: usize) -> f64 {
    f64::from(u32::try_from(count).expect("tap counts are at most 64"))
}

/// When a channel first showed each sign of failure, as sample indices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct FirstFailures {
    /// A pair with a NaN or infinite word entered.
    pub non_finite_input: Option<u64>,
    /// A NaN or infinite word left.
    pub non_finite_output: Option<u64>,
    /// The output exceeded the limit.
    pub output_over_limit: Option<u64>,
    /// Asymmetry above 1 %.
    pub asymmetry: Option<u64>,
    /// R not positive definite.
    pub definiteness: Option<u64>,
    /// A diagonal element above delta.
    pub wind_up: Option<u64>,
}

impl FirstFailures {
    /// The first sample at which the output could not be trusted any more.
    #[must_use]
    pub fn diverged_at(&self) -> Option<u64> {
        [self.non_finite_output, self.output_over_limit]
            .into_iter()
            .flatten()
            .min()
    }
}

/// Watches a channel sample by sample.
#[derive(Clone, Debug)]
pub struct HealthMonitor {
    output_limit: f64,
    samples: u64,
    first: FirstFailures,
    latest: Option<MatrixHealth>,
}

impl HealthMonitor {
    /// A monitor that calls an output diverged when its magnitude exceeds `output_limit`, in the
    /// words' unit.
    #[must_use]
    pub fn new(output_limit: f64) -> Self {
        Self {
            output_limit,
            samples: 0,
            first: FirstFailures::default(),
            latest: None,
        }
    }

    /// Notes one sample's words. A few comparisons; meant for every sample.
    #[inline]
    pub fn sample<F: Fp>(&mut self, input: F, desired: F, output: F) {
        let index = self.samples;
        self.samples += 1;
        if !(input.is_finite() && desired.is_finite()) {
            self.first.non_finite_input.get_or_insert(index);
        }
        let output = output.to_f64();
        if !output.is_finite() {
            self.first.non_finite_output.get_or_insert(index);
        } else if output.abs() > self.output_limit {
            self.first.output_over_limit.get_or_insert(index);
        }
    }

    /// Notes the matrix after the latest sample. Costs p^3 operations; meant for now and then.
    pub fn matrix<F: Fp>(&mut self, matrix: &[F], tap_count: usize, delta: F) {
        let health = MatrixHealth::of(matrix, tap_count, delta);
        let index = self.samples.saturating_sub(1);
        if health.is_finite {
            if health.asymmetry > ASYMMETRY_LIMIT {
                self.first.asymmetry.get_or_insert(index);
            }
            if health.pivot_min.is_nan() || health.pivot_min <= 0.0 {
                self.first.definiteness.get_or_insert(index);
            }
            if health.wind_up > 1.0 {
                self.first.wind_up.get_or_insert(index);
            }
        }
        self.latest = Some(health);
    }

    /// First sample of each failure so far.
    #[must_use]
    pub fn first_failures(&self) -> &FirstFailures {
        &self.first
    }

    /// The latest look at the matrix.
    #[must_use]
    pub fn latest(&self) -> Option<&MatrixHealth> {
        self.latest.as_ref()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(got: f64, want: f64) {
        assert!(
            (got - want).abs() <= 1e-12 * want.abs(),
            "got {got}, want {want}"
        );
    }

    #[test]
    fn a_known_matrix_has_its_pivots() {
        // Eigenvalues of [[2, 1], [1, 2]] .
        let health = MatrixHealth::of(&[2.0, 1.0, 1.0, 2.0], 2, 4.0);
        close(health.pivot_min, 0.75);
        close(health.wind_up, 0.5);
        assert!(health.asymmetry <= 0.0);
        assert!(health.is_sound());
    }

    #[test]
    fn asymmetry_and_indefiniteness_are_seen() {
        let skewed = MatrixHealth::of(&[1.0, 0.5, 0.25, 1.0], 2, 1.0);
        close(skewed.asymmetry, 0.25);
        assert!(!skewed.is_sound());
        let indefinite = MatrixHealth::of(&[1.0, 2.0, 2.0, 1.0], 2, 1.0);
        assert!(indefinite.pivot_min < 0.0);
        assert!(!MatrixHealth::of(&[f64::NAN], 1, 1.0).is_finite);
    }

    #[test]
    fn the_digits_warning_fires_above_its_limit_only() {
        // Default of the bench: 7.716e-4 (deg/h)^-2 at 4 taps. 1 deg/s is 3600 deg/h.
        let delta = 7.716e-4;
        assert_eq!(initial_digits_warning::<f64>(delta, 4, 3600.0), None);
        let warning = initial_digits_warning::<f64>(delta, 4, 3.6e6).expect("1000 deg/s");
        assert!(warning.to_string().contains("above 1e10"), "{warning}");
        assert!(initial_digits_warning::<f32>(delta, 4, 3600.0).is_none());
        assert!(initial_digits_warning::<f32>(delta, 4, 36_000.0).is_some());
        assert!(initial_digits_warning::<f64>(delta, 4, f64::NAN).is_some());
    }

    #[test]
    fn the_step_warning_follows_the_trace_bound() {
        assert!(step_size_warning(0.8, 10, 0.5).is_some());
        assert!(step_size_warning(0.8, 10, 0.125).is_none());
    }

    #[test]
    fn predicted_failure_matches_its_formula() {
        let samples = gain_first_failure_samples::<f64>(0.99).expect("forgetting");
        assert!((samples - 3143.8).abs() < 0.5, "{samples}");
        assert_eq!(gain_first_failure_samples::<f64>(1.0), None);
    }
}
