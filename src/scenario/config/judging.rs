//! Gates and published figures.

use crate::declare::table;
use crate::vocabulary::words;

table! {
    /// Gates: limits that decide over pass and fail. Give min, max or both. None by default.
    pub struct GateConfig {
        /// Channel and metric, split at the last dot.
        metric: String, example "raw.angle_random_walk_deg_per_sqrt_h";
        /// Lower limit, in the unit of the metric.
        min: Option<f64>, example 0.0055, in -1e30..=1e30;
        /// Upper limit, in the unit of the metric.
        max: Option<f64>, example 0.0065, in -1e30..=1e30;
        /// Channel whose same metric divides this one.
        relative_to: Option<String>, example "raw";
        /// What is compared: the whole 95 % interval, or the value alone.
        decide: GateDecision = "interval";
        /// What becomes of an interval that reaches over a limit.
        inconclusive: InconclusivePolicy = "fail";
    }
}

words! {
    /// What a gate compares.
    pub enum GateDecision {
        /// The whole interval.
        Interval = "interval",
        /// The value alone.
        Value = "value",
    }

    /// What becomes of an inconclusive gate.
    pub enum InconclusivePolicy {
        /// It fails.
        Fail = "fail",
        /// It is reported and allowed.
        Allow = "allow",
    }
}

table! {
    /// Published figures: printed beside the simulated ones, never gated. None by default.
    pub struct PublishedConfig {
        /// Channel and metric, split at the last dot.
        metric: String, example "raw.bias_stability_deg_per_h";
        /// The published figure.
        value: f64, example 0.0603, in -1e30..=1e30;
        /// Its unit, that of the metric; "1" or "" for a ratio.
        unit: String, example "deg/h", kind FreeText;
        /// Where it was published.
        source: String, example "the paper, table 2";
        /// Channel whose same metric divides this one: the figure is a relative change, in "1".
        relative_to: Option<String>, example "raw";
        /// Half a unit of the last digit of the figure. With it the figure is a claim: the run says whether it is
        /// consistent with it, that is whether the simulated interval and the rounding overlap.
        rounding: Option<f64>, example 5e-5, in 0.0..=1e30;
    }
}
