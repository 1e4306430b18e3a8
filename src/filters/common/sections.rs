//! Recursive filters: one pole, Butterworth and the constant-rate Kalman filter.

use std::f64::consts::PI;

use super::core_filter::{Core, CoreFilter};
use super::divergence::Fault;
use super::filter::Output;
use super::front_end::FrontEndConfig;
use crate::signal::{Section, WeightRule};
use crate::vocabulary::{DesiredSignal, OutputRegister};

/// One-pole low pass `y += k (x - y)` with half power at a frequency.
///
/// With `s = sin(pi f T)` the gain that puts `|H|^2 = 1/2` at f exactly is
/// `k = 2 s (sqrt(1 + s^2) - s)`.
///
/// * `cycles_per_sample`: `f T`, (0, 1/2).
///
/// # Panics
/// If the frequency is not below half the sample rate.
///
/// # Source
/// Derived from `|H|^2 = k^2 / (k^2 + 4 (1 - k) s^2)`.
#[must_use]
pub fn one_pole(cycles_per_sample: f64) -> Vec<Section> {
    let sine = (PI * checked(cycles_per_sample)).sin();
    one_pole_of_gain(2.0 * sine * ((1.0 + sine * sine).sqrt() - sine))
}

fn one_pole_of_gain(gain: f64) -> Vec<Section> {
    vec![Section {
        numerator: [gain, 0.0, 0.0],
        denominator: [gain - 1.0, 0.0],
    }]
}

/// Butterworth low pass of any order with half power at a frequency, as second-order sections.
///
/// The bilinear transform of the analogue prototype, the frequency prewarped so that it is exact:
/// with `w = tan(pi f T)` and `q_i = 2 sin((2 i + 1) pi / 2 n)` each pole pair gives
/// `w^2 (1 + z^-1)^2 / (1 + q w + w^2 + 2 (w^2 - 1) z^-1 + (1 - q w + w^2) z^-2)`; an odd order has
/// `w (1 + z^-1) / (1 + w + (w - 1) z^-1)` besides.
///
/// # Panics
/// If the order is 0 or the frequency is not below half the sample rate.
///
/// # Source
/// Oppenheim and Schafer, Discrete-Time Signal Processing, chapter 7.
#[must_use]
pub fn butterworth(order: usize, cycles_per_sample: f64) -> Vec<Section> {
    assert!(order > 0, "a low pass has at least one pole");
    let w = (PI * checked(cycles_per_sample)).tan();
    let mut sections: Vec<Section> = (0..order / 2)
        .map(|pair| {
            let q = 2.0 * ((2 * pair + 1) as f64 * PI / (2 * order) as f64).sin();
            let scale = 1.0 / (1.0 + q * w + w * w);
            let gain = w * w * scale;
            Section {
                numerator: [gain, 2.0 * gain, gain],
                denominator: [2.0 * (w * w - 1.0) * scale, (1.0 - q * w + w * w) * scale],
            }
        })
        .collect();
    if order % 2 == 1 {
        let gain = w / (1.0 + w);
        sections.push(Section {
            numerator: [gain, gain, 0.0],
            denominator: [(w - 1.0) / (1.0 + w), 0.0],
        });
    }
    sections
}

fn checked(cycles_per_sample: f64) -> f64 {
    assert!(
        cycles_per_sample > 0.0 && cycles_per_sample < 0.5,
        "{cycles_per_sample} cycles a sample lie in (0, 1/2)"
    );
    cycles_per_sample
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

/// A cascade of second-order sections with its state.
#[derive(Clone, Debug)]
pub struct SectionsCore {
    sections: Vec<Section>,
    /// Two delays of each section, of the signal and of the response to a constant 1.
    signal: Vec<[f64; 2]>,
    constant: Vec<[f64; 2]>,
}

/// A recursive filter behind the common front end.
pub type RecursiveFilter = CoreFilter<SectionsCore>;

impl RecursiveFilter {
    /// A cascade at rest.
    ///
    /// # Panics
    /// If there are no sections.
    #[must_use]
    pub fn new(sections: Vec<Section>, output_register: OutputRegister) -> Self {
        assert!(!sections.is_empty(), "a cascade has a section");
        let rest = vec![[0.0; 2]; sections.len()];
        let core = SectionsCore {
            sections,
            signal: rest.clone(),
            constant: rest,
        };
        Self::with_core(core, &FrontEndConfig::direct(output_register))
    }
}

/// One step of the cascade in transposed direct form II, whose rounding stays small.
fn cascade(sections: &[Section], state: &mut [[f64; 2]], input: f64) -> f64 {
    let mut value = input;
    for (section, [first, second]) in sections.iter().zip(state) {
        let [b0, b1, b2] = section.numerator;
        let [a1, a2] = section.denominator;
        let output = b0 * value + *first;
        *first = b1 * value - a1 * output + *second;
        *second = b2 * value - a2 * output;
        value = output;
    }
    value
}

impl Core for SectionsCore {
    fn update(&mut self, regressors: &[f64], _desired: f64) -> Result<Output, Fault> {
        Ok(Output {
            value_deg_per_h: cascade(&self.sections, &mut self.signal, regressors[0]),
            weight_sum: cascade(&self.sections, &mut self.constant, 1.0),
        })
    }

    fn weights(&self) -> &[f64] {
        &[]
    }

    fn regressors(&self) -> usize {
        1
    }

    fn rule(&self, _desired: DesiredSignal) -> WeightRule {
        WeightRule::Sections(self.sections.clone())
    }
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
    /// * `noise_deg_per_h`: standard deviation of the white noise of a word, > 0.
    /// * `step_deg_per_h`: standard deviation of the walk's step per word, > 0.
    ///
    /// # Panics
    /// If either is not positive; the scenario reader refuses that.
    #[must_use]
    pub fn new(noise_deg_per_h: f64, step_deg_per_h: f64, register: OutputRegister) -> Self {
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
        Self::with_core(core, &FrontEndConfig::direct(register))
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
