//! Groups of the patent's plan: mountings a, b, c at 10, 50 and 90 deg/s at 32.03 deg north.

use fogbench::calibration::{ErrorParameters, GroupDesign, GroupObservation, Misalignment};
use fogbench::units::deg_per_h_to_deg_per_s;

/// Vertical component of Earth rate, deg/s.
pub(crate) const EARTH_UP_DEG_PER_S: f64 = 0.002_215_896_904;

/// The patent's nine groups in order: case axis along the table axis, table rate in deg/s.
pub(crate) const NINE: [(usize, f64); 9] = [
    (0, 10.0),
    (0, 50.0),
    (0, 90.0),
    (1, 10.0),
    (1, 50.0),
    (1, 90.0),
    (2, 10.0),
    (2, 50.0),
    (2, 90.0),
];

/// Mean temperatures of the nine groups in a warm-up from 20 to 40 deg C, 1800 s; deg C.
pub(crate) const WARM_UP_C: [f64; 9] = [
    22.992, 28.213, 31.831, 35.208, 36.679, 37.698, 38.650, 39.064, 39.351,
];

/// Rates about the case axes with one of them along the table axis, deg/s.
pub(crate) fn rates((axis, table_rate_deg_per_s): (usize, f64)) -> [f64; 3] {
    let mut rates = [0.0; 3];
    rates[axis] = table_rate_deg_per_s + EARTH_UP_DEG_PER_S;
    rates
}

/// Designs of a plan without temperatures.
pub(crate) fn plan(groups: &[(usize, f64)]) -> Vec<GroupDesign> {
    let rates = groups
        .iter()
        .map(|group| GroupDesign::at_rate(rates(*group)));
    rates.collect()
}

/// Designs of a plan with one thermometer for all gyros.
pub(crate) fn warm_plan(groups: &[(usize, f64)], temperature_c: &[f64]) -> Vec<GroupDesign> {
    let mut designs = plan(groups);
    for (design, temperature) in designs.iter_mut().zip(temperature_c) {
        design.temperature_c = [*temperature; 3];
    }
    designs
}

/// Parameters of the worked example.
pub(crate) fn truth() -> ErrorParameters {
    ErrorParameters {
        scale_error: [800e-6, -500e-6, 300e-6],
        misalignment_rad: Misalignment {
            xy: 1.0e-3,
            xz: -0.8e-3,
            yx: 0.6e-3,
            yz: 1.2e-3,
            zx: -0.9e-3,
            zy: 0.5e-3,
        },
        bias_deg_per_s: [1.0, -2.0, 1.5].map(deg_per_h_to_deg_per_s),
    }
}

/// Noise-free groups of an assembly whose biases shift by `bias_shift_deg_per_s(group)`.
pub(crate) fn observed(
    designs: &[GroupDesign],
    parameters: &ErrorParameters,
    standard_error_deg_per_s: f64,
    bias_shift_deg_per_s: impl Fn(usize) -> [f64; 3],
) -> Vec<GroupObservation> {
    let observe = |(index, design): (usize, &GroupDesign)| {
        let mut output_deg_per_s = parameters.predict(design.reference_rate_deg_per_s);
        for (output, shift) in output_deg_per_s.iter_mut().zip(bias_shift_deg_per_s(index)) {
            *output += shift;
        }
        GroupObservation {
            design: *design,
            output_deg_per_s,
            standard_error_deg_per_s: [standard_error_deg_per_s; 3],
        }
    };
    designs.iter().enumerate().map(observe).collect()
}
