//! Shot noise of the photocurrent, dark current included: `2 e I`.

use crate::gyro::noise::source::{Density, NoiseSource, when};
use crate::units::ELEMENTARY_CHARGE_C;

pub(super) const SHOT: NoiseSource = NoiseSource {
    name: "shot",
    key: "gyro.noise.shot",
    density: |config, _| Density::OfCurrent {
        a2_per_hz_per_a: when(config.noise.shot, 2.0 * ELEMENTARY_CHARGE_C),
    },
};
