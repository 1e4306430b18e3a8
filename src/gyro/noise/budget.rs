//! Angle random walk by source, in closed form.

use std::f64::consts::{PI, SQRT_2};

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

    /// Relative standard deviation of the total over where the level lies between two codes of the converter.
    ///
    /// Rounding to steps of 1 under Gaussian noise s turns the level u into a mean of the slope
    /// `1 + 2 c`, `c = -exp(-2 pi^2 s^2) cos(2 pi u)`, and adds to the variance s^2
    /// `1/12 + c (1 / pi^2 + 4 s^2)`: noise over slope departs from `sqrt(s^2 + 1/12)` by
    /// `c (1 / pi^2 - 1/3) / (2 (s^2 + 1/12))`. The level moves through a step with the power by a
    /// thousandth, so that it counts as uniform in it; then `c` has the deviation
    /// `exp(-2 pi^2 s^2) / sqrt(2)`.
    ///
    /// # Source
    /// First term of the Fourier series of the rounding error: Widrow and Kollar, Quantization Noise,
    /// 2008, chapter 6.
    #[must_use]
    pub fn scatter_by_level(&self, detector: &Detector, coil: &Coil) -> f64 {
        let Some(noise) = detector.noise_steps(coil.transit_time_s) else {
            return 0.0;
        };
        let share = (self.detection_deg_per_sqrt_h() / self.total_deg_per_sqrt_h()).powi(2);
        let of_detection = departure_by_level(noise) / SQRT_2;
        if share.is_finite() {
            share * of_detection
        } else {
            0.0
        }
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

/// Largest relative departure of noise over slope behind a converter from `sqrt(s^2 + 1/12)`, for noise of s
/// steps before it.
fn departure_by_level(noise_steps: f64) -> f64 {
    let square = noise_steps * noise_steps;
    let slope = (-2.0 * PI * PI * square).exp();
    slope * (1.0 / 3.0 - 1.0 / (PI * PI)) / (2.0 * (square + 1.0 / 12.0))
}

#[cfg(test)]
mod tests {
    use statrs::distribution::{ContinuousCDF, Normal};

    use super::departure_by_level;

    /// Mean and variance of a level with noise, rounded to whole numbers.
    fn rounded(level: f64, noise: f64) -> (f64, f64) {
        let law = Normal::new(level, noise).expect("some noise");
        let codes = (-20..=20).map(f64::from);
        let weighted = codes.map(|code| (code, law.cdf(code + 0.5) - law.cdf(code - 0.5)));
        let (mean, square) = weighted.fold((0.0, 0.0), |(mean, square), (code, part)| {
            (mean + part * code, square + part * code * code)
        });
        (mean, square - mean * mean)
    }

    #[test]
    fn noise_behind_a_coarse_converter_departs_by_where_the_level_lies() {
        for noise in [0.4_f64, 0.46, 0.5, 0.6] {
            let departures = (0..200).map(|place| {
                let level = f64::from(place) / 200.0;
                let slope =
                    (rounded(level + 1e-4, noise).0 - rounded(level - 1e-4, noise).0) / 2e-4;
                let white = (noise * noise + 1.0 / 12.0).sqrt();
                rounded(level, noise).1.sqrt() / slope / white - 1.0
            });
            let departures: Vec<f64> = departures.collect();
            let largest = departures
                .iter()
                .fold(0.0, |most: f64, own| most.max(own.abs()));
            let form = departure_by_level(noise);
            assert!(
                (largest / form - 1.0).abs() < 0.03,
                "{noise}: {largest} {form}"
            );
            let square: f64 = departures.iter().map(|own| own * own).sum();
            let scatter = (square / 200.0).sqrt() * std::f64::consts::SQRT_2;
            assert!(
                (scatter / form - 1.0).abs() < 0.02,
                "{noise}: {scatter} {form}"
            );
        }
    }
}
