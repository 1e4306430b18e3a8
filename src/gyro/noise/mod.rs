//! Noise of the gyro: the sources at the detector, and the slow noise of the rate.
//!
//! Each detector noise source is one file, which says where it enters and with what density
//! ([`NoiseLaw`]); its key stands in [`NoiseConfig`] and its row in [`SOURCES`] here. The budget and its total, the
//! best modulation depth and both samplers of the loop model read the [`Densities`] of that list, and
//! nothing else knows the sources one by one. A walk that a data sheet states stands in the place of all
//! of them ([`equivalent`]).

mod adc;
mod amplifier;
mod gauss_markov;
mod rin;
mod shot;
mod technical;
mod thermal;
mod word_rounding;

pub(in crate::gyro) mod budget;
pub(in crate::gyro) mod budget_sheet;
pub(in crate::gyro) mod equivalent;
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
        /// Angle random walk of the gyro, as a data sheet states it. One white source then stands in the place
        /// of all others of this table, at every power, depth and temperature, as great as makes this the walk
        /// of the unfiltered output: what converter and rate words add by rounding is part of it. Bias
        /// instability and the rest of gyro.slow_noise stay as they are.
        angle_random_walk_deg_per_sqrt_h: Option<f64>, example 0.006, in 1e-8..=1e4, "deg/sqrt(h)";
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

/// How many sources are budgeted and drawn: those of [`SOURCES`], and the equivalent one.
pub(in crate::gyro) const COUNT: usize = SOURCES.len() + 1;

/// Place of the equivalent source: behind the others.
pub(in crate::gyro) const EQUIVALENT: usize = SOURCES.len();

/// Name of a source by its place.
pub(in crate::gyro) fn name_of(index: usize) -> &'static str {
    SOURCES
        .get(index)
        .map_or(equivalent::NAME, NoiseSource::name)
}

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

/// Density of every source of [`SOURCES`], in its order, then that of the equivalent one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Densities(pub(in crate::gyro) [Density; COUNT]);

impl Densities {
    /// The densities of a configuration at a working point.
    pub(in crate::gyro) fn new(config: &NoiseConfig, point: &WorkingPoint) -> Self {
        let is_replaced = point.equivalent_a2_per_hz > 0.0;
        Self(std::array::from_fn(|index| match SOURCES.get(index) {
            // Rounding is no amount of anything, and stays.
            Some(source) if is_replaced => (source.law.density)(0.0, point),
            Some(source) => (source.law.density)((source.amount)(config), point),
            None => Density::Current {
                a2_per_hz: point.equivalent_a2_per_hz,
            },
        }))
    }

    /// Whether a source has a line in the budget: the equivalent one, where it is on, in the place of
    /// those that it replaces.
    pub(in crate::gyro) fn is_listed(&self, index: usize) -> bool {
        let is_on = self.has_equivalent();
        let stays = matches!(self.0[index], Density::Rounding { .. });
        stays || is_on == (index == EQUIVALENT)
    }

    /// Names of the sources that the equivalent one replaces.
    pub(in crate::gyro) fn replaced(&self) -> Vec<&'static str> {
        let unlisted = (0..EQUIVALENT).filter(|index| !self.is_listed(*index));
        unlisted.map(name_of).collect()
    }

    /// Whether the equivalent source stands in the place of the others.
    pub(in crate::gyro) fn has_equivalent(&self) -> bool {
        matches!(self.0[EQUIVALENT], Density::Current { a2_per_hz } if a2_per_hz > 0.0)
    }

    /// The densities behind a gate of another length, through which the equivalent source makes the same
    /// walk.
    pub(in crate::gyro) fn behind_gate(mut self, ratio: f64) -> Self {
        if let Density::Current { a2_per_hz } = &mut self.0[EQUIVALENT] {
            *a2_per_hz *= ratio;
        }
        self
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
