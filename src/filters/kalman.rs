//! Kalman filter for a rate that walks, in white noise.

use super::common::{Core, CoreFilter, Fault, Filter, FrontEndConfig, Output};
use super::kind::FilterSettings;
use super::one_pole::one_pole_of_gain;
use crate::declare::{renamed, table};
use crate::signal::WeightRule;
use crate::vocabulary::{DesiredSignal, OutputRegister};

table! {
    /// Kalman filter for a rate that walks slowly, in white noise: a one-pole filter once settled.
    pub struct KalmanFilterConfig {
        /// Standard deviation of the white noise of one word. Source of the default: the noise budget.
        measurement_noise_deg_per_h: f64 = 19.0, in 1e-6..=1e9, "deg/h";
        #[serde(flatten)]
        rate_random_walk: RateRandomWalk;
        /// When the result appears: at the next sample tick, or as soon as it is computed.
        output_register: OutputRegister = "next-sample";
    }
}

renamed! {
    /// Random walk of the rate that a Kalman filter reckons with.
    pub enum RateRandomWalk, one "random walk of the rate" {
        /// Random walk of the rate that the filter reckons with, as of gyro.slow_noise. Source of the
        /// default: assumed; gives half power at about 100 Hz.
        PerSqrtH = "rate_random_walk_deg_per_h_per_sqrt_h": 11400.0, in 6e-8..=6e10, "deg/h/sqrt(h)";
        formerly PerSqrtS = "rate_random_walk_deg_per_h_per_sqrt_s": 190.0, in 1e-9..=1e9,
            "deg/h/sqrt(s)", times 60.0;
    }
}

impl RateRandomWalk {
    /// Standard deviation of the walk after a time, deg/h.
    #[must_use]
    pub fn after(self, time_s: f64) -> f64 {
        let per_sqrt_s = match self {
            Self::PerSqrtH(per_sqrt_h) => per_sqrt_h / 60.0,
            Self::PerSqrtS(per_sqrt_s) => per_sqrt_s,
        };
        per_sqrt_s * time_s.sqrt()
    }
}

impl FilterSettings for KalmanFilterConfig {
    fn build(&self, sample_period_s: f64) -> Option<Box<dyn Filter>> {
        Some(Box::new(Kalman::new(&KalmanConfig {
            noise_deg_per_h: self.measurement_noise_deg_per_h,
            step_deg_per_h: self.rate_random_walk.after(sample_period_s),
            output_register: self.output_register,
        })))
    }
}

/// Settings of a constant-rate Kalman filter, per word.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KalmanConfig {
    /// Standard deviation of the white noise of a word, > 0, deg/h.
    pub noise_deg_per_h: f64,
    /// Standard deviation of the walk's step from word to word, > 0, deg/h.
    pub step_deg_per_h: f64,
    /// When the result appears.
    pub output_register: OutputRegister,
}

/// Steady gain of a Kalman filter for a rate that walks, in white noise.
///
/// With the ratio `r = q / m` of the variance of the walk's step to that of the noise, the
/// covariance before an update over m solves `p^2 = r p + r`, and the gain is `p / (p + 1)`.
///
/// # Source
/// The scalar Riccati equation, as in Bar-Shalom et al., Estimation with Applications to Tracking
/// and Navigation, chapter 6.
#[must_use]
pub fn kalman_gain(step_to_noise_variance: f64) -> f64 {
    let r = step_to_noise_variance;
    let covariance = 0.5 * (r + (r * r + 4.0 * r).sqrt());
    covariance / (covariance + 1.0)
}

/// A Kalman filter for a rate that walks, in white noise: a one-pole filter whose gain starts at 1
/// and settles.
#[derive(Clone, Debug)]
pub struct KalmanCore {
    /// Variance of the rate over that of the noise, before the next update; infinite at the start.
    covariance: f64,
    step_to_noise_variance: f64,
    rate_deg_per_h: f64,
    weight_sum: f64,
}

/// The constant-rate Kalman filter behind the common front end.
pub type Kalman = CoreFilter<KalmanCore>;

impl Kalman {
    /// A filter that knows nothing of the rate yet.
    ///
    /// # Panics
    /// If noise or step is not positive; the scenario reader refuses that.
    #[must_use]
    pub fn new(config: &KalmanConfig) -> Self {
        let KalmanConfig {
            noise_deg_per_h,
            step_deg_per_h,
            output_register,
        } = *config;
        assert!(
            noise_deg_per_h > 0.0 && step_deg_per_h > 0.0,
            "noise {noise_deg_per_h} and step {step_deg_per_h} are positive"
        );
        let core = KalmanCore {
            covariance: f64::INFINITY,
            step_to_noise_variance: (step_deg_per_h / noise_deg_per_h).powi(2),
            rate_deg_per_h: 0.0,
            weight_sum: 0.0,
        };
        Self::with_core(core, &FrontEndConfig::direct(output_register))
    }
}

impl Core for KalmanCore {
    fn update(&mut self, regressors: &[f64], _desired: f64) -> Result<Output, Fault> {
        // p / (p + 1) without the ratio of two infinities of the first update.
        let gain = 1.0 / (1.0 + 1.0 / self.covariance);
        self.rate_deg_per_h += gain * (regressors[0] - self.rate_deg_per_h);
        self.weight_sum += gain * (1.0 - self.weight_sum);
        // Updated, the variance is (1 - k) p = k in units of the noise; the walk adds its step.
        self.covariance = gain + self.step_to_noise_variance;
        Ok(Output {
            value_deg_per_h: self.rate_deg_per_h,
            weight_sum: self.weight_sum,
        })
    }

    fn weights(&self) -> &[f64] {
        &[]
    }

    fn regressors(&self) -> usize {
        1
    }

    fn rule(&self, _desired: DesiredSignal) -> WeightRule {
        WeightRule::Sections(one_pole_of_gain(kalman_gain(self.step_to_noise_variance)))
    }
}
