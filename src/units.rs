//! Unit conversion: the only place that turns one unit into another.
//!
//! Invariant: no other module multiplies by 3600, 60 or pi/180 to change a unit. Names read
//! `<from>_to_<to>`; rates are `deg/h` or `deg/s` at the edges and `rad/s` inside the physics.

use std::f64::consts::PI;

/// Speed of light in vacuum, m/s (SI definition).
pub const SPEED_OF_LIGHT_M_PER_S: f64 = 299_792_458.0;
/// Elementary charge, C (SI definition).
pub const ELEMENTARY_CHARGE_C: f64 = 1.602_176_634e-19;
/// Boltzmann constant, J/K (SI definition).
pub const BOLTZMANN_J_PER_K: f64 = 1.380_649e-23;
/// Earth's rotation rate, rad/s (WGS 84).
pub const EARTH_RATE_RAD_PER_S: f64 = 7.292_115e-5;
/// Seconds in an hour.
pub const SECONDS_PER_HOUR: f64 = 3600.0;
/// Zero degrees Celsius in kelvin.
pub const ZERO_CELSIUS_K: f64 = 273.15;
/// One radian per root second as an angle random walk: `180/pi * 60` deg/sqrt(h).
pub const RAD_PER_SQRT_S_IN_DEG_PER_SQRT_H: f64 = 180.0 / PI * 60.0;

/// Converts an angle from degrees to radians.
#[must_use]
pub fn deg_to_rad(angle_deg: f64) -> f64 {
    angle_deg * (PI / 180.0)
}

/// Converts an angle from radians to degrees.
#[must_use]
pub fn rad_to_deg(angle_rad: f64) -> f64 {
    angle_rad * (180.0 / PI)
}

/// Converts an angle from arcseconds to radians.
#[must_use]
pub fn arcsec_to_rad(angle_arcsec: f64) -> f64 {
    deg_to_rad(angle_arcsec / 3600.0)
}

/// Converts an angle from radians to arcseconds.
#[must_use]
pub fn rad_to_arcsec(angle_rad: f64) -> f64 {
    rad_to_deg(angle_rad) * 3600.0
}

/// Converts a rate from deg/s to rad/s.
#[must_use]
pub fn deg_per_s_to_rad_per_s(rate_deg_per_s: f64) -> f64 {
    deg_to_rad(rate_deg_per_s)
}

/// Converts a rate from rad/s to deg/s.
#[must_use]
pub fn rad_per_s_to_deg_per_s(rate_rad_per_s: f64) -> f64 {
    rad_to_deg(rate_rad_per_s)
}

/// Converts a rate from rad/s to deg/h.
#[must_use]
pub fn rad_per_s_to_deg_per_h(rate_rad_per_s: f64) -> f64 {
    rad_to_deg(rate_rad_per_s) * SECONDS_PER_HOUR
}

/// Converts a rate from deg/h to rad/s.
#[must_use]
pub fn deg_per_h_to_rad_per_s(rate_deg_per_h: f64) -> f64 {
    deg_to_rad(rate_deg_per_h) / SECONDS_PER_HOUR
}

/// Converts a rate from deg/s to deg/h.
#[must_use]
pub fn deg_per_s_to_deg_per_h(rate_deg_per_s: f64) -> f64 {
    rate_deg_per_s * SECONDS_PER_HOUR
}

/// Converts a rate from mdeg/s to deg/h.
#[must_use]
pub fn mdeg_per_s_to_deg_per_h(rate_mdeg_per_s: f64) -> f64 {
    deg_per_s_to_deg_per_h(rate_mdeg_per_s * MILLI)
}

/// Converts a rate from rad/h to deg/h.
#[must_use]
pub fn rad_per_h_to_deg_per_h(rate_rad_per_h: f64) -> f64 {
    rad_to_deg(rate_rad_per_h)
}

/// Converts a rate from deg/h to deg/s.
#[must_use]
pub fn deg_per_h_to_deg_per_s(rate_deg_per_h: f64) -> f64 {
    rate_deg_per_h / SECONDS_PER_HOUR
}

/// Converts a rate from deg/h to arcsec/s: the same number, as both divide by 3600.
#[must_use]
pub fn deg_per_h_to_arcsec_per_s(rate_deg_per_h: f64) -> f64 {
    rate_deg_per_h
}

/// Converts a rate from arcsec/s to deg/h: the same number, as both divide by 3600.
#[must_use]
pub fn arcsec_per_s_to_deg_per_h(rate_arcsec_per_s: f64) -> f64 {
    rate_arcsec_per_s
}

/// Converts an angle random walk from rad/sqrt(s) to deg/sqrt(h).
#[must_use]
pub fn rad_per_sqrt_s_to_deg_per_sqrt_h(random_walk_rad_per_sqrt_s: f64) -> f64 {
    random_walk_rad_per_sqrt_s * RAD_PER_SQRT_S_IN_DEG_PER_SQRT_H
}

/// Converts an angle random walk from deg/sqrt(h) to rad/sqrt(s).
#[must_use]
pub fn deg_per_sqrt_h_to_rad_per_sqrt_s(random_walk_deg_per_sqrt_h: f64) -> f64 {
    random_walk_deg_per_sqrt_h / RAD_PER_SQRT_S_IN_DEG_PER_SQRT_H
}

/// Converts an angle random walk from (deg/h) sqrt(s) to deg/sqrt(h).
///
/// `N` read off an Allan deviation in deg/h at 1 s carries the unit (deg/h) sqrt(s).
#[must_use]
pub fn deg_per_h_sqrt_s_to_deg_per_sqrt_h(random_walk_deg_per_h_sqrt_s: f64) -> f64 {
    random_walk_deg_per_h_sqrt_s / 60.0
}

/// Converts an angle random walk from deg/sqrt(h) to (deg/h) sqrt(s).
#[must_use]
pub fn deg_per_sqrt_h_to_deg_per_h_sqrt_s(random_walk_deg_per_sqrt_h: f64) -> f64 {
    random_walk_deg_per_sqrt_h * 60.0
}

/// Converts a rate random walk from (deg/h)/sqrt(s) to deg/h/sqrt(h).
#[must_use]
pub fn deg_per_h_per_sqrt_s_to_deg_per_h_per_sqrt_h(walk_deg_per_h_per_sqrt_s: f64) -> f64 {
    walk_deg_per_h_per_sqrt_s * 60.0
}

/// Converts a rate random walk from deg/h/sqrt(h) to (deg/h)/sqrt(s).
#[must_use]
pub fn deg_per_h_per_sqrt_h_to_deg_per_h_per_sqrt_s(walk_deg_per_h_per_sqrt_h: f64) -> f64 {
    walk_deg_per_h_per_sqrt_h / 60.0
}

/// Converts a rate ramp from (deg/h)/s to deg/h/h.
#[must_use]
pub fn deg_per_h_per_s_to_deg_per_h_per_h(ramp_deg_per_h_per_s: f64) -> f64 {
    ramp_deg_per_h_per_s * SECONDS_PER_HOUR
}

/// Converts a rate ramp from deg/h/h to (deg/h)/s.
#[must_use]
pub fn deg_per_h_per_h_to_deg_per_h_per_s(ramp_deg_per_h_per_h: f64) -> f64 {
    ramp_deg_per_h_per_h / SECONDS_PER_HOUR
}

/// Converts a ratio to parts per million.
#[must_use]
pub fn ratio_to_ppm(ratio: f64) -> f64 {
    ratio * 1e6
}

/// Converts a gain of amplitude to decibels.
#[must_use]
pub fn gain_to_db(gain: f64) -> f64 {
    20.0 * gain.log10()
}

/// Converts a time from seconds to milliseconds.
#[must_use]
pub fn s_to_ms(time_s: f64) -> f64 {
    time_s * 1e3
}

/// Converts a time from seconds to microseconds.
#[must_use]
pub fn s_to_us(time_s: f64) -> f64 {
    time_s * 1e6
}

/// Converts a time from milliseconds to seconds.
#[must_use]
pub fn ms_to_s(time_ms: f64) -> f64 {
    time_ms * 1e-3
}

/// Time, us -> s.
#[inline]
#[must_use]
pub fn us_to_s(time_us: f64) -> f64 {
    time_us * 1e-6
}

/// Converts a frequency from Hz to kHz.
#[must_use]
pub fn hz_to_khz(frequency_hz: f64) -> f64 {
    frequency_hz * 1e-3
}

/// Converts a temperature from degrees Celsius to kelvin.
#[must_use]
pub fn celsius_to_kelvin(temperature_c: f64) -> f64 {
    temperature_c + ZERO_CELSIUS_K
}

/// Converts a temperature rate from K/min to K/s.
#[must_use]
pub fn k_per_min_to_k_per_s(rate_k_per_min: f64) -> f64 {
    rate_k_per_min / 60.0
}

/// Converts a temperature rate from K/s to K/min.
#[must_use]
pub fn k_per_s_to_k_per_min(rate_k_per_s: f64) -> f64 {
    rate_k_per_s * 60.0
}

/// Converts an angle from rad to urad, and its densities likewise.
#[must_use]
pub fn rad_to_urad(angle_rad: f64) -> f64 {
    angle_rad * 1e6
}

/// SI prefix pico.
pub const PICO: f64 = 1e-12;
/// SI prefix nano.
pub const NANO: f64 = 1e-9;
/// SI prefix micro.
pub const MICRO: f64 = 1e-6;
/// SI prefix milli.
pub const MILLI: f64 = 1e-3;
/// SI prefix kilo.
pub const KILO: f64 = 1e3;
