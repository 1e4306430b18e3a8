//! Recursive least squares held to unit DC gain.

use serde::Deserialize;

use super::common::{Core, CoreFilter, Fault, Filter, FrontEndConfig, Output, dot};
use super::kind::FilterSettings;
use super::rls::{RlsConfig, RlsCore};
use crate::signal::WeightRule;
use crate::vocabulary::{DesiredSignal, OutputRegister, UpdateSign};

/// Recursive least squares held to unit DC gain.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConstrainedRlsFilterConfig {
    /// Number of weights p, one more than are free.
    pub taps: u32,
    /// Forgetting factor, (0, 1].
    pub forgetting_factor: f64,
    /// Initial inverse correlation delta, (deg/h)^-2.
    pub initial_inverse_correlation: f64,
    /// Desired signal.
    pub desired: DesiredSignal,
    /// Samples by which the regressors lag the desired signal's newest sample.
    pub input_lag_samples: u32,
    /// When the result appears.
    pub output_register: OutputRegister,
}

impl FilterSettings for ConstrainedRlsFilterConfig {
    fn build(&self, _sample_period_s: f64) -> Box<dyn Filter> {
        Box::new(ConstrainedRls::new(&RlsConfig {
            taps: self.taps as usize,
            forgetting_factor: self.forgetting_factor,
            initial_inverse_correlation: self.initial_inverse_correlation,
            update_sign: UpdateSign::Corrected,
            front_end: FrontEndConfig {
                desired: self.desired,
                input_lag_samples: self.input_lag_samples as usize,
                output_register: self.output_register,
            },
        }))
    }
}

/// Weights `w = 1/p + B v`, v found by recursive least squares.
///
/// The columns of B are the differences of neighbouring taps, so that every `w` has the sum 1: the
/// filter of least squares among those that leave a constant rate alone. With the mean m of the
/// regressors and their p - 1 differences `z_j = L_j - L_(j+1)`, the output is `m + v'z` and v is
/// adapted to `d - m`. A constant cancels in every z and in `d - m`, so that the mean rate cannot
/// enter the weights at all.
///
/// # Source
/// The generalised sidelobe canceller: Griffiths and Jim, IEEE Trans. Antennas Propag. 30 (1982)
/// 27; Haykin, Adaptive Filter Theory, on linearly constrained filters.
#[derive(Clone, Debug)]
pub struct ConstrainedRlsCore {
    free: RlsCore,
    differences: Vec<f64>,
    weights: Vec<f64>,
}

/// Constrained recursive least squares behind the common front end.
pub type ConstrainedRls = CoreFilter<ConstrainedRlsCore>;

impl ConstrainedRls {
    /// A filter that starts as the mean of its taps.
    ///
    /// `config.taps` counts the weights of the filter, one more than are free.
    ///
    /// # Panics
    /// If there are fewer than two taps; otherwise as [`RlsCore::new`].
    #[must_use]
    pub fn new(config: &RlsConfig) -> Self {
        let taps = config.taps;
        assert!(taps > 1, "one weight of sum 1 has nothing to adapt");
        let core = ConstrainedRlsCore {
            free: RlsCore::new(&RlsConfig {
                taps: taps - 1,
                ..config.clone()
            }),
            differences: vec![0.0; taps - 1],
            weights: vec![1.0 / taps as f64; taps],
        };
        Self::with_core(core, &config.front_end)
    }
}

impl Core for ConstrainedRlsCore {
    fn update(&mut self, regressors: &[f64], desired: f64) -> Result<Output, Fault> {
        let taps = regressors.len() as f64;
        let mean = regressors.iter().sum::<f64>() / taps;
        for (difference, pair) in self.differences.iter_mut().zip(regressors.windows(2)) {
            *difference = pair[0] - pair[1];
        }
        let output = Output {
            value_deg_per_h: dot(&self.weights, regressors),
            weight_sum: self.weights.iter().sum(),
        };
        self.free.update(&self.differences, desired - mean)?;
        let free = self.free.weights();
        for (tap, weight) in self.weights.iter_mut().enumerate() {
            let above = free.get(tap).copied().unwrap_or(0.0);
            let below = tap.checked_sub(1).map_or(0.0, |tap| free[tap]);
            *weight = 1.0 / taps + above - below;
        }
        Ok(output)
    }

    fn weights(&self) -> &[f64] {
        &self.weights
    }

    fn rule(&self, desired: DesiredSignal) -> WeightRule {
        WeightRule::Adaptive {
            desired_weights: desired.weights().to_vec(),
            is_dc_gain_one: true,
        }
    }
}
