//! The configured motion as the checks and the metrics need it.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::assembly_motion::hardest;
use crate::gyro::{self, MotionExtremes};
use crate::metrics::{Dwell, Motion, Staircase};
use crate::scenario::{MotionConfig, Scenario, ServoConfig, Stairs};
use crate::turntable::{
    campaign_command_extremes, command_extremes, command_rate_max_rad_per_s, dwell_ends,
    earth_rate_rad_per_s, first_measured_index, input_axis_bounds,
    multi_sine_acceleration_max_rad_per_s2, step_indices,
};
use crate::units::{deg_per_s_to_deg_per_h, deg_per_s_to_rad_per_s, rad_per_s_to_deg_per_h};

/// Motion as the metrics see it; a staircase's last step counts from the start of the record.
pub(crate) fn motion(scenario: &Scenario, sample_period_s: f64) -> Motion {
    match scenario.measured_motion() {
        MotionConfig::Static(_) | MotionConfig::Rotation(_) => Motion::Steady,
        MotionConfig::Swing(swing) => {
            let frequency_hz = swing.frequency_hz;
            if swing.from_rest {
                Motion::SwingFromRest { frequency_hz }
            } else {
                Motion::Swing { frequency_hz }
            }
        }
        MotionConfig::Trapezoid(_)
        | MotionConfig::Chirp(_)
        | MotionConfig::Script(_)
        | MotionConfig::Calibration(_) => Motion::General,
        MotionConfig::MultiSine(multi_sine) => Motion::MultiSine {
            frequencies_hz: multi_sine.frequencies_hz.clone(),
        },
        MotionConfig::Steps(steps) => steps_motion(&steps.into(), scenario, sample_period_s),
        MotionConfig::ScaleFactorTest(test) => {
            steps_motion(&test.into(), scenario, sample_period_s)
        }
    }
}

fn steps_motion(stairs: &Stairs, scenario: &Scenario, sample_period_s: f64) -> Motion {
    let words = u64::from(scenario.gyro.output.average_samples);
    let last_step_index = step_indices(stairs, 0.0, word_period_s(scenario))
        .last()
        .map_or(0, |&word| index(word.div_ceil(words)));
    let rise = match stairs.rates_deg_per_s.as_slice() {
        [.., before, last] => last - before,
        _ => 0.0,
    };
    Motion::Steps {
        last_step_index,
        step_deg_per_h: deg_per_s_to_deg_per_h(rise),
        staircase: staircase(stairs, scenario, sample_period_s),
    }
}

/// The dwells of a staircase within the record, their settling left out.
fn staircase(stairs: &Stairs, scenario: &Scenario, sample_period_s: f64) -> Staircase {
    let rest_deg_per_h = rad_per_s_to_deg_per_h(earth_rate_rad_per_s(&scenario.turntable.site));
    let settle_samples = first_measured_index(stairs.settle_s, sample_period_s);
    // The table steps between rate words; samples that see two rates belong to neither dwell.
    let words = u64::from(scenario.gyro.output.average_samples);
    let steps_at = dwell_ends(stairs, 0.0, word_period_s(scenario));
    let ends: Vec<u64> = steps_at.iter().map(|word| word / words).collect();
    let starts = std::iter::once(0).chain(steps_at.iter().map(|word| word.div_ceil(words)));
    let dwells = starts.zip(&ends).zip(&stairs.rates_deg_per_s);
    Staircase {
        dwells: dwells
            .map(|((start, &end), &rate)| Dwell {
                samples: index(start.saturating_add(settle_samples))..index(end),
                rate_deg_per_h: rest_deg_per_h + deg_per_s_to_deg_per_h(rate),
            })
            .collect(),
        settle_s: stairs.settle_s,
        rest_deg_per_h,
        has_static_zeros: stairs.has_static_zeros,
    }
}

/// Period of the words that the table's steps fall between, s.
fn word_period_s(scenario: &Scenario) -> f64 {
    gyro::word_period_s(&scenario.gyro)
}

/// A count of samples as an index into a record.
fn index(count: u64) -> usize {
    usize::try_from(count).unwrap_or(usize::MAX)
}

/// Largest rate that motion and injected signal put on the input axis, of an assembly on any, deg/h.
pub(crate) fn rate_deg_per_h_max(scenario: &Scenario) -> f64 {
    if scenario.gyro.assembly.is_some() || scenario.gyro.injection.is_some() {
        return rad_per_s_to_deg_per_h(motion_extremes(scenario).rate_rad_per_s);
    }
    let axis = input_axis_bounds(&scenario.turntable);
    let commanded = command_rate_max_rad_per_s(&scenario.turntable.motion);
    rad_per_s_to_deg_per_h(axis.earth_rate_rad_per_s)
        + rad_per_s_to_deg_per_h(axis.rate_ratio * commanded)
}

/// The hardest motion on the input axis, of an assembly on any; the loop starts from zero rate.
pub(crate) fn motion_extremes(scenario: &Scenario) -> MotionExtremes {
    let command = command_extremes_of(scenario);
    let axis = input_axis_bounds(&scenario.turntable);
    let commanded = command.rate_rad_per_s;
    if scenario.gyro.injection.is_some() {
        // The table is at rest, and no mounting comes between the signal and the loop.
        return MotionExtremes {
            rate_rad_per_s: axis.earth_rate_rad_per_s + commanded,
            jump_rad_per_s: axis.earth_rate_rad_per_s + command.jump_rad_per_s,
            acceleration_rad_per_s2: command.acceleration_rad_per_s2,
        };
    }
    let input = MotionExtremes {
        rate_rad_per_s: axis.earth_rate_rad_per_s + axis.rate_ratio * commanded,
        jump_rad_per_s: axis.earth_rate_rad_per_s + axis.rate_ratio * command.jump_rad_per_s,
        acceleration_rad_per_s2: axis.rate_ratio * command.acceleration_rad_per_s2
            + commanded * (axis.acceleration_ratio * commanded + axis.earth_slope_rad_per_s),
    };
    match &scenario.gyro.assembly {
        None => input,
        Some(assembly) => hardest(&scenario.turntable, assembly, &command, &input),
    }
}

/// The hardest motion about the table axis but for the Earth's, or the hardest of an injected signal;
/// the servo starts settled.
fn command_extremes_of(scenario: &Scenario) -> MotionExtremes {
    let motion = scenario.measured_motion();
    let commanded = command_rate_max_rad_per_s(motion);
    let own = command_extremes(motion);
    let (jump, acceleration) = match motion {
        MotionConfig::Static(_) => (0.0, 0.0),
        MotionConfig::Swing(swing) => (0.0, TAU * swing.frequency_hz * commanded),
        MotionConfig::MultiSine(multi_sine) => {
            let acceleration = multi_sine_acceleration_max_rad_per_s2(multi_sine);
            let soft_start_s = multi_sine.soft_start_s.min(scenario.warm_up_s);
            if soft_start_s > 0.0 {
                let of_start = FRAC_PI_2 * commanded / soft_start_s;
                (0.0, acceleration + of_start)
            } else {
                (commanded, acceleration)
            }
        }
        MotionConfig::Rotation(rotation) => {
            let soft_start_s = rotation.soft_start_s.min(scenario.warm_up_s);
            if soft_start_s > 0.0 {
                (0.0, FRAC_PI_2 * commanded / soft_start_s)
            } else {
                (commanded, 0.0)
            }
        }
        MotionConfig::Trapezoid(_) | MotionConfig::Chirp(_) | MotionConfig::Script(_) => own
            .map_or((0.0, 0.0), |own| {
                (own.jump_rad_per_s, own.acceleration_rad_per_s2)
            }),
        MotionConfig::Calibration(campaign) => {
            let extremes = campaign_command_extremes(campaign, scenario.warm_up_s);
            (extremes.jump_rad_per_s, extremes.acceleration_rad_per_s2)
        }
        motion @ (MotionConfig::Steps(_) | MotionConfig::ScaleFactorTest(_)) => {
            let rates = Stairs::of(motion).map_or_else(Vec::new, |stairs| stairs.rates_deg_per_s);
            let first = rates.first().map_or(0.0, |rate| rate.abs());
            let rises = rates.windows(2).map(|pair| (pair[1] - pair[0]).abs());
            let rise = deg_per_s_to_rad_per_s(rises.fold(0.0, f64::max));
            let first = deg_per_s_to_rad_per_s(first);
            match &scenario.turntable.servo {
                ServoConfig::Ideal(_) => (rise.max(first), 0.0),
                // The slope of the step response of a second-order servo stays below wn.
                ServoConfig::SecondOrder(servo) => (first, TAU * servo.natural_frequency_hz * rise),
                // Whatever its controller demands, the motor is limited.
                ServoConfig::DirectDrive(servo) => {
                    (first, servo.acceleration_max_rad_per_s2(commanded))
                }
            }
        }
    };
    MotionExtremes {
        rate_rad_per_s: commanded,
        jump_rad_per_s: jump,
        acceleration_rad_per_s2: acceleration,
    }
}
