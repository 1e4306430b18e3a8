//! The configured motion as the checks and the metrics need it.

use super::assembly_motion::hardest;
use crate::gyro::{self, MotionExtremes};
use crate::metrics::{Dwell, Motion, Staircase};
use crate::scenario::{Scenario, Stairs};
use crate::turntable::{
    MotionClass, Surroundings, dwell_ends, earth_rate_rad_per_s, first_measured_index,
    input_axis_bounds, step_indices,
};
use crate::units::{deg_per_s_to_deg_per_h, rad_per_s_to_deg_per_h};

/// Motion as the metrics see it; a staircase's last step counts from the start of the record.
pub(crate) fn motion(scenario: &Scenario, sample_period_s: f64) -> Motion {
    match scenario.measured_motion().class() {
        MotionClass::Rest | MotionClass::Rotation => Motion::Steady,
        MotionClass::Swing {
            frequency_hz,
            is_from_rest: true,
        } => Motion::SwingFromRest { frequency_hz },
        MotionClass::Swing { frequency_hz, .. } => Motion::Swing { frequency_hz },
        MotionClass::MultiSine { frequencies_hz } => Motion::MultiSine {
            frequencies_hz: frequencies_hz.to_vec(),
        },
        MotionClass::Steps(stairs) => steps_motion(&stairs, scenario, sample_period_s),
        MotionClass::Campaign(_) | MotionClass::General => Motion::General,
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
        is_found: false,
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
    let commanded = scenario.turntable.motion.rate_max_rad_per_s();
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
    let command = motion.extremes(Surroundings {
        warm_up_s: scenario.warm_up_s,
        servo: &scenario.turntable.servo,
    });
    MotionExtremes {
        rate_rad_per_s: motion.rate_max_rad_per_s(),
        jump_rad_per_s: command.jump_rad_per_s,
        acceleration_rad_per_s2: command.acceleration_rad_per_s2,
    }
}
