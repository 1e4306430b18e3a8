//! Settings of the site, of the errors of the axis and of the mounting.

use crate::declare::table;
use crate::vocabulary::CaseAxis;

table! {
    /// Site and nominal pointing of the table axis.
    pub struct SiteConfig {
        /// Geodetic latitude, north positive. Source of the default: Xi'an, the city of the paper's second
        /// affiliation; the first's is Guiyang, 26.65.
        latitude_deg: f64 = 34.27, in -90.0..=90.0, "deg", told in Account;
        /// Elevation of the table axis above the horizon. Source of the default: an upright table axis.
        axis_elevation_deg: f64 = 90.0, in -90.0..=90.0, "deg";
        /// Azimuth of the table axis from north towards east. While the axis is upright it only turns the
        /// zero of the table angle, which matters to nothing but a gyro that is not along the axis.
        axis_azimuth_deg: f64 = 0.0, in -360.0..=360.0, "deg";
    }
}

table! {
    /// Errors of the axis. The axis points along its nominal direction plus these tilts; positive table
    /// angles turn right-handed about it. At angle 0 the mark of the platform points where the elevation
    /// of the axis falls: for an upright axis of azimuth 0 to the north.
    pub struct AxisConfig {
        /// How far the table axis leans towards north, as a level reads it. Source of the default: none.
        tilt_north_arcsec: f64 = 0.0, in -36000.0..=36000.0, "arcsec";
        /// How far the table axis leans towards east. Source of the default: none.
        tilt_east_arcsec: f64 = 0.0, in -36000.0..=36000.0, "arcsec";
        /// Half angle of the cone on which the platform normal goes round the table axis. Source of the
        /// default: none; precision tables have 1 to 5 arcsec.
        wobble_arcsec: f64 = 0.0, in 0.0..=3600.0, "arcsec";
        /// Rounds of the normal per turn, in the sense of the turn: 1 is a platform set askew on its
        /// spindle, 2 a bearing that is not round.
        wobble_harmonic: u32 = 1, in 1..=2;
    }
}

table! {
    /// How the gyro sits on the platform. Misalignment turns the whole case of an assembly by the least
    /// rotation that takes the normal to its place.
    pub struct MountingConfig {
        /// Angle between the input axis of the gyro and the platform normal. Source of the default: none.
        misalignment_arcsec: f64 = 0.0, in 0.0..=648_000.0, "arcsec";
        /// Direction in which the input axis leans: right-handed about the normal, from the platform's mark.
        misalignment_azimuth_deg: f64 = 0.0, in -360.0..=360.0, "deg";
        /// Table angle at the start of the warm-up.
        start_angle_deg: f64 = 0.0, in -360.0..=360.0, "deg";
        /// Axis of a three-axis assembly's case that lies along the platform normal (a single gyro has no
        /// other axis). The two that follow it in the cycle x, y, z, x point along the platform's mark and a
        /// quarter turn, right-handed, from it.
        axis_along_table: CaseAxis = "z";
    }
}
