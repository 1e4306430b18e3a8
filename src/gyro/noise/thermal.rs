//! Thermal (Johnson) noise of the transimpedance: `4 k T / R_f`.

use crate::gyro::noise::law::{Density, NoiseLaw};
use crate::units::{BOLTZMANN_J_PER_K, celsius_to_kelvin};

pub(super) const THERMAL: NoiseLaw = NoiseLaw {
    name: "thermal",
    density: |amount, point| {
        let kelvin = celsius_to_kelvin(point.case_c);
        let density = 4.0 * BOLTZMANN_J_PER_K * kelvin / point.detector.feedback_ohm();
        Density::Current {
            a2_per_hz: amount * density,
        }
    },
};
