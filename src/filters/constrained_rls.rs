//! Recursive least squares held to unit DC gain.

use super::common::{Core, CoreFilter, Fault, Filter, FrontEndConfig, Output, dot};
use super::kind::FilterSettings;
use super::rls::{RlsConfig, RlsCore};
use crate::declare::table;
use crate::signal::WeightRule;
use crate::vocabulary::{DesiredSignal, OutputRegister, UpdateSign};

table! {
    /// Recursive least squares held to unit DC gain: the mean rate cannot enter its weights.
    pub struct ConstrainedRlsFilterConfig {
        /// Number of weights, one more than are free. Source of the default: that of the plain filter.
        taps: u32 = 4, in 2..=64;
        /// Forgetting factor. Source of the default: that of the plain filter.
        forgetting_factor: f64 = 1.0, in 1e-3..=1.0;
        /// Initial inverse correlation. Source of the default: that of the plain filter.
        initial_inverse_correlation: f64 = 7.716e-4, in 1e-18..=1e12, "(deg/h)^-2";
        /// What the filter aims at.
        desired: DesiredSignal = "current";
        /// Samples by which the regressors lag the newest sample of the desired signal.
        input_lag_samples: u32 = 1, in 0..=64;
        /// When the result appears: at the next sample tick, or as soon as it is computed.
        output_register: OutputRegister = "next-sample";
    }
}

impl FilterSettings for ConstrainedRlsFilterConfig {
    fn build(&self, _sample_period_s: f64) -> Option<Box<dyn Filter>> {
        Some(Box::new(ConstrainedRls::new(&RlsConfig {
            taps: self.taps as usize,
            forgetting_factor: self.forgetting_factor,
            initial_inverse_correlation: self.initial_inverse_correlation,
            update_sign: UpdateSign::Corrected,
            front_end: FrontEndConfig {
                desired: self.desired,
                input_lag_samples: self.input_lag_samples as usize,
                output_register: self.output_register,
            },
        })))
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
            forgetting_factor: Some(self.free.forgetting_factor()),
        }
    }
}
