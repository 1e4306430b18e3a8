//! What theory expects a metric of a record to be, and how far records scatter about it.
//!
//! Of a filter that learns and forgets nothing the weights are those of the second moments so far:
//! the DC gain of time t is off by a part that follows the running mean of the slow noise and by one of
//! variance `c / t` that follows the autocovariance so far, both with the covariance of a running mean,
//! `1 / max(s, t)`.

use std::f64::consts::{PI, TAU};

use nalgebra::{DMatrix, DVector};

use crate::metrics::theory::prediction::{Prediction, lags_needed, predict};
use crate::signal::{FilterShape, WeightRule};

/// A known sine in the words.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownSine {
    /// Amplitude in the words, deg/h.
    pub amplitude_deg_per_h: f64,
    /// Frequency, Hz.
    pub frequency_hz: f64,
}

/// Words of a gyro to second order.
#[derive(Clone, Debug, PartialEq)]
pub struct Words {
    /// Autocovariance of their noise by lag, (deg/h)^2.
    pub autocovariance: Vec<f64>,
    /// Their mean, deg/h.
    pub mean_deg_per_h: f64,
    /// Relative standard deviation of their angle random walk over what its closed form leaves open.
    pub walk_scatter: f64,
    /// Standard deviation of the mean of their slow noise over a record, deg/h.
    pub slow_deviation_deg_per_h: f64,
    /// A sine that they hold.
    pub sine: Option<KnownSine>,
    /// Time between them, s.
    pub period_s: f64,
    /// Time before the record, s.
    pub warm_up_s: f64,
    /// Length of the record, s.
    pub duration_s: f64,
}

/// An expected figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExpectedFigure {
    /// Mean over records.
    pub value: f64,
    /// Standard deviation over records.
    pub deviation: f64,
}

/// What a channel makes of words.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelTheory {
    response: Option<Prediction>,
    shape: Option<FilterShape>,
    /// DC gain.
    pub dc_gain: f64,
    /// What the running mean of the slow noise moves the output by: the mean times the derivative of the
    /// gain by it.
    pub mean_pull: f64,
    /// Variance of the gain that the autocovariance so far gives, times the time so far, s.
    pub gain_variance_s: f64,
}

impl ChannelTheory {
    /// Raw words.
    #[must_use]
    pub fn raw() -> Self {
        Self {
            response: None,
            shape: None,
            dc_gain: 1.0,
            mean_pull: 0.0,
            gain_variance_s: 0.0,
        }
    }

    /// A filter behind words; `Err` says why there is no closed form.
    ///
    /// # Errors
    /// Why there is no closed form.
    pub fn of_filter(shape: &FilterShape, words: &Words) -> Result<Self, &'static str> {
        if words.autocovariance.len() < lags_needed(shape) {
            return Err("too few lags of the autocovariance are known");
        }
        let moments = words.second_moments();
        let fixed = |response: Prediction| Self {
            dc_gain: response.dc_gain(),
            response: Some(response),
            shape: Some(shape.clone()),
            mean_pull: 0.0,
            gain_variance_s: 0.0,
        };
        let WeightRule::Adaptive {
            desired_weights,
            is_dc_gain_one,
            forgetting_factor,
        } = &shape.rule
        else {
            let response = predict(shape, &moments);
            return response.map(fixed).ok_or("its weights are hidden");
        };
        if let Some(weights) = reached(shape, desired_weights) {
            let response = Prediction::of_weights(weights, shape.newest_age_samples);
            return Ok(fixed(response));
        }
        if forgetting_factor.is_none_or(|factor| factor < 1.0) {
            return Err("its weights never settle, so that no closed form holds");
        }
        let response = predict(shape, &moments).ok_or("raw has no power")?;
        let mut theory = fixed(response);
        if !is_dc_gain_one {
            theory.learn(words, &moments, desired_weights);
        }
        Ok(theory)
    }

    /// Works out how the gain moves with the moments.
    fn learn(&mut self, words: &Words, moments: &[f64], desired_weights: &[f64]) {
        let Some(gradient) = self.gradient(moments, desired_weights, |_| 1.0) else {
            return;
        };
        // The mean is in every moment, squared.
        let by_mean = 2.0 * words.mean_deg_per_h * gradient.iter().sum::<f64>();
        self.mean_pull = words.mean_deg_per_h * by_mean;
        self.gain_variance_s = words.variance_of(&gradient) * words.period_s;
    }

    /// Derivative by every moment of a linear function of the weights, given by the weight of each tap.
    ///
    /// `w = R^-1 p`, so that a small change moves it by `a^T (dp - dR w)` with `R a = h`.
    fn gradient(
        &self,
        moments: &[f64],
        desired_weights: &[f64],
        function: impl Fn(usize) -> f64,
    ) -> Option<Vec<f64>> {
        let shape = self.shape.as_ref()?;
        let weights = self.response.as_ref()?.weights()?;
        let taps = weights.len();
        let matrix = DMatrix::from_fn(taps, taps, |i, j| moments[i.abs_diff(j)]);
        let by_tap = matrix
            .cholesky()?
            .solve(&DVector::from_fn(taps, |tap, _| function(tap)));
        let mut gradient = vec![0.0; moments.len()];
        for (tap, own) in by_tap.iter().enumerate() {
            let age = shape.newest_age_samples + tap;
            for (desired_age, weight) in desired_weights.iter().enumerate() {
                gradient[age.abs_diff(desired_age + shape.register_samples)] += own * weight;
            }
            for (other, weight) in weights.iter().enumerate() {
                gradient[tap.abs_diff(other)] -= own * weight;
            }
        }
        Some(gradient)
    }

    /// Angle random walk of the channel, in the unit of that of raw.
    #[must_use]
    pub fn angle_random_walk(&self, raw: f64, words: &Words) -> ExpectedFigure {
        let value = raw * self.dc_gain.abs();
        let fit = (FIT_WORDS * words.period_s / words.duration_s).sqrt();
        let gain = self.gain_over_record(words).deviation / self.dc_gain.abs();
        ExpectedFigure {
            value,
            deviation: value * fit.hypot(gain).hypot(words.walk_scatter),
        }
    }

    /// Mean DC gain over the record.
    ///
    /// The mean over a record from W to W + T of what has the covariance `1 / max(s, t)` has the variance
    /// `2 (T - W ln((W + T) / W)) / T^2`.
    #[must_use]
    pub fn gain_over_record(&self, words: &Words) -> ExpectedFigure {
        let (from, length) = (words.warm_up_s, words.duration_s);
        let early = if from > 0.0 {
            from * ((from + length) / from).ln()
        } else {
            0.0
        };
        let share = 2.0 * (length - early) / (length * length);
        let by_mean = if words.mean_deg_per_h.abs() > 0.0 {
            self.mean_pull / words.mean_deg_per_h
        } else {
            0.0
        };
        let learned = self.gain_variance_s + by_mean * by_mean * words.white_level_s();
        // What the slow noise adds to the mean stays for the record.
        let slow = by_mean * words.slow_deviation_deg_per_h;
        ExpectedFigure {
            value: self.dc_gain,
            deviation: (share * learned).sqrt().hypot(slow),
        }
    }

    /// Standard deviation of the channel's noise, deg/h.
    #[must_use]
    pub fn noise_std(&self, words: &Words) -> ExpectedFigure {
        let power = match self.weights() {
            Some(weights) => noise_power(weights, &words.autocovariance),
            None => words.autocovariance[0],
        };
        // The scatter of the variance of a record: twice the sum of the squared autocovariance.
        let count = words.duration_s / words.period_s;
        let squares: f64 = words.autocovariance[1..]
            .iter()
            .map(|value| value * value)
            .sum();
        let whole = words.autocovariance[0].powi(2) + 2.0 * squares;
        let relative = (0.5 * whole / words.autocovariance[0].powi(2) / count).sqrt();
        let value = power.sqrt();
        let gain =
            self.gain_over_record(words).deviation / self.dc_gain.abs().max(f64::MIN_POSITIVE);
        ExpectedFigure {
            value,
            deviation: value * relative.hypot(gain),
        }
    }

    /// How the autocovariance of the channel at a lag follows from that of the words: weights by lag.
    fn lag_weights(&self, lag: usize) -> Vec<f64> {
        let weights = self.weights().unwrap_or(&[1.0]);
        let mut by_lag = vec![0.0; lag + weights.len()];
        for (age, own) in weights.iter().enumerate() {
            for (other_age, other) in weights.iter().enumerate() {
                by_lag[(lag + age).abs_diff(other_age)] += own * other;
            }
        }
        by_lag
    }

    /// Autocovariance of the channel's noise at a lag, (deg/h)^2, its weights as they are.
    #[must_use]
    pub fn autocovariance(&self, lag: usize, words: &Words) -> ExpectedFigure {
        let by_lag = self.lag_weights(lag);
        let rows = by_lag.iter().zip(&words.autocovariance);
        let value = rows.map(|(weight, own)| weight * own).sum();
        let moments = words.smeared(&by_lag);
        let variance = bartlett(&moments, &moments);
        ExpectedFigure {
            value,
            deviation: (variance * words.period_s / words.duration_s).sqrt(),
        }
    }

    /// Correlation of the autocovariance at a lag with that of another channel at another.
    #[must_use]
    pub fn autocovariance_correlation(
        &self,
        lag: usize,
        (other, other_lag): (&Self, usize),
        words: &Words,
    ) -> f64 {
        let own = words.smeared(&self.lag_weights(lag));
        let against = words.smeared(&other.lag_weights(other_lag));
        let scale = bartlett(&own, &own) * bartlett(&against, &against);
        bartlett(&own, &against) / scale.sqrt().max(f64::MIN_POSITIVE)
    }

    /// The weights, newest sample first; none of raw or an infinite response.
    #[must_use]
    pub fn weights(&self) -> Option<&[f64]> {
        self.response.as_ref()?.weights()
    }

    /// Phase delay behind raw at the sine of the words, s; none without a sine.
    #[must_use]
    pub fn delay_s(&self, words: &Words) -> Option<ExpectedFigure> {
        let sine = words.sine?;
        let Some(response) = &self.response else {
            return Some(ExpectedFigure {
                value: 0.0,
                deviation: 0.0,
            });
        };
        let value = response.delay_s(sine.frequency_hz, words.period_s);
        let deviation = self.delay_deviation_s(words, &sine).unwrap_or(0.0);
        Some(ExpectedFigure { value, deviation })
    }

    /// How far what it learns scatters its delay from record to record, s.
    fn delay_deviation_s(&self, words: &Words, sine: &KnownSine) -> Option<f64> {
        let shape = self.shape.as_ref()?;
        let WeightRule::Adaptive {
            desired_weights,
            is_dc_gain_one: false,
            ..
        } = &shape.rule
        else {
            return None;
        };
        reached(shape, desired_weights).is_none().then_some(())?;
        let weights = self.weights()?;
        let turn = TAU * sine.frequency_hz * words.period_s;
        let (re, im) = weights
            .iter()
            .enumerate()
            .fold((0.0, 0.0), |(re, im), (age, weight)| {
                let angle = turn * age as f64;
                (re + weight * angle.cos(), im - weight * angle.sin())
            });
        let power = re * re + im * im;
        let angular = TAU * sine.frequency_hz;
        let gradient = self.gradient(&words.second_moments(), desired_weights, |tap| {
            let angle = turn * tap as f64;
            // The imaginary part of `exp(-i angle) / H`.
            (-angle.sin() * re - angle.cos() * im) / power / -angular
        })?;
        let time_s = words.warm_up_s + words.duration_s;
        Some((words.variance_of(&gradient) * words.period_s / time_s).sqrt())
    }
}

/// Words of white noise per degree of freedom of the angle random walk that the Allan fit gives, over 2:
/// measured, 0.09 % over an hour at 3990 Hz.
const FIT_WORDS: f64 = 12.4;

/// Weights that make the desired signal itself, where the filter weighs all of its samples: there it goes
/// whatever the words, and stays.
fn reached(shape: &FilterShape, desired_weights: &[f64]) -> Option<Vec<f64>> {
    let mut weights = vec![0.0; shape.taps?];
    for (age, weight) in desired_weights.iter().enumerate() {
        let tap = (age + shape.register_samples).checked_sub(shape.newest_age_samples)?;
        *weights.get_mut(tap)? = *weight;
    }
    Some(weights)
}

/// Power of a weighted sum of noise.
fn noise_power(weights: &[f64], autocovariance: &[f64]) -> f64 {
    let rows = weights.iter().enumerate();
    rows.map(|(i, left)| {
        let columns = weights.iter().enumerate();
        let row: f64 = columns
            .map(|(j, right)| right * autocovariance.get(i.abs_diff(j)).copied().unwrap_or(0.0))
            .sum();
        left * row
    })
    .sum()
}

impl Words {
    /// Second moments by lag, mean and sine included, (deg/h)^2.
    #[must_use]
    pub fn second_moments(&self) -> Vec<f64> {
        let mean = self.mean_deg_per_h * self.mean_deg_per_h;
        let lags = self.autocovariance.iter().enumerate();
        lags.map(|(lag, noise)| noise + mean + self.sine_product(lag))
            .collect()
    }

    /// Product of a sine with itself a lag later, in the mean.
    fn sine_product(&self, lag: usize) -> f64 {
        self.sine.map_or(0.0, |sine| {
            let turn = TAU * sine.frequency_hz * self.period_s * lag as f64;
            0.5 * sine.amplitude_deg_per_h.powi(2) * turn.cos()
        })
    }

    /// Two-sided density of the noise at DC, (deg/h)^2 s.
    fn white_level_s(&self) -> f64 {
        let later: f64 = self.autocovariance[1..].iter().sum();
        (self.autocovariance[0] + 2.0 * later) * self.period_s
    }

    /// Autocovariance of the noise at a lag of either sign.
    fn at_lag(&self, lag: isize) -> f64 {
        let known = self.autocovariance.get(lag.unsigned_abs());
        known.copied().unwrap_or(0.0)
    }

    /// Lags beyond which the noise is not correlated.
    fn reach(&self) -> isize {
        self.autocovariance.len().cast_signed()
    }

    /// A weighted sum of products at a lag beside one product: `b_k = sum of gradient_l noise(k + l)` at every lag
    /// k that is not out of reach, from the most negative one on.
    fn smeared(&self, gradient: &[f64]) -> Vec<f64> {
        let shifts = -2 * self.reach()..=2 * self.reach();
        let of = |shift: isize| {
            let lags = gradient.iter().enumerate();
            lags.filter(|(_, own)| **own != 0.0)
                .map(|(lag, own)| own * self.at_lag(shift + lag.cast_signed()))
                .sum()
        };
        shifts.map(of).collect()
    }

    /// Variance of a weighted sum of moments that are means over one word each, as far as the noise alone
    /// and the noise beside a sine make it.
    ///
    /// Source: Bartlett's formula, and the product of a sine with noise.
    fn variance_of(&self, gradient: &[f64]) -> f64 {
        let moments = self.smeared(gradient);
        let beside = self.sine.map_or(0.0, |sine| {
            let turn = TAU * sine.frequency_hz * self.period_s;
            let later: f64 = (1..self.reach())
                .map(|lag| 2.0 * self.at_lag(lag) * (turn * lag as f64).cos())
                .sum();
            let product: f64 = gradient
                .iter()
                .enumerate()
                .map(|(lag, own)| own * (turn * lag as f64).cos())
                .sum();
            2.0 * sine.amplitude_deg_per_h.powi(2) * product * product * (self.at_lag(0) + later)
        });
        bartlett(&moments, &moments) + beside
    }
}

/// Covariance of two weighted sums of products at a lag, each a mean over one word, as far as the noise alone makes
/// it: over all lags k the sum of `b_k c_k + b_k c_-k`, of what [`Words::smeared`] makes of both.
///
/// Source: Bartlett's formula.
fn bartlett(own: &[f64], against: &[f64]) -> f64 {
    let turned = own.iter().rev();
    let rows = own.iter().zip(turned).zip(against);
    rows.map(|((a, b), c)| a * c + b * c).sum()
}

/// Mean and standard deviation of the largest magnitude of independent normals of these deviations.
#[must_use]
pub fn largest_of_normals(deviations: &[f64]) -> ExpectedFigure {
    let value = crate::metrics::steps::nonlinearity::expected_largest(deviations);
    // Of some ten deviates or more: Gumbel's scale is the deviation over sqrt(2 ln n).
    let count = deviations
        .iter()
        .filter(|deviation| **deviation > 0.0)
        .count();
    let widest = deviations.iter().copied().fold(0.0, f64::max);
    let scale = widest / (2.0 * (count.max(2) as f64).ln()).sqrt();
    ExpectedFigure {
        value,
        deviation: (scale * PI / 6.0_f64.sqrt()).min(value),
    }
}
