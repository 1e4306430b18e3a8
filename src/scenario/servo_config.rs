//! The configuration of a direct-drive servo and of the encoder.

use serde::Deserialize;

/// Motor, friction and a sampled position controller.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DirectDriveServoConfig {
    /// Moment of inertia of axis, table and load J, kg m^2.
    pub inertia_kg_m2: f64,
    /// Natural frequency `wn / 2 pi` the gains are made for, Hz: `Kp = J wn^2`.
    pub natural_frequency_hz: f64,
    /// Damping ratio zeta the gains are made for: `Kd = 2 zeta wn J`.
    pub damping_ratio: f64,
    /// Integral gain over `Kp wn`.
    pub integral_ratio: f64,
    /// Commanded rate fed forward, in units of `Kd`.
    pub rate_feed_forward: f64,
    /// Commanded acceleration fed forward, in units of J.
    pub acceleration_feed_forward: f64,
    /// Ticks of the controller per second, Hz.
    pub controller_rate_hz: f64,
    /// Corner of the low pass behind the difference of readings, Hz.
    pub derivative_filter_hz: f64,
    /// Bandwidth of the current loop, Hz.
    pub current_loop_bandwidth_hz: f64,
    /// Largest torque of the motor, N m.
    pub torque_limit_n_m: f64,
    /// Viscous friction b, N m s/rad.
    pub viscous_n_m_s_per_rad: f64,
    /// Coulomb friction Tc, N m.
    pub coulomb_n_m: f64,
    /// Static friction Ts, N m.
    pub static_n_m: f64,
    /// Stribeck rate ws, rad/s.
    pub stribeck_rate_rad_per_s: f64,
    /// Rate w0 over which friction changes sign, rad/s.
    pub friction_smoothing_rad_per_s: f64,
    /// Amplitude of the cogging torque, N m.
    pub cogging_n_m: f64,
    /// Cogs per revolution.
    pub cogging_per_revolution: u32,
    /// Amplitude of the unbalance torque, N m.
    pub unbalance_n_m: f64,
    /// Phase of the unbalance torque at angle 0, deg.
    pub unbalance_phase_deg: f64,
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

/// Angle encoder of the table: there is one if it has a resolution.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EncoderConfig {
    /// Least step it shows, arcsec; 0 = none.
    pub resolution_arcsec: Option<f64>,
    /// Age of the angle it shows, us.
    pub latency_us: f64,
    /// Amplitude of the error once per revolution, arcsec.
    pub eccentricity_error_arcsec: f64,
    /// Phase of that error at angle 0, deg.
    pub eccentricity_phase_deg: f64,
    /// Amplitude of the error once per line, arcsec.
    pub interpolation_error_arcsec: f64,
    /// Phase of that error at angle 0, deg.
    pub interpolation_phase_deg: f64,
    /// Lines of the disc.
    pub lines_per_revolution: u32,
}
