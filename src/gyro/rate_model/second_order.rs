//! Second-order effects of modulator and ramp at the output rate.

use std::f64::consts::TAU;

use crate::gyro::ModulationScheme;
use crate::gyro::optics::modulation::Timing;
use crate::gyro::optics::second_order::{Optics, adler_advance_rad};
use crate::random::{Stream, Streams};

/// What the effects make of the Sagnac phase of an output sample.
///
/// Error phases add to the Sagnac phase before the loop; a gain error divides it. The coupling
/// of the ramp is averaged over the sample by the exact solution of Adler's equation from the ramp
/// as it stands, which then follows the register, noise and lag included. Left out: the jumps of
/// single resets.
#[derive(Clone, Debug)]
pub(super) struct RateOptics {
    optics: Optics,
    visibility: f64,
    depth_rad: f64,
    half_periods: f64,
    periods: f64,
    /// Ramp plus the phase of the coupling, rad.
    ramp_rad: f64,
    drift: f64,
    correction: f64,
    dither: Stream,
}

impl RateOptics {
    /// The effects over output samples of `half_periods`, at the start of a run.
    pub(super) fn new(
        optics: Optics,
        (visibility, depth_rad): (f64, f64),
        half_periods: u32,
        streams: &Streams,
    ) -> Self {
        Self {
            optics,
            visibility,
            depth_rad,
            half_periods: f64::from(half_periods),
            periods: f64::from(half_periods / Timing::new(optics.scheme).half_periods),
            ramp_rad: optics.coupling_phase_rad,
            drift: 0.0,
            correction: 1.0,
            dither: streams.stream("phase_dither"),
        }
    }

    /// Replaces the gain error that comes on top of the configured one.
    pub(super) fn set_drift(&mut self, drift: f64) {
        self.drift = drift;
    }

    /// Applied over commanded phase, less one, as the second loop has left it.
    pub(super) fn gain_error(&self) -> f64 {
        self.uncorrected() * self.correction - 1.0
    }

    fn uncorrected(&self) -> f64 {
        (1.0 + self.optics.gain_error) * (1.0 + self.drift)
    }

    fn is_neutral(&self) -> bool {
        self.drift == 0.0 && !self.optics.is_needed()
    }

    /// Distorts the Sagnac phase of an output sample, cubics of equal length in normalised time, rad.
    pub(super) fn distort(&mut self, phases_rad: &mut [[f64; 4]]) {
        if self.is_neutral() {
            return;
        }
        let count = phases_rad.len() as f64;
        let means = phases_rad
            .iter()
            .map(|[c0, c1, c2, c3]| c0 + c1 / 2.0 + c2 / 3.0 + c3 / 4.0);
        let mean_rad = means.sum::<f64>() / count;
        // What is added to the phase all through the sample, before and after it is scaled.
        let (mut before, mut after) = (0.0, 0.0);
        if self.optics.dither_rad > 0.0 && self.optics.coupling_rad > 0.0 {
            let deviation = dither_variance(&self.optics, self.half_periods).sqrt();
            before += deviation * self.dither.normal();
        } else if self.optics.coupling_rad > 0.0 {
            let advance = adler_advance_rad(
                self.ramp_rad,
                mean_rad,
                self.optics.coupling_rad,
                self.half_periods,
            );
            before += advance / self.half_periods - mean_rad;
        }
        let scale = self.optics.scale(self.gain_error());
        // A step that is cut off lies half a bit below the register on average, but for a few
        // hundredths where the error comes in whole levels of the converter.
        after += 0.5 * self.optics.step_lsb_rad
            + self
                .optics
                .intensity_bias_rad(self.visibility, self.depth_rad, mean_rad);
        for phase_rad in phases_rad {
            phase_rad[0] += before;
            for coefficient in phase_rad.iter_mut() {
                *coefficient *= scale;
            }
            phase_rad[0] += after;
        }
    }

    /// Lets the ramp and the second loop follow the mean register of the sample.
    pub(super) fn follow(&mut self, mean_step_rad: f64) {
        if self.is_neutral() {
            return;
        }
        let advance_rad = mean_step_rad * self.half_periods;
        self.ramp_rad = (self.ramp_rad + advance_rad).rem_euclid(TAU);
        let corrections = if self.optics.scheme == ModulationScheme::TwoState {
            (advance_rad.abs() / TAU).min(self.periods)
        } else {
            self.periods
        };
        let left = (1.0 - self.optics.second_loop_gain).powf(corrections);
        self.correction = (1.0 + self.gain_error() * left) / self.uncorrected();
    }
}

/// Variance of the mean error phase over `half_periods` that dithered coupling leaves, rad^2.
///
/// Each interval of I half periods holds `a sin u` of a ramp that jumped by a normal phase of
/// standard deviation s: neighbours correlate by `rho = exp(-s^2 / 2)`, so that the mean over M has
/// `a^2 / 2 (I / M) (1 + rho) / (1 - rho)`, an angle random walk. Motion only lowers it.
pub(super) fn dither_variance(optics: &Optics, half_periods: f64) -> f64 {
    let per_period = f64::from(Timing::new(optics.scheme).half_periods);
    let interval = f64::from(optics.dither_interval_periods) * per_period;
    let correlation = (-0.5 * optics.dither_rad * optics.dither_rad).exp();
    let stretch = (1.0 + correlation) / (1.0 - correlation);
    0.5 * optics.coupling_rad * optics.coupling_rad * interval / half_periods * stretch
}
