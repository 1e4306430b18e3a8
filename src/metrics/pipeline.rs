//! Figures of a hardware pipeline, which its simulation gives.

use super::key::metric::MetricKey;

/// Why other channels lack the figures of pipelines.
pub(crate) const PIPELINE_ONLY: &str = "only a filter with pipeline = \"fpga\" has it";

/// Predicted time to failure.
pub static PREDICTED_FAILURE: MetricKey = MetricKey::of_pipelines(
    "predicted_failure_s",
    "s",
    "time to failure ln(0.01/eps)/(1-alpha) of the gain-first update, in samples and s",
)
.higher_is_better()
.of_settings()
.heading("predicted failure")
.closing_tables();

/// Latency.
pub static LATENCY: MetricKey = MetricKey::of_pipelines(
    "latency_us",
    "us",
    "from accepting a sample to its result, counted on the model",
)
.lower_is_better()
.of_settings()
.heading("latency")
.closing_tables();

/// Sample period of the pipeline.
pub static SAMPLE_PERIOD: MetricKey =
    MetricKey::of_pipelines("sample_period_us", "us", "time of these clocks")
        .lower_is_better()
        .of_settings()
        .heading("pipeline period")
        .closing_tables();

/// Clocks per sample.
pub static CLOCKS_PER_SAMPLE: MetricKey = MetricKey::of_pipelines(
    "clocks_per_sample",
    "1",
    "clocks from one accepted sample to the next, back to back, counted on the model",
)
.lower_is_better()
.of_settings();

/// Largest sample rate of the pipeline.
pub static SAMPLE_RATE_MAX: MetricKey = MetricKey::of_pipelines(
    "sample_rate_max_khz",
    "kHz",
    "largest sample rate the pipeline keeps up with, 1/sample_period_us",
)
.higher_is_better()
.of_settings();

/// Largest asymmetry of the inverse correlation matrix.
pub static ASYMMETRY_MAX: MetricKey = MetricKey::of_pipelines(
    "asymmetry_max",
    "1",
    "largest difference of mirrored elements of the inverse correlation matrix over its largest",
);

/// Smallest pivot of the inverse correlation matrix.
pub static SMALLEST_PIVOT: MetricKey = MetricKey::of_pipelines(
    "smallest_pivot",
    "1",
    "smallest Cholesky pivot of that matrix over its largest diagonal element",
);

/// Condition number of the inverse correlation matrix.
pub static CONDITION_NUMBER: MetricKey = MetricKey::of_pipelines(
    "condition_number",
    "1",
    "largest ratio of the extreme eigenvalues of that matrix",
);
