//! Settings of several sines of rate at once.

use crate::declare::table;
use crate::vocabulary::PhaseRule;

table! {
    /// Several sines of rate at once, for a frequency response from one record.
    pub struct MultiSineConfig {
        /// Frequencies, ascending, at most 64; a cycle must span at least 8 output samples, and the record
        /// three cycles of the lowest and one of each difference.
        frequencies_hz: Vec<f64>, example [5.0, 20.0, 80.0, 320.0], in 1e-6..=100_000.0, "Hz";
        /// Rate amplitudes: one for all frequencies, or one for each.
        rate_amplitudes_deg_per_s: Vec<f64>, example [1.0], in 1e-9..=2000.0, "deg/s";
        /// Phases, which decide how high the sum peaks: cosines of phase -pi k (k - 1) / K (if all K
        /// amplitudes are equal) or pi (k - 1)^2 / K, or sines of phase zero. Source of the default:
        /// Schroeder, IEEE Trans. Inf. Theory 16 (1970) 85, which serves unequal amplitudes too.
        phases: PhaseRule = "schroeder";
        /// Raised-cosine start of the motion, inside the warm-up. Source of the default: assumed.
        soft_start_s: f64 = 1.0, in 0.0..=1.0, "s";
    }
}

impl MultiSineConfig {
    /// Rate amplitude of tone `index`, deg/s.
    ///
    /// # Panics
    /// If there is neither one amplitude nor one for each frequency; the reader refuses that.
    #[must_use]
    pub fn rate_amplitude_deg_per_s(&self, index: usize) -> f64 {
        match self.rate_amplitudes_deg_per_s.as_slice() {
            [common] => *common,
            each => each[index],
        }
    }
}
