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

/// Why other channels lack the figures of fixed-point words.
pub(crate) const FIXED_POINT_ONLY: &str = "only a filter with number_format = \"fixed\" has it";

/// Words of x beyond the ends of their format.
pub static OVERFLOWS_X: MetricKey = MetricKey::of_fixed_point(
    "overflows_x",
    "1",
    "words of x beyond the ends of their format, warm-up included",
)
.lower_is_better();

/// Words of d beyond the ends of their format.
pub static OVERFLOWS_D: MetricKey = MetricKey::of_fixed_point(
    "overflows_d",
    "1",
    "words of d beyond the ends of their format, warm-up included",
)
.lower_is_better();

/// Words of t beyond the ends of their format.
pub static OVERFLOWS_T: MetricKey = MetricKey::of_fixed_point(
    "overflows_t",
    "1",
    "words of t beyond the ends of their format, warm-up included",
)
.lower_is_better();

/// Words of the denominator beyond the ends of their format.
pub static OVERFLOWS_DEN: MetricKey = MetricKey::of_fixed_point(
    "overflows_den",
    "1",
    "words of the denominator beyond the ends of their format, warm-up included",
)
.lower_is_better();

/// Words of k beyond the ends of their format.
pub static OVERFLOWS_K: MetricKey = MetricKey::of_fixed_point(
    "overflows_k",
    "1",
    "words of k beyond the ends of their format, warm-up included",
)
.lower_is_better();

/// Words of R beyond the ends of their format.
pub static OVERFLOWS_R: MetricKey = MetricKey::of_fixed_point(
    "overflows_r",
    "1",
    "words of R beyond the ends of their format, warm-up included",
)
.lower_is_better();

/// Words of W beyond the ends of their format.
pub static OVERFLOWS_W: MetricKey = MetricKey::of_fixed_point(
    "overflows_w",
    "1",
    "words of W beyond the ends of their format, warm-up included",
)
.lower_is_better();

/// Words of y and e beyond the ends of their format.
pub static OVERFLOWS_Y: MetricKey = MetricKey::of_fixed_point(
    "overflows_y",
    "1",
    "words of y and e beyond the ends of their format, warm-up included",
)
.lower_is_better();

/// Words beyond the ends of the signals, in the order of their formats.
pub(crate) static OVERFLOWS: [&MetricKey; 8] = [
    &OVERFLOWS_X,
    &OVERFLOWS_D,
    &OVERFLOWS_T,
    &OVERFLOWS_DEN,
    &OVERFLOWS_K,
    &OVERFLOWS_R,
    &OVERFLOWS_W,
    &OVERFLOWS_Y,
];

/// When the inverse correlation matrix stopped being definite.
pub static INDEFINITE_AT: MetricKey = MetricKey::of_fixed_point(
    "indefinite_at_s",
    "s",
    "stamp of the first sample with a denominator or a diagonal element of R at or below zero; the filter may \
     live on, and has diverged once its output is a hundredth of the full scale off that of its twin in binary64",
)
.higher_is_better()
.heading("indefinite at");

/// Error of the output over the signal.
pub static ROUNDING_ERROR_OVER_SIGNAL: MetricKey = MetricKey::of_fixed_point(
    "rounding_error_over_signal",
    "1",
    "rms of the output minus that of the same filter in binary64, over the rms of the latter",
)
.lower_is_better()
.heading("rounding/signal");

/// Angle random walk over that of the twin.
pub static ANGLE_RANDOM_WALK_OVER_BINARY64: MetricKey = MetricKey::of_fixed_point(
    "angle_random_walk_over_binary64",
    "1",
    "angle random walk over that of the same filter in binary64 on the same words",
)
.lower_is_better()
.heading("ARW/binary64")
.closing_tables();

/// DC gain minus that of the twin.
pub static DC_GAIN_MINUS_BINARY64: MetricKey = MetricKey::of_fixed_point(
    "dc_gain_minus_binary64",
    "1",
    "DC gain minus that of the same filter in binary64 on the same words",
)
.heading("DC gain - binary64");

/// Delay minus that of the twin.
pub static DELAY_MINUS_BINARY64: MetricKey = MetricKey::of_fixed_point(
    "delay_minus_binary64_us",
    "us",
    "delay against raw minus that of the same filter in binary64 on the same words",
)
.heading("delay - binary64")
.closing_tables();
