//! The motion of a three-axis assembly as the checks and the metrics need it.

use crate::gyro::{InputAxis, MotionExtremes};
use crate::metrics::{Against, ChannelMetrics, MetricKey, known_metrics};
use crate::scenario::{AssemblyConfig, Scenario, TurntableConfig};
use crate::units::{EARTH_RATE_RAD_PER_S, arcsec_to_rad};
use crate::vocabulary::CaseAxis;

/// Index of a case axis.
pub(crate) fn axis_index(axis: CaseAxis) -> usize {
    match axis {
        CaseAxis::X => 0,
        CaseAxis::Y => 1,
        CaseAxis::Z => 2,
    }
}

/// Index of the case axis along the table axis.
fn index_along(table: &TurntableConfig) -> usize {
    axis_index(table.mounting.axis_along_table)
}

/// Indices of the case axes that are ever along the table axis.
fn indices_along(table: &TurntableConfig) -> Vec<usize> {
    match table.motion.campaign() {
        Some(campaign) => {
            let axes = campaign.axes.iter();
            axes.map(|axis| axis_index(*axis)).collect()
        }
        None => vec![index_along(table)],
    }
}

/// The hardest motion on any of the three input axes, their biases included.
///
/// * `command`: motion about the table axis, without the Earth's.
/// * `along`: motion on the case axis along the table axis.
///
/// A case axis across the table axis sees at most the whole Earth rate, which the table turns past
/// it, and `sin mu + k sin w` of the command under misalignment `mu` and wobble `w` of harmonic k.
pub(crate) fn hardest(
    table: &TurntableConfig,
    assembly: &AssemblyConfig,
    command: &MotionExtremes,
    along: &MotionExtremes,
) -> MotionExtremes {
    let harmonic = f64::from(table.axis.wobble_harmonic);
    let wobble = harmonic * arcsec_to_rad(table.axis.wobble_arcsec).sin();
    let lean = arcsec_to_rad(table.mounting.misalignment_arcsec).sin() + wobble;
    let commanded = command.rate_rad_per_s;
    let across = MotionExtremes {
        rate_rad_per_s: EARTH_RATE_RAD_PER_S + lean * commanded,
        jump_rad_per_s: EARTH_RATE_RAD_PER_S + lean * command.jump_rad_per_s,
        acceleration_rad_per_s2: lean * command.acceleration_rad_per_s2
            + commanded * ((harmonic - 1.0) * wobble * commanded + EARTH_RATE_RAD_PER_S),
    };
    let mut hardest = MotionExtremes::default();
    let gyros = InputAxis::of_assembly(assembly);
    let mountings = indices_along(table);
    let pairs = mountings
        .iter()
        .flat_map(|along| gyros.iter().map(move |gyro| (*along, gyro)));
    for (index_along, input_axis) in pairs {
        let bias = input_axis.bias_rad_per_s.abs();
        let sensed = |of: fn(&MotionExtremes) -> f64| -> f64 {
            let axes = input_axis.sensitivity.iter().enumerate();
            let parts = axes.map(|(axis, sensitivity)| {
                sensitivity.abs() * of(if axis == index_along { along } else { &across })
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

/// Why a channel can never have a metric because its gyro stands across the table axis.
///
/// What raw compares with the true rate is of the turned axis too; filters compare it with raw.
pub(crate) fn lacks(scenario: &Scenario, channel: &str, key: &MetricKey) -> Option<&'static str> {
    scenario.gyro.assembly.as_ref()?;
    let along = scenario.axis_prefixes()[index_along(&scenario.turntable)];
    let is_concerned = key.is_of_turned_axis
        || (scenario.is_unfiltered(channel) && key.against == Against::TruthForRaw);
    (is_concerned && !channel.starts_with(along))
        .then_some("the table does not turn about this axis")
}

/// Takes from a channel across the table axis what it can never have.
pub(crate) fn drop_lacking(scenario: &Scenario, channel: &str, metrics: &mut ChannelMetrics) {
    for key in known_metrics() {
        if let Some(reason) = lacks(scenario, channel, key) {
            metrics.withdraw(key, reason);
        }
    }
}
