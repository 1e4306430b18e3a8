//! Light source: its settings and the intensity noise of broadband light.

use std::f64::consts::{LN_2, PI};

use crate::declare::table;
use crate::units::{NANO, SPEED_OF_LIGHT_M_PER_S};

table! {
    /// Light source and interferometer.
    pub struct SourceConfig {
        /// Mean vacuum wavelength. Source of the default: the paper.
        wavelength_nm: f64 = 1310.0, in 200.0..=5000.0, "nm";
        /// Mean detected power over a fringe, half of the fringe maximum. Source of the default: assumed;
        /// low, so that the total reaches 0.0060 deg/sqrt(h). The other reading of that total is a healthy
        /// power beside gyro.noise.technical_phase_urad_per_sqrt_hz: scenarios/base/fog70-technical.toml.
        power_uw: f64 = 0.87, in 1e-3..=100000.0, "uW", told in Account Budget;
        /// Full width at half maximum of the Gaussian spectrum. Source of the default: assumed,
        /// superluminescent diode.
        linewidth_nm: f64 = 35.0, in 1e-6..=500.0, "nm";
        /// Degree of polarisation at the detector. Source of the default: assumed, polarising circuit.
        polarisation_degree: f64 = 1.0, in 0.0..=1.0;
        /// Fringe visibility. Source of the default: assumed.
        visibility: f64 = 0.95, in 1e-3..=1.0;
    }
}

/// One-sided relative intensity noise of thermal-like light with a Gaussian spectrum, 1/Hz.
///
/// `RIN = (1 + P^2) tau_c` with the coherence time `tau_c = integral |gamma(t)|^2 dt =
/// sqrt(2 ln 2 / pi) / dnu`, the full width at half maximum `dnu = c dlambda / lambda^2` and the
/// degree of polarisation P. White far beyond any band of interest here.
///
/// # Source
/// Goodman, Statistical Optics, section 4.3 and 6.1 (variance of integrated intensity of partially
/// polarised thermal light). Checked by known answer K16.
#[must_use]
pub fn relative_intensity_noise_per_hz(config: &SourceConfig) -> f64 {
    let wavelength_m = config.wavelength_nm * NANO;
    let linewidth_hz =
        SPEED_OF_LIGHT_M_PER_S * config.linewidth_nm * NANO / (wavelength_m * wavelength_m);
    let coherence_time_s = (2.0 * LN_2 / PI).sqrt() / linewidth_hz;
    (1.0 + config.polarisation_degree * config.polarisation_degree) * coherence_time_s
}
