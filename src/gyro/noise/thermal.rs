//! Thermal (Johnson) noise of the transimpedance: `4 k T / R_f`.

use crate::gyro::noise::source::{Density, NoiseSource, when};
use crate::units::{BOLTZMANN_J_PER_K, KILO, celsius_to_kelvin};

pub(super) const THERMAL: NoiseSource = NoiseSource {
    name: "thermal",
    key: "gyro.noise.thermal",
    density: |config, condition| {
        let kelvin = celsius_to_kelvin(condition.case_c);
        let feedback_ohm = config.detector.transimpedance_kohm * KILO;
        Density::Current {
            a2_per_hz: when(
                config.noise.thermal,
                4.0 * BOLTZMANN_J_PER_K * kelvin / feedback_ohm,
            ),
        }
    },
};
