//! Three gyros in one case, as patent CN101221046 models them.

use crate::gyro::error::GyroError;
use crate::gyro::instrument::Gyro;
use crate::gyro::{AssemblyConfig, Fidelity, GyroConfig};
use crate::random::Streams;
use crate::signal::MotionSegment;
use crate::units::{MICRO, arcsec_to_rad, deg_per_h_to_rad_per_s};

/// Names of the case axes; the noise streams of each gyro are named after its axis.
const AXES: [&str; 3] = ["x", "y", "z"];

/// What the input axis of one gyro makes of the rates about the case axes.
///
/// Row i of `Wm = (I + K_G + theta_G) W + B_G`, with W the inertial rates about the case axes,
/// `K_G = diag(K_x, K_y, K_z)` the scale-factor errors, `B_G` the biases and
///
/// ```text
///           |     0      theta_xz  -theta_xy |
/// theta_G = | -theta_yz      0      theta_yx |
///           |  theta_zy  -theta_zx      0    |
/// ```
///
/// Signs: a right-hand rotation by a small angle `theta_ij` about case axis j takes the input axis
/// `e_i` of gyro i to `e_i + theta_ij (e_j x e_i)`; `theta_xy` turns x towards -z, `theta_xz`
/// towards +y. First order, as in the patent: what a rotation by 1e-3 rad takes from the own axis,
/// 0.5 ppm, is part of the scale-factor error.
///
/// # Source
/// Patent CN101221046, equations (1) to (8). Equation (3) itself is not legible there; it follows
/// without freedom from (6) and (8). Known answers: `tests/assembly.rs`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InputAxis {
    /// Row of `I + K_G + theta_G`: rate sensed per rate about the case axes x, y, z.
    pub sensitivity: [f64; 3],
    /// Bias, rad/s.
    pub bias_rad_per_s: f64,
}

impl InputAxis {
    /// The input axes of the gyros x, y, z.
    #[must_use]
    pub fn of_assembly(config: &AssemblyConfig) -> [Self; 3] {
        let theta = |angle_arcsec: f64| arcsec_to_rad(angle_arcsec);
        let scale = config
            .scale_factor_error_ppm
            .map(|error_ppm| 1.0 + MICRO * error_ppm);
        let bias = config.bias_deg_per_h.map(deg_per_h_to_rad_per_s);
        let (xy, xz) = (theta(config.theta_xy_arcsec), theta(config.theta_xz_arcsec));
        let (yx, yz) = (theta(config.theta_yx_arcsec), theta(config.theta_yz_arcsec));
        let (zx, zy) = (theta(config.theta_zx_arcsec), theta(config.theta_zy_arcsec));
        let rows = [
            [scale[0], xz, -xy],
            [-yz, scale[1], yx],
            [zy, -zx, scale[2]],
        ];
        [0, 1, 2].map(|axis| Self {
            sensitivity: rows[axis],
            bias_rad_per_s: bias[axis],
        })
    }

    /// What this axis senses of the motion about the case axes x, y, z, bias included.
    ///
    /// A combination of cubics is a cubic: nothing is lost between the stamps.
    #[must_use]
    pub fn sensed(&self, case: &[MotionSegment; 3]) -> MotionSegment {
        let [x, y, z] = self.sensitivity;
        let mut coefficients = [0.0; 4];
        for (power, coefficient) in coefficients.iter_mut().enumerate() {
            let [about_x, about_y, about_z] =
                case.each_ref().map(|axis| axis.rate_rad_per_s[power]);
            *coefficient = x * about_x + y * about_y + z * about_z;
        }
        coefficients[0] += self.bias_rad_per_s;
        MotionSegment {
            rate_rad_per_s: coefficients,
        }
    }
}

/// The configuration of gyro `axis` with its own temperature coefficients joined to the common ones.
///
/// Bias and expansion of the coil's diameter are linear in the temperature of the coil: the second
/// acts on the scale factor alone, so that a coefficient of the scale factor is one more of it.
fn with_own_temperature(config: &GyroConfig, assembly: &AssemblyConfig, axis: usize) -> GyroConfig {
    let mut own = config.clone();
    own.thermal.bias_deg_per_h_per_k += assembly.bias_deg_per_h_per_k[axis];
    own.thermal.diameter_ppm_per_k += assembly.scale_factor_ppm_per_k[axis];
    own
}

/// One gyro of an assembly: a whole gyro behind its own input axis, with noise of its own.
///
/// A scale-factor error acts on the sensed rate; the noise, which it would change by the same few
/// parts per million, is left as that of an ideal gyro. No source is shared between the gyros: an
/// assembly whose three coils share one light source has correlated intensity noise, this one not.
#[derive(Clone, Debug)]
pub struct CaseGyro {
    input_axis: InputAxis,
    gyro: Gyro,
}

impl CaseGyro {
    /// The gyros x, y, z of an assembly, alike but for their input axes; a configuration without
    /// an assembly has none.
    ///
    /// Noise streams are those of a single gyro, each within the scope `x`, `y` or `z`.
    ///
    /// # Errors
    /// Any [`GyroError`], as [`Gyro::new`].
    pub fn assembly(
        config: &GyroConfig,
        fidelity: Fidelity,
        simulated_time_s: f64,
        streams: &Streams,
    ) -> Result<Vec<Self>, GyroError> {
        let Some(assembly) = &config.assembly else {
            return Ok(Vec::new());
        };
        let input_axes = InputAxis::of_assembly(assembly);
        let gyros = AXES.into_iter().zip(input_axes);
        gyros
            .enumerate()
            .map(|(index, (axis, input_axis))| {
                let streams = streams.scoped(axis);
                let own = with_own_temperature(config, assembly, index);
                let gyro = Gyro::new(&own, fidelity, simulated_time_s, &streams)?;
                Ok(Self { input_axis, gyro })
            })
            .collect()
    }

    /// Rate word of the output sample over which the case moves as `case`, deg/h.
    pub fn next_word(&mut self, case: &[MotionSegment; 3]) -> f64 {
        self.gyro.next_word(&self.input_axis.sensed(case))
    }

    /// The gyro behind the input axis.
    #[must_use]
    pub fn gyro(&self) -> &Gyro {
        &self.gyro
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_input_axis_sees_what_the_cross_product_says() {
        // theta_ij turns gyro i about axis j: e_i + theta (e_j x e_i), for all six pairs.
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [
                a[1] * b[2] - a[2] * b[1],
                a[2] * b[0] - a[0] * b[2],
                a[0] * b[1] - a[1] * b[0],
            ]
        };
        let unit = |axis: usize| [0, 1, 2].map(|other| f64::from(u8::from(other == axis)));
        for (index, (gyro, about)) in [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)]
            .into_iter()
            .enumerate()
        {
            let mut angles = [0.0; 6];
            angles[index] = 200.0;
            let config = AssemblyConfig {
                bias_deg_per_h: [0.0; 3],
                scale_factor_error_ppm: [0.0; 3],
                bias_deg_per_h_per_k: [0.0; 3],
                scale_factor_ppm_per_k: [0.0; 3],
                theta_xy_arcsec: angles[0],
                theta_xz_arcsec: angles[1],
                theta_yx_arcsec: angles[2],
                theta_yz_arcsec: angles[3],
                theta_zx_arcsec: angles[4],
                theta_zy_arcsec: angles[5],
            };
            let tilt = cross(unit(about), unit(gyro)).map(|side| side * arcsec_to_rad(200.0));
            for (axis, seen) in InputAxis::of_assembly(&config).iter().enumerate() {
                let own = unit(axis);
                let expected = [0, 1, 2].map(|k| own[k] + if axis == gyro { tilt[k] } else { 0.0 });
                for (got, want) in seen.sensitivity.iter().zip(expected) {
                    assert!((got - want).abs() < 1e-15, "theta {gyro} about {about}");
                }
            }
        }
    }

    #[test]
    fn every_power_of_the_motion_is_combined_and_the_bias_is_constant() {
        let axis = InputAxis {
            sensitivity: [2.0, -3.0, 0.5],
            bias_rad_per_s: 7.0,
        };
        let segment = |first: f64| MotionSegment {
            rate_rad_per_s: [first, 2.0 * first, 3.0 * first, 4.0 * first],
        };
        let sensed = axis.sensed(&[segment(1.0), segment(10.0), segment(100.0)]);
        let level = 2.0 - 30.0 + 50.0;
        let expected = [level + 7.0, 2.0 * level, 3.0 * level, 4.0 * level];
        let bits = |rates: [f64; 4]| rates.map(f64::to_bits);
        assert_eq!(bits(sensed.rate_rad_per_s), bits(expected));
    }
}
