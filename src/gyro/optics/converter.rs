//! Analogue-to-digital converter: codes and step.

use crate::gyro::AdcConfig;

/// Step of a converter, V; 0 for an ideal one.
pub(in crate::gyro) fn converter_step_v(config: &AdcConfig) -> f64 {
    match config.bits {
        0 => 0.0,
        bits => config.range_v / codes(bits),
    }
}

/// Largest code of a converter; infinite for an ideal one.
pub(in crate::gyro) fn converter_code_max(config: &AdcConfig) -> f64 {
    match config.bits {
        0 => f64::INFINITY,
        bits => codes(bits) - 1.0,
    }
}

/// Codes of a converter.
fn codes(bits: u32) -> f64 {
    2.0_f64.powi(bits.cast_signed())
}
