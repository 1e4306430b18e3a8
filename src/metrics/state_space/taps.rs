//! White noise as words that are smoothed show it: weighed over as many words as they are correlated.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use super::blocks::{Block, State};

/// Points of a spectrum, over the whole circle.
const POINTS: usize = 4096;

/// Part of its largest value below which a spectrum does not fall: a mean has zeros, an estimate may go
/// below them.
const FLOOR: f64 = 1e-4;

/// A moving average of white noise of unit variance.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Taps {
    /// Weight of the present noise and of those before it.
    weights: Vec<f64>,
}

impl Taps {
    /// The weights that have this autocovariance at lags from 0 on, and none beyond. Nothing without power.
    ///
    /// The spectrum is factored by its cepstrum: `log S = c_0 + 2 sum c_k cos(k w)` is that of
    /// `exp(c_0/2 + sum c_k z^-k)`, whose coefficients follow one from another.
    ///
    /// Source: Oppenheim, Schafer, Discrete-Time Signal Processing, section on minimum phase sequences.
    pub(super) fn of(autocovariance: &[f64]) -> Option<Self> {
        let cosines: Vec<f64> = (0..POINTS)
            .map(|point| (TAU * point as f64 / POINTS as f64).cos())
            .collect();
        let turned = |order: usize, point: usize| cosines[order * point % POINTS];
        let half = POINTS / 2;
        let spectrum: Vec<f64> = (0..=half)
            .map(|point| {
                let lags = autocovariance.iter().enumerate().skip(1);
                let rest: f64 = lags.map(|(lag, it)| it * turned(lag, point)).sum();
                autocovariance[0] + 2.0 * rest
            })
            .collect();
        let largest = spectrum.iter().copied().fold(0.0, f64::max);
        if largest <= 0.0 {
            return None;
        }
        let logarithms: Vec<f64> = spectrum
            .iter()
            .map(|it| it.max(FLOOR * largest).ln())
            .collect();
        let cepstrum = |order: usize| {
            let inner: f64 = (1..half)
                .map(|point| logarithms[point] * turned(order, point))
                .sum();
            let ends = logarithms[0] + logarithms[half] * turned(order, half);
            (2.0 * inner + ends) / POINTS as f64
        };
        let mut weights = vec![(0.5 * cepstrum(0)).exp()];
        let logarithm: Vec<f64> = (0..autocovariance.len()).map(cepstrum).collect();
        for order in 1..autocovariance.len() {
            let sum: f64 = (1..=order)
                .map(|k| k as f64 * logarithm[k] * weights[order - k])
                .sum();
            weights.push(sum / order as f64);
        }
        Some(Self { weights })
    }

    /// The same with such a factor that means of many words have the variance of those of white words.
    ///
    /// * `white_variance`: of one such word.
    pub(super) fn scaled_to(&self, white_variance: f64) -> Option<Self> {
        let total: f64 = self.weights.iter().sum();
        let scale = white_variance.max(0.0).sqrt() / total.abs();
        (scale > 0.0 && scale.is_finite()).then(|| Self {
            weights: self.weights.iter().map(|weight| scale * weight).collect(),
        })
    }

    /// Allan variance at so many words, `(2 sum over the lags of R times the autocorrelation of the
    /// difference of two means) / (4 m^2)`.
    pub(super) fn allan_variance(&self, words: usize) -> f64 {
        let m = words.max(1) as f64;
        let sum: f64 = (0..self.weights.len().min(2 * words.max(1)))
            .map(|lag| {
                let own = self.weights.iter().skip(lag).zip(&self.weights);
                let covariance: f64 = own.map(|(a, b)| a * b).sum();
                let lag_words = lag as f64;
                let overlap = if lag_words <= m {
                    2.0 * m - 3.0 * lag_words
                } else {
                    lag_words - 2.0 * m
                };
                let sides = if lag == 0 { 1.0 } else { 2.0 };
                sides * covariance * overlap
            })
            .sum();
        sum / (2.0 * m * m)
    }

    /// The system: its states are the noises that the words have taken in before.
    pub(super) fn block(&self) -> Block {
        let count = self.weights.len() - 1;
        let holds = "white noise that words before have taken in";
        let unit = |row: usize| DVector::from_fn(count, |index, _| f64::from(index == row));
        let drive = unit(0);
        Block {
            states: (1..=count)
                .map(|age| State::new(format!("smoothing_{age}"), "1", holds))
                .collect(),
            transition: DMatrix::from_fn(count, count, |row, column| f64::from(row == column + 1)),
            process_noise: &drive * drive.transpose(),
            observation: DVector::from_column_slice(&self.weights[1..]),
            measurement_noise: self.weights[0] * self.weights[0],
            cross_covariance: self.weights[0] * &drive,
            initial: DMatrix::identity(count, count),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_answer_a_mean_and_a_pole_come_back_from_their_autocovariance() {
        // A mean of eight words: eighths, and (2 m - 1/8 ...) by its closed form at one word.
        let mean: Vec<f64> = (0..10)
            .map(|lag| (8.0 - f64::from(lag)).max(0.0) / 64.0)
            .collect();
        let taps = Taps::of(&mean).expect("taps");
        for m in [1_usize, 2, 5, 20, 100] {
            let lags = 1..2 * m;
            let shape = |lag: usize| mean.get(lag).copied().unwrap_or(0.0);
            let overlap = |lag: usize| {
                let (m, lag) = (m as f64, lag as f64);
                if lag <= m {
                    2.0 * m - 3.0 * lag
                } else {
                    lag - 2.0 * m
                }
            };
            let sum: f64 = lags.map(|lag| 2.0 * shape(lag) * overlap(lag)).sum();
            let wanted = (2.0 * m as f64 * mean[0] + sum) / (2.0 * (m * m) as f64);
            let ratio = taps.allan_variance(m) / wanted;
            assert!((ratio - 1.0).abs() < 0.03, "{m}: {ratio}");
        }
        let decay = (-0.2_f64).exp();
        let pole: Vec<f64> = (0..40).map(|lag| decay.powi(lag)).collect();
        let of_means = (1.0 + decay) / (1.0 - decay);
        let taps = Taps::of(&pole).expect("taps");
        let taps = taps.scaled_to(of_means).expect("power");
        let first = taps.weights[1] / taps.weights[0];
        assert!((first - decay).abs() < 1e-3, "{first}");
        let total: f64 = taps.weights.iter().sum();
        assert!((total * total / of_means - 1.0).abs() < 1e-12);
        assert_eq!(Taps::of(&[0.0, 0.0]), None);
        assert_eq!(taps.scaled_to(-1.0), None);
    }
}
