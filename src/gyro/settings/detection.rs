//! Settings of photodetector, amplifier, gate and converter.

use crate::declare::table;

table! {
    /// Photodetector, transimpedance amplifier and gate.
    pub struct DetectorConfig {
        /// Responsivity. Source of the default: assumed, InGaAs at 1310 nm.
        responsivity_a_per_w: f64 = 0.9, in 1e-3..=2.0, "A/W";
        /// Dark current. Source of the default: assumed negligible.
        dark_current_na: f64 = 0.0, in 0.0..=1e6, "nA";
        /// Transimpedance. Source of the default: assumed.
        transimpedance_kohm: f64 = 20.0, in 1e-3..=1e6, "kOhm";
        /// Voltage gain after the transimpedance stage. Source of the default: assumed.
        post_gain: f64 = 10.0, in 1e-3..=1e6;
        /// Amplifier voltage noise. Source of the default: assumed.
        voltage_noise_nv_per_sqrt_hz: f64 = 6.0, in 0.0..=1e6, "nV/sqrt(Hz)";
        /// Amplifier current noise. Source of the default: assumed negligible.
        current_noise_pa_per_sqrt_hz: f64 = 0.0, in 0.0..=1e6, "pA/sqrt(Hz)";
        /// Fraction of each half period that is gated into the demodulator. Source of the default: assumed.
        gate_duty: f64 = 0.7, in 1e-3..=1.0;
        /// Whether the gate leaves out the spikes that a mismatched half period makes. Source of the default:
        /// assumed. false averages the whole half period and needs gate_duty = 1.
        gate_spikes: bool = true;
    }
}

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
