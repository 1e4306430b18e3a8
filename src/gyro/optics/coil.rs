//! Fibre coil: Sagnac scale factor and transit time.

use std::f64::consts::PI;

use crate::declare::table;
use crate::gyro::SourceConfig;
use crate::units::{MILLI, NANO, SPEED_OF_LIGHT_M_PER_S};

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

/// The two numbers a coil gives the gyro.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coil {
    /// Sagnac scale factor `Ks`, s (rad of phase per rad/s of rate).
    pub scale_factor_s: f64,
    /// Transit time `tau`, s.
    pub transit_time_s: f64,
}

impl Coil {
    /// Scale factor and transit time of a coil at the source's mean wavelength.
    ///
    /// `Ks = 2 pi L D / (lambda c)`: the fibre's index does not enter, the Sagnac phase is a
    /// vacuum effect. `tau = n_g L / c` with the group index.
    ///
    /// # Source
    /// Lefevre, The Fiber-Optic Gyroscope, 2nd ed., sections 2.1 and 3.2. Checked by known answer K1.
    #[must_use]
    pub fn new(coil: &CoilConfig, source: &SourceConfig) -> Self {
        let diameter_m = coil.diameter_mm * MILLI;
        let wavelength_m = source.wavelength_nm * NANO;
        Self {
            scale_factor_s: 2.0 * PI * coil.length_m * diameter_m
                / (wavelength_m * SPEED_OF_LIGHT_M_PER_S),
            transit_time_s: coil.group_index * coil.length_m / SPEED_OF_LIGHT_M_PER_S,
        }
    }

    /// Proper (eigen) frequency `1 / 2 tau` = modulation frequency, Hz.
    #[must_use]
    pub fn proper_frequency_hz(&self) -> f64 {
        0.5 / self.transit_time_s
    }

    /// Half modulation period: the transit time but for a relative mismatch, s.
    #[must_use]
    pub fn half_period_s(&self, mismatch: f64) -> f64 {
        self.transit_time_s * (1.0 + mismatch)
    }

    /// Loop period `T_L = 2 tau`, s.
    #[must_use]
    pub fn loop_period_s(&self) -> f64 {
        2.0 * self.transit_time_s
    }

    /// Angle turned between two resets of the ramp, `theta_2pi = 2 pi tau / Ks = n_g lambda / D`, rad.
    #[must_use]
    pub fn angle_per_reset_rad(&self) -> f64 {
        2.0 * PI * self.transit_time_s / self.scale_factor_s
    }

    /// Rate of a Sagnac phase of pi, the edge of the first fringe, rad/s.
    #[must_use]
    pub fn single_fringe_rate_rad_per_s(&self) -> f64 {
        PI / self.scale_factor_s
    }
}
