//! Relative intensity noise of the light source: `RIN I^2`.

use crate::gyro::noise::law::{Density, NoiseLaw};
use crate::gyro::optics::source::relative_intensity_noise_per_hz;

pub(super) const RIN: NoiseLaw = NoiseLaw {
    name: "rin",
    density: |amount, point| Density::Intensity {
        per_hz: amount * relative_intensity_noise_per_hz(point.source),
    },
};
