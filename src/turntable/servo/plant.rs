//! Motor, current loop, inertia and the torques that disturb them.

use std::f64::consts::TAU;

use crate::turntable::DirectDriveServoConfig;
use crate::units::deg_to_rad;

/// Steps of the integrator per shortest time constant; see [`Plant::advance`].
const STEPS_PER_TIME_CONSTANT: f64 = 4.0;

/// What moves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    /// Angle, rad, whole turns counted.
    pub(super) angle: f64,
    /// rad/s.
    pub(super) rate: f64,
    /// Torque of the motor, N m.
    pub(super) torque: f64,
}

/// Constants of the motor and of what it turns.
///
/// ```text
/// J dw/dt = M - b w - [Tc + (Ts - Tc) exp(-(w/ws)^2)] tanh(w/w0)
///             - Tcog sin(n theta) - Tunb sin(theta + phase)
/// dM/dt   = 2 pi f_i (M_demanded - M)
/// ```
///
/// `M = Kt i` is the torque of the current; only the product enters. The friction is Stribeck's
/// curve, its jump at rest replaced by `tanh`: below `w0` the axis creeps instead of sticking,
/// at `w = w0 atanh(M / Ts)`.
///
/// # Source
/// Armstrong-Helouvry, Dupont and Canudas de Wit, "A survey of models, analysis tools and
/// compensation methods for the control of machines with friction", Automatica 30 (1994).
#[derive(Clone, Debug)]
pub(super) struct Plant {
    inertia: f64,
    viscous: f64,
    coulomb: f64,
    static_excess: f64,
    stribeck_rate: f64,
    smoothing_rate: f64,
    cogging: f64,
    cogging_per_turn: f64,
    unbalance: f64,
    unbalance_phase: f64,
    /// Bandwidth of the current loop, rad/s.
    current_bandwidth: f64,
    /// Fastest of friction and current loop, 1/s.
    stiffness: f64,
}

impl Plant {
    pub(super) fn new(config: &DirectDriveServoConfig) -> Self {
        let current_bandwidth = TAU * config.current_loop_bandwidth_hz;
        Self {
            inertia: config.inertia_kg_m2,
            viscous: config.viscous_n_m_s_per_rad,
            coulomb: config.coulomb_n_m,
            static_excess: config.static_n_m - config.coulomb_n_m,
            stribeck_rate: config.stribeck_rate_rad_per_s,
            smoothing_rate: config.friction_smoothing_rad_per_s,
            cogging: config.cogging_n_m,
            cogging_per_turn: f64::from(config.cogging_per_revolution),
            unbalance: config.unbalance_n_m,
            unbalance_phase: deg_to_rad(config.unbalance_phase_deg),
            current_bandwidth,
            stiffness: config.friction_stiffness_per_s().max(current_bandwidth),
        }
    }

    /// Torque against the motion at a steady rate, N m, but for cogging and unbalance.
    pub(super) fn drag(&self, rate: f64) -> f64 {
        let ratio = rate / self.stribeck_rate;
        let friction = self.coulomb + self.static_excess * (-ratio * ratio).exp();
        self.viscous * rate + friction * (rate / self.smoothing_rate).tanh()
    }

    /// rad/s^2.
    fn acceleration_at(&self, angle: f64, rate: f64, torque: f64) -> f64 {
        let position = self.cogging * (self.cogging_per_turn * angle).sin()
            + self.unbalance * (angle + self.unbalance_phase).sin();
        (torque - self.drag(rate) - position) / self.inertia
    }

    /// Present acceleration, rad/s^2.
    pub(super) fn acceleration(&self, axis: &Axis) -> f64 {
        self.acceleration_at(axis.angle, axis.rate, axis.torque)
    }

    /// Moves the axis on by `time_s` under a constant torque demand, N m.
    ///
    /// Classical Runge-Kutta of order four, the current loop by its exact exponential. Smoothed
    /// friction is stiff: about rest it has the time constant `J w0 / Ts`, 71 us with the default
    /// constants, and the method is stable on the real axis up to 2.785 of them. Steps are a
    /// quarter of the shortest of that, the current loop's and that of the passing cogs, so that
    /// the decay of one time constant errs by less than `4 (1/4)^5 / 120` = 3e-5 of it.
    pub(super) fn advance(&self, axis: &mut Axis, demand: f64, time_s: f64) {
        let passing = self.cogging_per_turn * axis.rate.abs();
        let fastest = self.stiffness.max(passing);
        let count = (STEPS_PER_TIME_CONSTANT * time_s * fastest).ceil().max(1.0);
        let step_s = time_s / count;
        let half_decay = (-0.5 * self.current_bandwidth * step_s).exp();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a rounded positive count; the cast saturates"
        )]
        let count = count as u64;
        for _ in 0..count {
            self.step(axis, demand, step_s, half_decay);
        }
    }

    fn step(&self, axis: &mut Axis, demand: f64, step_s: f64, half_decay: f64) {
        let half_s = 0.5 * step_s;
        let Axis {
            angle,
            rate,
            torque,
        } = *axis;
        let middle = demand + (torque - demand) * half_decay;
        let end = demand + (middle - demand) * half_decay;
        let slope1 = self.acceleration_at(angle, rate, torque);
        let rate2 = rate + half_s * slope1;
        let slope2 = self.acceleration_at(angle + half_s * rate, rate2, middle);
        let rate3 = rate + half_s * slope2;
        let slope3 = self.acceleration_at(angle + half_s * rate2, rate3, middle);
        let rate4 = rate + step_s * slope3;
        let slope4 = self.acceleration_at(angle + step_s * rate3, rate4, end);
        *axis = Axis {
            angle: angle + step_s / 6.0 * (rate + 2.0 * (rate2 + rate3) + rate4),
            rate: rate + step_s / 6.0 * (slope1 + 2.0 * (slope2 + slope3) + slope4),
            torque: end,
        };
    }
}
