//! Angle random walk by source, in closed form.

use std::f64::consts::PI;

use crate::gyro::noise::SOURCES;
use crate::gyro::noise::law::Density;
use crate::gyro::optics::coil::Coil;
use crate::gyro::optics::detector::Detector;
use crate::gyro::rate_word::RateOutputConfig;
use crate::units::{
    deg_per_h_sqrt_s_to_deg_per_sqrt_h, deg_per_sqrt_h_to_deg_per_h_sqrt_s,
    rad_per_sqrt_s_to_deg_per_sqrt_h,
};

/// Name of the rounding of the rate word.
const RATE_WORD: &str = "rate_word";
/// Noise of a word in steps below which the series of its rounding is as good as its limit (1e-11).
const SMALL_NOISE_STEPS: f64 = 0.1;
/// Terms of the series above: the next is `exp(-4 pi^2 121 / 100)`.
const ROUNDING_TERMS: u32 = 10;
/// Name of the sum of all sources.
const TOTAL: &str = "total";

/// Angle random walk of each source, deg/sqrt(h); a source switched off has 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseBudget {
    /// Of the detection, in the order of [`SOURCES`].
    walks_deg_per_sqrt_h: [f64; SOURCES.len()],
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
            Density::Rounding { step_v } => {
                let step_a = step_v / detector.transimpedance_v_per_a;
                let count = detector.samples_per_half_period;
                (coil.transit_time_s / (12.0 * count)).sqrt() * step_a / slope
            }
            Density::Intensity { .. } | Density::OfCurrent { .. } | Density::Current { .. } => {
                let a2_per_hz = density.a2_per_hz(detector.bias_current_a, detector.dark_current_a);
                (a2_per_hz / (2.0 * detector.gate_duty)).sqrt() / slope
            }
        };
        let densities = detector.densities.0;
        Self {
            walks_deg_per_sqrt_h: densities
                .map(|density| rad_per_sqrt_s_to_deg_per_sqrt_h(walk_rad_per_sqrt_s(density))),
            rate_word_deg_per_sqrt_h: 0.0,
        }
    }

    /// The budget with the rounding of the rate words.
    ///
    /// A word of period T behind a loop of time constant `t` scatters by
    /// `s^2 = (N^2 / T) (1 - (t / T) (1 - exp(-T / t)))`. Rounded to a step q it has, in the mean over
    /// the rates, `q^2 (1/12 - sum exp(-4 pi^2 k^2 s^2 / q^2) / (2 pi^2 k^2))` more: `q^2 / 12` where the
    /// noise of a word exceeds a third of the step, and nothing without noise, which moves no word.
    /// White from word to word, that is an angle random walk of `q sqrt(T / 12)`. Pulses carry their
    /// remainder over and have none.
    ///
    /// # Source
    /// Derived: Fourier series of the error of rounding, as in Widrow and Kollar, Quantization Noise,
    /// chapter 4.
    #[must_use]
    pub fn with_rate_word(
        self,
        config: &RateOutputConfig,
        word_period_s: f64,
        loop_time_constant_s: f64,
    ) -> Self {
        let step = config.word_step_deg_per_h();
        if step <= 0.0 {
            return self;
        }
        let walk = deg_per_sqrt_h_to_deg_per_h_sqrt_s(self.total_deg_per_sqrt_h());
        let ratio = loop_time_constant_s / word_period_s;
        let kept = 1.0 + ratio * (-1.0 / ratio).exp_m1();
        let squared = walk * walk * kept / (word_period_s * step * step);
        let added = if squared < SMALL_NOISE_STEPS * SMALL_NOISE_STEPS {
            // Of words near the border between two steps, s / sqrt(pi) in all.
            (squared / PI).sqrt() - squared
        } else {
            let regular = (1..=ROUNDING_TERMS).map(|k| {
                let k_squared = f64::from(k * k);
                (-4.0 * PI * PI * k_squared * squared).exp() / (2.0 * PI * PI * k_squared)
            });
            1.0 / 12.0 - regular.sum::<f64>()
        };
        let variance = step * step * added;
        Self {
            rate_word_deg_per_sqrt_h: deg_per_h_sqrt_s_to_deg_per_sqrt_h(
                (variance * word_period_s).sqrt(),
            ),
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
        let names = SOURCES.iter().map(|source| source.name());
        names
            .zip(self.walks_deg_per_sqrt_h)
            .chain([(RATE_WORD, self.rate_word_deg_per_sqrt_h)])
            .chain([(TOTAL, self.total_deg_per_sqrt_h())])
            .collect()
    }
}
