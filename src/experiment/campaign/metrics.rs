//! The estimates of a campaign as metrics that gates can name, and their ranking over campaigns.

use super::units::rms;
use crate::metrics::catalogue::{
    BIAS_ERROR_RMS, COMPENSATED_RATE_ERROR, MISALIGNMENT_ERROR_RMS, NORMALISED_ERROR_SQUARED,
    PLAN_CONDITION_NUMBER, ROUNDING_LOSS, SCALE_FACTOR_ERROR_RMS,
};
use crate::metrics::{Applies, ChannelMetrics, Estimate, MetricKey, known_metrics};
use crate::scenario::Scenario;
use crate::signal::{CalibrationEstimate, CalibrationRank, CalibrationSheet, EstimateError};

fn is_campaign(scenario: &Scenario) -> bool {
    scenario.turntable.motion.campaign().is_some()
}

/// Why the channels of a campaign never have a metric.
pub(crate) fn lacks(scenario: &Scenario, key: &MetricKey) -> Option<&'static str> {
    (is_campaign(scenario) && key.is_of_one_motion)
        .then_some("the record of a campaign holds many rates: see its calibration")
}

/// Takes from a channel of a campaign what says nothing there.
pub(crate) fn drop_lacking(scenario: &Scenario, metrics: &mut ChannelMetrics) {
    for key in known_metrics() {
        if let Some(reason) = lacks(scenario, key) {
            metrics.withdraw(key, reason);
        }
    }
}

/// The estimator whose estimate a gate names in place of a channel.
pub(crate) fn estimator_of(scenario: &Scenario, channel: &str) -> Option<&'static str> {
    let channels = scenario.calibration_channels().into_iter();
    let mut pairs = channels.zip(scenario.calibration.kinds());
    let (_, kind) = pairs.find(|(name, _)| name == channel)?;
    Some(kind.word())
}

/// Why the estimate of an estimator never has a metric.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum UnsupportedMetric {
    /// A metric of channels.
    #[error("an estimate has {} only", own.join(", "))]
    OfChannels {
        /// Metrics of an estimate.
        own: Vec<&'static str>,
    },
    /// A metric of the covariance recursion.
    #[error("only the covariance recursion loses digits")]
    OfCovariance,
}

/// Checks that the estimate of an estimator has a metric.
///
/// # Errors
/// [`UnsupportedMetric`]: why it never has it.
pub(crate) fn supports(estimator: &str, metric: &str) -> Result<(), UnsupportedMetric> {
    let known = known_metrics().iter();
    let own: Vec<&str> = known
        .filter(|known| known.applies == Applies::Calibration)
        .map(|known| known.name)
        .collect();
    if !own.contains(&metric) {
        return Err(UnsupportedMetric::OfChannels { own });
    }
    if metric == ROUNDING_LOSS.name && estimator != "arls-covariance" {
        return Err(UnsupportedMetric::OfCovariance);
    }
    Ok(())
}

/// The estimates of a sheet under the names of their channels.
pub(crate) fn estimate_channels(
    sheet: &CalibrationSheet,
) -> impl Iterator<Item = (String, ChannelMetrics)> {
    let estimates = sheet.estimates.iter();
    estimates.map(|found| (format!("calibration_{}", found.name), metrics(found)))
}

fn metrics(found: &CalibrationEstimate) -> ChannelMetrics {
    let mut channel = ChannelMetrics::default();
    let mut put = |key: &MetricKey, value: f64| {
        channel.put(key, Estimate::exact(value));
    };
    let condition = found.condition_number.into_iter().fold(0.0, f64::max);
    put(&PLAN_CONDITION_NUMBER, condition);
    if let Some(rounding) = &found.rounding {
        put(&ROUNDING_LOSS, rounding.bias_deg_per_h);
    }
    if let Some(error) = &found.error {
        put(&BIAS_ERROR_RMS, error.bias_rms_deg_per_h);
        put(&SCALE_FACTOR_ERROR_RMS, error.scale_factor_rms_ppm);
        put(&MISALIGNMENT_ERROR_RMS, error.misalignment_rms_arcsec);
        put(
            &COMPENSATED_RATE_ERROR,
            error.compensated_rate_max_deg_per_h,
        );
        if let Some(normalised) = error.normalised_error_squared {
            put(&NORMALISED_ERROR_SQUARED, normalised);
        }
    }
    channel
}

/// The first sheet with the ranking over all, best bias first; none without a sheet.
///
/// An estimator is ranked if it worked in every campaign.
pub(crate) fn ranked(sheets: Vec<CalibrationSheet>) -> Option<CalibrationSheet> {
    let mut ranking = Vec::new();
    if sheets.len() > 1 {
        let names = sheets[0].estimates.iter().map(|found| found.name.clone());
        ranking = names.filter_map(|name| rank(&sheets, name)).collect();
        ranking.sort_by(|a, b| a.bias_rms_deg_per_h.total_cmp(&b.bias_rms_deg_per_h));
    }
    let mut first = sheets.into_iter().next()?;
    first.ranking = ranking;
    Some(first)
}

fn rank(sheets: &[CalibrationSheet], name: String) -> Option<CalibrationRank> {
    let errors: Option<Vec<EstimateError>> = sheets
        .iter()
        .map(|sheet| {
            let mut estimates = sheet.estimates.iter();
            estimates.find(|found| found.name == name)?.error
        })
        .collect();
    let errors = errors?;
    let over = |of: fn(&EstimateError) -> f64| rms(errors.iter().map(of));
    let normalised: Option<Vec<f64>> = errors
        .iter()
        .map(|error| error.normalised_error_squared)
        .collect();
    Some(CalibrationRank {
        name,
        campaigns: errors.len(),
        bias_rms_deg_per_h: over(|error| error.bias_rms_deg_per_h),
        scale_factor_rms_ppm: over(|error| error.scale_factor_rms_ppm),
        misalignment_rms_arcsec: over(|error| error.misalignment_rms_arcsec),
        normalised_error_squared: normalised.map(|values| mean(&values)),
    })
}

/// Mean of at least one value.
pub(crate) fn mean(values: &[f64]) -> f64 {
    let count = values.iter().fold(0.0, |count, _| count + 1.0);
    values.iter().sum::<f64>() / count
}
