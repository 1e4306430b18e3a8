//! Closed-loop fibre-optic gyro, from the optics to the rate word.
//!
//! Invariant: the optical feedback loop closes inside this folder and nowhere else.
//!
//! ```text
//! motion segment -> Sagnac phase (coil) --(+)--> raised cosine (detector, source, modulator)
//!                                          |-       |  + noise, converter
//!        2 pi ramp, converter (modulator) -+        v
//!                 ^------------ integrator <- demodulation (controller)
//!                                   |
//!                                   v  mean over an output sample, rounding (rate word)
//! ```
//!
//! Two models share every part above: [`LoopModel`] runs each half modulation period;
//! [`RateModel`] advances the same loop, linearised, by one output sample at a time with the same
//! mean, bandwidth, delay and noise colour. [`Gyro`] is either of them; [`cautions`] says where
//! their assumptions end. [`CaseGyro`] is one of three gyros in a case, behind its own input axis.
//! The loop model has two kernels: a plain one, and a full one with the second-order effects of
//! modulator and ramp, which runs only when one of them is on.
//!
//! Temperature (`thermal`) sets the [`Condition`] both models work in: detected power, scale factor,
//! bias. Where it never changes it is settled when the gyro is built and costs nothing after.
//!
//! Vibration of the case reaches the loop as phases and as powers per state of the bias wave.
//!
//! Symbols: `tau` = transit time of the coil = half modulation period, `T_L = 2 tau` = loop
//! period, `Ks` = Sagnac scale factor, `g` = integrator gain, `d` = pipeline latency in loop
//! periods, `r` = step of the ramp per `tau` (the register), `phi_m` = modulation depth.

mod assembly;
mod config;
mod controller;
mod error;
mod injection;
mod input_axis;
mod instrument;
mod limits;
mod loop_model;
mod noise;
mod optics;
mod parts;
mod rate_model;
mod rate_word;
mod thermal;
mod vibration;

pub use assembly::CaseGyro;
pub use config::{Fidelity, GyroConfig};
pub use controller::{Controller, ControllerConfig, gain_limit};
pub use error::GyroError;
pub use injection::InjectionConfig;
pub use input_axis::{AssemblyConfig, InputAxis};
pub use instrument::{
    Gyro, WordNoise, facts, sample_period_s, word_noise, word_period_s, word_response,
};
pub use limits::{MotionExtremes, cautions};
pub use loop_model::LoopModel;
pub use loop_model::faults::LoopFaults;
pub use noise::budget::NoiseBudget;
pub use noise::budget_sheet::{budget_at, budget_sheet, power_independent_ratio};
pub use noise::slow_noise::{SlowNoise, SlowNoiseConfig, slow_drift};
pub use noise::{
    Densities, Density, NoiseConfig, NoiseDraw, NoiseSource, SOURCES as NOISE_SOURCES,
};
pub use optics::coil::{Coil, CoilConfig};
pub use optics::converter::AdcConfig;
pub use optics::detector::Detector;
pub use optics::modulator::{
    ModulationScheme, Modulator, ModulatorConfig, ResetSample, optimum_depth_rad,
};
pub use optics::receiver::DetectorConfig;
pub use optics::second_order::{expected_mean_rate_rad_per_s, spike_share};
pub use optics::source::{SourceConfig, relative_intensity_noise_per_hz};
pub use rate_model::RateModel;
pub use rate_word::{OutputQuantisation, RateOutputConfig};
pub use thermal::chamber::{
    SoakConfig, TemperatureConfig, TemperatureProfileConfig, TemperatureRampConfig,
};
pub use thermal::condition::{CoilThermometer, Condition, coil_temperatures_c, temperature_record};
pub use thermal::power::{
    ConstantPowerConfig, ExponentialPowerConfig, PowerConfig, QuadraticPowerConfig,
};
pub use thermal::settings::{ThermalConfig, ThermalWarmUp, Winding};
pub use thermal::{Chamber, Network, NetworkState, Propagator, Shupe, layer_integral, layer_order};
pub use vibration::settings::{
    NoVibrationConfig, RandomVibrationConfig, SineVibrationConfig, VibrationConfig, VibrationMotion,
};
