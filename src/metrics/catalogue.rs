//! List of the metrics, in the order of the columns of tables.

use super::key::MetricKey;

/// Names the metrics and lists them: each row is a module and the metric that it declares.
macro_rules! catalogue {
    ($($module:ident :: $key:ident),* $(,)?) => {
        $(pub use super::$module::$key;)*

        const CATALOGUE: &[&MetricKey] = &[$(&$key),*];
    };
}

catalogue! {
    noise_fit::ANGLE_RANDOM_WALK,
    steady::ANGLE_RANDOM_WALK_OVER_DC_GAIN,
    weight_noise::WEIGHT_NOISE_RATIO,
    bias::BIAS_STABILITY_1S,
    bias::BIAS_STABILITY_10S,
    bias::BIAS_STABILITY_100S,
    bias::BIAS_STABILITY,
    steady::BIAS_STABILITY_OVER_DC_GAIN,
    noise_fit::BIAS_INSTABILITY,
    noise_fit::RATE_RANDOM_WALK,
    noise_fit::RATE_RAMP,
    noise_fit::QUANTISATION,
    aggregate::BIAS_REPEATABILITY,
    channel::SETTLING_TIME,
    step_shape::RISE_TIME,
    step_shape::OVERSHOOT,
    swing::DELAY_VS_RAW,
    swing::DELAY_PREDICTED,
    swing::DELAY_VS_TRUTH,
    swing::DELAY_VS_ENCODER,
    swing::DELAY_BY_CORRELATION,
    swing::AMPLITUDE_RATIO,
    multi_sine::BANDWIDTH,
    swing::HARMONIC_DISTORTION,
    steady::MEAN,
    steady::MEAN_ERROR,
    noise_level::MEAN_RATIO,
    channel::MINIMUM,
    channel::MAXIMUM,
    staircase::SCALE_FACTOR_ERROR,
    staircase::SCALE_FACTOR_NONLINEARITY,
    staircase::SCALE_FACTOR_NONLINEARITY_OF_READING,
    staircase::SCALE_FACTOR_ASYMMETRY,
    aggregate::SCALE_FACTOR_REPEATABILITY,
    small_input::THRESHOLD,
    small_input::DEAD_BAND,
    small_input::RESOLUTION,
    channel::TRACKING_ERROR_RMS,
    noise_level::NOISE_STD,
    autocovariance::LAG1_CORRELATION,
    noise_level::NOISE_GAIN,
    noise_delay::NOISE_DELAY_BOUND_NOISE_GAIN,
    noise_delay::NOISE_GAIN_OVER_BOUND,
    channel::DC_GAIN,
    steady::DC_GAIN_PREDICTED,
    channel::DC_GAIN_ADAPTED,
    steady::DELAY_AT_DC,
    channel::SETTLED_GAIN,
    readaptation::READAPTATION_TIME,
    pipeline::PREDICTED_FAILURE,
    channel::DIVERGED_AT,
    pipeline::LATENCY,
    pipeline::SAMPLE_PERIOD,
    pipeline::CLOCKS_PER_SAMPLE,
    pipeline::SAMPLE_RATE_MAX,
    pipeline::ASYMMETRY_MAX,
    pipeline::SMALLEST_PIVOT,
    pipeline::CONDITION_NUMBER,
    estimates::BIAS_ERROR_RMS,
    estimates::SCALE_FACTOR_ERROR_RMS,
    estimates::MISALIGNMENT_ERROR_RMS,
    estimates::NORMALISED_ERROR_SQUARED,
    estimates::COMPENSATED_RATE_ERROR,
    estimates::PLAN_CONDITION_NUMBER,
    estimates::ROUNDING_LOSS,
}

/// Every metric a channel can have, in the order tables print them.
#[must_use]
pub fn known_metrics() -> &'static [&'static MetricKey] {
    CATALOGUE
}

/// Metrics that the Allan fit gives.
pub(crate) fn fitted_metrics() -> impl Iterator<Item = &'static MetricKey> {
    CATALOGUE.iter().copied().filter(|key| key.is_fitted())
}

/// Metrics whose values of every repeat are kept, in the order of the columns of `runs.csv`.
#[must_use]
pub fn repeated_metrics() -> Vec<&'static MetricKey> {
    let mut kept: Vec<_> = CATALOGUE
        .iter()
        .copied()
        .filter(|key| key.run_column.is_some())
        .collect();
    kept.sort_by_key(|key| key.run_column);
    kept
}

/// The metric of a name.
#[must_use]
pub fn find(name: &str) -> Option<&'static MetricKey> {
    CATALOGUE.iter().copied().find(|known| known.name == name)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_metric_has_a_name_of_its_own_and_a_heading_where_a_table_shows_it() {
        let names: BTreeSet<&str> = CATALOGUE.iter().map(|key| key.name).collect();
        assert_eq!(names.len(), CATALOGUE.len());
        for key in CATALOGUE {
            assert_eq!(find(key.name), Some(*key));
            let is_shown = !key.tables.is_empty() || key.closes_tables;
            assert!(!is_shown || key.heading.is_some(), "{}", key.name);
            let is_headline_only = key.tables.is_empty() && !key.headlines.is_empty();
            assert!(!is_headline_only, "{} heads a line of no table", key.name);
        }
    }

    #[test]
    fn columns_of_repeats_stand_in_places_of_their_own() {
        let places: Vec<Option<u8>> = repeated_metrics()
            .iter()
            .map(|key| key.run_column)
            .collect();
        let expected: Vec<Option<u8>> = (1..).map(Some).take(places.len()).collect();
        assert_eq!(places, expected);
    }
}
