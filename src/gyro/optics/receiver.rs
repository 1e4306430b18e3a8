//! Settings of photodetector and transimpedance amplifier, in SI units.

use crate::declare::table;
use crate::units::{KILO, NANO};

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

impl DetectorConfig {
    /// Feedback resistance of the transimpedance, ohm.
    pub(in crate::gyro) fn feedback_ohm(&self) -> f64 {
        self.transimpedance_kohm * KILO
    }

    /// Converter volts per ampere of photocurrent, `G = R_f G_v`.
    pub(in crate::gyro) fn transimpedance_v_per_a(&self) -> f64 {
        self.transimpedance_kohm * KILO * self.post_gain
    }

    /// Dark current, A.
    pub(in crate::gyro) fn dark_current_a(&self) -> f64 {
        self.dark_current_na * NANO
    }
}
