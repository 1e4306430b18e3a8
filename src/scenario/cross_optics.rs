//! Combinations of the gyro's keys that make no physical sense.

use crate::gyro::{GyroConfig, ModulationScheme};

/// Key and complaint of every contradiction in a gyro.
pub(super) fn contradictions(gyro: &GyroConfig) -> Vec<(&'static str, String)> {
    let mut found = Vec::new();
    let modulator = &gyro.modulator;
    let is_two_state = modulator.scheme == ModulationScheme::TwoState;
    if !gyro.detector.gate_spikes {
        if !is_two_state {
            found.push((
                "gyro.detector.gate_spikes",
                "gyro.detector.gate_spikes = false averages the spikes of a square wave: set \
                 gyro.modulator.scheme = \"two-state\", between other states the spikes differ"
                    .to_string(),
            ));
        }
        if gyro.detector.gate_duty < 1.0 {
            found.push((
                "gyro.detector.gate_spikes",
                format!(
                    "gyro.detector.gate_spikes = false averages the whole half period, but \
                     gyro.detector.gate_duty = {:?} leaves a part of it out: set gate_duty = 1",
                    gyro.detector.gate_duty
                ),
            ));
        }
    }
    if modulator.intensity_modulation != 0.0 && !is_two_state {
        found.push((
            "gyro.modulator.intensity_modulation",
            "gyro.modulator.intensity_modulation goes with the two states of a square wave: set \
             gyro.modulator.scheme = \"two-state\""
                .to_string(),
        ));
    }
    let samples = gyro.adc.samples_per_half_period;
    if modulator.scheme == ModulationScheme::FourStateHalf && !samples.is_multiple_of(2) {
        found.push((
            "gyro.adc.samples_per_half_period",
            format!(
                "gyro.adc.samples_per_half_period = {samples} is odd, but \
                 gyro.modulator.scheme = \"four-state-half\" has two states in a half period"
            ),
        ));
    }
    found
}
