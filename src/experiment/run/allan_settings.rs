//! From the keys of the Allan curve to the options of the metrics.

use crate::metrics::{AllanEstimator, AllanOptions};
use crate::scenario::{AllanConfig, AllanEstimatorConfig};

/// The options that the keys stand for, intervals at 95 %.
pub(crate) fn allan_options(config: AllanConfig) -> AllanOptions {
    AllanOptions {
        estimator: match config.estimator {
            AllanEstimatorConfig::Overlapping => AllanEstimator::Overlapping,
            AllanEstimatorConfig::Plain => AllanEstimator::Plain,
            AllanEstimatorConfig::Modified => AllanEstimator::Modified,
            AllanEstimatorConfig::Hadamard => AllanEstimator::Hadamard,
        },
        taus: config.averaging_times,
        ..AllanOptions::default()
    }
}
