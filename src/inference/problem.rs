//! What a problem file says.

use crate::declare::table;
use crate::vocabulary::{InferredQuantity, Prior};

table! {
    /// A problem: printed figures, the records they were read from, and what is left open about these.
    pub struct ProblemConfig {
        /// Version of the file format.
        schema: u32 = 1, in 1..=1;
        /// Name of the problem.
        name: String, example "paper", kind Name;
        /// What is asked, one sentence.
        description: Option<String>, example "Which settings make all figures of Table 2 at once.";
        /// Seed of the search. Source of the default: none, any number does.
        seed: u64 = 1, in 0..=9_223_372_036_854_775_807;
        /// Points by which each reading is searched. Source of the default: assumed.
        points: u32 = 256, in 32..=65_536;
        /// Simulations of each record under each reading, between which figures without a closed form are
        /// interpolated; 0 leaves these untold.
        simulations: u32 = 0, in 0..=10_000;
        /// Probability that a figure is not what the metric of its name says. Source of the default:
        /// assumed; one figure in 200.
        doubt: f64 = 0.005, in 1e-9..=0.5;
        records as "record": Vec<RecordConfig>;
        parameters as "parameter": Vec<ParameterConfig>;
        choices as "choice": Vec<ChoiceConfig>;
        published as "published": Vec<PrintedConfig>;
        logs as "log": Vec<LoggedConfig>;
        experiments as "experiment": Vec<ExperimentConfig>;
        gates as "gate": Vec<ProblemGateConfig>;
    }
}

table! {
    /// Records: the scenarios whose figures were printed.
    pub struct RecordConfig {
        /// Name by which the other tables call it.
        name: String, example "rest", kind Name;
        /// Scenario file, relative to this one.
        scenario: String, example "../scenarios/paper/static-25c.toml", kind File;
        /// Keys that differ from the scenario, as key=value.
        set: Option<Vec<String>>, example ["seed=7"];
    }
}

table! {
    /// Parameters: numbers left open, each within a range.
    pub struct ParameterConfig {
        /// Name by which results call it.
        name: String, example "bandwidth", kind Name;
        /// Keys that have this value, one or several.
        keys: Vec<String>, example ["gyro.controller.loop_bandwidth_hz"];
        /// Least value, in the unit of the keys.
        low: f64, example 500.0, in -1e30..=1e30;
        /// Greatest value, in the unit of the keys.
        high: f64, example 4000.0, in -1e30..=1e30;
        /// What is thought of the values before any figure is read.
        prior: Prior = "uniform";
        /// Names of the records that it acts in; all if it is not given.
        records: Option<Vec<String>>, example ["rest"];
    }
}

table! {
    /// Readings of what is left open in words: rows of one question are alternatives, and rows of one
    /// question and one answer hold together.
    pub struct ChoiceConfig {
        /// Question that is left open.
        question: String, example "swing amplitude";
        /// Answer that this row is part of.
        answer: String, example "an angle";
        /// Keys that follow from it, as key=value; none if the scenario is as this answer says.
        set: Option<Vec<String>>, example ["turntable.swing.rate_amplitude_deg_per_s=31.4"];
        /// Names of the records that it acts in; all if it is not given.
        records: Option<Vec<String>>, example ["swing"];
        /// How likely the answer is before any figure is read, beside the other answers.
        weight: f64 = 1.0, in 1e-9..=1e9;
    }
}

table! {
    /// Published figures, each with how it was rounded or how uncertain it is stated to be.
    pub struct PrintedConfig {
        /// Name of the record that it was read from.
        record: String, example "rest";
        /// Channel and metric, split at the last dot; of a point of a curve with its place in brackets, as in
        /// `raw.allan[10]`.
        metric: String, example "lms.angle_random_walk_deg_per_sqrt_h";
        /// The figure as printed.
        value: f64, example 0.006, in -1e30..=1e30;
        /// Its unit, that of the metric; "1" or "" for a ratio.
        unit: String, example "deg/sqrt(h)", kind FreeText;
        /// Step to which it was rounded; give this or the next.
        rounding: Option<f64>, example 0.0001, in 1e-30..=1e30;
        /// Standard uncertainty that is stated with it.
        standard_uncertainty: Option<f64>, example 0.0001, in 1e-30..=1e30;
        /// Where it was published.
        source: String, example "paper, table 2";
    }
}

table! {
    /// Logs whose figures stand beside those that were printed, as `fogbench analyze` has measured them.
    pub struct LoggedConfig {
        /// Name of the record that was logged.
        record: String, example "rest";
        /// What `fogbench analyze --format json` has printed, relative to this file.
        file: String, example "rest.json", kind File;
        /// Channels and metrics; points of a curve with their place in brackets, or those that tell most by
        /// the name of the curve alone.
        metrics: Vec<String>, example ["raw.mean_deg_per_h", "raw.allan[100]", "raw.autocovariance"];
    }
}

table! {
    /// Experiments that could be made: what each would tell is worked out.
    pub struct ExperimentConfig {
        /// Name of the experiment.
        name: String, example "half-the-bandwidth", kind Name;
        /// Name of the record that it varies.
        record: String, example "rest";
        /// Keys that differ from the record, as key=value.
        set: Option<Vec<String>>, example ["duration_s=36000.0"];
        /// Channel and metric that would be read.
        metric: String, example "rls.dc_gain";
    }
}

table! {
    /// Gates: what must be found. One that is not accepted gives exit code 1.
    pub struct ProblemGateConfig {
        /// What is judged.
        of: InferredQuantity, example "unexplained-figures";
        /// Least value that is accepted.
        min: Option<f64>, example 0.0, in -1e30..=1e30;
        /// Greatest value that is accepted.
        max: Option<f64>, example 0.0, in -1e30..=1e30;
    }
}
