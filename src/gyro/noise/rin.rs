//! Relative intensity noise of the light source: `RIN I^2`.

use std::f64::consts::{LN_2, PI};

use crate::gyro::SourceConfig;
use crate::gyro::noise::source::{Density, NoiseSource, when};
use crate::units::{NANO, SPEED_OF_LIGHT_M_PER_S};

pub(super) const RIN: NoiseSource = NoiseSource {
    name: "rin",
    key: "gyro.noise.rin",
    density: |config, _| Density::Intensity {
        per_hz: when(
            config.noise.rin,
            relative_intensity_noise_per_hz(&config.source),
        ),
    },
};

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
