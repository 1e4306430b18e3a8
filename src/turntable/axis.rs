//! Where the table axis points, and how much of the Earth's rotation it sees.

use std::f64::consts::PI;

use crate::turntable::{AxisConfig, MountingConfig, SiteConfig, TurntableConfig};
use crate::units::{EARTH_RATE_RAD_PER_S, arcsec_to_rad, deg_to_rad};

/// A vector in the frame that the place of use names.
pub(super) type Vector = [f64; 3];

/// Projection of the Earth's rotation on the nominal table axis, rad/s.
///
/// In local north, east, up coordinates the Earth turns at `OmegaE (cos lat, 0, sin lat)` and an
/// axis of elevation `el` and azimuth `az` (from north towards east) points along
/// `(cos el cos az, cos el sin az, sin el)`, so that
/// `Omega = OmegaE (cos lat cos el cos az + sin lat sin el)`.
/// A vertical axis sees `15.0411 sin(lat)` deg/h; a horizontal one pointing east sees nothing.
///
/// # Source
/// Derived from the two vectors above; `OmegaE` is that of WGS 84. Known answer:
/// `known_answer_k28_earth_rate_on_a_vertical_axis`.
#[must_use]
pub fn earth_rate_rad_per_s(site: &SiteConfig) -> f64 {
    let latitude = deg_to_rad(site.latitude_deg);
    let elevation = deg_to_rad(site.axis_elevation_deg);
    let azimuth = deg_to_rad(site.axis_azimuth_deg);
    EARTH_RATE_RAD_PER_S
        * (latitude.cos() * elevation.cos() * azimuth.cos() + latitude.sin() * elevation.sin())
}

/// The Earth's rotation in the frame of the table, rad/s.
///
/// The frame is right-handed and does not turn: its third axis `a` is the mean table axis, the
/// nominal direction plus the two tilts, made a unit vector; its first axis is where the mark of
/// the platform points at table angle 0, the direction in which the elevation of the axis falls,
/// made perpendicular to `a`; its second axis is `a` times the first.
pub(super) fn earth_in_table_frame(site: &SiteConfig, axis: &AxisConfig) -> Vector {
    let (sin_elevation, cos_elevation) = deg_to_rad(site.axis_elevation_deg).sin_cos();
    let (sin_azimuth, cos_azimuth) = deg_to_rad(site.axis_azimuth_deg).sin_cos();
    // East, north, up: right-handed, unlike north, east, up.
    let third = unit([
        cos_elevation * sin_azimuth + arcsec_to_rad(axis.tilt_east_arcsec),
        cos_elevation * cos_azimuth + arcsec_to_rad(axis.tilt_north_arcsec),
        sin_elevation,
    ]);
    let falling = [
        sin_elevation * sin_azimuth,
        sin_elevation * cos_azimuth,
        -cos_elevation,
    ];
    let along = dot(falling, third);
    let first = unit([0, 1, 2].map(|i| falling[i] - along * third[i]));
    let second = cross(third, first);
    let (sin_latitude, cos_latitude) = deg_to_rad(site.latitude_deg).sin_cos();
    let earth = [
        0.0,
        EARTH_RATE_RAD_PER_S * cos_latitude,
        EARTH_RATE_RAD_PER_S * sin_latitude,
    ];
    [first, second, third].map(|axis| dot(axis, earth))
}

/// Rate on the input axis that turning of the table does not change, rad/s: the Earth's rotation
/// on the mean axis, if the input axis stays along it; `None` if it does not.
pub(super) fn fixed_earth_rate(config: &TurntableConfig) -> Option<f64> {
    let is_aligned =
        is_zero(config.axis.wobble_arcsec) && is_zero(config.mounting.misalignment_arcsec);
    let is_upright =
        is_zero(config.axis.tilt_north_arcsec) && is_zero(config.axis.tilt_east_arcsec);
    match (is_aligned, is_upright) {
        (true, true) => Some(earth_rate_rad_per_s(&config.site)),
        (true, false) => Some(earth_in_table_frame(&config.site, &config.axis)[2]),
        (false, _) => None,
    }
}

/// What the geometry makes of the table's motion at most; see [`input_axis_bounds`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct InputAxisBounds {
    /// Rate on the input axis over table rate, in magnitude.
    pub rate_ratio: f64,
    /// Acceleration on the input axis over the square of the table rate.
    pub acceleration_ratio: f64,
    /// The Earth's rate on the input axis in magnitude, rad/s.
    pub earth_rate_rad_per_s: f64,
    /// Change of the Earth's rate per radian of table angle, rad/s.
    pub earth_slope_rad_per_s: f64,
}

/// Bounds on what a gyro on this table sees, whatever the table angle.
///
/// With misalignment `mu` and wobble `w` of harmonic `k` the input axis stays within `mu + w` of
/// the mean axis, which itself is `gamma` away from the pole: the Earth's rate is at most
/// `OmegaE |cos(gamma +- (mu + w))|`. A table rate of 1 shows as at most
/// `|cos mu| (1 - k (1 - cos w)) + k sin mu sin w`.
#[must_use]
pub fn input_axis_bounds(config: &TurntableConfig) -> InputAxisBounds {
    if let Some(rate) = fixed_earth_rate(config) {
        return InputAxisBounds {
            rate_ratio: 1.0,
            acceleration_ratio: 0.0,
            earth_rate_rad_per_s: rate.abs(),
            earth_slope_rad_per_s: 0.0,
        };
    }
    let MountingConfig {
        misalignment_arcsec,
        ..
    } = config.mounting;
    let misalignment = arcsec_to_rad(misalignment_arcsec);
    let wobble = arcsec_to_rad(config.axis.wobble_arcsec);
    let harmonic = f64::from(config.axis.wobble_harmonic);
    let cone = misalignment + wobble;
    let axial = earth_in_table_frame(&config.site, &config.axis)[2] / EARTH_RATE_RAD_PER_S;
    let pole = axial.clamp(-1.0, 1.0).acos();
    let seen = if cone >= pole || cone >= PI - pole {
        1.0
    } else {
        (pole - cone).cos().abs().max((pole + cone).cos().abs())
    };
    let across = misalignment.sin() * wobble.sin();
    InputAxisBounds {
        rate_ratio: misalignment.cos().abs() * (1.0 - harmonic * (1.0 - wobble.cos()))
            + harmonic * across,
        acceleration_ratio: harmonic * (harmonic - 1.0) * across,
        earth_rate_rad_per_s: EARTH_RATE_RAD_PER_S * seen,
        earth_slope_rad_per_s: EARTH_RATE_RAD_PER_S
            * pole.sin()
            * (misalignment.sin() + harmonic * wobble.sin()),
    }
}

/// Whether a length or angle is exactly zero.
fn is_zero(value: f64) -> bool {
    value.abs() <= 0.0
}

/// Scalar product.
pub(super) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product.
pub(super) fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The unit vector along a vector that is not zero.
fn unit(vector: Vector) -> Vector {
    let length = dot(vector, vector).sqrt();
    vector.map(|component| component / length)
}
