//! Input axis of a gyro in a three-axis assembly.

use crate::declare::table;
use crate::signal::MotionSegment;
use crate::units::{MICRO, arcsec_to_rad, deg_per_h_to_rad_per_s};

table! {
    /// Optional table: three such gyros in one case, alike but for the errors below, each with noise of
    /// its own. Absent is one gyro whose input axis is the table axis. The channels are then x_raw,
    /// y_raw, z_raw, and for each filter `x_<name>`, `y_<name>`, `z_<name>`. The words follow
    /// Wm = (I + K_G + theta_G) W + B_G of patent CN101221046, equations (1) to (8), with the inertial
    /// rates W about the case axes. theta_ij is the small right-hand rotation of gyro i's input axis about
    /// case axis j: theta_xy turns the input axis of x towards -z, theta_xz towards +y.
    pub struct AssemblyConfig {
        /// Constant bias of the gyros x, y, z. Source of the default: none, an ideal case.
        bias_deg_per_h: [f64; 3] = [0.0, 0.0, 0.0], in -1e6..=1e6, "deg/h";
        /// Scale-factor error of the gyros x, y, z. Source of the default: none, an ideal case.
        scale_factor_error_ppm: [f64; 3] = [0.0, 0.0, 0.0], in -1e5..=1e5, "ppm";
        /// Bias of each gyro per kelvin of the coil beyond gyro.thermal.reference_c, on top of what all
        /// three have by gyro.thermal. Source of the default: none, an ideal case.
        bias_deg_per_h_per_k: [f64; 3] = [0.0, 0.0, 0.0], in -1000.0..=1000.0, "deg/h/K";
        /// Scale factor of each gyro per kelvin of the coil beyond gyro.thermal.reference_c, likewise.
        /// Source of the default: none, an ideal case.
        scale_factor_ppm_per_k: [f64; 3] = [0.0, 0.0, 0.0], in -1000.0..=1000.0, "ppm/K";
        /// Small right-hand rotation of gyro x's input axis about case axis y. Source of the default: none.
        theta_xy_arcsec: f64 = 0.0, in -2e4..=2e4, "arcsec";
        /// Small right-hand rotation of gyro x's input axis about case axis z. Source of the default: none.
        theta_xz_arcsec: f64 = 0.0, in -2e4..=2e4, "arcsec";
        /// Small right-hand rotation of gyro y's input axis about case axis x. Source of the default: none.
        theta_yx_arcsec: f64 = 0.0, in -2e4..=2e4, "arcsec";
        /// Small right-hand rotation of gyro y's input axis about case axis z. Source of the default: none.
        theta_yz_arcsec: f64 = 0.0, in -2e4..=2e4, "arcsec";
        /// Small right-hand rotation of gyro z's input axis about case axis x. Source of the default: none.
        theta_zx_arcsec: f64 = 0.0, in -2e4..=2e4, "arcsec";
        /// Small right-hand rotation of gyro z's input axis about case axis y. Source of the default: none.
        theta_zy_arcsec: f64 = 0.0, in -2e4..=2e4, "arcsec";
    }
}

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
/// without freedom from (6) and (8). Known answers: `tests/calibration/assembly.rs`.
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
                theta_xy_arcsec: angles[0],
                theta_xz_arcsec: angles[1],
                theta_yx_arcsec: angles[2],
                theta_yz_arcsec: angles[3],
                theta_zx_arcsec: angles[4],
                theta_zy_arcsec: angles[5],
                ..AssemblyConfig::reference()
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
