//! From group means to a sheet: every estimator side by side, against the truth where it is known.

use super::units::{calibration_estimate, compensation_checks, observation, plan_table};
use crate::calibration::{
    Calibration, CalibrationError, Estimator, Forgetting, GroupDesign, GroupObservation, Reading,
    RecursiveSettings, TemperatureColumns, check_plan, diagnose, estimate,
};
use crate::scenario::CalibrationConfig;
use crate::signal::{CalibrationGroup, CalibrationSheet, CalibrationTruth};
use crate::vocabulary::EstimatorKind;

/// Reduced chi-square beyond which the model lacks something: with five groups to spare noise alone
/// gets there once in 50 000 campaigns.
const MISFIT: f64 = 6.0;

/// Estimates the parameters of an assembly from group means with every estimator asked for.
///
/// * `groups`: in the order they were taken, which forgetting depends on.
/// * `of_samples`: the estimate from the samples themselves, where one was asked for.
/// * `truth`: parameters of a simulated assembly. Estimators that fit a coefficient of temperature
///   give bias and scale factor at its reference temperature; without a truth, at their weighted mean
///   temperature.
///
/// Returns the sheet and the calibration that is applied. An estimator that cannot work on these
/// groups and is not applied becomes a warning.
///
/// # Errors
/// [`CalibrationError`] of the applied estimator: unusable numbers, a plan that leaves parameters
/// open, weights that leave too few groups, scale factors that no gyro has.
///
/// # Panics
/// Never: the applied estimator is among those that run.
pub(crate) fn calibration_sheet(
    groups: &[CalibrationGroup],
    settings: &CalibrationConfig,
    truth: Option<&CalibrationTruth>,
    of_samples: Option<&Result<Calibration, CalibrationError>>,
) -> Result<(CalibrationSheet, Calibration), CalibrationError> {
    let observations: Vec<GroupObservation> = groups.iter().map(observation).collect();
    let designs: Vec<GroupDesign> = observations.iter().map(|group| group.design).collect();
    let reference = truth.map(|truth| [truth.reference_temperature_c; 3]);
    let middle = reference.unwrap_or_else(|| mean_temperature(&designs));
    let plan = check_plan(&designs, TemperatureColumns::NONE, middle)?;
    let with_temperature = check_plan(&designs, TemperatureColumns::BIAS, middle).ok();
    let mut warnings: Vec<String> = diagnose(&observations)
        .iter()
        .map(ToString::to_string)
        .collect();
    let mut estimates = Vec::new();
    let mut applied = None;
    for kind in settings.kinds() {
        let found = match estimator(kind, settings) {
            Some(estimator) => estimate(&observations, &estimator, reference),
            None => of_samples
                .cloned()
                .unwrap_or(Err(CalibrationError::NoEncoder)),
        };
        match found {
            Ok(calibration) => {
                estimates.push(calibration_estimate(
                    kind.word(),
                    groups,
                    &calibration,
                    truth,
                )?);
                if kind == settings.apply {
                    applied = Some(calibration);
                }
            }
            Err(error) if kind == settings.apply => return Err(error),
            Err(error) => warnings.push(format!("no estimate by {}: {error}", kind.word())),
        }
    }
    let applied = applied.expect("the applied estimator runs or its error is returned above");
    let fits_temperature = settings.kinds().iter().any(|kind| kind.fits_temperature());
    let mut sheet = CalibrationSheet {
        plan: plan_table(&plan),
        plan_with_temperature: with_temperature
            .filter(|_| fits_temperature)
            .map(|plan| plan_table(&plan)),
        groups: groups.to_vec(),
        estimates,
        applied: settings.apply.word().to_owned(),
        compensation: compensation_checks(&applied, groups, truth)?,
        truth: truth.copied(),
        ranking: Vec::new(),
        warnings,
    };
    sheet.warnings.extend(misfit(&applied));
    sheet.warnings.extend(extrapolation(&sheet, settings));
    Ok((sheet, applied))
}

/// The estimator of a kind with its settings; nothing of one that takes no groups.
fn estimator(kind: EstimatorKind, settings: &CalibrationConfig) -> Option<Estimator> {
    let form = settings.forgetting_form;
    let forgetting = |constant_per_k| Forgetting::Temperature {
        form,
        constant_per_k,
    };
    let recursive = RecursiveSettings {
        initial_covariance: settings.initial_covariance,
        ..RecursiveSettings::new(forgetting(settings.forgetting_constant_per_k))
    };
    Some(match kind {
        EstimatorKind::EncoderRate => return None,
        EstimatorKind::Batch => Estimator::Batch {
            temperature: TemperatureColumns::NONE,
        },
        EstimatorKind::BatchTemperature => Estimator::Batch {
            temperature: TemperatureColumns::BIAS,
        },
        EstimatorKind::Arls => Estimator::Recursive(recursive),
        EstimatorKind::ArlsCovariance => Estimator::CovarianceRecursion(recursive),
        EstimatorKind::ArlsTemperature => Estimator::Weighted {
            forgetting: forgetting(settings.forgetting_constant_with_temperature_per_k),
            reading: Reading::Discount,
            temperature: TemperatureColumns::BIAS,
        },
    })
}

fn mean_temperature(designs: &[GroupDesign]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    let mut count = 0.0;
    for design in designs {
        count += 1.0;
        for (sum, value) in sum.iter_mut().zip(design.temperature_c) {
            *sum += value;
        }
    }
    sum.map(|sum| if count > 0.0 { sum / count } else { 0.0 })
}

/// Gyros whose residuals are larger than their noise.
fn misfit(applied: &Calibration) -> Vec<String> {
    let gyros = ["x", "y", "z"].into_iter().zip(applied.reduced_chi_square);
    let large = gyros.filter_map(|(axis, misfit)| Some((axis, misfit.filter(|m| *m > MISFIT)?)));
    large
        .map(|(axis, misfit)| {
            format!(
                "the residuals of gyro {axis} have {misfit:.1} times the variance that their noise \
                 explains: something drifts or bends that the model lacks, and the standard errors \
                 are too small"
            )
        })
        .collect()
}

/// Whether bias and scale factor are given at a temperature that no group was near.
fn extrapolation(sheet: &CalibrationSheet, settings: &CalibrationConfig) -> Option<String> {
    if !settings.apply.fits_temperature() {
        return None;
    }
    let reference_c = sheet.applied_estimate()?.reference_temperature_c[0];
    let temperatures = sheet.groups.iter().map(|group| group.temperature_c[0]);
    let low = temperatures.clone().fold(f64::INFINITY, f64::min);
    let high = temperatures.fold(f64::NEG_INFINITY, f64::max);
    let beyond_k = (low - reference_c).max(reference_c - high);
    (beyond_k > 0.1 * (high - low)).then(|| {
        format!(
            "the biases at {reference_c:.2} C are extrapolated: the groups were taken between \
             {low:.2} and {high:.2} C"
        )
    })
}
