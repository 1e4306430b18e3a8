//! Settings of a three-axis assembly.

use crate::declare::table;

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
