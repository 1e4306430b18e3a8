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
mod filter_config;
mod gyro_config;
mod json_schema;
mod keys;
mod leaf;
mod manifest;
mod matrix;
mod resolved;
mod schema;
mod source;
mod suite;
mod tree;
mod turntable_config;

pub use config::{
    Fidelity, GateConfig, GateDecision, InconclusivePolicy, OutputConfig, PublishedConfig,
    SamplesFormat, Scenario,
};
pub use defaults::reference_toml;
pub(crate) use error::portable_place;
pub use error::{Location, ScenarioError};
pub use filter_config::{
    ButterworthFilterConfig, ConstrainedRlsFilterConfig, DesiredSignal, Division, FilterConfig,
    FilterKind, KalmanFilterConfig, LmsFilterConfig, MovingAverageFilterConfig, NumberFormat,
    OnePoleFilterConfig, OutputRegister, Pipeline, RlsFilterConfig, SavitzkyGolayFilterConfig,
    UpdateOrder, UpdateSign,
};
pub use gyro_config::{
    AdcConfig, CoilConfig, ControllerConfig, DetectorConfig, GyroConfig, ModulatorConfig,
    NoiseConfig, NoiseDraw, RateOutputConfig, SlowNoiseConfig, SoakConfig, SourceConfig,
    TemperatureConfig,
};
pub use json_schema::json_schema;
pub use manifest::manifest_toml;
pub use resolved::{InputFile, Resolved, SweepPoint};
pub use suite::load_suite;
pub use turntable_config::{
    MotionConfig, RotationConfig, SecondOrderServoConfig, ServoConfig, SiteConfig, StaticConfig,
    StepsConfig, SwingConfig, TurntableConfig,
};

#[cfg(test)]
mod tests;
