//! Settings of a sine sweep.

use crate::declare::table;
use crate::vocabulary::words;

table! {
    /// A swing whose frequency sweeps: at the first frequency through the warm-up, from the start of the
    /// record to the last one in sweep_s, then the soft stop and rest.
    pub struct ChirpConfig,
    one "amplitude" of rate_amplitude_deg_per_s | angle_amplitude_deg
    {
        /// Rate amplitude; give this or angle_amplitude_deg.
        rate_amplitude_deg_per_s: Option<f64>, example 1.0, in 1e-9..=2000.0, "deg/s";
        /// Angle amplitude; the rate amplitude is 2 pi f times this at every frequency.
        angle_amplitude_deg: Option<f64>, example 0.01, in 1e-9..=360.0, "deg";
        /// Frequency through the warm-up and at the start of the sweep.
        start_frequency_hz: f64, example 1.0, in 1e-6..=1000.0, "Hz";
        /// Frequency at the end of the sweep; a cycle must span at least 8 output samples.
        end_frequency_hz: f64, example 50.0, in 1e-6..=1000.0, "Hz";
        /// Length of the sweep; it must fit into the duration.
        sweep_s: f64, example 20.0, in 1e-6..=1e7, "s";
        /// Frequency moves by as many hertz, or by the same factor, in every second. Source of the default:
        /// customary, as many cycles in every octave.
        progression: Progression = "logarithmic";
        /// Raised-cosine start of the motion, inside the warm-up. Source of the default: assumed.
        soft_start_s: f64 = 1.0, in 0.0..=1.0, "s";
        /// Raised-cosine end of the motion, after the sweep. Source of the default: assumed.
        soft_stop_s: f64 = 1.0, in 0.0..=1e6, "s";
    }
}

words! {
    /// How the frequency of a sweep moves.
    pub enum Progression {
        /// By as many hertz in every second.
        Linear = "linear",
        /// By the same factor in every second.
        Logarithmic = "logarithmic",
    }
}
