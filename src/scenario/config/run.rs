//! The configuration of one run: the whole scenario file.

use super::allan::AllanConfig;
use super::comparison::{AssumptionConfig, ComparisonConfig, ComparisonRowConfig, FigureConfig};
use super::judging::{GateConfig, PublishedConfig};
use super::output::OutputConfig;
use super::trial::TrialConfig;
use crate::calibration::{CalibrationConfig, CompensationConfig};
use crate::declare::table;
use crate::filters::FilterConfig;
use crate::gyro::{Fidelity, GyroConfig};
use crate::recording::LogFormat;
use crate::turntable::TurntableConfig;

table! {
    /// One resolved run, as the stages receive it.
    pub struct Scenario {
        /// Version of the file format.
        schema: u32 = 1, in 1..=1;
        /// Name of the scenario and of its folder under the output folder; never inherited.
        /// raw, truth, time_s and encoder_arcsec are reserved. A file without a name is a base for others.
        name: String, example "swing-5hz", kind Name;
        /// What the experiment shows, one sentence.
        description: Option<String>, example "Delay of the filters while the table swings at 5 Hz.";
        /// Path of the file this one builds on, relative to this file. Cycles are refused.
        extends: Option<String>, example "../base/fog70.toml",
            apart "its values have been merged with those of this file";
        /// Seed of every noise stream. Source of the default: none, any number does.
        seed: u64 = 1, in 0..=9_223_372_036_854_775_807;
        /// Number of independent noise records, all else equal.
        repeats: u32 = 1, in 1..=100_000;
        /// Time measured; of a log what it holds, unless less is asked for.
        duration_s: f64, example 20.0, in 1e-6..=1e7, "s";
        /// Time simulated and filtered before it, left out of every metric. Source of the default: assumed;
        /// adaptive filters have settled long before. Of a log 0.
        warm_up_s: f64 = 60.0, in 0.0..=1e6, "s";
        /// Gyro model: every half modulation period ("loop"), or its equivalent at the output rate ("rate").
        fidelity: Fidelity = "loop";
        /// Averaging time of the plain bias stability. Source of the default: customary in
        /// Chinese practice (GJB 2426A); the paper does not state its own.
        bias_averaging_time_s: f64 = 100.0, in 1e-6..=1e6, "s";
        log: Option<LogFormat>;
        turntable: TurntableConfig;
        gyro: GyroConfig;
        compensation: Option<CompensationConfig>;
        calibration: CalibrationConfig;
        filters as "filter": Vec<FilterConfig>;
        allan: AllanConfig;
        trial: TrialConfig;
        gates as "gate": Vec<GateConfig>;
        published as "published": Vec<PublishedConfig>;
        comparisons as "comparison": Vec<ComparisonConfig>;
        comparison_rows as "comparison_row": Vec<ComparisonRowConfig>;
        assumptions as "assumption": Vec<AssumptionConfig>;
        figures as "figure": Vec<FigureConfig>;
        output: OutputConfig;
        /// Swept keys and their values; the runs are the Cartesian product, the last key fastest. All points
        /// share the noise (common random numbers), so that they compare in pairs. Values are an array, or a
        /// range with both ends in it: { from = 100, to = 2000, count = 9, spacing = "log" }, whose spacing
        /// is "linear" if it is not given. A range is rounded to six digits of its step; that of a whole
        /// number keeps to whole numbers, to which "log" rounds.
        matrix: Option<String>, example "\"gyro.source.power_uw\" = [0.5, 0.87, 2.0]", kind Matrix,
            apart "each point of it is a scenario of its own";
    }
}
