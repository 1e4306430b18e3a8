//! Settings of the servo.

use super::rest::StaticConfig;
use crate::declare::{alternatives, table};

alternatives! {
    /// How the table follows its command.
    pub enum ServoConfig, one "servo", first by default {
        /// The axis is the command.
        Ideal(StaticConfig) = "ideal",
        SecondOrder(SecondOrderServoConfig) = "second_order",
        DirectDrive(DirectDriveServoConfig) = "direct_drive",
    }
}

table! {
    /// Second-order low pass from commanded to actual rate.
    pub struct SecondOrderServoConfig {
        /// Natural frequency of H(s) = wn^2 / (s^2 + 2 zeta wn s + wn^2), wn / 2 pi.
        natural_frequency_hz: f64, example 50.0, in 1e-3..=10000.0, "Hz";
        /// Damping ratio zeta.
        damping_ratio: f64, example 0.7, in 1e-3..=10.0;
    }
}

table! {
    /// A direct-drive motor with friction, steered by a sampled controller that reads the encoder below
    /// (an ideal one without it). Sources of the defaults: assumed, as of a table of some 0.3 m, where
    /// nothing else is said.
    pub struct DirectDriveServoConfig {
        /// Moment of inertia J of axis, table and load.
        inertia_kg_m2: f64 = 0.05, in 1e-6..=1000.0, "kg m^2";
        /// Natural frequency of the position loop, wn / 2 pi; Kp = J wn^2.
        natural_frequency_hz: f64 = 40.0, in 1e-3..=1000.0, "Hz";
        /// Damping ratio zeta of the position loop; Kd = 2 zeta wn J.
        damping_ratio: f64 = 0.7, in 1e-3..=10.0;
        /// Integral gain over Kp wn; stable below twice the damping ratio.
        integral_ratio: f64 = 0.1, in 0.0..=10.0;
        /// Commanded rate fed forward, in units of Kd. With this and the next at 0 the axis follows as the
        /// second-order servo does, with both at 1 exactly but for friction and the delays of the loop.
        rate_feed_forward: f64 = 1.0, in 0.0..=2.0;
        /// Commanded acceleration fed forward, in units of J.
        acceleration_feed_forward: f64 = 1.0, in 0.0..=2.0;
        /// Ticks of the position controller per second; at least 10 per cycle of the natural frequency.
        controller_rate_hz: f64 = 4000.0, in 1.0..=200000.0, "Hz";
        /// Corner of the low pass behind the difference of encoder readings.
        derivative_filter_hz: f64 = 1000.0, in 1e-3..=1e6, "Hz";
        /// Bandwidth of the first-order current loop. Source of the default: typical are 500 to 1000.
        current_loop_bandwidth_hz: f64 = 1000.0, in 1e-3..=100000.0, "Hz";
        /// Largest torque of the motor, torque constant times largest current; 2 N m turn the default
        /// inertia at 2292 deg/s^2. Steps of the command are not shaped: while they ask for more, the axis
        /// falls behind and overshoots to make up the angle.
        torque_limit_n_m: f64 = 2.0, in 1e-6..=1e6, "N m";
        /// Viscous friction.
        viscous_n_m_s_per_rad: f64 = 0.01, in 0.0..=1000.0, "N m s/rad";
        /// Coulomb friction.
        coulomb_n_m: f64 = 0.05, in 0.0..=1000.0, "N m";
        /// Static friction, at least the Coulomb friction.
        static_n_m: f64 = 0.07, in 0.0..=1000.0, "N m";
        /// Stribeck rate ws: friction falls from static to Coulomb as exp(-(w/ws)^2).
        stribeck_rate_rad_per_s: f64 = 1e-3, in 1e-9..=10.0, "rad/s";
        /// Rate w0 over which friction changes sign, tanh(w/w0); below it the axis creeps.
        friction_smoothing_rad_per_s: f64 = 1e-4, in 1e-9..=1.0, "rad/s";
        /// Amplitude of the cogging torque.
        cogging_n_m: f64 = 0.01, in 0.0..=1000.0, "N m";
        /// Periods of the cogging torque per revolution.
        cogging_per_revolution: u32 = 24, in 1..=100_000;
        /// Amplitude of the torque of an unbalanced load on a tilted axis; none on an upright one.
        unbalance_n_m: f64 = 0.0, in 0.0..=1000.0, "N m";
        /// Phase of that torque at angle 0.
        unbalance_phase_deg: f64 = 0.0, in -360.0..=360.0, "deg";
    }
}

impl DirectDriveServoConfig {
    /// Inverse time constant of smoothed friction about rest, `(Ts / w0 + b) / J`, 1/s.
    pub(crate) fn friction_stiffness_per_s(&self) -> f64 {
        let slope = self.static_n_m / self.friction_smoothing_rad_per_s;
        (slope + self.viscous_n_m_s_per_rad) / self.inertia_kg_m2
    }

    /// Largest torque that can act on the axis over its inertia, rad/s^2.
    pub(crate) fn acceleration_max_rad_per_s2(&self, rate_max_rad_per_s: f64) -> f64 {
        let drag = self.static_n_m + self.viscous_n_m_s_per_rad * rate_max_rad_per_s;
        let position = self.cogging_n_m + self.unbalance_n_m;
        (self.torque_limit_n_m + drag + position) / self.inertia_kg_m2
    }
}

#[cfg(test)]
impl DirectDriveServoConfig {
    /// 0.05 kg m^2 at 40 Hz and 4 kHz with nothing that disturbs it.
    pub(crate) fn frictionless() -> Self {
        Self {
            inertia_kg_m2: 0.05,
            natural_frequency_hz: 40.0,
            damping_ratio: 0.7,
            integral_ratio: 0.0,
            rate_feed_forward: 0.0,
            acceleration_feed_forward: 0.0,
            controller_rate_hz: 4000.0,
            derivative_filter_hz: 1000.0,
            current_loop_bandwidth_hz: 1000.0,
            torque_limit_n_m: 2.0,
            viscous_n_m_s_per_rad: 0.0,
            coulomb_n_m: 0.0,
            static_n_m: 0.0,
            stribeck_rate_rad_per_s: 1e-3,
            friction_smoothing_rad_per_s: 1e-4,
            cogging_n_m: 0.0,
            cogging_per_revolution: 24,
            unbalance_n_m: 0.0,
            unbalance_phase_deg: 0.0,
        }
    }
}
