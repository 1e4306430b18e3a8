//! Scenario files: TOML in, checked immutable configuration out.
//!
//! Invariant: pure data. No state, no hidden default: `scenarios/reference.toml` is embedded and is
//! the only source of defaults; a value that reaches a stage has been checked for type, range and
//! contradiction, and every complaint points at the file, line and key that is wrong.

mod address;
mod chain;
mod channels;
mod check;
mod clashes;
mod compensation_source;
mod complaints;
mod config;
mod cross;
mod cross_comparison;
mod cross_compensation;
mod cross_gyro;
mod cross_optics;
mod cross_servo;
mod cross_vibration;
mod defaults;
mod deserialize;
mod discover;
mod draft;
mod emit;
mod error;
mod excerpt;
mod faults;
mod inert;
mod inert_rules;
mod input;
mod json_schema;
mod leaf;
mod manifest;
mod matrix;
mod numbers;
mod presence;
mod reference;
mod resolve;
mod resolved;
mod schema;
mod script;
mod setting;
mod source;
mod stand_in;
mod suggest;
mod suite;
mod synonyms;
mod template;
mod tree;
mod unresolved;
mod weight;

pub use crate::calibration::{CalibrationConfig, CompensationConfig, CompensationParameters};
pub use crate::filters::{
    ButterworthFilterConfig, ConstrainedRlsFilterConfig, FilterConfig, FilterKind,
    KalmanFilterConfig, LmsFilterConfig, MovingAverageFilterConfig, OnePoleFilterConfig,
    RlsFilterConfig, SavitzkyGolayFilterConfig, SignLmsFilterConfig,
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
pub use crate::turntable::{
    AxisConfig, CampaignConfig, CampaignGroup, ChirpConfig, DirectDriveServoConfig, EncoderConfig,
    MotionClass, MotionConfig, MountingConfig, MultiSineConfig, PreferredSeries, Progression,
    RotationConfig, ScaleFactorTestConfig, ScriptConfig, ScriptPoints, SecondOrderServoConfig,
    ServoConfig, SiteConfig, Stairs, StaticConfig, StepsConfig, SwingConfig, TEST_RATES_MIN,
    TrapezoidConfig, TurntableConfig,
};
pub use compensation_source::load_calibration;
pub use complaints::ScenarioErrors;
pub use config::{
    AllanConfig, AllanEstimatorConfig, AssumptionConfig, ComparisonColumn, ComparisonConfig,
    ComparisonKind, ComparisonRowConfig, FigureConfig, FilterState, GateConfig, GateDecision,
    InconclusivePolicy, OutputConfig, PublishedConfig, SamplesFormat, Scenario, TrialConfig,
};
pub(crate) use cross_comparison::slug;
pub(crate) use draft::UnsoundReading;
pub use error::{Location, ScenarioError};
pub(crate) use error::{in_both, in_order, portable_place};
pub use excerpt::{bounded, excerpt};
pub use json_schema::json_schema;
pub use manifest::manifest_toml;
pub use reference::reference_toml;
pub use resolved::{InputFile, Resolved, SweepPoint};
pub use setting::Setting;
pub(crate) use suite::{Reading, read_suite};
pub use suite::{load_base_or_scenario, load_suite, visit_suite};
pub(crate) use unresolved::Unresolved;

#[cfg(test)]
mod inert_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod wish_tests;
