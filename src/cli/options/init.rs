//! What may be said of a gyro for which a scenario is begun.

use std::path::PathBuf;

use clap::Args;

use crate::cli::options::numbers::{name, within_key};
use crate::experiment::StarterGyro;

/// Options of `init`.
#[derive(Args, Debug)]
pub(in crate::cli) struct InitOptions {
    /// File to write [default: stdout]
    #[arg(short, long, value_name = "FILE")]
    pub(in crate::cli) output: Option<PathBuf>,
    /// Replace the file if there is one
    #[arg(long, requires = "output")]
    pub(in crate::cli) force: bool,
    /// Name of the scenario
    #[arg(long, value_name = "NAME", default_value = "my-gyro", value_parser = name())]
    pub(in crate::cli) name: String,
    /// Length of the fibre, m
    #[arg(long, value_name = "L", allow_negative_numbers = true,
          value_parser = within_key("gyro.coil.length_m"))]
    length_m: f64,
    /// Mean diameter of the coil, mm
    #[arg(long, value_name = "D", allow_negative_numbers = true,
          value_parser = within_key("gyro.coil.diameter_mm"))]
    diameter_mm: f64,
    /// Mean wavelength of the light, nm
    #[arg(long, value_name = "W", allow_negative_numbers = true,
          value_parser = within_key("gyro.source.wavelength_nm"))]
    wavelength_nm: f64,
    /// Angle random walk of the data sheet, deg/sqrt(h) [default: what the sources of noise add up to]
    #[arg(long, value_name = "N", allow_negative_numbers = true, conflicts_with = "power_uw",
          value_parser = within_key("gyro.noise.angle_random_walk_deg_per_sqrt_h"))]
    arw: Option<f64>,
    /// Power on the detector, mean over a fringe, uW [default: assumed]
    #[arg(long, value_name = "P", allow_negative_numbers = true,
          value_parser = within_key("gyro.source.power_uw"))]
    power_uw: Option<f64>,
    /// Bias instability of the data sheet, deg/h [default: assumed]
    #[arg(long, value_name = "B", allow_negative_numbers = true,
          value_parser = within_key("gyro.slow_noise.bias_instability_deg_per_h"))]
    bias_instability: Option<f64>,
}

impl InitOptions {
    /// The gyro.
    pub(in crate::cli) fn gyro(&self) -> StarterGyro {
        StarterGyro {
            length_m: self.length_m,
            diameter_mm: self.diameter_mm,
            wavelength_nm: self.wavelength_nm,
            walk_deg_per_sqrt_h: self.arw,
            power_uw: self.power_uw,
            bias_instability_deg_per_h: self.bias_instability,
        }
    }
}
