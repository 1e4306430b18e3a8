//! The sampled position controller of a direct drive.

use std::f64::consts::TAU;

use crate::turntable::DirectDriveServoConfig;

/// What the axis is told at one instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setpoint {
    /// rad.
    pub(super) angle: f64,
    /// rad/s.
    pub(super) rate: f64,
    /// rad/s^2.
    pub(super) acceleration: f64,
}

/// Gains and limits.
#[derive(Clone, Debug)]
struct Gains {
    /// N m per rad.
    proportional: f64,
    /// N m per rad and sample.
    integral: f64,
    /// N m per rad/s.
    derivative: f64,
    /// N m per rad/s of command.
    rate_forward: f64,
    /// N m per rad/s^2 of command.
    acceleration_forward: f64,
    /// Largest torque, N m.
    torque_limit: f64,
    period_s: f64,
    /// Share of a new difference that enters the rate estimate.
    derivative_share: f64,
}

/// PID controller of position with feed-forward of rate and acceleration.
///
/// ```text
/// M = Kp (c - y) + Ki sum (c - y) T + Kd (rate_feed_forward c' - y') + acceleration_feed_forward J c''
/// Kp = J wn^2,  Kd = 2 zeta wn J,  Ki = integral_ratio Kp wn
/// ```
///
/// `y'` is the difference of two readings over a period, through a first-order low pass. It acts
/// on the reading alone, so that without friction, integral part and feed-forward the axis follows
/// by `wn^2 / (s^2 + 2 zeta wn s + wn^2)`, and with both feed-forwards at 1 exactly, but for the
/// delays of sampling, current loop and low pass. While the torque is limited the integral part
/// takes nothing that would limit it further (conditional integration).
///
/// # Source
/// Astrom and Hagglund, "Advanced PID Control", 2006, sections 3.5 (anti-windup) and 3.4 (weighted
/// command); gains by comparing coefficients of `J y'' = M`.
#[derive(Clone, Debug)]
pub(super) struct Controller {
    gains: Gains,
    /// Reading at the tick before, rad.
    reading: f64,
    /// Estimated rate, rad/s.
    rate: f64,
    /// Integral part, N m.
    integral: f64,
}

impl Controller {
    /// A controller that has held `rate` (rad/s) against `drag` (N m) for ever.
    ///
    /// * `reading`: what the encoder showed one period before the first tick, rad.
    pub(super) fn new(config: &DirectDriveServoConfig, reading: f64, rate: f64, drag: f64) -> Self {
        let natural = TAU * config.natural_frequency_hz;
        let proportional = config.inertia_kg_m2 * natural * natural;
        let derivative = 2.0 * config.damping_ratio * natural * config.inertia_kg_m2;
        let period_s = 1.0 / config.controller_rate_hz;
        let gains = Gains {
            proportional,
            integral: config.integral_ratio * proportional * natural * period_s,
            derivative,
            rate_forward: config.rate_feed_forward * derivative,
            acceleration_forward: config.acceleration_feed_forward * config.inertia_kg_m2,
            torque_limit: config.torque_limit_n_m,
            period_s,
            derivative_share: 1.0 - (-TAU * config.derivative_filter_hz * period_s).exp(),
        };
        Self {
            integral: drag + (gains.derivative - gains.rate_forward) * rate,
            gains,
            reading,
            rate,
        }
    }

    /// Torque demand until the next tick, N m.
    pub(super) fn demand(&mut self, setpoint: &Setpoint, reading: f64) -> f64 {
        let gains = &self.gains;
        let difference = (reading - self.reading) / gains.period_s;
        self.reading = reading;
        self.rate += gains.derivative_share * (difference - self.rate);
        let error = setpoint.angle - reading;
        let integral = self.integral + gains.integral * error;
        let wanted = gains.proportional * error + integral - gains.derivative * self.rate
            + gains.rate_forward * setpoint.rate
            + gains.acceleration_forward * setpoint.acceleration;
        let torque = wanted.clamp(-gains.torque_limit, gains.torque_limit);
        let winds_up = (wanted - torque) * error > 0.0;
        if !winds_up {
            self.integral = integral;
        }
        torque
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_integral_part_does_not_wind_up_while_the_torque_is_limited() {
        let config = DirectDriveServoConfig {
            torque_limit_n_m: 1.0,
            integral_ratio: 0.5,
            ..DirectDriveServoConfig::frictionless()
        };
        let mut controller = Controller::new(&config, 0.0, 0.0, 0.0);
        let at = |angle| Setpoint {
            angle,
            rate: 0.0,
            acceleration: 0.0,
        };
        // One radian asks for J wn^2 = 3158 N m, three thousand times the limit, for a second.
        for _ in 0..4000 {
            assert!((controller.demand(&at(1.0), 0.0) - 1.0).abs() < 1e-15);
        }
        assert!(controller.integral.abs() < 1e-15, "{controller:?}");
        // Once the error is gone nothing is left to unwind.
        assert!(controller.demand(&at(0.0), 0.0).abs() < 1e-15);
        // Within the limit it integrates: Ki e T = 0.5 J wn^3 x 1e-6 rad / 4000 Hz.
        controller.demand(&at(1e-6), 0.0);
        let expected = 0.5 * 0.05 * (TAU * 40.0_f64).powi(3) * 1e-6 / 4000.0;
        assert!((controller.integral - expected).abs() < 1e-12 * expected.abs());
    }
}
