//! A calibration out of the record `calibration` of a `summary.json`.

use serde_json::Value;

use crate::report::calibration::documents::{AXES, THETAS};
use crate::report::restore::values::{interned, numbers, real, reals, texts};
use crate::signal::{
    AssemblyParameters, AxisCoefficient, CalibrationEstimate, CalibrationGroup, CalibrationPlan,
    CalibrationRank, CalibrationSheet, CalibrationTruth, CompensationCheck, EstimateError,
    ParameterRounding,
};

/// The sheet of a record; see [`super::calibration_json`].
pub(in crate::report) fn calibration_sheet(record: &Value) -> Option<CalibrationSheet> {
    let groups = record.get("groups")?.as_array()?.iter().map(group);
    let estimates = record.get("estimates")?.as_object()?.iter();
    let estimates = estimates.map(|(name, found)| estimate(name, found));
    let forms = record.get("compensation")?.as_object()?.iter();
    let forms = forms.map(|(form, check)| {
        Some(CompensationCheck {
            form: interned(form),
            residual_deg_per_h: rows(check, "residual_deg_per_h")?,
            residual_max_deg_per_h: real(check, "residual_max_deg_per_h")?,
            error_max_deg_per_h: real(check, "error_max_deg_per_h"),
        })
    });
    let ranking = record.get("ranking").and_then(Value::as_array);
    let ranking = ranking.into_iter().flatten().map(rank);
    Some(CalibrationSheet {
        plan: plan(record.get("plan")?)?,
        plan_with_temperature: lifted(record.get("plan_with_temperature"), plan)?,
        groups: groups.collect::<Option<_>>()?,
        estimates: estimates.collect::<Option<_>>()?,
        applied: record.get("applied")?.as_str()?.to_owned(),
        compensation: forms.collect::<Option<_>>()?,
        truth: lifted(record.get("truth"), truth)?,
        ranking: ranking.collect::<Option<_>>()?,
        warnings: texts(record.get("warnings")?)?,
    })
}

/// What stands there, read; none within where nothing does, none where it cannot be read.
fn lifted<T>(value: Option<&Value>, read: impl Fn(&Value) -> Option<T>) -> Option<Option<T>> {
    match value {
        None => Some(None),
        Some(value) => read(value).map(Some),
    }
}

fn count(record: &Value, key: &str) -> Option<usize> {
    usize::try_from(record.get(key)?.as_u64()?).ok()
}

/// Counts of the gyros x, y, z.
fn counts(record: &Value, key: &str) -> Option<[usize; 3]> {
    let counts = record.get(key)?.as_array()?.iter();
    let counts = counts.map(|count| usize::try_from(count.as_u64()?).ok());
    counts.collect::<Option<Vec<usize>>>()?.try_into().ok()
}

fn rows(record: &Value, key: &str) -> Option<Vec<[f64; 3]>> {
    let rows = record.get(key)?.as_array()?.iter();
    rows.map(|row| numbers(row)?.try_into().ok()).collect()
}

fn plan(record: &Value) -> Option<CalibrationPlan> {
    Some(CalibrationPlan {
        groups: count(record, "groups")?,
        rank: count(record, "rank")?,
        condition_number: reals(record, "condition_number")?,
        singular_values: numbers(record.get("singular_values")?)?,
        scale_factor_ppm_per_deg_per_h: reals(record, "scale_factor_ppm_per_deg_per_h")?,
        bias_per_standard_error: reals(record, "bias_per_standard_error")?,
        scale_factor_bias_correlation: reals(record, "scale_factor_bias_correlation")?,
    })
}

fn group(record: &Value) -> Option<CalibrationGroup> {
    let axis = record.get("mounting")?.as_str()?;
    Some(CalibrationGroup {
        mounting: AXES.iter().position(|known| *known == axis)?,
        rate_deg_per_s: real(record, "rate_deg_per_s")?,
        reference_rate_deg_per_s: reals(record, "reference_rate_deg_per_s")?,
        temperature_c: reals(record, "temperature_c")?,
        temperature_rate_k_per_min: reals(record, "temperature_rate_k_per_min")?,
        output_deg_per_h: reals(record, "output_deg_per_h")?,
        standard_error_deg_per_h: reals(record, "standard_error_deg_per_h")?,
        start_s: real(record, "start_s"),
        averaging_time_s: real(record, "averaging_time_s")?,
        turns: real(record, "turns"),
        samples: count(record, "samples")?,
        rejected: counts(record, "rejected")?,
    })
}

fn parameters(record: &Value) -> Option<AssemblyParameters> {
    let mut theta_arcsec = [0.0; 6];
    for (theta, name) in theta_arcsec.iter_mut().zip(THETAS) {
        *theta = real(record, &format!("theta_{name}_arcsec"))?;
    }
    Some(AssemblyParameters {
        bias_deg_per_h: reals(record, "bias_deg_per_h")?,
        scale_factor_error_ppm: reals(record, "scale_factor_error_ppm")?,
        theta_arcsec,
    })
}

fn estimate(name: &str, record: &Value) -> Option<CalibrationEstimate> {
    let misfit = lifted(record.get("reduced_chi_square"), |_| {
        reals::<3>(record, "reduced_chi_square")
    })?;
    let slope = |slope: &Value| {
        Some(AxisCoefficient {
            value: reals(slope, "value")?,
            standard_error: reals(slope, "standard_error")?,
        })
    };
    let rounding = |rounding: &Value| {
        Some(ParameterRounding {
            bias_deg_per_h: real(rounding, "bias_deg_per_h")?,
            sensitivity_ppm: real(rounding, "sensitivity_ppm")?,
        })
    };
    Some(CalibrationEstimate {
        name: name.to_owned(),
        parameters: parameters(record.get("parameters")?)?,
        standard_error: parameters(record.get("standard_error")?)?,
        covariance: [[0.0; 12]; 12],
        reference_temperature_c: reals(record, "reference_temperature_c")?,
        bias_deg_per_h_per_k: lifted(record.get("bias_deg_per_h_per_k"), slope)?,
        residual_deg_per_h: rows(record, "residual_deg_per_h")?,
        residual_rms_deg_per_h: reals(record, "residual_rms_deg_per_h")?,
        reduced_chi_square: misfit.map_or([None; 3], |misfit| misfit.map(Some)),
        weights: rows(record, "weights")?,
        condition_number: reals(record, "condition_number")?,
        rounding: lifted(record.get("rounding"), rounding)?,
        delay_ms: lifted(record.get("delay_ms"), slope)?,
        rejected_samples: lifted(record.get("rejected_samples"), |_| {
            counts(record, "rejected_samples")
        })?,
        error: lifted(record.get("error"), error)?,
    })
}

fn error(record: &Value) -> Option<EstimateError> {
    Some(EstimateError {
        parameters: parameters(record)?,
        bias_rms_deg_per_h: real(record, "bias_rms_deg_per_h")?,
        scale_factor_rms_ppm: real(record, "scale_factor_rms_ppm")?,
        misalignment_rms_arcsec: real(record, "misalignment_rms_arcsec")?,
        normalised_error_squared: real(record, "normalised_error_squared"),
        compensated_rate_max_deg_per_h: real(record, "compensated_rate_max_deg_per_h")?,
    })
}

fn truth(record: &Value) -> Option<CalibrationTruth> {
    Some(CalibrationTruth {
        parameters: parameters(record)?,
        bias_deg_per_h_per_k: reals(record, "bias_deg_per_h_per_k")?,
        reference_temperature_c: real(record, "reference_temperature_c")?,
    })
}

fn rank(record: &Value) -> Option<CalibrationRank> {
    Some(CalibrationRank {
        name: record.get("estimator")?.as_str()?.to_owned(),
        campaigns: count(record, "campaigns")?,
        bias_rms_deg_per_h: real(record, "bias_rms_deg_per_h")?,
        scale_factor_rms_ppm: real(record, "scale_factor_rms_ppm")?,
        misalignment_rms_arcsec: real(record, "misalignment_rms_arcsec")?,
        normalised_error_squared: real(record, "normalised_error_squared"),
    })
}
