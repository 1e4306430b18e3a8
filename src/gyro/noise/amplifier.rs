//! Voltage and current noise of the amplifier: `(e_n / R_f)^2 + i_n^2`.

use crate::gyro::noise::law::{Density, NoiseLaw};
use crate::units::{NANO, PICO};

pub(super) const AMPLIFIER: NoiseLaw = NoiseLaw {
    name: "amplifier",
    density: |amount, point| {
        let detector = point.detector;
        let voltage = detector.voltage_noise_nv_per_sqrt_hz * NANO / detector.feedback_ohm();
        let current = detector.current_noise_pa_per_sqrt_hz * PICO;
        Density::Current {
            a2_per_hz: amount * (voltage * voltage + current * current),
        }
    },
};
