//! From the register to the rate word.

use crate::gyro::coil::Coil;
use crate::scenario::RateOutputConfig;
use crate::units::{deg_per_s_to_deg_per_h, rad_per_s_to_deg_per_s};

/// Turns the mean register of an output sample into its rate word.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RateWord {
    scale_factor_s: f64,
    lsb_deg_per_s: f64,
}

impl RateWord {
    /// The rate word of a configuration.
    pub(super) fn new(config: &RateOutputConfig, coil: &Coil) -> Self {
        Self {
            scale_factor_s: coil.scale_factor_s,
            lsb_deg_per_s: config.rate_lsb_deg_per_s,
        }
    }

    /// Rate word of a mean feedback phase step (rad per half period), deg/h.
    ///
    /// Rounded to the nearest least significant bit, the remainder thrown away: white noise of
    /// `lsb / sqrt(12)` per word, an angle random walk and not an angle quantisation.
    pub(super) fn deg_per_h(&self, mean_step_rad: f64) -> f64 {
        let rate_deg_per_s = rad_per_s_to_deg_per_s(mean_step_rad / self.scale_factor_s);
        let rounded = if self.lsb_deg_per_s > 0.0 {
            (rate_deg_per_s / self.lsb_deg_per_s).round() * self.lsb_deg_per_s
        } else {
            rate_deg_per_s
        };
        deg_per_s_to_deg_per_h(rounded)
    }
}
