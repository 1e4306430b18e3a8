//! The configuration of one run, as the stages receive it.
//!
//! Field names are the keys of the scenario file, units included; ranges and defaults stand in
//! `scenarios/reference.toml`. Values of these types come out of the reader only, which has
//! checked them; nothing here has a `Default`.

use std::str::FromStr;

use serde::Deserialize;

use super::calibration_config::CalibrationConfig;
use super::comparison_config::{
    AssumptionConfig, ComparisonConfig, ComparisonRowConfig, FigureConfig,
};
use super::compensation_config::CompensationConfig;
use super::gyro_config::GyroConfig;
use super::turntable_config::TurntableConfig;
use crate::filters::FilterConfig;
use crate::vocabulary::AveragingTimes;

/// One resolved run.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// Version of the file format, 1.
    pub schema: u32,
    /// Name: `[a-z0-9][a-z0-9_-]{0,63}`; the folder under `output/`.
    pub name: String,
    /// What the experiment shows, one sentence.
    pub description: Option<String>,
    /// Seed of every noise stream.
    pub seed: u64,
    /// Number of independent noise records.
    pub repeats: u32,
    /// Time measured, s.
    pub duration_s: f64,
    /// Time simulated and filtered before it, left out of every metric, s.
    pub warm_up_s: f64,
    /// Gyro model.
    pub fidelity: Fidelity,
    /// Averaging time of the plain `bias_stability_deg_per_h`, s.
    pub bias_averaging_time_s: f64,
    /// Table motion, servo and site.
    pub turntable: TurntableConfig,
    /// The gyro.
    pub gyro: GyroConfig,
    /// What is taken out of the outputs of an assembly; none leaves them as they are.
    pub compensation: Option<CompensationConfig>,
    /// What is made of a calibration campaign.
    pub calibration: CalibrationConfig,
    /// Filters, in the order of the file.
    #[serde(default, rename = "filter")]
    pub filters: Vec<FilterConfig>,
    /// The Allan curve of every channel.
    pub allan: AllanConfig,
    /// What is measured of the filters beside their words.
    pub trial: TrialConfig,
    /// Gates, in the order of the file.
    #[serde(default, rename = "gate")]
    pub gates: Vec<GateConfig>,
    /// Published figures to print beside the simulated ones.
    #[serde(default)]
    pub published: Vec<PublishedConfig>,
    /// Tables over several scenarios that close the suite.
    #[serde(default, rename = "comparison")]
    pub comparisons: Vec<ComparisonConfig>,
    /// Rows of these tables.
    #[serde(default, rename = "comparison_row")]
    pub comparison_rows: Vec<ComparisonRowConfig>,
    /// What a publication leaves open, and how it is read.
    #[serde(default, rename = "assumption")]
    pub assumptions: Vec<AssumptionConfig>,
    /// Published figures that are drawn again.
    #[serde(default, rename = "figure")]
    pub figures: Vec<FigureConfig>,
    /// What to write.
    pub output: OutputConfig,
}

/// Which gyro model runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fidelity {
    /// Every half modulation period.
    Loop,
    /// Output-rate equivalent.
    Rate,
}

/// The Allan curve of every channel; the fit of the noise terms does not depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AllanConfig {
    /// Which deviation.
    pub estimator: AllanEstimatorConfig,
    /// At which averaging times.
    pub averaging_times: AveragingTimes,
}

/// A deviation of the Allan family.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AllanEstimatorConfig {
    /// Allan deviation over every start.
    Overlapping,
    /// Allan deviation of neighbouring blocks.
    Plain,
    /// Modified Allan deviation.
    Modified,
    /// Overlapping Hadamard deviation.
    Hadamard,
}

impl FromStr for AllanEstimatorConfig {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text {
            "overlapping" => Ok(Self::Overlapping),
            "plain" => Ok(Self::Plain),
            "modified" => Ok(Self::Modified),
            "hadamard" => Ok(Self::Hadamard),
            _ => Err("expected overlapping, plain, modified or hadamard".to_owned()),
        }
    }
}

/// What is measured of the filters beside their words.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrialConfig {
    /// Gain for constant rates from 0.001 to 100 deg/s.
    pub rate_gain: bool,
    /// What becomes of the filters between the rates of a staircase.
    pub filter_state: FilterState,
}

/// What becomes of the filters between the rates of a staircase or a scale factor test.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FilterState {
    /// They go on with what they have learnt.
    Carried,
    /// They start afresh in every dwell, half-way through its settling.
    Reset,
}

/// A limit on a metric.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GateConfig {
    /// `<channel>.<metric>`, split at the last dot.
    pub metric: String,
    /// Lower limit, in the metric's unit.
    pub min: Option<f64>,
    /// Upper limit, in the metric's unit.
    pub max: Option<f64>,
    /// Channel whose same metric divides this one.
    pub relative_to: Option<String>,
    /// What is compared.
    pub decide: GateDecision,
    /// What an undecided interval means.
    pub inconclusive: InconclusivePolicy,
}

/// What a gate compares.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GateDecision {
    /// The whole interval.
    Interval,
    /// The value alone.
    Value,
}

/// What becomes of an inconclusive gate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum InconclusivePolicy {
    /// It fails.
    Fail,
    /// It is reported and allowed.
    Allow,
}

/// A published figure: shown beside the simulated one, never gated.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PublishedConfig {
    /// `<channel>.<metric>`.
    pub metric: String,
    /// The figure.
    pub value: f64,
    /// Its unit.
    pub unit: String,
    /// Where it was published.
    pub source: String,
}

/// What to write besides the report.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OutputConfig {
    /// Rate words of every channel.
    pub samples: SamplesFormat,
}

/// Format of the rate words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SamplesFormat {
    /// Not written.
    None,
    /// One NPY file per channel.
    Npy,
}
