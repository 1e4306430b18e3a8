//! Every noise source drawn on its own, each from the stream of its name.

use crate::gyro::noise::law::Density;
use crate::gyro::noise::{COUNT, name_of};
use crate::gyro::optics::detector::{Detector, half_period_phase_variance_rad2};
use crate::random::{Stream, Streams};

/// Units and times that turn densities into draws.
#[derive(Clone, Copy, Debug)]
pub(in crate::gyro) struct DrawUnits {
    /// Level per ampere of photocurrent.
    pub(in crate::gyro) levels_per_a: f64,
    /// Ramp codes per radian of phase.
    pub(in crate::gyro) codes_per_rad: f64,
    /// Time of one state of the bias wave, s.
    pub(in crate::gyro) state_time_s: f64,
}

/// Draws of all sources, sorted by the place where they enter.
///
/// Within a place they keep the order of the densities; the levels are summed in that order.
#[derive(Clone, Debug)]
pub(in crate::gyro) struct ExactDraw {
    drawn: [Drawn; COUNT],
    /// Where phase, light, photocurrent and current end in `drawn`; the rest is not drawn.
    ends: [usize; 4],
}

/// Draw of one source.
#[derive(Clone, Debug)]
struct Drawn {
    name: &'static str,
    place: Place,
    /// Standard deviation: ramp codes, relative, or levels; of the photocurrent the variance per
    /// level.
    scale: f64,
    stream: Stream,
}

/// Place where a source enters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Place {
    Phase,
    Light,
    Photocurrent,
    Current,
    Nowhere,
}

impl ExactDraw {
    /// The draws of a detection chain.
    pub(in crate::gyro) fn new(detector: &Detector, units: DrawUnits, streams: &Streams) -> Self {
        let mut drawn = std::array::from_fn(|index| {
            let (place, scale) = scaled(detector.densities.0[index], detector, units);
            let name = name_of(index);
            Drawn {
                name,
                place: if scale > 0.0 { place } else { Place::Nowhere },
                scale,
                stream: streams.stream(name),
            }
        });
        drawn.sort_by_key(|one: &Drawn| one.place);
        let places = [
            Place::Phase,
            Place::Light,
            Place::Photocurrent,
            Place::Current,
        ];
        let ends = places.map(|place| drawn.partition_point(|one| one.place <= place));
        Self { drawn, ends }
    }

    /// The draws of `other`, from the streams of this one.
    pub(in crate::gyro) fn retuned(&self, mut other: Self) -> Self {
        for one in &mut other.drawn {
            if let Some(own) = self.drawn.iter().find(|own| own.name == one.name) {
                one.stream.clone_from(&own.stream);
            }
        }
        other
    }

    /// Phase error of a half period with the noise that enters there, ramp codes.
    #[inline]
    pub(in crate::gyro) fn phase_codes(&mut self, error_codes: f64) -> f64 {
        let drawn = self.drawn[..self.ends[0]].iter_mut();
        drawn.fold(error_codes, |phase, one| {
            phase + one.scale * one.stream.normal()
        })
    }

    /// Level of one sample, before the converter, of a photocurrent `light` and a `dark` current.
    #[inline]
    pub(in crate::gyro) fn sample_level(&mut self, light: f64, dark: f64) -> f64 {
        let [phase, lights, photocurrents, currents] = self.ends;
        let mut level = light;
        for one in &mut self.drawn[phase..lights] {
            level *= 1.0 + one.scale * one.stream.normal();
        }
        level += dark;
        for one in &mut self.drawn[lights..photocurrents] {
            let variance = one.scale * (light + dark);
            level += variance.max(0.0).sqrt() * one.stream.normal();
        }
        for one in &mut self.drawn[photocurrents..currents] {
            level += one.scale * one.stream.normal();
        }
        level
    }
}

/// Place and scale of a density.
///
/// The variance of one sample is `n S / (2 gate_duty tau)`, so that the mean of n has that of the
/// gate.
fn scaled(density: Density, detector: &Detector, units: DrawUnits) -> (Place, f64) {
    let sample_variance = |density: f64| {
        detector.samples_per_half_period
            * detector.half_period_variance_a2(density, units.state_time_s)
    };
    match density {
        Density::Phase { rad2_per_hz } => (
            Place::Phase,
            half_period_phase_variance_rad2(rad2_per_hz, units.state_time_s).sqrt()
                * units.codes_per_rad,
        ),
        Density::Intensity { per_hz } => (Place::Light, sample_variance(per_hz).sqrt()),
        // 2 e I is linear in the current: one factor of the unit converts I, one remains.
        Density::OfCurrent { a2_per_hz_per_a } => (
            Place::Photocurrent,
            sample_variance(a2_per_hz_per_a) * units.levels_per_a,
        ),
        Density::Current { a2_per_hz } => (
            Place::Current,
            sample_variance(a2_per_hz).sqrt() * units.levels_per_a,
        ),
        Density::Rounding { .. } => (Place::Nowhere, 0.0),
    }
}
