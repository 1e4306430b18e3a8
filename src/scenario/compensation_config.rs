//! The configuration of the compensation: names are the keys of the scenario file.

use serde::Deserialize;

use crate::vocabulary::CompensationForm;

/// How the constant errors of an assembly are taken out of its outputs.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CompensationConfig {
    /// How rates follow from the outputs.
    pub form: CompensationForm,
    /// The parameters; those of a file have been read into their place. `None`: a campaign finds them.
    pub parameters: Option<CompensationParameters>,
    /// The calibration scenario that finds them, in its canonical spelling.
    pub campaign_scenario: Option<String>,
}

/// Errors of an assembly as a calibration found them; names, signs and units are those of
/// [`AssemblyConfig`](super::AssemblyConfig).
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CompensationParameters {
    /// Bias of the gyros x, y, z at their reference temperatures, deg/h.
    pub bias_deg_per_h: [f64; 3],
    /// Scale-factor error of the gyros x, y, z, ppm.
    pub scale_factor_error_ppm: [f64; 3],
    /// Rotation of gyro x about case axis y, arcsec.
    pub theta_xy_arcsec: f64,
    /// Rotation of gyro x about case axis z, arcsec.
    pub theta_xz_arcsec: f64,
    /// Rotation of gyro y about case axis x, arcsec.
    pub theta_yx_arcsec: f64,
    /// Rotation of gyro y about case axis z, arcsec.
    pub theta_yz_arcsec: f64,
    /// Rotation of gyro z about case axis x, arcsec.
    pub theta_zx_arcsec: f64,
    /// Rotation of gyro z about case axis y, arcsec.
    pub theta_zy_arcsec: f64,
    /// Temperature of the gyros x, y, z at which the biases hold, deg C.
    pub reference_temperature_c: [f64; 3],
    /// Temperature coefficient of the biases, deg/h/K.
    pub bias_deg_per_h_per_k: [f64; 3],
}
