//! Rounding in the analogue-to-digital converter.
//!
//! Not drawn: the loop model rounds, and its budget counts what rounding amounts to.

use crate::gyro::noise::law::{Density, NoiseLaw};
use crate::gyro::optics::converter::converter_step_v;

pub(super) const ADC: NoiseLaw = NoiseLaw {
    name: "adc",
    density: |_, point| Density::Rounding {
        step_v: converter_step_v(point.adc),
    },
};
