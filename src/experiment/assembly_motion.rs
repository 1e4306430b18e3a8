//! The motion of a three-axis assembly as the checks and the metrics need it.

use crate::gyro::{InputAxis, MotionExtremes};
use crate::scenario::{AssemblyConfig, CaseAxis, Scenario};
use crate::units::EARTH_RATE_RAD_PER_S;

/// Whether the gyro with this index is the one that the table turns.
pub(super) fn is_turned(scenario: &Scenario, gyro: usize) -> bool {
    scenario.gyro.assembly.is_none() || gyro == index_along_table(scenario)
}

fn index_along_table(scenario: &Scenario) -> usize {
    match scenario.turntable.mounting.axis_along_table {
        CaseAxis::X => 0,
        CaseAxis::Y => 1,
        CaseAxis::Z => 2,
    }
}

/// The hardest motion on any of the three input axes, their biases included.
///
/// The case axis along the table axis has the table's motion, the others at most the whole Earth
/// rate, which the table turns past them.
pub(super) fn hardest(
    scenario: &Scenario,
    assembly: &AssemblyConfig,
    table: &MotionExtremes,
) -> MotionExtremes {
    let across = MotionExtremes {
        rate_rad_per_s: EARTH_RATE_RAD_PER_S,
        jump_rad_per_s: EARTH_RATE_RAD_PER_S,
        acceleration_rad_per_s2: EARTH_RATE_RAD_PER_S * table.rate_rad_per_s,
    };
    let along = index_along_table(scenario);
    let mut hardest = MotionExtremes::default();
    for input_axis in InputAxis::of_assembly(assembly) {
        let bias = input_axis.bias_rad_per_s.abs();
        let sensed = |of: fn(&MotionExtremes) -> f64| -> f64 {
            let axes = input_axis.sensitivity.iter().enumerate();
            let parts = axes.map(|(axis, sensitivity)| {
                sensitivity.abs() * of(if axis == along { table } else { &across })
            });
            parts.sum()
        };
        let rate = sensed(|motion| motion.rate_rad_per_s) + bias;
        let jump = sensed(|motion| motion.jump_rad_per_s) + bias;
        let acceleration = sensed(|motion| motion.acceleration_rad_per_s2);
        hardest = MotionExtremes {
            rate_rad_per_s: hardest.rate_rad_per_s.max(rate),
            jump_rad_per_s: hardest.jump_rad_per_s.max(jump),
            acceleration_rad_per_s2: hardest.acceleration_rad_per_s2.max(acceleration),
        };
    }
    hardest
}
