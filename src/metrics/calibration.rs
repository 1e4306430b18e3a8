//! Figures of the estimates of a calibration campaign.

use super::key::metric::{Headline, MetricKey, Pool, Table};

/// Bias error rms.
pub static BIAS_ERROR_RMS: MetricKey = MetricKey::of_estimates(
    "bias_error_rms_deg_per_h",
    "deg/h",
    "root mean square error of the three biases that an estimator finds",
)
.lower_is_better()
.heading("bias error rms")
.pooled(Pool::RootMeanSquare)
.tables(&[Table::Campaign])
.headlines(&[Headline::General]);

/// Scale factor error rms.
pub static SCALE_FACTOR_ERROR_RMS: MetricKey = MetricKey::of_estimates(
    "scale_factor_error_rms_ppm",
    "ppm",
    "root mean square error of the three scale factors that an estimator finds",
)
.lower_is_better()
.heading("scale factor error rms")
.pooled(Pool::RootMeanSquare)
.tables(&[Table::Campaign])
.headlines(&[Headline::General]);

/// Misalignment error rms.
pub static MISALIGNMENT_ERROR_RMS: MetricKey = MetricKey::of_estimates(
    "misalignment_error_rms_arcsec",
    "arcsec",
    "root mean square error of the six misalignments that an estimator finds",
)
.lower_is_better()
.pooled(Pool::RootMeanSquare);

/// Normalised error squared.
pub static NORMALISED_ERROR_SQUARED: MetricKey = MetricKey::of_estimates(
    "normalised_error_squared",
    "1",
    "squared errors of the twelve parameters over their covariance, 12 if that tells all",
);

/// Compensated rate error.
pub static COMPENSATED_RATE_ERROR: MetricKey = MetricKey::of_estimates(
    "compensated_rate_error_deg_per_h",
    "deg/h",
    "largest error of the plan's rates compensated with the estimate, exact form",
)
.lower_is_better();

/// Plan condition number.
pub static PLAN_CONDITION_NUMBER: MetricKey = MetricKey::of_estimates(
    "plan_condition_number",
    "1",
    "largest condition number of the weighted rows of the three gyros",
)
.lower_is_better()
.of_settings();

/// Rounding loss.
pub static ROUNDING_LOSS: MetricKey = MetricKey::of_estimates(
    "rounding_loss_deg_per_h",
    "deg/h",
    "largest difference of a bias of the covariance recursion from its square-root form",
)
.lower_is_better();
