//! Variants of the reference gyro and readings of its facts.

use fogbench::gyro::{NOISE_SOURCES, NoiseSource};
use fogbench::scenario::{GyroConfig, reference_toml};

use super::reference_gyro::{gyro, undisturbed};

/// Setting that switches a noise source off: `false`, or 0 for a source that has a size.
pub(crate) fn off(source: &NoiseSource) -> String {
    set(source, "false", "0")
}

/// Setting that switches a noise source on: `true`, or a size that shows.
pub(crate) fn on(source: &NoiseSource) -> String {
    set(source, "true", "2")
}

fn set(source: &NoiseSource, switch: &str, size: &str) -> String {
    let reference: toml::Table = reference_toml().parse().expect("the reference is TOML");
    let mut names = source.key.split('.');
    let root = names.next().and_then(|name| reference.get(name));
    let default = names.fold(root, |table, name| table.and_then(|table| table.get(name)));
    let value = match default.expect("a noise source has a key of the reference") {
        toml::Value::Boolean(_) => switch,
        _ => size,
    };
    let name = source.key.strip_prefix("gyro.").expect("a key of the gyro");
    format!("{name} = {value}")
}

/// The reference gyro with every noise off and ideal converters.
pub(crate) fn silent_gyro() -> GyroConfig {
    let mut settings: Vec<String> = NOISE_SOURCES.iter().map(off).collect();
    settings.push("modulator.dac_bits = 0".to_owned());
    undisturbed(gyro(&settings))
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
