//! Scenario files: TOML in, checked immutable configuration out.
//!
//! ```text
//!  files ──> read ──> document ──> check ──> config ──> stages
//!                                   │  └──> message
//!              declarations ──> keys┴──> generate: reference.toml, scenario.schema.json
//! ```
//!
//! Invariant: pure data. No state, no hidden default: a default stands in the declaration of its key,
//! beside the stage that works by it, and `scenarios/reference.toml` prints it. A value that reaches a
//! stage has been checked for type, range and contradiction, and every complaint points at the file,
//! line and key that is wrong.

mod check;
mod config;
mod document;
mod generate;
mod keys;
mod message;
mod read;

pub use crate::calibration::{
    CalibrationConfig, CompensationConfig, CompensationParameters, TemperatureParameters,
};
pub use crate::filters::{
    ButterworthFilterConfig, ConstrainedRlsFilterConfig, FilterConfig, FilterKind,
    KalmanFilterConfig, LmsFilterConfig, MovingAverageFilterConfig, OnePoleFilterConfig,
    ProcessFilterConfig, ReplayFilterConfig, RlsFilterConfig, SavitzkyGolayFilterConfig,
    SignLmsFilterConfig,
};
pub use crate::gyro::{
    AdcConfig, AssemblyConfig, CoilConfig, ConstantPowerConfig, ControllerConfig, DetectorConfig,
    ExponentialPowerConfig, Fidelity, GyroConfig, InjectionConfig, ModulationScheme,
    ModulatorConfig, NoVibrationConfig, NoiseConfig, NoiseDraw, OutputQuantisation, PowerConfig,
    QuadraticPowerConfig, RandomVibrationConfig, RateOutputConfig, ResetSample,
    SineVibrationConfig, SlowNoiseConfig, SoakConfig, SourceConfig, TemperatureConfig,
    TemperatureProfileConfig, TemperatureRampConfig, ThermalConfig, ThermalWarmUp, VibrationConfig,
    VibrationMotion, Winding,
};
pub use crate::recording::LogFacts;
pub use crate::turntable::{
    AxisConfig, CampaignConfig, CampaignGroup, ChirpConfig, DirectDriveServoConfig, EncoderConfig,
    MotionClass, MotionConfig, MountingConfig, MultiSineConfig, PreferredSeries, Progression,
    RotationConfig, ScaleFactorTestConfig, ScriptConfig, ScriptPoints, SecondOrderServoConfig,
    ServoConfig, SignalShape, SiteConfig, Stairs, StaticConfig, StepsConfig, SwingConfig,
    TEST_RATES_MIN, TestSignalConfig, TrapezoidConfig, TurntableConfig,
};
pub(crate) use check::cross::comparison::slug;
pub(crate) use check::cross::{RESERVED, reserved};
pub(crate) use check::leaf::is_name;
pub use config::channels::LogChannels;
pub(crate) use config::channels::{WITHOUT_OUTLIERS, WITHOUT_TEMPERATURE, motion_of_log};
pub use config::{
    AllanConfig, AllanEstimatorConfig, AssumptionConfig, BlackBoxTrial, ComparisonColumn,
    ComparisonConfig, ComparisonKind, ComparisonRowConfig, FigureConfig, FilterState, GateConfig,
    GateDecision, InconclusivePolicy, OutputConfig, PublishedConfig, RangeConfig, ReportedRuns,
    SamplesFormat, Scenario, Spacing, TrialConfig,
};
pub use document::setting::Setting;
pub use generate::json_schema::json_schema;
pub use generate::problem_schema::problem_schema;
pub use generate::reference::reference_toml;
pub use generate::reference_part::{UnknownKey, reference_part};
pub(crate) use keys::schema::{declared_key, unit_of_written};
pub use message::complaints::ScenarioErrors;
pub use message::error::{Location, ScenarioError};
pub(crate) use message::error::{in_both, in_order, portable_place};
pub use message::excerpt::{bounded, excerpt};
pub use read::assumed::{AssumedInShort, AssumedValue};
pub use read::discover::left_out;
pub use read::files::compensation_source::load_calibration;
pub use read::files::log_format::{load_log_format, log_format_toml};
pub(crate) use read::files::log_source::digest_of_log;
pub use read::files::manifest::manifest_toml;
pub use read::files::named_files::NamedFile;
pub use read::files::problem::{Problem, load_problem, problem_keys};
pub use read::files::temperature_source::{
    TemperatureTables, load_log_temperature, load_temperature,
};
pub use read::moved::{Movable, NotMovable};
pub use read::purpose::Purpose;
pub(crate) use read::resolve::UnsoundReading;
#[cfg(feature = "report")]
pub(crate) use read::resolved::run_folder;
pub use read::resolved::{InputFile, Resolved, SweepPoint};
pub(crate) use read::suite::{Reading, read_suite};
pub use read::suite::{load_base_or_scenario, load_suite, visit_suite};
pub(crate) use read::unresolved::Unresolved;

#[cfg(test)]
mod tests;
