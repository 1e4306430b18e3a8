//! A scale factor test of points whose means were taken elsewhere.

use super::scale_factor::{RatePoint, ScaleFactorFit, StaticZero, fit_scale_factor};
use crate::metrics::estimate::reason::Unavailable;

/// Parameters of the line.
const LINE: usize = 2;

/// Fits the scale factor of points, the output in any unit.
///
/// Without standard errors what is left of the line is taken as noise, of one size at every point: scale factor,
/// offset and asymmetry have intervals by it, the nonlinearity, which is the same residuals, has none.
///
/// * `points`: rate and mean output of each.
/// * `errors`: standard errors of the outputs; none where they are not known.
///
/// # Errors
/// The reason, in words, with fewer than three distinct rates.
///
/// ```
/// use fogbench::metrics::fit_points;
///
/// let points: Vec<(f64, f64)> = (-5..=5).map(|rate| f64::from(rate)).map(|w| (w, 3.0 * w + 7.0)).collect();
/// let fit = fit_points(&points, None).unwrap();
/// assert!((fit.factor.value - 3.0).abs() < 1e-12 && (fit.offset.value - 7.0).abs() < 1e-12);
/// ```
pub fn fit_points(
    points: &[(f64, f64)],
    errors: Option<&[f64]>,
) -> Result<ScaleFactorFit, Unavailable> {
    let with = |deviation: &dyn Fn(usize) -> f64, freedom: f64| {
        let rows = points.iter().enumerate();
        let rows: Vec<RatePoint> = rows
            .map(|(index, (input, output))| RatePoint {
                input_deg_per_h: *input,
                output_deg_per_h: *output,
                deviation_deg_per_h: deviation(index),
                degrees_of_freedom: freedom,
            })
            .collect();
        fit_scale_factor(&rows, StaticZero::default())
    };
    if let Some(errors) = errors {
        return with(&|index| errors[index], f64::INFINITY);
    }
    let plain = with(&|_| 0.0, f64::INFINITY)?;
    let squares = plain.residuals.iter().map(|it| it.value_deg_per_h.powi(2));
    // Three distinct rates or more leave one degree of freedom at least.
    let freedom = (points.len() - LINE) as f64;
    let deviation = (squares.sum::<f64>() / freedom).sqrt();
    let noisy = with(&|_| deviation, freedom)?;
    Ok(ScaleFactorFit {
        nonlinearity: plain.nonlinearity,
        nonlinearity_of_reading: plain.nonlinearity_of_reading,
        ..noisy
    })
}
