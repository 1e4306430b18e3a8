//! Settings of the compensation of an assembly's errors.

use crate::declare::table;
use crate::vocabulary::CompensationForm;

table! {
    /// Compensation: what a calibration has found is taken out of the outputs of an assembly, sample by
    /// sample. Absent, the outputs stay as they are. With it there are the channels x_compensated,
    /// y_compensated and z_compensated behind the raw ones, and the filters are given the compensated
    /// words and compared with them. Exactly one source of parameters: a file that `fogbench calibrate`
    /// or the run of a calibration scenario wrote, a campaign, or the parameters themselves. The
    /// thermometer of each gyro is the mean temperature of its coil.
    pub struct CompensationConfig,
    one "source of parameters" of file | campaign | campaign_scenario | parameters,
    beside "[gyro.assembly]"
    {
        /// How rates follow from the outputs: by the inverse matrix, or by the patent's first order. "exact"
        /// is XA^-1 (Wm - XB); "first-order" is Wm - (K_G Wm + theta_G Wm + B_G) of patent CN101221046,
        /// equations (23) and (24), which leaves errors of second order. Source of the default: the first
        /// order leaves up to 1 deg/h at 100 deg/s and 1e-3 errors.
        form: CompensationForm = "exact";
        /// Path of a calibration.toml, whose parameters take the place of this key. Relative to this file.
        file: Option<String>, example "calibration.toml",
            apart "its values have been put in the place of the parameters";
        /// Path of a calibration scenario that is run first; its result is applied. Relative to this file;
        /// its first repeat is run, with the seed and the estimator that stand there.
        campaign: Option<String>, example "campaign.toml",
            apart "its text has been put in the place of the campaign scenario";
        /// The calibration scenario itself, as the manifest of a run holds it. Nobody writes this by hand.
        campaign_scenario: Option<String>, example "name = \"campaign\"\nduration_s = 20.0\n";
        parameters: Option<CompensationParameters>;
    }
}

table! {
    /// Errors of an assembly as a calibration found them; names, signs and units of all of them are those
    /// of gyro.assembly.
    pub struct CompensationParameters {
        /// Bias of the gyros x, y, z at their reference temperatures. Names, signs and units of all
        /// parameters are those of gyro.assembly. Source of the default: none, nothing to take out.
        bias_deg_per_h: [f64; 3] = [0.0, 0.0, 0.0], in -1e6..=1e6, "deg/h";
        /// Scale-factor error of the gyros x, y, z. Source of the default: none.
        scale_factor_error_ppm: [f64; 3] = [0.0, 0.0, 0.0], in -1e6..=1e6, "ppm";
        /// Small right-hand rotation of gyro x's input axis about case axis y. Source of the default: none.
        theta_xy_arcsec: f64 = 0.0, in -1e6..=1e6, "arcsec";
        /// Small right-hand rotation of gyro x's input axis about case axis z. Source of the default: none.
        theta_xz_arcsec: f64 = 0.0, in -1e6..=1e6, "arcsec";
        /// Small right-hand rotation of gyro y's input axis about case axis x. Source of the default: none.
        theta_yx_arcsec: f64 = 0.0, in -1e6..=1e6, "arcsec";
        /// Small right-hand rotation of gyro y's input axis about case axis z. Source of the default: none.
        theta_yz_arcsec: f64 = 0.0, in -1e6..=1e6, "arcsec";
        /// Small right-hand rotation of gyro z's input axis about case axis x. Source of the default: none.
        theta_zx_arcsec: f64 = 0.0, in -1e6..=1e6, "arcsec";
        /// Small right-hand rotation of gyro z's input axis about case axis y. Source of the default: none.
        theta_zy_arcsec: f64 = 0.0, in -1e6..=1e6, "arcsec";
        /// Temperature of the gyros x, y, z at which the biases hold. Source of the default: that of
        /// gyro.thermal.reference_c.
        reference_temperature_c: [f64; 3] = [25.0, 25.0, 25.0], in -100.0..=150.0, "C";
        /// Temperature coefficient of the biases of the gyros x, y, z. Source of the default: none; without
        /// it no thermometer is read.
        bias_deg_per_h_per_k: [f64; 3] = [0.0, 0.0, 0.0], in -1000.0..=1000.0, "deg/h/K";
        /// Quadratic temperature coefficient of these biases. Source of the default: none.
        bias_deg_per_h_per_k2: [f64; 3] = [0.0, 0.0, 0.0], in -100.0..=100.0, "deg/h/K^2";
        /// Coefficient of these biases on the rate of the temperature, the Shupe effect. Source of the
        /// default: none.
        bias_deg_per_h_per_k_per_min: [f64; 3] = [0.0, 0.0, 0.0], in -1e4..=1e4, "deg/h/(K/min)";
        /// Temperature coefficient of the scale factors. Source of the default: none.
        scale_factor_ppm_per_k: [f64; 3] = [0.0, 0.0, 0.0], in -1e4..=1e4, "ppm/K";
    }
}
