//! Scenario files: TOML in, checked immutable configuration out.
//!
//! Invariant: pure data. No state, no hidden default: `scenarios/reference.toml` is embedded and is
//! the only source of defaults; a value that reaches a stage has been checked for type, range and
//! contradiction, and every complaint points at the file, line and key that is wrong.

mod address;
mod check;
mod config;
mod cross;
mod defaults;
mod emit;
mod error;
mod json_schema;
mod keys;
mod manifest;
mod matrix;
mod resolved;
mod schema;
mod source;
mod suite;
mod tree;

pub use config::{
    AdcConfig, CoilConfig, ControllerConfig, DesiredSignal, DetectorConfig, Fidelity, FilterConfig,
    FilterKind, GateConfig, GateDecision, GyroConfig, InconclusivePolicy, LmsFilterConfig,
    ModulatorConfig, MotionConfig, NoiseConfig, NoiseDraw, OutputConfig, OutputRegister, Pipeline,
    PublishedConfig, RateOutputConfig, RlsFilterConfig, RotationConfig, SamplesFormat, Scenario,
    SecondOrderServoConfig, ServoConfig, SiteConfig, SlowNoiseConfig, SoakConfig, SourceConfig,
    StaticConfig, StepsConfig, SwingConfig, TemperatureConfig, TurntableConfig, UpdateSign,
};
pub use defaults::reference_toml;
pub use error::{Location, ScenarioError};
pub use json_schema::json_schema;
pub use manifest::manifest_toml;
pub use resolved::{InputFile, Resolved, SweepPoint};
pub use suite::load_suite;

#[cfg(test)]
mod tests;
