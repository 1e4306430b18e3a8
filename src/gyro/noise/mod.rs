//! Noise of the gyro: the sources at the detector, and the slow noise of the rate.
//!
//! Each detector noise source is one file, which says where it enters and with what density
//! ([`NoiseLaw`]); its key stands in [`NoiseConfig`] and its row in [`SOURCES`] here. The budget and its total, the
//! best modulation depth and both samplers of the loop model read the [`Densities`] of that list, and
//! nothing else knows the sources one by one.

mod adc;
mod amplifier;
mod gauss_markov;
mod rin;
mod shot;
mod technical;
mod thermal;

pub(in crate::gyro) mod budget;
pub(in crate::gyro) mod budget_sheet;
pub(in crate::gyro) mod exact_draw;
pub(in crate::gyro) mod law;
pub(in crate::gyro) mod slow_noise;

pub use law::Density;

use law::{NoiseLaw, WorkingPoint};

use crate::declare::table;
use crate::vocabulary::words;

table! {
    /// Fast noise sources.
    pub struct NoiseConfig {
        /// Shot noise of the photocurrent.
        shot: bool = true;
        /// Thermal (Johnson) noise of the transimpedance.
        thermal: bool = true;
        /// Amplifier voltage and current noise.
        amplifier: bool = true;
        /// Relative intensity noise of the source.
        rin: bool = true;
        /// Technical phase noise, one-sided: whatever else jitters the demodulated phase (modulator, ramp,
        /// clock). White up to half the half-period rate, so that the gate does not alter it; phase noise
        /// that is white far beyond the gate's band counts 1 / sqrt(gate_duty) of its density. Source of the
        /// default: none.
        technical_phase_urad_per_sqrt_hz: f64 = 0.0, in 0.0..=1e6, "urad/sqrt(Hz)";
        /// One normal per half period with the variance of all sources, or every source and every sample of
        /// the converter drawn on its own.
        draw: NoiseDraw = "combined";
    }
}

words! {
    /// How fast noise is drawn in the loop model.
    pub enum NoiseDraw {
        /// One normal per half period with the variance of all sources.
        Combined = "combined",
        /// Every source and every ADC sample drawn on its own.
        Exact = "exact",
    }
}

/// Detector noise sources, in the order of the budget.
///
/// The order is part of the results: densities and squares are summed in it.
pub const SOURCES: [NoiseSource; 6] = [
    source("gyro.noise.shot", |noise| on(noise.shot), shot::SHOT),
    source(
        "gyro.noise.thermal",
        |noise| on(noise.thermal),
        thermal::THERMAL,
    ),
    source(
        "gyro.noise.amplifier",
        |noise| on(noise.amplifier),
        amplifier::AMPLIFIER,
    ),
    source("gyro.noise.rin", |noise| on(noise.rin), rin::RIN),
    source("gyro.adc.bits", |_| 1.0, adc::ADC),
    source(
        "gyro.noise.technical_phase_urad_per_sqrt_hz",
        |noise| noise.technical_phase_urad_per_sqrt_hz,
        technical::TECHNICAL,
    ),
];

/// A detector noise source: its key, and what it does.
#[derive(Clone, Copy, Debug)]
pub struct NoiseSource {
    /// Scenario key that switches it off, by `false` or 0.
    pub key: &'static str,
    /// Amount of it that the settings ask for.
    amount: fn(&NoiseConfig) -> f64,
    law: NoiseLaw,
}

impl NoiseSource {
    /// Name in budgets, and of the stream it is drawn from on its own.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        self.law.name
    }
}

const fn source(key: &'static str, amount: fn(&NoiseConfig) -> f64, law: NoiseLaw) -> NoiseSource {
    NoiseSource { key, amount, law }
}

/// Amount of a source that is switched: all of it or nothing.
fn on(is_on: bool) -> f64 {
    f64::from(u8::from(is_on))
}

/// Density of every source of [`SOURCES`], in its order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Densities(pub(in crate::gyro) [Density; SOURCES.len()]);

impl Densities {
    /// The densities of a configuration at a working point.
    pub(in crate::gyro) fn new(config: &NoiseConfig, point: &WorkingPoint) -> Self {
        Self(SOURCES.map(|source| (source.law.density)((source.amount)(config), point)))
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
