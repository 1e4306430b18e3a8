//! Tables without faults, from which tests depart.

use fogbench::scenario::{AxisConfig, CaseAxis, MountingConfig};

/// An axis without tilt or wobble.
pub(crate) fn true_axis() -> AxisConfig {
    AxisConfig {
        tilt_north_arcsec: 0.0,
        tilt_east_arcsec: 0.0,
        wobble_arcsec: 0.0,
        wobble_harmonic: 1,
    }
}

/// A gyro along the platform normal.
pub(crate) fn true_mounting() -> MountingConfig {
    MountingConfig {
        misalignment_arcsec: 0.0,
        misalignment_azimuth_deg: 0.0,
        start_angle_deg: 0.0,
        axis_along_table: CaseAxis::Z,
    }
}
