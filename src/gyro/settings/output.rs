//! Settings of the rate word.

use crate::declare::table;
use crate::vocabulary::words;

table! {
    /// Rate word.
    pub struct RateOutputConfig {
        /// Half modulation periods averaged into one rate word. Source of the default: 3989.45 Hz, as the
        /// paper equates 1 sample with 0.25 ms.
        half_periods_per_sample: u32 = 64, even in 2..=1_048_576;
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
