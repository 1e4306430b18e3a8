//! How the table follows: from commanded to actual rate.

mod controller;
mod direct_drive;
mod plant;
mod second_order;

use std::f64::consts::TAU;

use crate::signal::MotionSegment;
use crate::turntable::{EncoderConfig, ServoConfig};
use direct_drive::DirectDrive;
use second_order::SecondOrder;

/// The servo with its state.
#[derive(Clone, Debug)]
pub(super) enum Servo {
    /// The axis is the command.
    Ideal,
    /// Second-order low pass.
    SecondOrder(SecondOrder),
    /// Motor, friction and a sampled controller.
    DirectDrive(Box<DirectDrive>),
}

impl Servo {
    /// A servo that has settled on `initial_rate` (rad/s) for ever.
    ///
    /// A direct drive reads its position from `encoder`, an ideal one where the table has none.
    pub(super) fn new(
        config: &ServoConfig,
        encoder: &EncoderConfig,
        initial_rate: f64,
        sample_period_s: f64,
    ) -> Self {
        match config {
            ServoConfig::Ideal(_) => Self::Ideal,
            ServoConfig::SecondOrder(second_order) => Self::SecondOrder(SecondOrder::new(
                second_order,
                initial_rate,
                sample_period_s,
            )),
            ServoConfig::DirectDrive(direct_drive) => Self::DirectDrive(Box::new(
                DirectDrive::new(direct_drive, encoder, initial_rate, sample_period_s),
            )),
        }
    }

    /// Actual motion over the sample in which `command` is commanded.
    pub(super) fn follow(&mut self, command: MotionSegment) -> MotionSegment {
        match self {
            Self::Ideal => command,
            Self::SecondOrder(second_order) => second_order.follow(command),
            Self::DirectDrive(direct_drive) => direct_drive.follow(&command),
        }
    }
}

/// Largest jump, rad/s, and acceleration, rad/s^2, of a table that starts at a rate `first` and is told
/// to step by at most `rise` and to turn at most at `rate_max`, all rad/s.
pub(super) fn step_response_extremes(
    config: &ServoConfig,
    first: f64,
    rise: f64,
    rate_max: f64,
) -> (f64, f64) {
    match config {
        ServoConfig::Ideal(_) => (rise.max(first), 0.0),
        // The slope of the step response of a second-order servo stays below wn.
        ServoConfig::SecondOrder(servo) => (first, TAU * servo.natural_frequency_hz * rise),
        // Whatever its controller demands, the motor is limited.
        ServoConfig::DirectDrive(servo) => (first, servo.acceleration_max_rad_per_s2(rate_max)),
    }
}
