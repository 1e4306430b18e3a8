//! Second-order effects of modulator and ramp, in closed form.

use std::f64::consts::TAU;

use crate::gyro::optics::coil::Coil;
use crate::gyro::thermal::condition::Condition;
use crate::gyro::{GyroConfig, ModulationScheme, ResetSample};
use crate::units::{MICRO, deg_per_h_to_rad_per_s, deg_to_rad};

/// Settings of the second-order effects, SI, as both models use them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::gyro) struct Optics {
    pub(in crate::gyro) scheme: ModulationScheme,
    /// Applied over commanded phase, less one, before any correction.
    pub(in crate::gyro) gain_error: f64,
    pub(in crate::gyro) is_reset_blanked: bool,
    pub(in crate::gyro) second_loop_gain: f64,
    pub(in crate::gyro) coupling_rad: f64,
    pub(in crate::gyro) coupling_phase_rad: f64,
    pub(in crate::gyro) dither_rad: f64,
    pub(in crate::gyro) dither_interval_periods: u32,
    /// Half period over transit time, less one.
    pub(in crate::gyro) mismatch: f64,
    /// Share of a half period that the averaged spikes take; 0 if they are gated.
    pub(in crate::gyro) gap_share: f64,
    pub(in crate::gyro) intensity_modulation: f64,
    /// Step of the ramp's register as applied, rad; 0 = ideal.
    pub(in crate::gyro) step_lsb_rad: f64,
    /// Largest step, rad; infinite if not limited.
    pub(in crate::gyro) step_limit_rad: f64,
}

impl Optics {
    /// The effects of a configuration.
    pub(in crate::gyro) fn new(config: &GyroConfig) -> Self {
        let modulator = &config.modulator;
        let controller = &config.controller;
        let mismatch = modulator.half_period_mismatch;
        Self {
            scheme: modulator.scheme,
            gain_error: modulator.gain_error_ppm * MICRO,
            is_reset_blanked: modulator.reset_sample == ResetSample::Blanked,
            second_loop_gain: controller.second_loop_gain,
            coupling_rad: modulator.cross_coupling_urad * MICRO,
            coupling_phase_rad: deg_to_rad(modulator.cross_coupling_phase_deg),
            dither_rad: deg_to_rad(modulator.dither_deg),
            dither_interval_periods: modulator.dither_interval_periods,
            mismatch,
            gap_share: if config.detector.gate_spikes {
                0.0
            } else {
                spike_share(mismatch)
            },
            intensity_modulation: modulator.intensity_modulation,
            step_lsb_rad: if controller.step_bits > 0 {
                TAU / 2.0_f64.powi(controller.step_bits.cast_signed())
            } else {
                0.0
            },
            step_limit_rad: if controller.step_limit_deg > 0.0 {
                deg_to_rad(controller.step_limit_deg)
            } else {
                f64::INFINITY
            },
        }
    }

    /// Whether any effect is on that the plain kernel leaves out.
    pub(in crate::gyro) fn is_needed(&self) -> bool {
        self.scheme != ModulationScheme::TwoState
            || self.gain_error != 0.0
            || self.is_reset_blanked
            || self.second_loop_gain > 0.0
            || self.coupling_rad > 0.0
            || self.dither_rad > 0.0
            || self.gap_share > 0.0
            || self.step_lsb_rad > 0.0
            || self.step_limit_rad.is_finite()
    }

    /// Share of the loop periods that reaches the integrator when the ramp rests.
    pub(in crate::gyro) fn update_share(&self) -> f64 {
        if self.dither_rad > 0.0 {
            1.0 - f64::from(self.dither_interval_periods).recip()
        } else {
            1.0
        }
    }

    /// Mean register per Sagnac phase at a modulator gain error, with resets.
    ///
    /// A reset leaves `d = 2 pi eps` in one half period. Blanked, the loop balances
    /// `phi_s = (1 + eps) r`. Demodulated, each turn of the ramp adds `sin d` to the balance:
    /// `phi_s = (1 + eps) r - sin(d) r / 2 pi`, a scale factor right to the third order in d.
    pub(in crate::gyro) fn scale(&self, gain_error: f64) -> f64 {
        let excess = if self.is_reset_blanked {
            gain_error
        } else {
            gain_error - (TAU * gain_error).sin() / TAU
        };
        (1.0 + excess).recip()
    }

    /// Register that intensity modulation of the averaged spikes adds, rad.
    ///
    /// `-m w (1 + V cos phi_s) / ((1 - w) V sin phi_m)` with w the share of the spikes: in a spike
    /// both passes see the same bias state s, so that the power `P0 (1 + V cos phi_s)` carries
    /// `1 + m s` of it, while in a plateau the two passes see opposite states and it cancels. The
    /// spike has the state of its own half period for either sign of the mismatch, so that the
    /// sign of the bias is that of -m. For V = 1 and a small mismatch: `2 m |delta| / sin phi_m`.
    pub(in crate::gyro) fn intensity_bias_rad(
        &self,
        visibility: f64,
        depth_rad: f64,
        phase_rad: f64,
    ) -> f64 {
        let share = self.gap_share / (1.0 - self.gap_share);
        -self.intensity_modulation * share * (1.0 + visibility * phase_rad.cos())
            / (visibility * depth_rad.sin())
    }
}

/// Share of a half period `T_h = tau (1 + delta)` in which both passes see the same state.
///
/// A state meets its opposite for tau if the half period is longer, for `2 T_h - tau` if it is
/// shorter; `|T_h - tau| / T_h` is left, with full power on the detector (a spike).
#[must_use]
pub fn spike_share(mismatch: f64) -> f64 {
    mismatch.abs() / (1.0 + mismatch)
}

/// Mean output rate at a constant input rate in the long run, noise apart, rad/s.
///
/// In the condition of the start: its temperature gives scale factor, bias and half-wave voltage.
///
/// * **Dead band.** An error phase `a sin(u + theta)` of the ramp u makes
///   `tau du/dt = phi_s + a sin(u + theta)`, Adler's equation: u stands still for
///   `|phi_s| <= a`, else its mean step is `sgn(phi_s) sqrt(phi_s^2 - a^2)`. Ramp dither removes it.
/// * **Modulator gain** eps: `1 / (1 + eps)` if resets are blanked, else
///   `1 / (1 + (d - sin d) / 2 pi)` with `d = 2 pi eps`; 1 once a second loop has settled.
/// * **Spikes** averaged with intensity modulation: a bias.
///
/// # Source
/// Adler, A study of locking phenomena in oscillators, Proc. IRE 34 (1946); the rest derived.
/// Known answers K8 and K11.
#[must_use]
pub fn expected_mean_rate_rad_per_s(config: &GyroConfig, rate_rad_per_s: f64) -> f64 {
    let optics = Optics::new(config);
    let condition = Condition::at_start(config);
    let scale_factor_s = Coil::new(&config.coil, &config.source).scale_factor_s;
    let bias_rad_per_s =
        condition.bias_rad_per_s + deg_per_h_to_rad_per_s(config.slow_noise.bias_deg_per_h);
    let phase_rad = scale_factor_s * condition.scale_ratio * (rate_rad_per_s + bias_rad_per_s);
    let dead_rad = if optics.dither_rad > 0.0 {
        0.0
    } else {
        optics.coupling_rad
    };
    let beat_rad = (phase_rad * phase_rad - dead_rad * dead_rad)
        .max(0.0)
        .sqrt()
        .copysign(phase_rad);
    let gain_error = if optics.second_loop_gain > 0.0 {
        0.0
    } else {
        (1.0 + optics.gain_error) * (1.0 + condition.modulator_gain_error) - 1.0
    };
    let bias_rad = optics.intensity_bias_rad(
        config.source.visibility,
        deg_to_rad(config.modulator.depth_deg),
        phase_rad,
    );
    (beat_rad * optics.scale(gain_error) + bias_rad) / scale_factor_s
}

/// Advance of the ramp over `time` half periods under `du/dt = phi + a sin u`, rad.
///
/// With `tan(u/2) = p/q` the equation is linear, `p' = (a p + phi q) / 2`,
/// `q' = -(phi p + a q) / 2`; the square of its matrix is `(a^2 - phi^2) / 4` times the unit
/// matrix, so that its exponential is a sine and cosine, or their hyperbolic twins. Outside the
/// dead band the half angle turns by pi in every half cycle, which counts the turns.
pub(in crate::gyro) fn adler_advance_rad(
    start_rad: f64,
    phase_rad: f64,
    dead_rad: f64,
    time: f64,
) -> f64 {
    let (p, q) = (0.5 * start_rad).sin_cos();
    let square = 0.25 * (phase_rad * phase_rad - dead_rad * dead_rad);
    let (turns, even, odd) = if square > 0.0 {
        let omega = square.sqrt();
        let cycles = (omega * time / std::f64::consts::PI).floor();
        let left = omega * time - cycles * std::f64::consts::PI;
        (cycles.copysign(phase_rad), left.cos(), left.sin() / omega)
    } else if square < 0.0 {
        let kappa = (-square).sqrt();
        (0.0, 1.0, (kappa * time).tanh() / kappa)
    } else {
        (0.0, 1.0, time)
    };
    let p_end = even * p + 0.5 * odd * (dead_rad * p + phase_rad * q);
    let q_end = even * q - 0.5 * odd * (phase_rad * p + dead_rad * q);
    let half = (p_end * q - q_end * p).atan2(q_end * q + p_end * p);
    2.0 * half + TAU * turns
}

#[cfg(test)]
mod tests {
    use super::adler_advance_rad;

    #[test]
    fn adler_advance_solves_the_differential_equation() {
        for (start, phase, dead, time) in [
            (0.3, 1.0, 0.2, 25.0),
            (2.0, -0.7, 0.3, 40.0),
            (-1.0, 0.1, 0.2, 7.0),
            (4.0, -0.05, 0.2, 12.0),
            (1.0, 0.2, 0.2, 3.0),
            (0.0, 0.4, 0.0, 33.0),
        ] {
            // Classical Runge-Kutta, global error of order h^4.
            let steps = 20_000_u32;
            let h = time / f64::from(steps);
            let slope = |u: f64| phase + dead * u.sin();
            let mut u = start;
            for _ in 0..steps {
                let k1 = slope(u);
                let k2 = slope(u + 0.5 * h * k1);
                let k3 = slope(u + 0.5 * h * k2);
                let k4 = slope(u + h * k3);
                u += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
            }
            let advance = adler_advance_rad(start, phase, dead, time);
            assert!((advance - (u - start)).abs() < 1e-9, "{advance} {u}");
        }
    }
}
