//! Technical phase noise: whatever else jitters the demodulated phase (modulator, ramp, clock).

use crate::gyro::noise::source::{Density, NoiseSource};
use crate::units::MICRO;

pub(super) const TECHNICAL: NoiseSource = NoiseSource {
    name: "technical",
    key: "gyro.noise.technical_phase_urad_per_sqrt_hz",
    density: |config, _| Density::Phase {
        rad2_per_hz: (config.noise.technical_phase_urad_per_sqrt_hz * MICRO).powi(2),
    },
};
