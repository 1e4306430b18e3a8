//! The configuration of one run, as the stages receive it.
//!
//! Field names are the keys of the scenario file, units included; ranges and defaults stand in
//! `scenarios/reference.toml`. Values of these types come out of the reader only, which has
//! checked them; nothing here has a `Default`.

use serde::Deserialize;

use super::filter_config::FilterConfig;
use super::gyro_config::GyroConfig;

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
    /// Filters, in the order of the file.
    #[serde(default, rename = "filter")]
    pub filters: Vec<FilterConfig>,
    /// Gates, in the order of the file.
    #[serde(default, rename = "gate")]
    pub gates: Vec<GateConfig>,
    /// Published figures to print beside the simulated ones.
    #[serde(default)]
    pub published: Vec<PublishedConfig>,
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

/// Rate table: exactly one motion.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct TurntableConfig {
    /// What the table is told to do (`[turntable.static]`, `.swing`, `.steps` or `.rotation`).
    #[serde(flatten)]
    pub motion: MotionConfig,
    /// How the table follows (`[turntable.servo.ideal]` or `.second_order`).
    pub servo: ServoConfig,
    /// Where the table stands and where its axis points.
    pub site: SiteConfig,
}

/// Commanded motion.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MotionConfig {
    /// At rest.
    Static(StaticConfig),
    /// Sine rate.
    Swing(SwingConfig),
    /// A staircase of rates.
    Steps(StepsConfig),
    /// Constant rate.
    Rotation(RotationConfig),
}

/// At rest: nothing to set.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StaticConfig {}

/// Swing about the table axis; exactly one amplitude is given.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SwingConfig {
    /// Rate amplitude, deg/s.
    pub rate_amplitude_deg_per_s: Option<f64>,
    /// Angle amplitude, deg; the rate amplitude is `2 pi f` times this.
    pub angle_amplitude_deg: Option<f64>,
    /// Swing frequency, Hz.
    pub frequency_hz: f64,
    /// Raised-cosine soft start, s, inside the warm-up.
    pub soft_start_s: f64,
}

/// Staircase: each rate is held for the dwell time; the last one is held for ever.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StepsConfig {
    /// Rates, deg/s, in order.
    pub rates_deg_per_s: Vec<f64>,
    /// Time at each rate, s; the first dwell begins at the end of the warm-up, before which the
    /// first rate is held. Steps fall on output-sample boundaries.
    pub dwell_s: f64,
}

/// Constant rotation.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RotationConfig {
    /// Rate, deg/s.
    pub rate_deg_per_s: f64,
    /// Raised-cosine soft start, s, inside the warm-up.
    pub soft_start_s: f64,
}

/// How the table follows its command.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ServoConfig {
    /// The axis is the command.
    Ideal(StaticConfig),
    /// Second-order low pass.
    SecondOrder(SecondOrderServoConfig),
}

/// `H(s) = wn^2 / (s^2 + 2 zeta wn s + wn^2)` from commanded to actual rate.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SecondOrderServoConfig {
    /// Natural frequency `wn / 2 pi`, Hz.
    pub natural_frequency_hz: f64,
    /// Damping ratio zeta.
    pub damping_ratio: f64,
}

/// Site and pointing of the table axis, which is the gyro's input axis.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SiteConfig {
    /// Geodetic latitude, deg, north positive.
    pub latitude_deg: f64,
    /// Elevation of the input axis above the horizon, deg (90 = up).
    pub axis_elevation_deg: f64,
    /// Azimuth of the input axis from north towards east, deg.
    pub axis_azimuth_deg: f64,
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
