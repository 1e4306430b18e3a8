//! Noise of the gyro: the sources at the detector, and the slow noise of the rate.
//!
//! Each detector noise source is one file, which says where the source enters and with what
//! density ([`NoiseSource`]); [`SOURCES`] is the list of them. The densities of a configuration are a
//! [`Densities`]; the budget and its total, the best modulation depth and both samplers of the loop
//! model read that, and nothing else knows the sources one by one.

mod adc;
mod amplifier;
mod rin;
mod shot;
mod technical;
mod thermal;

pub(in crate::gyro) mod budget;
pub(in crate::gyro) mod budget_sheet;
pub(in crate::gyro) mod exact_draw;
pub(in crate::gyro) mod slow_noise;
pub(in crate::gyro) mod source;

pub use rin::relative_intensity_noise_per_hz;
pub use source::{Density, NoiseSource};

use crate::gyro::GyroConfig;
use crate::gyro::thermal::condition::Condition;

/// Detector noise sources, in the order of the budget.
///
/// The order is part of the results: densities and squares are summed in it.
pub const SOURCES: [NoiseSource; 6] = [
    shot::SHOT,
    thermal::THERMAL,
    amplifier::AMPLIFIER,
    rin::RIN,
    adc::ADC,
    technical::TECHNICAL,
];

/// Density of every source of [`SOURCES`], in its order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Densities(pub(in crate::gyro) [Density; SOURCES.len()]);

impl Densities {
    /// The densities of a configuration in a condition.
    pub(in crate::gyro) fn new(config: &GyroConfig, condition: &Condition) -> Self {
        Self(SOURCES.map(|source| (source.density)(config, condition)))
    }

    /// Sum of the current densities, A^2/Hz, at a photocurrent.
    #[must_use]
    pub fn a2_per_hz(&self, photocurrent_a: f64, dark_current_a: f64) -> f64 {
        let densities = self.0.iter();
        densities
            .map(|density| density.a2_per_hz(photocurrent_a, dark_current_a))
            .sum()
    }

    /// Sum of the phase densities, rad^2/Hz.
    #[must_use]
    pub fn phase_rad2_per_hz(&self) -> f64 {
        let densities = self.0.iter();
        densities
            .map(|density| match *density {
                Density::Phase { rad2_per_hz } => rad2_per_hz,
                _ => 0.0,
            })
            .sum()
    }
}
