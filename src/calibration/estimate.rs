//! From group means to parameters: one way through all estimators.

use nalgebra::{DMatrix, DVector};

use super::covariance_recursion::covariance_recursion;
use super::design::{Column, GroupDesign, TemperatureColumns, columns, design_matrix};
use super::diagnose::{SCALE_ERROR_MAX, diagnose};
use super::error::{AXES, CalibrationError};
use super::error_model::ErrorParameters;
use super::estimator::{Estimator, RecursiveSettings};
use super::observations::{GroupObservation, check_groups};
use super::plan::{check_plan, descending};
use super::result::{Calibration, RoundingLoss, TemperatureCoefficients};
use super::solver::{Fit, SquareRootInformation, weighted_least_squares};

/// Condition number of the weighted rows beyond which forgetting has left too little.
const WEIGHTED_CONDITION_MAX: f64 = 1e12;

/// Estimates the parameters of an assembly from group means in the order they were taken.
///
/// For each gyro minimises `sum_i w_i (y_i - a_i x)^2` over its unknowns x, with weights `w_i` that are
/// 1 for a batch and what the recursion leaves otherwise
/// ([`Reading::weights`](super::Reading::weights)): recursive least squares with forgetting is weighted
/// least squares, apart from the prior `P_0`. The estimate is linear in the
/// observations, `x = G y`, so that its covariance from independent errors of the means is
/// `G Sigma G^T`. It holds for any weights, whether or not they are the inverse variances; what the
/// model lacks (drift, table errors) is not in it, for which see `reduced_chi_square`.
///
/// * `groups`: all rates deg/s, temperatures deg C.
/// * `reference_temperature_c`: temperature of the gyros x, y, z that bias and scale factor are given
///   at where the estimator has temperature columns; none: the weighted mean over the groups. Without
///   temperature columns the estimate belongs to that mean whatever is asked for.
///
/// # Errors
/// [`CalibrationError`]: unusable numbers or settings, a plan that leaves parameters open, weights
/// that leave too few groups, or scale errors that no gyro has, with what may be the cause.
///
/// # Source
/// Patent CN101221046, equations (9) to (19); known answers `patent_kat1_…` and `patent_kat2_…`.
pub fn estimate(
    groups: &[GroupObservation],
    estimator: &Estimator,
    reference_temperature_c: Option<[f64; 3]>,
) -> Result<Calibration, CalibrationError> {
    check_groups(groups)?;
    estimator.check()?;
    let designs: Vec<GroupDesign> = groups.iter().map(|group| group.design).collect();
    let temperature = estimator.temperature_columns();
    let weights = [0, 1, 2].map(|axis| AxisWeights::of(groups, estimator, axis));
    let means = [0, 1, 2].map(|axis| mean_temperature(&designs, &weights[axis].rows, axis));
    let reference = match reference_temperature_c {
        Some(asked) if temperature != TemperatureColumns::NONE => asked,
        _ => means,
    };
    check_plan(&designs, temperature, reference)?;
    let mut fits = Vec::with_capacity(3);
    for axis in 0..3 {
        fits.push(fit_axis(
            groups,
            estimator,
            axis,
            reference[axis],
            &weights[axis],
        )?);
    }
    let calibration = assemble(groups, estimator, reference, &weights, &fits);
    reject_implausible(groups, &calibration)?;
    reject_not_finite(&calibration)?;
    Ok(calibration)
}

/// Forgetting factors of one gyro and the weights they leave.
///
/// Each gyro has its own where each has its own thermometer: the patent's sigma_x, sigma_y, sigma_z
/// (equation 16). The first factor only discounts the prior.
struct AxisWeights {
    factors: Vec<f64>,
    rows: Vec<f64>,
}

impl AxisWeights {
    fn of(groups: &[GroupObservation], estimator: &Estimator, axis: usize) -> Self {
        let temperature_c: Vec<f64> = groups
            .iter()
            .map(|group| group.design.temperature_c[axis])
            .collect();
        let initial = estimator
            .recursion()
            .and_then(|settings| settings.initial_temperature_c)
            .map(|all| all[axis])
            .or(temperature_c.first().copied())
            .unwrap_or_default();
        let (forgetting, reading) = estimator.forgetting();
        let factors = forgetting.factors(initial, &temperature_c);
        let rows = reading.weights(&factors);
        Self { factors, rows }
    }
}

/// Weighted mean temperature: where the bias of a gyro is best known, and what an estimate without
/// temperature columns belongs to, deg C.
fn mean_temperature(designs: &[GroupDesign], weights: &[f64], axis: usize) -> f64 {
    let total: f64 = weights.iter().sum();
    let pairs = designs.iter().zip(weights);
    let sum: f64 = pairs
        .map(|(design, weight)| design.temperature_c[axis] * weight)
        .sum();
    if total > 0.0 { sum / total } else { 0.0 }
}

/// Solution of one gyro with what the report needs of it.
struct AxisFit {
    fit: Fit,
    rows: DMatrix<f64>,
    condition_number: f64,
}

/// Fits one gyro.
///
/// The plan has full rank, but weights may take it away again: a factor of 1e-3 for every group of a
/// mounting leaves the other mountings alone to speak. The condition number of `sqrt(w_i) a_i` tells.
fn fit_axis(
    groups: &[GroupObservation],
    estimator: &Estimator,
    axis: usize,
    reference_temperature_c: f64,
    weights: &AxisWeights,
) -> Result<AxisFit, CalibrationError> {
    let designs: Vec<GroupDesign> = groups.iter().map(|group| group.design).collect();
    let model = columns(estimator.temperature_columns());
    let rows = design_matrix(&designs, &model, axis, reference_temperature_c);
    let mut weighted = rows.clone();
    for (mut row, weight) in weighted.row_iter_mut().zip(&weights.rows) {
        row *= weight.sqrt();
    }
    let unresolved = CalibrationError::Unresolved { axis: AXES[axis] };
    let values = descending(&weighted).ok_or(unresolved)?;
    let condition_number = values[0] / values[values.len() - 1];
    let forgotten = || CalibrationError::Forgotten {
        axis: AXES[axis],
        condition_number,
    };
    // Written so that a NaN from 0 / 0 is refused too.
    if !matches!(condition_number.partial_cmp(&WEIGHTED_CONDITION_MAX), Some(order) if order.is_lt())
    {
        return Err(forgotten());
    }
    let outputs = groups.iter().map(|group| group.output_deg_per_s[axis]);
    let outputs = DVector::from_iterator(groups.len(), outputs);
    let fit = match estimator.recursion() {
        Some(settings) => recursive_fit(&rows, &outputs, settings, weights),
        None => weighted_least_squares(&rows, &outputs, &weights.rows),
    };
    Ok(AxisFit {
        fit: fit.ok_or_else(forgotten)?,
        rows,
        condition_number,
    })
}

/// The recursion in square-root form over the groups in order.
fn recursive_fit(
    rows: &DMatrix<f64>,
    outputs: &DVector<f64>,
    settings: &RecursiveSettings,
    weights: &AxisWeights,
) -> Option<Fit> {
    let mut state = SquareRootInformation::new(rows.ncols(), settings.initial_covariance);
    for (index, factor) in weights.factors.iter().enumerate() {
        let (forgetting, weight) = settings.reading.update(*factor);
        let row: Vec<f64> = rows.row(index).iter().copied().collect();
        state.update(forgetting, weight, &row, outputs[index]);
    }
    Some(Fit {
        solution: state.solution()?,
        gain: state.gain(rows, &weights.rows)?,
    })
}

/// Puts the fits of the three gyros together as `x1..x12` and their covariance.
///
/// The gyros share no noise, so that the covariance has three blocks of 4 by 4; coefficients of
/// temperature stand beside it with their standard errors alone. For the literal recursion the
/// parameters are its own, rounding included, and everything else that of the square-root form.
fn assemble(
    groups: &[GroupObservation],
    estimator: &Estimator,
    reference_temperature_c: [f64; 3],
    weights: &[AxisWeights; 3],
    fits: &[AxisFit],
) -> Calibration {
    let model = columns(estimator.temperature_columns());
    let mut x = [0.0; 12];
    let mut covariance = [[0.0; 12]; 12];
    let mut temperature = TemperatureCoefficients::default();
    let mut misfit = [None; 3];
    let mut residuals = vec![[0.0; 3]; groups.len()];
    for (axis, axis_fit) in fits.iter().enumerate() {
        let Fit { solution, gain } = &axis_fit.fit;
        let outputs = groups.iter().map(|group| group.output_deg_per_s[axis]);
        let outputs = DVector::from_iterator(groups.len(), outputs);
        let errors: Vec<f64> = groups
            .iter()
            .map(|group| group.standard_error_deg_per_s[axis])
            .collect();
        let spread = sandwich(gain, &errors);
        for row in 0..4 {
            x[4 * axis + row] = solution[row];
            for column in 0..4 {
                covariance[4 * axis + row][4 * axis + column] = spread[(row, column)];
            }
        }
        for (index, column) in model.iter().enumerate().skip(4) {
            temperature.set(
                *column,
                axis,
                solution[index],
                spread[(index, index)].sqrt(),
            );
        }
        let left = outputs - &axis_fit.rows * solution;
        for (residual, value) in residuals.iter_mut().zip(left.iter()) {
            residual[axis] = *value;
        }
        misfit[axis] = reduced_chi_square(&axis_fit.rows, gain, &left, &errors);
    }
    let mut rounding_loss = None;
    if let Estimator::CovarianceRecursion(settings) = estimator {
        let factors = [0, 1, 2].map(|axis: usize| weights[axis].factors.as_slice());
        let literal = covariance_recursion(groups, settings, &factors);
        rounding_loss = Some(RoundingLoss::between(&literal, &x));
        x = literal;
    }
    let by_group = |pick: fn(&AxisWeights) -> &Vec<f64>| {
        (0..groups.len())
            .map(|group| [0, 1, 2].map(|axis: usize| pick(&weights[axis])[group]))
            .collect()
    };
    Calibration {
        parameters: ErrorParameters::from_vector(&x),
        covariance,
        temperature,
        reference_temperature_c,
        forgetting_factors: by_group(|weights| &weights.factors),
        weights: by_group(|weights| &weights.rows),
        residual_deg_per_s: residuals,
        reduced_chi_square: misfit,
        condition_number: [0, 1, 2].map(|axis: usize| fits[axis].condition_number),
        rounding_loss,
        of_samples: None,
    }
}

/// Covariance of the estimate: `G Sigma G^T` with the groups' variances on the diagonal of Sigma.
///
/// * `gain`: G, `[columns, groups]`; `standard_errors`: `[groups]`, deg/s.
fn sandwich(gain: &DMatrix<f64>, standard_errors: &[f64]) -> DMatrix<f64> {
    let mut scaled = gain.clone();
    for (mut column, error) in scaled.column_iter_mut().zip(standard_errors) {
        column *= *error;
    }
    &scaled * scaled.transpose()
}

/// Sum of squared residuals in standard errors over its expectation for measurement noise alone.
///
/// The expectation is `sum_ij (I - A G)_ij^2 s_j^2 / s_i^2`, which is groups minus unknowns for
/// equal weights and errors. Nothing for noise-free data or without a group to spare.
fn reduced_chi_square(
    rows: &DMatrix<f64>,
    gain: &DMatrix<f64>,
    residuals: &DVector<f64>,
    standard_errors: &[f64],
) -> Option<f64> {
    let count = rows.nrows();
    if count <= rows.ncols() || standard_errors.iter().any(|error| *error <= 0.0) {
        return None;
    }
    let left = DMatrix::identity(count, count) - rows * gain;
    let expected: f64 = (0..count)
        .flat_map(|i| (0..count).map(move |j| (i, j)))
        .map(|(i, j)| (left[(i, j)] * standard_errors[j] / standard_errors[i]).powi(2))
        .sum();
    let scaled = residuals.iter().zip(standard_errors);
    let sum: f64 = scaled
        .map(|(residual, error)| (residual / error).powi(2))
        .sum();
    Some(sum / expected)
}

/// Refuses scale errors beyond [`SCALE_ERROR_MAX`], with what the groups say about the cause.
fn reject_implausible(
    groups: &[GroupObservation],
    calibration: &Calibration,
) -> Result<(), CalibrationError> {
    for (axis, scale_error) in calibration.parameters.scale_error.into_iter().enumerate() {
        // Written so that NaN is refused too.
        if scale_error.abs() <= SCALE_ERROR_MAX {
            continue;
        }
        let findings: Vec<String> = diagnose(groups).iter().map(ToString::to_string).collect();
        let hint = if findings.is_empty() {
            "the outputs do not belong to the stated rates".to_owned()
        } else {
            findings.join("; ")
        };
        return Err(CalibrationError::Implausible {
            axis: AXES[axis],
            scale_error,
            limit: SCALE_ERROR_MAX,
            hint,
        });
    }
    Ok(())
}

/// Refuses an estimate of which a part is no finite number: groups whose numbers differ by more than
/// binary64 can square.
fn reject_not_finite(calibration: &Calibration) -> Result<(), CalibrationError> {
    let coefficients = [
        &calibration.temperature.bias,
        &calibration.temperature.bias_rate,
        &calibration.temperature.scale,
    ];
    let coefficients = coefficients.into_iter().flatten();
    let coefficients: Vec<f64> = coefficients
        .flat_map(|it| it.value.into_iter().chain(it.standard_error))
        .collect();
    let parameters = calibration.parameters.to_vector();
    let misfits: Vec<f64> = calibration
        .reduced_chi_square
        .iter()
        .flatten()
        .copied()
        .collect();
    let parts: [(&'static str, &mut dyn Iterator<Item = &f64>); 7] = [
        ("estimate", &mut parameters.iter()),
        ("covariance", &mut calibration.covariance.iter().flatten()),
        ("coefficient of temperature", &mut coefficients.iter()),
        (
            "weight of a group",
            &mut calibration.weights.iter().flatten(),
        ),
        (
            "residual",
            &mut calibration.residual_deg_per_s.iter().flatten(),
        ),
        ("reduced chi-square", &mut misfits.iter()),
        ("condition number", &mut calibration.condition_number.iter()),
    ];
    for (what, mut values) in parts {
        if let Some(value) = Iterator::find(&mut values, |value| !value.is_finite()) {
            return Err(CalibrationError::NotFinite {
                what,
                value: *value,
            });
        }
    }
    Ok(())
}

/// Columns after the patent's four, for [`TemperatureCoefficients::set`].
impl TemperatureCoefficients {
    fn set(&mut self, column: Column, axis: usize, value: f64, standard_error: f64) {
        let target = match column {
            Column::Temperature => &mut self.bias,
            Column::TemperatureRate => &mut self.bias_rate,
            Column::TemperatureTimesRate => &mut self.scale,
            Column::Rate(_) | Column::One => return,
        };
        let coefficients = target.get_or_insert_default();
        coefficients.value[axis] = value;
        coefficients.standard_error[axis] = standard_error;
    }
}
