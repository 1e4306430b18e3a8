//! From the register to the rate word.

use crate::gyro::optics::coil::Coil;
use crate::gyro::{OutputQuantisation, RateOutputConfig};
use crate::units::{
    arcsec_per_s_to_deg_per_h, deg_per_h_to_arcsec_per_s, deg_per_s_to_deg_per_h,
    rad_per_s_to_deg_per_h, rad_per_s_to_deg_per_s,
};

/// Turns the mean register of an output sample into its rate word.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RateWord {
    scale_factor_s: f64,
    rounding: Rounding,
}

/// How a word is rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Rounding {
    /// To the nearest least significant bit of the rate, the remainder thrown away; 0 = not at all.
    Word { lsb_deg_per_s: f64 },
    /// To whole pulses of angle, the remainder carried over.
    Pulses {
        sample_period_s: f64,
        lsb_arcsec: f64,
        /// Angle not yet put out, arcsec, within half a pulse.
        remainder_arcsec: f64,
    },
}

impl RateWord {
    /// The rate word of a configuration, for output samples of `sample_period_s`.
    pub(super) fn new(config: &RateOutputConfig, coil: &Coil, sample_period_s: f64) -> Self {
        Self {
            scale_factor_s: coil.scale_factor_s,
            rounding: match config.quantisation {
                OutputQuantisation::RateWord => Rounding::Word {
                    lsb_deg_per_s: config.rate_lsb_deg_per_s,
                },
                OutputQuantisation::AngleCarry => Rounding::Pulses {
                    sample_period_s,
                    lsb_arcsec: config.angle_lsb_arcsec,
                    remainder_arcsec: 0.0,
                },
            },
        }
    }

    /// Rate word of a mean feedback phase step (rad per half period), deg/h.
    ///
    /// A rounded word has white noise of `lsb / sqrt(12)`: an angle random walk of
    /// `lsb sqrt(T / 12)` for the sample period T, and not an angle quantisation. Counted pulses err
    /// by at most half a pulse of angle for ever: where the angle is dithered (by noise of half a
    /// pulse or by the motion) the quantisation is `Q = lsb / sqrt(12)`, the Allan variance
    /// `3 Q^2 / tau^2`.
    ///
    /// # Source
    /// Quantisation noise as in IEEE Std 952, annex C. Checked by known answer K22.
    pub(super) fn deg_per_h(&mut self, mean_step_rad: f64) -> f64 {
        let rate_rad_per_s = mean_step_rad / self.scale_factor_s;
        match &mut self.rounding {
            Rounding::Word { lsb_deg_per_s } => {
                let rate_deg_per_s = rad_per_s_to_deg_per_s(rate_rad_per_s);
                let rounded = if *lsb_deg_per_s > 0.0 {
                    (rate_deg_per_s / *lsb_deg_per_s).round() * *lsb_deg_per_s
                } else {
                    rate_deg_per_s
                };
                deg_per_s_to_deg_per_h(rounded)
            }
            Rounding::Pulses {
                sample_period_s,
                lsb_arcsec,
                remainder_arcsec,
            } => {
                let rate = deg_per_h_to_arcsec_per_s(rad_per_s_to_deg_per_h(rate_rad_per_s));
                let angle_arcsec = rate * *sample_period_s + *remainder_arcsec;
                let pulses = (angle_arcsec / *lsb_arcsec).round();
                *remainder_arcsec = angle_arcsec - pulses * *lsb_arcsec;
                arcsec_per_s_to_deg_per_h(pulses * *lsb_arcsec / *sample_period_s)
            }
        }
    }
}
