//! Group means: what the estimators see of a record.

use super::design::GroupDesign;
use super::error::{AXES, CalibrationError};

/// One group of samples, reduced to means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroupObservation {
    /// Rates and temperatures of the group.
    pub design: GroupDesign,
    /// Mean outputs of the gyros x, y, z, deg/s.
    pub output_deg_per_s: [f64; 3],
    /// Standard errors of these means, deg/s; 0 for noise-free data.
    pub standard_error_deg_per_s: [f64; 3],
}

/// Checks that all numbers of all groups are usable.
pub(super) fn check_groups(groups: &[GroupObservation]) -> Result<(), CalibrationError> {
    for (index, group) in groups.iter().enumerate() {
        let design = &group.design;
        let finite: [(&'static str, [f64; 3]); 5] = [
            ("reference rate (deg/s)", design.reference_rate_deg_per_s),
            ("temperature (deg C)", design.temperature_c),
            (
                "temperature rate (K/min)",
                design.temperature_rate_k_per_min,
            ),
            ("output (deg/s)", group.output_deg_per_s),
            ("standard error (deg/s)", group.standard_error_deg_per_s),
        ];
        for (quantity, values) in finite {
            let is_error = quantity.starts_with("standard");
            for (axis, value) in AXES.into_iter().zip(values) {
                if !value.is_finite() || (is_error && value < 0.0) {
                    return Err(CalibrationError::BadValue {
                        group: index + 1,
                        quantity,
                        axis,
                        value,
                        expected: if is_error { ">= 0" } else { "a finite number" },
                    });
                }
            }
        }
    }
    Ok(())
}
