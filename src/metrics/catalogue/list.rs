//! List of the metrics, in the order of the columns of tables, and of the curves.

use crate::metrics::key::curve::CurveKey;
use crate::metrics::key::metric::MetricKey;

/// Names rows and lists them: each is a module and the row that it declares.
macro_rules! rows {
    ($list:ident: $row:ty; $($($segment:ident)::+),* $(,)?) => {
        $(pub use crate::metrics::$($segment)::+;)*

        const $list: &[&$row] = &[$(&crate::metrics::$($segment)::+),*];
    };
}

rows! {
    CATALOGUE: MetricKey;
    allan::noise_fit::ANGLE_RANDOM_WALK,
    trial::dc_gain::ANGLE_RANDOM_WALK_OVER_DC_GAIN,
    trial::weight_noise::WEIGHT_NOISE_RATIO,
    trial::weight_noise::ALLAN_RATIO_INSIDE_MEMORY,
    noise::bias_stability::BIAS_STABILITY_1S,
    noise::bias_stability::BIAS_STABILITY_10S,
    noise::bias_stability::BIAS_STABILITY_100S,
    noise::bias_stability::BIAS_STABILITY,
    trial::dc_gain::BIAS_STABILITY_OVER_DC_GAIN,
    allan::noise_fit::BIAS_INSTABILITY,
    allan::noise_fit::RATE_RANDOM_WALK,
    allan::noise_fit::RATE_RAMP,
    allan::noise_fit::QUANTISATION,
    allan::extra_terms::CORRELATED_NOISE,
    allan::extra_terms::CORRELATION_TIME,
    allan::extra_terms::SINE_AMPLITUDE,
    allan::extra_terms::SINE_PERIOD,
    pool::repeatability::BIAS_REPEATABILITY,
    steps::settling::SETTLING_TIME,
    steps::shape::RISE_TIME,
    steps::shape::OVERSHOOT,
    motion::swing::DELAY_VS_RAW,
    motion::swing::DELAY_PREDICTED,
    motion::swing::DELAY_VS_TRUTH,
    motion::swing::DELAY_VS_ENCODER,
    motion::swing::DELAY_BY_CORRELATION,
    motion::swing::AMPLITUDE_RATIO,
    motion::multi_sine::BANDWIDTH,
    motion::swing::HARMONIC_DISTORTION,
    motion::mean::MEAN,
    motion::mean::MEAN_ERROR,
    motion::mean::MEAN_RATIO,
    motion::mean::MINIMUM,
    motion::mean::MAXIMUM,
    steps::staircase::SCALE_FACTOR_ERROR,
    steps::staircase::SCALE_FACTOR_OFFSET,
    steps::staircase::SCALE_FACTOR_NONLINEARITY,
    steps::staircase::SCALE_FACTOR_NONLINEARITY_OF_READING,
    steps::staircase::SCALE_FACTOR_ASYMMETRY,
    pool::repeatability::SCALE_FACTOR_REPEATABILITY,
    steps::small_input::THRESHOLD,
    steps::small_input::DEAD_BAND,
    steps::small_input::RESOLUTION,
    motion::tracking::TRACKING_ERROR_RMS,
    noise::level::NOISE_STD,
    noise::two_runs::TWO_RUN_NOISE_STD,
    noise::autocovariance::LAG1_CORRELATION,
    noise::level::NOISE_GAIN,
    trial::noise_delay::NOISE_DELAY_BOUND_NOISE_GAIN,
    trial::noise_delay::NOISE_GAIN_OVER_BOUND,
    trial::dc_gain::DC_GAIN,
    trial::predicted::DC_GAIN_PREDICTED,
    trial::dc_gain::DC_GAIN_ADAPTED,
    trial::predicted::DELAY_AT_DC,
    motion::steps::SETTLED_GAIN,
    trial::black_box::LOOK_AHEAD,
    trial::black_box::MEMORY_1_PERCENT,
    trial::black_box::MEMORY_0P1_PERCENT,
    trial::black_box::ADAPTATION_MEMORY,
    trial::black_box::STEP_GAIN_1S,
    trial::black_box::STEP_GAIN_10S,
    trial::black_box::STEP_GAIN_100S,
    trial::black_box::SINE_GAIN,
    trial::black_box::LASTING_RATE_GAIN,
    trial::black_box::TWIN_MEAN_RATIO,
    trial::black_box::DELAY_AT_REST,
    equal_delay::NOISE_AT_EQUAL_DELAY,
    equal_delay::OPERATIONS_PER_WORD,
    trial::black_box::DELAY_UNDER_SWING,
    trial::black_box::SWING_READAPTATION,
    trial::black_box::START_UP,
    trial::black_box::SATURATION_GAIN,
    trial::black_box::LINEARITY_ERROR,
    trial::black_box::TIME_INVARIANCE_ERROR,
    trial::black_box::GLITCH_RESPONSE,
    trial::readaptation::READAPTATION_TIME,
    pipeline::PREDICTED_FAILURE,
    quality::outliers::OUTLIERS,
    quality::smoothing::SMOOTHING_TIME,
    temperature::keys::BIAS_PER_K,
    temperature::keys::BIAS_PER_K2,
    temperature::keys::BIAS_PER_K_PER_MIN,
    temperature::keys::SCALE_FACTOR_PER_K,
    temperature::keys::HYSTERESIS,
    temperature::keys::HYSTERESIS_LEFT,
    temperature::keys::STD_LEFT,
    measure::DIVERGED_AT,
    pipeline::LATENCY,
    pipeline::SAMPLE_PERIOD,
    pipeline::CLOCKS_PER_SAMPLE,
    pipeline::SAMPLE_RATE_MAX,
    pipeline::ASYMMETRY_MAX,
    pipeline::SMALLEST_PIVOT,
    pipeline::CONDITION_NUMBER,
    pipeline::OVERFLOWS_X,
    pipeline::OVERFLOWS_D,
    pipeline::OVERFLOWS_T,
    pipeline::OVERFLOWS_DEN,
    pipeline::OVERFLOWS_K,
    pipeline::OVERFLOWS_R,
    pipeline::OVERFLOWS_W,
    pipeline::OVERFLOWS_Y,
    pipeline::INDEFINITE_AT,
    pipeline::ROUNDING_ERROR_OVER_SIGNAL,
    pipeline::ANGLE_RANDOM_WALK_OVER_BINARY64,
    pipeline::DC_GAIN_MINUS_BINARY64,
    pipeline::DELAY_MINUS_BINARY64,
    calibration::BIAS_ERROR_RMS,
    calibration::SCALE_FACTOR_ERROR_RMS,
    calibration::MISALIGNMENT_ERROR_RMS,
    calibration::NORMALISED_ERROR_SQUARED,
    calibration::COMPENSATED_RATE_ERROR,
    calibration::PLAN_CONDITION_NUMBER,
    calibration::ROUNDING_LOSS,
}

rows! {
    CURVES: CurveKey;
    allan::curves::ALLAN,
    allan::curves::ALLAN_FIT,
    noise::spectrum::PSD,
    noise::autocovariance::AUTOCOVARIANCE,
    steps::staircase::RESPONSE,
    steps::staircase::SCALE_FACTOR,
    motion::multi_sine::FREQUENCY_RESPONSE,
    motion::multi_sine::FREQUENCY_RESPONSE_VS_RAW,
    trial::frozen_response::FROZEN_RESPONSE,
    trial::noise_delay::NOISE_DELAY_BOUND,
    trial::rate_gain::RATE_GAIN,
    temperature::keys::TEMPERATURE,
}

/// Every metric a channel can have, in the order tables print them.
#[must_use]
pub fn known_metrics() -> &'static [&'static MetricKey] {
    CATALOGUE
}

/// Every curve a channel can have.
#[must_use]
pub fn known_curves() -> &'static [&'static CurveKey] {
    CURVES
}

/// Every metric in the order of the columns of `runs.csv`: those with a place of their own first.
#[must_use]
pub fn repeated_metrics() -> Vec<&'static MetricKey> {
    let mut all = CATALOGUE.to_vec();
    all.sort_by_key(|key| (key.run_column.is_none(), key.run_column));
    all
}

/// The metric of a name.
#[must_use]
pub fn find(name: &str) -> Option<&'static MetricKey> {
    CATALOGUE.iter().copied().find(|known| known.name == name)
}

#[cfg(test)]
mod tests {
    use std::collections::{BTreeMap, BTreeSet};
    use std::fs;
    use std::path::Path;

    use super::*;
    use crate::metrics::allan::entry::FIT_METRICS;
    use crate::metrics::key::metric::Pool;

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
    fn the_fit_to_the_pooled_allan_variance_gives_what_is_declared_so() {
        let declared = CATALOGUE.iter().copied();
        let declared: Vec<_> = declared
            .filter(|key| matches!(key.pool, Pool::AllanFit))
            .collect();
        assert_eq!(declared, FIT_METRICS);
    }

    #[test]
    fn every_row_that_is_declared_is_listed() {
        let mut sources = Vec::new();
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/metrics");
        for room in fs::read_dir(folder).unwrap().flatten() {
            match fs::read_dir(room.path()) {
                Ok(files) => {
                    let files = files.flatten().map(|file| file.path());
                    sources.extend(files.filter(|path| path.is_file()));
                }
                Err(_) => sources.push(room.path()),
            }
        }
        let mut declared = BTreeMap::new();
        for text in sources.iter().map(|path| fs::read_to_string(path).unwrap()) {
            for line in text.lines().filter(|line| line.starts_with("pub static ")) {
                let (name, row) = line
                    .trim_start_matches("pub static ")
                    .split_once(": ")
                    .unwrap();
                declared.insert(name.to_owned(), row.split(' ').next().map(str::to_owned));
            }
        }
        let list = include_str!("list.rs");
        for (name, row) in declared {
            let is_row = matches!(row.as_deref(), Some("MetricKey" | "CurveKey"));
            let is_listed = list.contains(&format!("::{name},\n"));
            assert!(!is_row || is_listed, "{name} is declared and not listed");
        }
    }

    #[test]
    fn every_curve_has_a_name_of_its_own_and_columns_that_say_what_they_hold() {
        let names: BTreeSet<&str> = CURVES.iter().map(|key| key.name).collect();
        assert_eq!(names.len(), CURVES.len());
        for key in CURVES {
            assert!(
                !key.definition.is_empty() && !key.columns.is_empty(),
                "{}",
                key.name
            );
            let all = key.columns.iter().chain(key.words);
            let columns: BTreeSet<&str> = all.clone().map(|column| column.name).collect();
            assert_eq!(columns.len(), all.clone().count(), "{}", key.name);
            for column in all {
                let is_told = !column.unit().is_empty() && !column.definition().is_empty();
                assert!(is_told, "{}.{}", key.name, column.name);
                let middle = column.end_of;
                assert!(
                    middle.is_none_or(|of| key.has(of)),
                    "{}.{}",
                    key.name,
                    column.name
                );
            }
        }
    }

    #[test]
    fn columns_of_repeats_stand_in_places_of_their_own() {
        let all = repeated_metrics();
        assert_eq!(all.len(), CATALOGUE.len());
        let places: Vec<u8> = all.iter().filter_map(|key| key.run_column).collect();
        let expected: Vec<u8> = (1..).take(places.len()).collect();
        assert_eq!(places, expected);
        assert!(
            all[..places.len()]
                .iter()
                .all(|key| key.run_column.is_some())
        );
    }
}
