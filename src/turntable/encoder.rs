//! The angle encoder: what a laboratory sees of the axis.

use std::collections::VecDeque;

use crate::signal::MotionSegment;
use crate::turntable::EncoderConfig;
use crate::units::{arcsec_to_rad, deg_to_rad, us_to_s};

/// From the angle of the axis to the angle shown: cyclic errors, then rounding.
///
/// ```text
/// shown = delta round((theta + e1 sin(theta + p1) + eN sin(N theta + pN)) / delta)
/// ```
///
/// `e1` is the eccentricity of the disc, once per revolution; `eN` the error of interpolating
/// between its `N` lines. Turning at `w`, an error `e` that repeats `k` times a revolution makes
/// the rate implied ripple by `k w e`.
///
/// Rounding alone gives the difference of two readings over `T` the standard deviation
/// `delta / (sqrt(6) T)` as a rate: 0.163 deg/s for 0.36 arcsec at 4 kHz, a sixth of a swing of
/// 1 deg/s. An encoder is therefore compared as an angle, never by differences.
#[derive(Clone, Debug)]
pub(super) struct Scale {
    resolution: f64,
    eccentricity: f64,
    eccentricity_phase: f64,
    interpolation: f64,
    interpolation_phase: f64,
    lines: f64,
}

impl Scale {
    /// The scale of a table's encoder; that of a table without one shows the angle itself.
    pub(super) fn new(config: &EncoderConfig) -> Self {
        Self {
            resolution: arcsec_to_rad(config.resolution_arcsec.unwrap_or(0.0)),
            eccentricity: arcsec_to_rad(config.eccentricity_error_arcsec),
            eccentricity_phase: deg_to_rad(config.eccentricity_phase_deg),
            interpolation: arcsec_to_rad(config.interpolation_error_arcsec),
            interpolation_phase: deg_to_rad(config.interpolation_phase_deg),
            lines: f64::from(config.lines_per_revolution),
        }
    }

    /// What is shown at an angle, both in rad.
    pub(super) fn reading_rad(&self, angle_rad: f64) -> f64 {
        let error = self.eccentricity * (angle_rad + self.eccentricity_phase).sin()
            + self.interpolation * (self.lines * angle_rad + self.interpolation_phase).sin();
        let shown = angle_rad + error;
        if self.resolution > 0.0 {
            (shown / self.resolution).round() * self.resolution
        } else {
            shown
        }
    }
}

/// The encoder as a channel: readings at the gyro's stamps, late by its latency.
///
/// The angle is the closed-form integral of the motion handed to the gyro, without the Earth's
/// rotation, which carries disc and reading head alike.
#[derive(Clone, Debug)]
pub(super) struct Encoder {
    scale: Scale,
    /// Latency in samples.
    latency: f64,
    sample_period_s: f64,
    /// Rate before time 0, rad/s.
    initial_rate: f64,
    /// Angle at the last stamp, rad.
    angle: f64,
    /// The newest samples, newest first: angle at the start, rad, and motion.
    past: VecDeque<(f64, MotionSegment)>,
}

impl Encoder {
    /// The encoder of a table that has turned at `initial_rate` (rad/s) for ever and passes angle
    /// 0 at time 0; none if the table has none.
    pub(super) fn new(
        config: &EncoderConfig,
        initial_rate: f64,
        sample_period_s: f64,
    ) -> Option<Self> {
        config.resolution_arcsec?;
        Some(Self {
            scale: Scale::new(config),
            latency: us_to_s(config.latency_us) / sample_period_s,
            sample_period_s,
            initial_rate,
            angle: 0.0,
            past: VecDeque::new(),
        })
    }

    /// Turns the disc by the motion of one sample.
    pub(super) fn advance(&mut self, motion: &MotionSegment) {
        self.past.push_front((self.angle, *motion));
        let kept = whole(self.latency) + 1;
        self.past.truncate(kept);
        self.angle += motion.angle_at(1.0, self.sample_period_s);
    }

    /// Reading at the stamp of the last sample, rad.
    pub(super) fn reading_rad(&self) -> f64 {
        let samples = whole(self.latency);
        let elapsed = 1.0 - self.latency.fract();
        let angle = match self.past.get(samples) {
            Some((start, motion)) => start + motion.angle_at(elapsed, self.sample_period_s),
            None => {
                let since_start = f64::from(u32::try_from(self.past.len()).unwrap_or(u32::MAX));
                self.initial_rate * self.sample_period_s * (since_start - self.latency)
            }
        };
        self.scale.reading_rad(angle)
    }
}

/// Whole samples in a latency, which the scenario reader bounds.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "rounded down and not negative; the cast saturates"
)]
fn whole(samples: f64) -> usize {
    samples.floor() as usize
}
