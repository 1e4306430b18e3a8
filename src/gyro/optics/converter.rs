//! Analogue-to-digital converter: codes and step.

use crate::declare::table;

table! {
    /// Analogue-to-digital converter.
    pub struct AdcConfig {
        /// Bits; 0 is ideal, without quantisation or saturation. Source of the default: assumed.
        bits: u32 = 12, in 0..=32;
        /// Range: the codes cover 0 to this. Source of the default: assumed.
        range_v: f64 = 2.0, in 1e-3..=1000.0, "V";
        /// Samples averaged per half period. Source of the default: assumed.
        samples_per_half_period: u32 = 8, in 1..=1024;
    }
}

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
