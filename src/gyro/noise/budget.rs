//! Angle random walk by source, in closed form.

use crate::gyro::noise::law::Density;
use crate::gyro::noise::word_rounding::rate_word_walk;
use crate::gyro::noise::{COUNT, name_of};
use crate::gyro::optics::coil::Coil;
use crate::gyro::optics::detector::Detector;
use crate::gyro::rate_word::RateOutputConfig;
use crate::units::rad_per_sqrt_s_to_deg_per_sqrt_h;

/// Name of the rounding of the rate word.
const RATE_WORD: &str = "rate_word";
/// Name of the sum of all sources.
const TOTAL: &str = "total";

/// Angle random walk of each source, deg/sqrt(h); a source switched off has 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseBudget {
    /// Of the detection, in the order of the densities.
    walks_deg_per_sqrt_h: [f64; COUNT],
    /// Whether each has a line: neither one that the equivalent source replaces nor that one, if it replaces
    /// none.
    is_listed: [bool; COUNT],
    /// Of the rounding of the words, which the loop does not see.
    rate_word_deg_per_sqrt_h: f64,
}

impl NoiseBudget {
    /// The budget of a detection chain behind a coil.
    ///
    /// A white current noise of one-sided density `S` gives
    /// `N = sqrt(S / (2 gate_duty)) / (Ks slope)` rad/sqrt(s), whatever the loop gain; rounding to
    /// `q` with n samples averaged gives `N = sqrt(tau / (12 n)) q / (G Ks slope)`. They add in
    /// quadrature. Technical phase noise of density `S1` gives `N = sqrt(S1 / 2) / Ks`: a pair
    /// averages the independent phases of its halves, so that the error of one loop period `T_L` has
    /// the variance `S1 / (4 tau) = S1 / (2 T_L)`; neither slope nor gate enters. Rounding counts as
    /// white noise of variance `q^2 / 12`, which holds while the noise of one sample exceeds about
    /// half a step.
    ///
    /// # Source
    /// Derived from the variance of the pair difference that is demodulated. Checked by known
    /// answer K13 against the loop model, source by source.
    #[must_use]
    pub fn new(detector: &Detector, coil: &Coil) -> Self {
        let slope = coil.scale_factor_s * detector.slope_a_per_rad;
        let walk_rad_per_sqrt_s = |density: Density| match density {
            Density::Phase { rad2_per_hz } => (0.5 * rad2_per_hz).sqrt() / coil.scale_factor_s,
            Density::Rounding { .. } => detector.converter_walk_rad_per_sqrt_s(coil),
            Density::Intensity { .. } | Density::OfCurrent { .. } | Density::Current { .. } => {
                let a2_per_hz = density.a2_per_hz(detector.bias_current_a, detector.dark_current_a);
                (a2_per_hz / (2.0 * detector.gate_duty)).sqrt() / slope
            }
        };
        let densities = &detector.densities;
        Self {
            walks_deg_per_sqrt_h: densities
                .0
                .map(|density| rad_per_sqrt_s_to_deg_per_sqrt_h(walk_rad_per_sqrt_s(density))),
            is_listed: std::array::from_fn(|index| densities.is_listed(index)),
            rate_word_deg_per_sqrt_h: 0.0,
        }
    }

    /// The budget with the rounding of the rate words.
    #[must_use]
    pub fn with_rate_word(
        self,
        config: &RateOutputConfig,
        word_period_s: f64,
        loop_time_constant_s: f64,
    ) -> Self {
        let detected = self.detection_deg_per_sqrt_h();
        let periods = (word_period_s, loop_time_constant_s);
        Self {
            rate_word_deg_per_sqrt_h: rate_word_walk(detected, config, periods),
            ..self
        }
    }

    /// Sum of all but the rounding of the words in quadrature, deg/sqrt(h): what the loop sees.
    #[must_use]
    pub fn detection_deg_per_sqrt_h(&self) -> f64 {
        let walks = self.walks_deg_per_sqrt_h.iter();
        walks.map(|walk| walk * walk).sum::<f64>().sqrt()
    }

    /// Sum in quadrature, deg/sqrt(h).
    #[must_use]
    pub fn total_deg_per_sqrt_h(&self) -> f64 {
        self.detection_deg_per_sqrt_h()
            .hypot(self.rate_word_deg_per_sqrt_h)
    }

    /// Name and angle random walk of each source and of the total, deg/sqrt(h), in report order.
    #[must_use]
    pub fn entries(&self) -> Vec<(&'static str, f64)> {
        let walks = self.walks_deg_per_sqrt_h.into_iter().enumerate();
        walks
            .filter(|(index, _)| self.is_listed[*index])
            .map(|(index, walk)| (name_of(index), walk))
            .chain([(RATE_WORD, self.rate_word_deg_per_sqrt_h)])
            .chain([(TOTAL, self.total_deg_per_sqrt_h())])
            .collect()
    }
}
