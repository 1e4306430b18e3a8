//! What the bench asks of a motion, whatever its kind.

use std::sync::Arc;

use super::checks::MotionChecks;
use super::course::Course;
use crate::turntable::motion::kinds::campaign::CampaignConfig;
use crate::turntable::motion::stairs::Stairs;
use crate::turntable::servo::ServoConfig;

/// Kind of motion: implemented by the settings of each.
pub(in crate::turntable) trait Motion {
    /// Class by which the motion is measured and shown.
    fn class(&self) -> MotionClass<'_>;

    /// Largest commanded rate in magnitude, without the Earth's, rad/s; of several sines its bound.
    fn rate_max_rad_per_s(&self) -> f64;

    /// Highest frequency of the sines that it is made of, Hz; 0 where it is made of none.
    fn frequency_max_hz(&self) -> f64 {
        0.0
    }

    /// Largest jump and acceleration in magnitude, the Earth's left out.
    fn extremes(&self, surroundings: Surroundings) -> CommandExtremes;

    /// Refuses settings that contradict each other or the record.
    fn check(&self, checks: &mut MotionChecks);

    /// Whether a key of this motion is without effect beside its other settings.
    fn is_idle(&self, _key: &str, _duration_s: f64) -> bool {
        false
    }

    /// Command of the motion: the record begins after `warm_up_s`, one sample lasts `sample_period_s`.
    fn course(&self, warm_up_s: f64, sample_period_s: f64) -> Arc<dyn Course>;
}

/// Class of motions that are measured and shown alike.
#[derive(Clone, Debug, PartialEq)]
pub enum MotionClass<'a> {
    /// No motion.
    Rest,
    /// One rate for ever.
    Rotation,
    /// One sine.
    Swing {
        /// Frequency, Hz.
        frequency_hz: f64,
        /// Whether it begins with the record.
        is_from_rest: bool,
    },
    /// Several sines at once.
    MultiSine {
        /// Frequencies, Hz, ascending.
        frequencies_hz: &'a [f64],
    },
    /// Rates held one after the other.
    Steps(Stairs),
    /// Groups of constant rate in changing mountings.
    Campaign(&'a CampaignConfig),
    /// Any other course of the rate.
    General,
}

/// What the extremes of a command depend on besides the motion.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings<'a> {
    /// Length of the warm-up, s.
    pub warm_up_s: f64,
    /// Servo, which rounds the steps of a staircase off.
    pub servo: &'a ServoConfig,
}

/// What a motion asks of the table at most.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CommandExtremes {
    /// Largest jump of the rate, the one from rest at the start included, rad/s.
    pub jump_rad_per_s: f64,
    /// Largest acceleration in magnitude, rad/s^2.
    pub acceleration_rad_per_s2: f64,
}

impl CommandExtremes {
    /// Extremes of a motion of one amplitude behind a soft start, or of its jump without one.
    ///
    /// A raised cosine of length t rises by at most `pi / 2 t` of the amplitude.
    pub(super) fn soft(rate_max: f64, acceleration: f64, soft_start_s: f64) -> Self {
        if soft_start_s > 0.0 {
            let of_start = std::f64::consts::FRAC_PI_2 * rate_max / soft_start_s;
            Self {
                jump_rad_per_s: 0.0,
                acceleration_rad_per_s2: acceleration + of_start,
            }
        } else {
            Self {
                jump_rad_per_s: rate_max,
                acceleration_rad_per_s2: acceleration,
            }
        }
    }
}
