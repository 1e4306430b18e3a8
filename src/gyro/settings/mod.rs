//! Settings of the gyro: the tables of keys below `gyro`, each part beside the others.
//!
//! Invariant: declarations only; nothing here computes.

mod assembly;
mod controller;
mod detection;
mod injection;
mod modulator;
mod noise;
mod optics;
mod output;
mod power;
mod temperature;
mod thermal;
mod vibration;

pub use assembly::AssemblyConfig;
pub use controller::ControllerConfig;
pub use detection::{AdcConfig, DetectorConfig};
pub use injection::InjectionConfig;
pub use modulator::{ModulationScheme, ModulatorConfig, ResetSample};
pub use noise::{NoiseConfig, NoiseDraw, SlowNoiseConfig};
pub use optics::{CoilConfig, SourceConfig};
pub use output::{OutputQuantisation, RateOutputConfig};
pub use power::{ConstantPowerConfig, ExponentialPowerConfig, PowerConfig, QuadraticPowerConfig};
pub use temperature::{
    SoakConfig, TemperatureConfig, TemperatureProfileConfig, TemperatureRampConfig,
};
pub use thermal::{ThermalConfig, ThermalWarmUp, Winding};
pub use vibration::{
    NoVibrationConfig, RandomVibrationConfig, SineVibrationConfig, VibrationConfig, VibrationMotion,
};

use crate::declare::table;
use crate::vocabulary::words;

table! {
    /// Gyro. Unless said otherwise the defaults are the assumed budget that gives a total angle random
    /// walk of 0.0060 deg/sqrt(h).
    pub struct GyroConfig {
        coil: CoilConfig;
        source: SourceConfig;
        modulator: ModulatorConfig;
        detector: DetectorConfig;
        adc: AdcConfig;
        controller: ControllerConfig;
        noise: NoiseConfig;
        slow_noise: SlowNoiseConfig;
        vibration: VibrationConfig;
        injection: Option<InjectionConfig>;
        output: RateOutputConfig;
        assembly: Option<AssemblyConfig>;
        temperature: TemperatureConfig;
        thermal: ThermalConfig;
    }
}

words! {
    /// Which gyro model runs.
    pub enum Fidelity {
        /// Every half modulation period.
        Loop = "loop",
        /// Output-rate equivalent.
        Rate = "rate",
    }
}
