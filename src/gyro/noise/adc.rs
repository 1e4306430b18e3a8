//! Rounding in the analogue-to-digital converter.
//!
//! Not drawn: the loop model rounds, and its budget counts what rounding amounts to.

use crate::gyro::noise::source::{Density, NoiseSource};
use crate::gyro::optics::converter::converter_step_v;

pub(super) const ADC: NoiseSource = NoiseSource {
    name: "adc",
    key: "gyro.adc.bits",
    density: |config, _| Density::Rounding {
        step_v: converter_step_v(&config.adc),
    },
};
