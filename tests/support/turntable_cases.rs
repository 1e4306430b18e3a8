//! Tables without faults, from which tests depart.

use fogbench::scenario::{AxisConfig, EncoderConfig, MountingConfig};
use fogbench::vocabulary::CaseAxis;

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

/// A table without an encoder; given a resolution, one without faults.
pub(crate) fn no_encoder() -> EncoderConfig {
    EncoderConfig {
        resolution_arcsec: None,
        latency_us: 0.0,
        eccentricity_error_arcsec: 0.0,
        eccentricity_phase_deg: 0.0,
        interpolation_error_arcsec: 0.0,
        interpolation_phase_deg: 0.0,
        lines_per_revolution: 0,
    }
}
