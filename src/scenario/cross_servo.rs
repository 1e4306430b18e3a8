//! Checks across the values of servo and encoder.

use crate::units::s_to_us;

use super::resolved::Resolved;
use crate::turntable::DirectDriveServoConfig;
use crate::turntable::ServoConfig;
use crate::wording::number;

/// Fewest ticks of the controller per cycle of its natural frequency: at ten, sampling alone turns
/// the phase of the loop by 36 deg.
const TICKS_PER_CYCLE_MIN: f64 = 10.0;

/// Stiffest friction that is integrated, 1/s: four steps per time constant are 4e6 a second.
const FRICTION_STIFFNESS_MAX_PER_S: f64 = 1e6;

/// Keys to blame, with the complaints.
pub(crate) fn check(resolved: &Resolved) -> Vec<(String, String)> {
    let mut errors = Vec::new();
    let turntable = &resolved.scenario.turntable;
    if let ServoConfig::DirectDrive(servo) = &turntable.servo {
        check_friction(servo, &mut errors);
        check_loop(servo, turntable.encoder.latency_us, &mut errors);
    }
    errors
}

fn servo_key(key: &str) -> String {
    format!("turntable.servo.direct_drive.{key}")
}

fn check_friction(servo: &DirectDriveServoConfig, errors: &mut Vec<(String, String)>) {
    if servo.static_n_m < servo.coulomb_n_m {
        let path = servo_key("static_n_m");
        let message = format!(
            "{path} = {:?} N m is below coulomb_n_m = {:?} N m: friction at rest is the larger",
            servo.static_n_m, servo.coulomb_n_m
        );
        errors.push((path, message));
    }
    let stiffness = servo.friction_stiffness_per_s();
    if stiffness > FRICTION_STIFFNESS_MAX_PER_S {
        let path = servo_key("friction_smoothing_rad_per_s");
        let message = format!(
            "{path} = {:?} rad/s is too small: friction would settle in {:.3e} us, allowed from \
             {} us; J / (static_n_m / friction_smoothing_rad_per_s + viscous_n_m_s_per_rad) is \
             that time",
            servo.friction_smoothing_rad_per_s,
            s_to_us(1.0 / stiffness),
            s_to_us(1.0 / FRICTION_STIFFNESS_MAX_PER_S)
        );
        errors.push((path, message));
    }
}

fn check_loop(servo: &DirectDriveServoConfig, latency_us: f64, errors: &mut Vec<(String, String)>) {
    let ticks_per_cycle = servo.controller_rate_hz / servo.natural_frequency_hz;
    if ticks_per_cycle < TICKS_PER_CYCLE_MIN {
        let path = servo_key("controller_rate_hz");
        let message = format!(
            "{path} = {:?} Hz is too slow: a natural frequency of {:?} Hz needs \
             {TICKS_PER_CYCLE_MIN} ticks a cycle",
            servo.controller_rate_hz, servo.natural_frequency_hz
        );
        errors.push((path, message));
    }
    // Routh: J s^3 + Kd s^2 + Kp s + Ki has its roots on the left if Kd Kp > J Ki.
    if servo.integral_ratio >= 2.0 * servo.damping_ratio {
        let path = servo_key("integral_ratio");
        let message = format!(
            "{path} = {:?} is unstable: it must stay below 2 damping_ratio = {}",
            servo.integral_ratio,
            number(2.0 * servo.damping_ratio)
        );
        errors.push((path, message));
    }
    let period_us = s_to_us(1.0 / servo.controller_rate_hz);
    if latency_us > period_us {
        let path = "turntable.encoder.latency_us".to_owned();
        let message = format!(
            "{path} = {latency_us:?} us is longer than a tick of the servo that reads the \
             encoder: allowed up to {} us",
            number(period_us)
        );
        errors.push((path, message));
    }
}
