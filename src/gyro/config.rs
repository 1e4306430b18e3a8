//! Settings of the gyro as a whole.

use crate::declare::table;
use crate::gyro::controller::ControllerConfig;
use crate::gyro::injection::InjectionConfig;
use crate::gyro::input_axis::AssemblyConfig;
use crate::gyro::noise::NoiseConfig;
use crate::gyro::noise::slow_noise::SlowNoiseConfig;
use crate::gyro::optics::coil::CoilConfig;
use crate::gyro::optics::converter::AdcConfig;
use crate::gyro::optics::modulator::ModulatorConfig;
use crate::gyro::optics::receiver::DetectorConfig;
use crate::gyro::optics::source::SourceConfig;
use crate::gyro::rate_word::RateOutputConfig;
use crate::gyro::thermal::chamber::TemperatureConfig;
use crate::gyro::thermal::settings::ThermalConfig;
use crate::gyro::vibration::settings::VibrationConfig;
use crate::vocabulary::words;

table! {
    /// Gyro. Unless said otherwise the defaults are the assumed budget that gives a total angle random
    /// walk of 0.0060 deg/sqrt(h).
    pub struct GyroConfig {
        coil: CoilConfig;
        source: SourceConfig, told in Budget;
        modulator: ModulatorConfig;
        detector: DetectorConfig, told in Budget;
        adc: AdcConfig, told in Budget;
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
