//! From the register to the rate word.

use crate::declare::table;
use crate::gyro::optics::coil::Coil;
use crate::units::{
    arcsec_per_s_to_deg_per_h, deg_per_h_to_arcsec_per_s, deg_per_s_to_deg_per_h,
    rad_per_s_to_deg_per_h, rad_per_s_to_deg_per_s,
};
use crate::vocabulary::words;

table! {
    /// Rate word.
    pub struct RateOutputConfig {
        /// Half modulation periods averaged into one rate word. Source of the default: 3989.45 Hz, as the
        /// paper equates 1 sample with 0.25 ms.
        half_periods_per_sample: u32 = 64, even in 2..=1_048_576, told in Account;
        /// Rate words averaged into one sample of the output, which filters and metrics see: the output rate is
        /// that of the words over this. Words are rounded before they are averaged. Source of the default: none.
        average_samples: u32 = 1, in 1..=1_048_576;
        /// What is rounded: each rate word, its remainder thrown away, or the angle turned since the start, to
        /// whole pulses, its remainder carried into the next word. Source of the default: assumed.
        quantisation: OutputQuantisation = "rate-word";
        /// Least significant bit of the rate word, rounded without carry; 0 is not rounded. Source of the
        /// default: assumed. Only with quantisation = "rate-word".
        rate_lsb_deg_per_s: f64 = 1e-4, in 0.0..=1.0, "deg/s";
        /// Angle of one pulse; a word is then whole pulses times this over the output period. Only with
        /// quantisation = "angle-carry". Source of the default: derived, 1/256 of the 5.6655 arcsec that this
        /// coil turns per reset of the ramp (n_g lambda / D).
        angle_lsb_arcsec: f64 = 0.0221, in 1e-9..=3600.0, "arcsec";
    }
}

words! {
    /// What the output rounds.
    pub enum OutputQuantisation {
        /// Each rate word to its least significant bit; the remainder is thrown away.
        RateWord = "rate-word",
        /// The angle to whole pulses; the remainder is carried into the next word.
        AngleCarry = "angle-carry",
    }
}

impl RateOutputConfig {
    /// Step to which each word is rounded, its remainder thrown away, deg/h; 0 if none is.
    pub(super) fn word_step_deg_per_h(&self) -> f64 {
        match self.quantisation {
            OutputQuantisation::RateWord => deg_per_s_to_deg_per_h(self.rate_lsb_deg_per_s),
            OutputQuantisation::AngleCarry => 0.0,
        }
    }
}

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
