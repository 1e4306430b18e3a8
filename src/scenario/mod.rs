//! Scenario files: TOML in, checked immutable configuration out.
//!
//! Invariant: pure data. No state, no hidden default: `scenarios/reference.toml` is embedded and is
//! the only source of defaults; a value that reaches a stage has been checked for type, range and
//! contradiction, and every complaint points at the file, line and key that is wrong.

mod address;
mod assembly_config;
mod calibration_config;
mod chain;
mod channels;
mod check;
mod clashes;
mod comparison_config;
mod compensation_config;
mod compensation_source;
mod complaints;
mod config;
mod cross;
mod cross_calibration;
mod cross_comparison;
mod cross_compensation;
mod cross_gyro;
mod cross_multi_sine;
mod cross_optics;
mod cross_servo;
mod cross_turntable;
mod cross_vibration;
mod defaults;
mod deserialize;
mod discover;
mod draft;
mod emit;
mod error;
mod excerpt;
mod faults;
mod gyro_config;
mod inert;
mod inert_rules;
mod injection_config;
mod input;
mod json_schema;
mod keys;
mod leaf;
mod manifest;
mod matrix;
mod numbers;
mod presence;
mod resolved;
mod schema;
mod script;
mod servo_config;
mod setting;
mod source;
mod stairs;
mod stand_in;
mod suggest;
mod suite;
mod synonyms;
mod template;
mod thermal_config;
mod tree;
mod turntable_config;
mod unresolved;
mod vibration_config;
mod weight;

pub use assembly_config::AssemblyConfig;
pub use calibration_config::{CalibrationConfig, CampaignConfig, CampaignGroup};
pub use comparison_config::{
    AssumptionConfig, ComparisonColumn, ComparisonConfig, ComparisonKind, ComparisonRowConfig,
    FigureConfig,
};
pub use compensation_config::{CompensationConfig, CompensationParameters};
pub use compensation_source::load_calibration;
pub use complaints::ScenarioErrors;
pub use config::{
    AllanConfig, AllanEstimatorConfig, Fidelity, FilterState, GateConfig, GateDecision,
    InconclusivePolicy, OutputConfig, PublishedConfig, SamplesFormat, Scenario,
};
pub(crate) use cross_comparison::slug;
pub use defaults::{reference_calibration, reference_toml};
pub(crate) use draft::UnsoundReading;
pub use error::{Location, ScenarioError};
pub(crate) use error::{in_both, in_order, portable_place};
pub use excerpt::{bounded, excerpt};
pub use gyro_config::{
    AdcConfig, CoilConfig, ControllerConfig, DetectorConfig, GyroConfig, ModulationScheme,
    ModulatorConfig, NoiseConfig, NoiseDraw, OutputQuantisation, RateOutputConfig, ResetSample,
    SlowNoiseConfig, SourceConfig,
};
pub use injection_config::InjectionConfig;
pub use json_schema::json_schema;
pub use manifest::manifest_toml;
pub use resolved::{InputFile, Resolved, SweepPoint};
pub use servo_config::{DirectDriveServoConfig, EncoderConfig};
pub use setting::Setting;
pub use stairs::{Stairs, TEST_RATES_MIN};
pub(crate) use suite::{Reading, read_suite};
pub use suite::{load_base_or_scenario, load_suite, visit_suite};
pub use thermal_config::{
    ConstantPowerConfig, ExponentialPowerConfig, PowerConfig, QuadraticPowerConfig, SoakConfig,
    TemperatureConfig, TemperatureProfileConfig, TemperatureRampConfig, ThermalConfig,
    ThermalWarmUp, Winding,
};
pub use turntable_config::{
    AxisConfig, CaseAxis, ChirpConfig, MotionConfig, MountingConfig, MultiSineConfig, PhaseRule,
    PreferredSeries, Progression, RotationConfig, ScaleFactorTestConfig, ScriptConfig,
    ScriptPoints, SecondOrderServoConfig, ServoConfig, SiteConfig, StaticConfig, StepsConfig,
    SwingConfig, TrapezoidConfig, TurntableConfig,
};
pub(crate) use unresolved::Unresolved;
pub use vibration_config::{
    RandomVibrationConfig, SineVibrationConfig, VibrationConfig, VibrationMotion,
};

#[cfg(test)]
mod inert_tests;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod wish_tests;
