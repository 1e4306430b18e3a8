//! Whether errors are as large as the covariance says, where the truth is known.

use nalgebra::{SMatrix, SVector};

use super::error_model::ErrorParameters;
use super::result::Calibration;

/// `e^T C^-1 e` of the twelve errors: 12 on average if the covariance is right.
///
/// None if the covariance is singular (noise-free data).
#[must_use]
pub fn normalised_error_squared(calibration: &Calibration, truth: &ErrorParameters) -> Option<f64> {
    let (found, truth) = (calibration.parameters.to_vector(), truth.to_vector());
    let error = SVector::<f64, 12>::from_fn(|index, _| found[index] - truth[index]);
    let covariance =
        SMatrix::<f64, 12, 12>::from_fn(|row, column| calibration.covariance[row][column]);
    let factor = covariance.cholesky()?;
    Some(error.dot(&factor.solve(&error)))
}

/// Root mean square error beyond what the standard errors explain: the unmodelled bias.
///
/// `sqrt(mean e^2 - mean s^2)` over campaigns, in the unit of the errors; 0 if the errors are no
/// larger than they should be.
///
/// * `errors`, `standard_errors`: `[campaigns]` of one parameter, or of several of one kind.
#[must_use]
pub fn unmodelled_rms(errors: &[f64], standard_errors: &[f64]) -> f64 {
    let excess = errors
        .iter()
        .zip(standard_errors)
        .map(|(e, s)| e * e - s * s);
    #[expect(
        clippy::cast_precision_loss,
        reason = "a count of campaigns is exact in f64"
    )]
    let count = errors.len().max(1) as f64;
    (excess.sum::<f64>() / count).max(0.0).sqrt()
}
