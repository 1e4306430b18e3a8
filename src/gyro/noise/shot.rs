//! Shot noise of the photocurrent, dark current included: `2 e I`.

use crate::gyro::noise::law::{Density, NoiseLaw};
use crate::units::ELEMENTARY_CHARGE_C;

pub(super) const SHOT: NoiseLaw = NoiseLaw {
    name: "shot",
    density: |amount, _| Density::OfCurrent {
        a2_per_hz_per_a: amount * (2.0 * ELEMENTARY_CHARGE_C),
    },
};
