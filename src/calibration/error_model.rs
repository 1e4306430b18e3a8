//! The twelve parameters of a three-axis gyro assembly.

use nalgebra::{Matrix3, Vector3};

use crate::units::deg_per_s_to_deg_per_h;

/// Names of `x1..x12` without their signs, in the patent's order (equation 8).
pub const PARAMETER_NAMES: [&str; 12] = [
    "K_gx", "th_gxz", "th_gxy", "B_gx", "th_gyz", "K_gy", "th_gyx", "B_gy", "th_gzy", "th_gzx",
    "K_gz", "B_gz",
];

/// Small rotations of the input axes, rad: `xz` is that of gyro x about case axis z, right-handed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Misalignment {
    /// `th_gxy`, gyro x about y.
    pub xy: f64,
    /// `th_gxz`, gyro x about z.
    pub xz: f64,
    /// `th_gyx`, gyro y about x.
    pub yx: f64,
    /// `th_gyz`, gyro y about z.
    pub yz: f64,
    /// `th_gzx`, gyro z about x.
    pub zx: f64,
    /// `th_gzy`, gyro z about y.
    pub zy: f64,
}

/// Scale errors, misalignments and biases of three gyros in one case.
///
/// `Wm = XA W + XB` with `XA = I + K_G + theta_G`, `XB = B_G` and
///
/// ```text
///           |    0      th_gxz  -th_gxy |
/// theta_G = | -th_gyz     0      th_gyx |
///           |  th_gzy  -th_gzx     0    |
/// ```
///
/// # Source
/// Patent CN101221046, equations (1) to (8) and (19).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ErrorParameters {
    /// Scale-factor errors `K_gx, K_gy, K_gz`, ratios.
    pub scale_error: [f64; 3],
    /// Misalignments, rad.
    pub misalignment_rad: Misalignment,
    /// Biases `B_gx, B_gy, B_gz`, deg/s.
    pub bias_deg_per_s: [f64; 3],
}

impl ErrorParameters {
    /// `x1..x12`: row by row of `[XA | XB]` (equation 8); `x4, x8, x12` in deg/s.
    #[must_use]
    pub fn to_vector(&self) -> [f64; 12] {
        let [kx, ky, kz] = self.scale_error;
        let [bx, by, bz] = self.bias_deg_per_s;
        let t = &self.misalignment_rad;
        [
            1.0 + kx,
            t.xz,
            -t.xy,
            bx,
            -t.yz,
            1.0 + ky,
            t.yx,
            by,
            t.zy,
            -t.zx,
            1.0 + kz,
            bz,
        ]
    }

    /// The named parameters of `x1..x12` (equation 19).
    #[must_use]
    pub fn from_vector(x: &[f64; 12]) -> Self {
        Self {
            scale_error: [x[0] - 1.0, x[5] - 1.0, x[10] - 1.0],
            misalignment_rad: Misalignment {
                xy: -x[2],
                xz: x[1],
                yx: x[6],
                yz: -x[4],
                zx: -x[9],
                zy: x[8],
            },
            bias_deg_per_s: [x[3], x[7], x[11]],
        }
    }

    /// Biases, deg/h.
    #[must_use]
    pub fn bias_deg_per_h(&self) -> [f64; 3] {
        self.bias_deg_per_s.map(deg_per_s_to_deg_per_h)
    }

    /// `XA = I + K_G + theta_G`.
    #[must_use]
    pub fn sensitivity(&self) -> [[f64; 3]; 3] {
        let x = self.to_vector();
        [[x[0], x[1], x[2]], [x[4], x[5], x[6]], [x[8], x[9], x[10]]]
    }

    /// `D = K_G + theta_G`, what the sensitivity has beyond the unit matrix.
    #[must_use]
    pub fn deviation(&self) -> [[f64; 3]; 3] {
        let mut rows = self.sensitivity();
        for (axis, row) in rows.iter_mut().enumerate() {
            row[axis] = self.scale_error[axis];
        }
        rows
    }

    /// Outputs `Wm = XA W + XB` for rates about the case axes, all deg/s (equation 6).
    #[must_use]
    pub fn predict(&self, rate_deg_per_s: [f64; 3]) -> [f64; 3] {
        let outputs = matrix(self.sensitivity()) * Vector3::from(rate_deg_per_s)
            + Vector3::from(self.bias_deg_per_s);
        outputs.into()
    }
}

/// The matrix of given rows.
pub(super) fn matrix(rows: [[f64; 3]; 3]) -> Matrix3<f64> {
    Matrix3::from_fn(|row, column| rows[row][column])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn named_parameters_and_the_vector_are_the_same_thing() {
        let x = [
            1.25, 2.0, 3.0, 4.0, 5.0, 1.5, 7.0, 8.0, 9.0, 10.0, 1.75, 12.0,
        ];
        let named = ErrorParameters::from_vector(&x);
        assert_eq!(named.to_vector().map(f64::to_bits), x.map(f64::to_bits));
        let seen = named.predict([1.0, 10.0, 100.0]);
        let expected = [325.25, 728.0, 296.0];
        for (got, want) in seen.iter().zip(expected) {
            assert!((got - want).abs() < 1e-12, "{seen:?}");
        }
    }

    #[test]
    fn a_small_rotation_turns_the_input_axis_as_the_cross_product_says() {
        // th_gxz turns x towards +y, th_gxy towards -z: gyro x then sees those rates.
        let turned = ErrorParameters {
            misalignment_rad: Misalignment {
                xz: 1e-3,
                xy: 2e-3,
                ..Misalignment::default()
            },
            ..ErrorParameters::default()
        };
        assert!((turned.predict([0.0, 1.0, 0.0])[0] - 1e-3).abs() < 1e-18);
        assert!((turned.predict([0.0, 0.0, 1.0])[0] + 2e-3).abs() < 1e-18);
    }
}
