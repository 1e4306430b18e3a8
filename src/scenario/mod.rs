//! Scenario files: TOML in, checked immutable configuration out.
//!
//! Invariant: pure data. No state, no hidden default: `scenarios/reference.toml` is embedded and is
//! the only source of defaults; a value that reaches a stage has been checked for type, range and
//! contradiction, and every complaint points at the file, line and key that is wrong.

mod config;

pub use config::{
    AdcConfig, CoilConfig, ControllerConfig, DesiredSignal, DetectorConfig, Fidelity, FilterConfig,
    FilterKind, GateConfig, GateDecision, GyroConfig, InconclusivePolicy, LmsFilterConfig,
    ModulatorConfig, MotionConfig, NoiseConfig, NoiseDraw, OutputConfig, OutputRegister, Pipeline,
    PublishedConfig, RateOutputConfig, RlsFilterConfig, RotationConfig, SamplesFormat, Scenario,
    SecondOrderServoConfig, ServoConfig, SiteConfig, SlowNoiseConfig, SoakConfig, SourceConfig,
    StaticConfig, StepsConfig, SwingConfig, TemperatureConfig, TurntableConfig, UpdateSign,
};
