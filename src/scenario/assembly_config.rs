//! The configuration of the three-axis assembly: names are the keys of the scenario file.

use serde::Deserialize;

/// Three gyros in one case: what makes each different from an ideal one along its axis.
///
/// `theta_ij_arcsec` is the small right-hand rotation of gyro i's input axis about case axis j, the
/// `theta_gij` of patent CN101221046, equations (3) and (8).
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AssemblyConfig {
    /// Constant bias of the gyros x, y, z, deg/h.
    pub bias_deg_per_h: [f64; 3],
    /// Scale-factor error of the gyros x, y, z, ppm.
    pub scale_factor_error_ppm: [f64; 3],
    /// Change of the bias per kelvin of the coil beyond `gyro.thermal.reference_c`, deg/h/K.
    pub bias_deg_per_h_per_k: [f64; 3],
    /// Change of the scale factor per kelvin of the coil beyond that temperature, ppm/K.
    pub scale_factor_ppm_per_k: [f64; 3],
    /// Rotation of gyro x about case axis y, arcsec: turns its input axis towards -z.
    pub theta_xy_arcsec: f64,
    /// Rotation of gyro x about case axis z, arcsec: turns its input axis towards +y.
    pub theta_xz_arcsec: f64,
    /// Rotation of gyro y about case axis x, arcsec: turns its input axis towards +z.
    pub theta_yx_arcsec: f64,
    /// Rotation of gyro y about case axis z, arcsec: turns its input axis towards -x.
    pub theta_yz_arcsec: f64,
    /// Rotation of gyro z about case axis x, arcsec: turns its input axis towards -y.
    pub theta_zx_arcsec: f64,
    /// Rotation of gyro z about case axis y, arcsec: turns its input axis towards +x.
    pub theta_zy_arcsec: f64,
}
