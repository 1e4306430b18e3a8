//! Voltage and current noise of the amplifier: `(e_n / R_f)^2 + i_n^2`.

use crate::gyro::noise::source::{Density, NoiseSource, when};
use crate::units::{KILO, NANO, PICO};

pub(super) const AMPLIFIER: NoiseSource = NoiseSource {
    name: "amplifier",
    key: "gyro.noise.amplifier",
    density: |config, _| {
        let feedback_ohm = config.detector.transimpedance_kohm * KILO;
        let voltage = config.detector.voltage_noise_nv_per_sqrt_hz * NANO / feedback_ohm;
        let current = config.detector.current_noise_pa_per_sqrt_hz * PICO;
        Density::Current {
            a2_per_hz: when(
                config.noise.amplifier,
                voltage * voltage + current * current,
            ),
        }
    },
};
