//! What can be wrong with a hardware pipeline before it runs.

use super::pipeline_metrics::MATRIX_METRICS;
use super::pipeline_settings::PipelineSettings;
use crate::metrics::catalogue::PREDICTED_FAILURE;
use crate::metrics::{Applies, MetricKey};
use crate::scenario::Scenario;
use crate::units::s_to_us;

/// The table of the filter in its scenario.
pub(super) fn kind(settings: &PipelineSettings) -> &'static str {
    settings.core.kind().name
}

/// Checks the constants in their word format, and that a sample is done before the next arrives.
///
/// * `path`: table of the filter, for the complaint.
///
/// # Errors
/// The key to blame and the complaint.
pub(super) fn check(
    settings: &PipelineSettings,
    path: &str,
    output_rate_hz: f64,
) -> Result<(), (String, String)> {
    let timing = settings
        .timing()
        .map_err(|error| (path.to_owned(), format!("{path}: {error}")))?;
    let period_us = s_to_us(1.0 / output_rate_hz);
    if timing.sample_period_us <= period_us {
        return Ok(());
    }
    let clock_mhz = settings.clock_mhz;
    let message = format!(
        "{path}.clock_mhz = {clock_mhz} is too slow: {} clocks a sample take {:.3} us, the gyro \
         gives one every {period_us:.3} us; use {:.3} MHz or more, or fewer taps",
        timing.usage.clocks_per_sample,
        timing.sample_period_us,
        clock_mhz * timing.sample_period_us / period_us
    );
    Err((format!("{path}.clock_mhz"), message))
}

/// Why a channel can never have a metric of hardware pipelines; nothing for other metrics.
pub(super) fn lacks(scenario: &Scenario, channel: &str, key: &MetricKey) -> Option<&'static str> {
    if key.applies != Applies::Pipeline {
        return None;
    }
    let filter = scenario.filter_of(channel)?;
    let Some(settings) = PipelineSettings::of(&filter.kind) else {
        return Some("only a filter with pipeline = \"fpga\" has it");
    };
    if MATRIX_METRICS.contains(&key) && !settings.core.kind().has_matrix {
        return Some("a least-mean-squares filter has no matrix");
    }
    if *key == PREDICTED_FAILURE && settings.failure_samples().is_none() {
        return Some("only update_order = \"gain-first\" below a forgetting factor of 1 has it");
    }
    None
}
