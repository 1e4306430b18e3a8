//! The table: command, servo and Earth rate joined.

use super::axis::earth_rate_rad_per_s;
use super::profile::Profile;
use super::servo::Servo;
use crate::scenario::TurntableConfig;
use crate::signal::MotionSegment;

/// A rate table that carries one gyro, its axis along the gyro's input axis.
///
/// Delivers truth: the inertial rate of the axis after the servo, table motion plus the projection
/// of the Earth's rotation. Nothing it does depends on anything but its configuration.
#[derive(Clone, Debug)]
pub struct Turntable {
    profile: Profile,
    servo: Servo,
    /// Projection of the Earth's rotation, rad/s.
    earth_rate: f64,
}

impl Turntable {
    /// A table at the start of the warm-up, settled on the first rate it is told to hold.
    ///
    /// * `warm_up_s`: s, >= 0; soft starts lie inside it and are shortened to it.
    /// * `sample_period_s`: s, > 0; one segment is delivered per sample.
    ///
    /// # Panics
    /// If a swing has not exactly one amplitude, several sines neither one amplitude nor one for each,
    /// or a staircase no rate; the scenario reader refuses all of these.
    #[must_use]
    pub fn new(config: &TurntableConfig, warm_up_s: f64, sample_period_s: f64) -> Self {
        let profile = Profile::new(&config.motion, warm_up_s, sample_period_s);
        Self {
            servo: Servo::new(&config.servo, profile.initial_rate(), sample_period_s),
            profile,
            earth_rate: earth_rate_rad_per_s(&config.site),
        }
    }

    /// Motion over the next output sample, rad/s; the rate at its end is truth at that stamp.
    ///
    /// The first call covers the time from 0 to T. Cubics join with equal rate and slope, except at
    /// the steps of a staircase on an ideal table. Against the exact sine of angular frequency `w`
    /// an ideal table errs by nothing at the stamps and by at most `(w T)^4 / 384` of the amplitude
    /// between them (2e-10 at 10 Hz and 4 kHz); a servo has its amplitude low by that much at most.
    pub fn next_segment(&mut self) -> MotionSegment {
        let mut motion = self.servo.follow(self.profile.next_segment());
        motion.rate_rad_per_s[0] += self.earth_rate;
        motion
    }
}
