//! Variants of the reference gyro and readings of its facts.

use fogbench::scenario::{GyroConfig, NoiseConfig, NoiseDraw};

use super::reference_gyro::reference_gyro;

/// The reference gyro with every noise off and ideal converters.
pub(crate) fn silent_gyro() -> GyroConfig {
    let mut config = reference_gyro();
    config.noise = NoiseConfig {
        shot: false,
        thermal: false,
        amplifier: false,
        rin: false,
        technical_phase_urad_per_sqrt_hz: 0.0,
        draw: NoiseDraw::Combined,
    };
    config.adc.bits = 0;
    config.modulator.dac_bits = 0;
    config
}

/// One entry of the budget, deg/sqrt(h).
pub(crate) fn budget_of(config: &GyroConfig, source: &str) -> f64 {
    let facts = fogbench::gyro::facts(config).expect("the gyro is sound");
    let mut budget = facts.angle_random_walk_budget_deg_per_sqrt_h.iter();
    budget
        .find(|(name, _)| *name == source)
        .expect("a source of the budget")
        .1
}

/// Overlapping Allan deviation at an averaging factor (written apart from the library; NIST SP 1065, eq. 11, as angles).
pub(crate) fn allan_deviation(rates: &[f64], factor: usize) -> f64 {
    let mut angles = vec![0.0];
    let mut sum = 0.0;
    for rate in rates {
        sum += rate;
        angles.push(sum);
    }
    let terms = angles.len() - 2 * factor;
    let squares: f64 = (0..terms)
        .map(|k| (angles[k + 2 * factor] - 2.0 * angles[k + factor] + angles[k]).powi(2))
        .sum();
    (squares / (2.0 * (factor * factor * terms) as f64)).sqrt()
}
