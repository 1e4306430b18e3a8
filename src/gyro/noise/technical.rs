//! Technical phase noise: whatever else jitters the demodulated phase (modulator, ramp, clock).

use crate::gyro::noise::law::{Density, NoiseLaw};
use crate::units::MICRO;

pub(super) const TECHNICAL: NoiseLaw = NoiseLaw {
    name: "technical",
    density: |urad_per_sqrt_hz, _| Density::Phase {
        rad2_per_hz: (urad_per_sqrt_hz * MICRO).powi(2),
    },
};
