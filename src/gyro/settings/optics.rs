//! Settings of coil and light source.

use crate::declare::table;

table! {
    /// Fibre coil.
    pub struct CoilConfig {
        /// Fibre length. Source of the default: the paper.
        length_m: f64 = 800.0, in 1.0..=50000.0, "m";
        /// Mean coil diameter. Source of the default: the paper.
        diameter_mm: f64 = 70.0, in 1.0..=2000.0, "mm";
        /// Group index of the fibre; sets the transit time, not the scale factor. Source of the default:
        /// standard single-mode fibre at 1310 nm.
        group_index: f64 = 1.4677, in 1.0..=4.0;
    }
}

table! {
    /// Light source and interferometer.
    pub struct SourceConfig {
        /// Mean vacuum wavelength. Source of the default: the paper.
        wavelength_nm: f64 = 1310.0, in 200.0..=5000.0, "nm";
        /// Mean detected power over a fringe, half of the fringe maximum. Source of the default: assumed;
        /// low, so that the total reaches 0.0060 deg/sqrt(h). The other reading of that total is a healthy
        /// power beside gyro.noise.technical_phase_urad_per_sqrt_hz: scenarios/base/fog70-technical.toml.
        power_uw: f64 = 0.87, in 1e-3..=100000.0, "uW";
        /// Full width at half maximum of the Gaussian spectrum. Source of the default: assumed,
        /// superluminescent diode.
        linewidth_nm: f64 = 35.0, in 1e-6..=500.0, "nm";
        /// Degree of polarisation at the detector. Source of the default: assumed, polarising circuit.
        polarisation_degree: f64 = 1.0, in 0.0..=1.0;
        /// Fringe visibility. Source of the default: assumed.
        visibility: f64 = 0.95, in 1e-3..=1.0;
    }
}
