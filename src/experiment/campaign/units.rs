//! Between the units of the calibration library (deg/s, rad, ratios) and those of its tables.

use crate::calibration::{
    Calibration, CalibrationError, Compensation, ErrorParameters, GroupDesign, GroupObservation,
    Misalignment, PlanReport, normalised_error_squared,
};
use crate::signal::{
    AssemblyParameters, AxisCoefficient, CalibrationEstimate, CalibrationGroup, CalibrationPlan,
    CalibrationTruth, CompensationCheck, EstimateError, ParameterRounding,
};
use crate::units::{
    MICRO, arcsec_to_rad, deg_per_h_to_deg_per_s, deg_per_s_to_deg_per_h, rad_to_arcsec,
    ratio_to_ppm, s_to_ms,
};
use crate::vocabulary::{CompensationForm, Word};

/// A group as the library takes it.
pub(crate) fn observation(group: &CalibrationGroup) -> GroupObservation {
    GroupObservation {
        design: GroupDesign {
            reference_rate_deg_per_s: group.reference_rate_deg_per_s,
            temperature_c: group.temperature_c,
            temperature_rate_k_per_min: group.temperature_rate_k_per_min,
        },
        output_deg_per_s: group.output_deg_per_h.map(deg_per_h_to_deg_per_s),
        standard_error_deg_per_s: group.standard_error_deg_per_h.map(deg_per_h_to_deg_per_s),
    }
}

/// Named parameters in the library's units.
pub(crate) fn error_parameters(parameters: &AssemblyParameters) -> ErrorParameters {
    let [xy, xz, yx, yz, zx, zy] = parameters.theta_arcsec.map(arcsec_to_rad);
    ErrorParameters {
        scale_error: parameters.scale_factor_error_ppm.map(|ppm| ppm * MICRO),
        misalignment_rad: Misalignment {
            xy,
            xz,
            yx,
            yz,
            zx,
            zy,
        },
        bias_deg_per_s: parameters.bias_deg_per_h.map(deg_per_h_to_deg_per_s),
    }
}

/// Named parameters in customary units.
fn assembly_parameters(parameters: &ErrorParameters) -> AssemblyParameters {
    let theta = &parameters.misalignment_rad;
    AssemblyParameters {
        bias_deg_per_h: parameters.bias_deg_per_h(),
        scale_factor_error_ppm: parameters.scale_error.map(ratio_to_ppm),
        theta_arcsec: [theta.xy, theta.xz, theta.yx, theta.yz, theta.zx, theta.zy]
            .map(rad_to_arcsec),
    }
}

/// Standard errors of the named parameters; signs of the patent's vector do not matter to them.
fn standard_errors(calibration: &Calibration) -> AssemblyParameters {
    let x = calibration.standard_errors();
    AssemblyParameters {
        bias_deg_per_h: [x[3], x[7], x[11]].map(deg_per_s_to_deg_per_h),
        scale_factor_error_ppm: [x[0], x[5], x[10]].map(ratio_to_ppm),
        theta_arcsec: [x[2], x[1], x[6], x[4], x[9], x[8]].map(rad_to_arcsec),
    }
}

/// What a plan determines, as a table.
pub(crate) fn plan_table(plan: &PlanReport) -> CalibrationPlan {
    let axes = plan.axes.each_ref();
    CalibrationPlan {
        groups: plan.groups,
        rank: plan.rank,
        condition_number: axes.map(|axis| axis.condition_number),
        singular_values: plan.axes[0].singular_values.clone(),
        scale_factor_ppm_per_deg_per_h: axes
            .map(|axis| ratio_to_ppm(deg_per_h_to_deg_per_s(axis.scale_std_per_sigma))),
        bias_per_standard_error: axes.map(|axis| axis.bias_std_per_sigma),
        scale_factor_bias_correlation: axes.map(|axis| axis.scale_bias_correlation),
    }
}

/// One estimate with its error.
pub(crate) fn calibration_estimate(
    name: &str,
    groups: &[CalibrationGroup],
    calibration: &Calibration,
    truth: Option<&CalibrationTruth>,
) -> Result<CalibrationEstimate, CalibrationError> {
    let residuals = calibration.residual_deg_per_s.iter();
    let residual_deg_per_h: Vec<[f64; 3]> = residuals
        .map(|group| group.map(deg_per_s_to_deg_per_h))
        .collect();
    let error = truth.map(|truth| estimate_error(calibration, groups, truth));
    Ok(CalibrationEstimate {
        name: name.to_owned(),
        parameters: assembly_parameters(&calibration.parameters),
        standard_error: standard_errors(calibration),
        covariance: calibration.covariance,
        reference_temperature_c: calibration.reference_temperature_c,
        bias_deg_per_h_per_k: calibration.temperature.bias.map(|bias| AxisCoefficient {
            value: bias.value.map(deg_per_s_to_deg_per_h),
            standard_error: bias.standard_error.map(deg_per_s_to_deg_per_h),
        }),
        residual_rms_deg_per_h: [0, 1, 2]
            .map(|axis: usize| rms(residual_deg_per_h.iter().map(|group| group[axis]))),
        residual_deg_per_h,
        reduced_chi_square: calibration.reduced_chi_square,
        weights: calibration.weights.clone(),
        condition_number: calibration.condition_number,
        rounding: calibration.rounding_loss.map(|loss| ParameterRounding {
            bias_deg_per_h: deg_per_s_to_deg_per_h(loss.bias_deg_per_s),
            sensitivity_ppm: ratio_to_ppm(loss.sensitivity),
        }),
        delay_ms: calibration.of_samples.map(|found| AxisCoefficient {
            value: found.delay_s.value.map(s_to_ms),
            standard_error: found.delay_s.standard_error.map(s_to_ms),
        }),
        rejected_samples: calibration.of_samples.map(|found| found.rejected),
        error: error.transpose()?,
    })
}

fn estimate_error(
    calibration: &Calibration,
    groups: &[CalibrationGroup],
    truth: &CalibrationTruth,
) -> Result<EstimateError, CalibrationError> {
    let found = assembly_parameters(&calibration.parameters);
    let pairs = |found: [f64; 3], truth: [f64; 3]| [0, 1, 2].map(|i: usize| found[i] - truth[i]);
    let known = &truth.parameters;
    let parameters = AssemblyParameters {
        bias_deg_per_h: pairs(found.bias_deg_per_h, known.bias_deg_per_h),
        scale_factor_error_ppm: pairs(found.scale_factor_error_ppm, known.scale_factor_error_ppm),
        theta_arcsec: [0, 1, 2, 3, 4, 5]
            .map(|i: usize| found.theta_arcsec[i] - known.theta_arcsec[i]),
    };
    Ok(EstimateError {
        bias_rms_deg_per_h: rms(parameters.bias_deg_per_h),
        scale_factor_rms_ppm: rms(parameters.scale_factor_error_ppm),
        misalignment_rms_arcsec: rms(parameters.theta_arcsec),
        normalised_error_squared: normalised_error_squared(calibration, &error_parameters(known)),
        compensated_rate_max_deg_per_h: compensated_error_max(
            &Compensation::of(calibration)?,
            CompensationForm::Exact,
            groups,
            truth,
        ),
        parameters,
    })
}

/// Largest error of the plan's rates after the true outputs have been compensated, deg/h.
fn compensated_error_max(
    compensation: &Compensation,
    form: CompensationForm,
    groups: &[CalibrationGroup],
    truth: &CalibrationTruth,
) -> f64 {
    let gyros = error_parameters(&truth.parameters);
    let warm = Some([truth.reference_temperature_c; 3]);
    let errors = groups.iter().flat_map(|group| {
        let rate = group.reference_rate_deg_per_s;
        let found = compensation.rates(form, gyros.predict(rate), warm);
        [0, 1, 2].map(|axis: usize| deg_per_s_to_deg_per_h((found[axis] - rate[axis]).abs()))
    });
    errors.fold(0.0, f64::max)
}

/// Both forms of compensation with an estimate.
pub(crate) fn compensation_checks(
    applied: &Calibration,
    groups: &[CalibrationGroup],
    truth: Option<&CalibrationTruth>,
) -> Result<Vec<CompensationCheck>, CalibrationError> {
    let compensation = Compensation::of(applied)?;
    let checks = CompensationForm::ALL.iter().map(|&form| {
        let rates = groups.iter().map(|group| group.reference_rate_deg_per_s);
        let residual_deg_per_h: Vec<[f64; 3]> = rates
            .map(|rate| {
                compensation
                    .residual(form, rate)
                    .map(deg_per_s_to_deg_per_h)
            })
            .collect();
        let all = residual_deg_per_h.iter().flatten();
        CompensationCheck {
            form: form.word(),
            residual_max_deg_per_h: all.fold(0.0, |max, value| value.abs().max(max)),
            residual_deg_per_h,
            error_max_deg_per_h: truth
                .map(|truth| compensated_error_max(&compensation, form, groups, truth)),
        }
    });
    Ok(checks.collect())
}

/// Root mean square.
pub(crate) fn rms(values: impl IntoIterator<Item = f64>) -> f64 {
    let (sum, count) = values.into_iter().fold((0.0, 0.0), |(sum, count), value| {
        (sum + value * value, count + 1.0)
    });
    if count > 0.0 {
        (sum / count).sqrt()
    } else {
        0.0
    }
}
