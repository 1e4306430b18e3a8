//! Tables without faults, from which tests depart.

use fogbench::scenario::{AxisConfig, EncoderConfig, MountingConfig};
use fogbench::vocabulary::CaseAxis;

/// An axis without tilt or wobble.
pub(crate) fn true_axis() -> AxisConfig {
    AxisConfig {
        wobble_harmonic: 1,
        ..AxisConfig::reference()
    }
}

/// A gyro along the platform normal.
pub(crate) fn true_mounting() -> MountingConfig {
    MountingConfig {
        axis_along_table: CaseAxis::Z,
        ..MountingConfig::reference()
    }
}

/// A table without an encoder; given a resolution, one without faults.
pub(crate) fn no_encoder() -> EncoderConfig {
    EncoderConfig {
        lines_per_revolution: 0,
        ..EncoderConfig::reference()
    }
}
