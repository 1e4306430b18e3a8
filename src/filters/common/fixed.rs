//! Filters whose weights are given: the ones a user would reach for before an adaptive one.

use nalgebra::{DMatrix, DVector};

use super::core_filter::{Core, CoreFilter, dot};
use super::divergence::Fault;
use super::filter::Output;
use super::front_end::FrontEndConfig;
use crate::signal::WeightRule;
use crate::vocabulary::{DesiredSignal, OutputRegister};

/// Weights of the mean of the newest `taps` samples.
///
/// # Panics
/// If there are no taps.
#[must_use]
pub fn moving_average(taps: usize) -> Vec<f64> {
    assert!(taps > 0, "a mean has at least one sample");
    vec![1.0 / taps as f64; taps]
}

/// Weights of a Savitzky-Golay filter that gives the smoothed value at the newest sample.
///
/// The value at age 0 of the polynomial of degree `order` fitted by least squares to the newest
/// `taps` samples. Every polynomial signal of that degree passes without error and so without
/// delay; the price is noise, for a straight line `(4 p - 2) / (p (p + 1))` of the power.
///
/// Computed with orthogonal columns (QR) of powers of the age scaled to [-1, 1].
///
/// # Panics
/// If there are not more taps than the order; the scenario reader refuses that.
///
/// # Source
/// Savitzky and Golay, Anal. Chem. 36 (1964) 1627, at the end point of the window.
#[must_use]
pub fn savitzky_golay(taps: usize, order: usize) -> Vec<f64> {
    assert!(taps > order, "{taps} samples cannot fix degree {order}");
    let half = 0.5 * (taps as f64 - 1.0).max(1.0);
    let powers = DMatrix::from_fn(taps, order + 1, |age, power| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_possible_wrap,
            reason = "the order of a smoothing polynomial is small"
        )]
        let power = power as i32;
        (age as f64 / half - 1.0).powi(power)
    });
    let decomposition = powers.qr();
    let newest = DVector::from_fn(
        order + 1,
        |power, _| {
            if power % 2 == 0 { 1.0 } else { -1.0 }
        },
    );
    // The value at the newest sample is c'R^-1 Q'x, and so the weights are Q R^-T c.
    let solved = decomposition
        .r()
        .transpose()
        .solve_lower_triangular(&newest)
        .expect("distinct ages give independent powers");
    (decomposition.q() * solved).as_slice().to_vec()
}

/// Weights that never change.
#[derive(Clone, Debug)]
pub struct FixedCore {
    weights: Vec<f64>,
    weight_sum: f64,
}

/// Given weights behind the common front end.
pub type FixedFilter = CoreFilter<FixedCore>;

impl FixedFilter {
    /// The filter with these weights, newest sample first.
    ///
    /// # Panics
    /// If there are no weights.
    #[must_use]
    pub fn new(weights: Vec<f64>, output_register: OutputRegister) -> Self {
        Self::delayed(weights, 0, output_register)
    }

    /// The filter with these weights, the first of which stands on the sample of age
    /// `delay_samples`.
    ///
    /// # Panics
    /// If there are no weights.
    #[must_use]
    pub fn delayed(
        weights: Vec<f64>,
        delay_samples: usize,
        output_register: OutputRegister,
    ) -> Self {
        assert!(!weights.is_empty(), "a filter has at least one tap");
        let weight_sum = weights.iter().sum();
        let core = FixedCore {
            weights,
            weight_sum,
        };
        let front_end = FrontEndConfig {
            input_lag_samples: delay_samples,
            ..FrontEndConfig::direct(output_register)
        };
        Self::with_core(core, &front_end)
    }
}

impl Core for FixedCore {
    fn update(&mut self, regressors: &[f64], _desired: f64) -> Result<Output, Fault> {
        Ok(Output {
            value_deg_per_h: dot(&self.weights, regressors),
            weight_sum: self.weight_sum,
        })
    }

    fn weights(&self) -> &[f64] {
        &self.weights
    }

    fn rule(&self, _desired: DesiredSignal) -> WeightRule {
        WeightRule::Fixed(self.weights.clone())
    }
}
