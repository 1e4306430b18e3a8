//! Settings of the estimation: how the means of a campaign become parameters.

use crate::declare::table;
use crate::vocabulary::{EstimatorKind, ForgettingForm};

table! {
    /// Calibration: what is made of the groups of `[turntable.calibration]`.
    pub struct CalibrationConfig {
        /// Estimators that run side by side. "batch": least squares over all groups; "batch-temperature": with
        /// a coefficient of temperature of each bias; "arls": the patent's recursion, whose forgetting factor
        /// falls with the step of temperature, in square-root form; "arls-covariance": the same to the letter,
        /// which loses digits; "arls-temperature": least squares with the weights of the recursion and a
        /// coefficient of temperature; "encoder-rate": least squares over all samples with the rate that
        /// turntable.encoder shows, changes of rate included, and a coefficient of temperature.
        estimators: Vec<EstimatorKind> = ["batch", "batch-temperature", "arls", "arls-covariance", "arls-temperature"];
        /// The one whose parameters are applied; it runs also if it is not among the others. Source of the
        /// default: the most robust of the five where biases drift with temperature, over simulated campaigns.
        apply: EstimatorKind = "arls-temperature";
        /// Forgetting factor against the step dT of temperature between groups: 1 - c dT, exp(-c dT),
        /// 1 / (1 + c dT) or exp(-(c dT)^2), never below 1e-3. The patent's own equation (17) is lost. Source
        /// of the default: assumed; results depend on the weights, hardly on the form.
        forgetting_form: ForgettingForm = "exponential";
        /// Its constant c for the estimators without a coefficient of temperature. Source of the default:
        /// the equation's list of symbols names none, as if c were 1; least bias errors from 0.5 to 2.
        forgetting_constant_per_k: f64 = 1.0, in 0.0..=1000.0, "1/K";
        /// Its constant c beside a fitted coefficient of temperature. Source of the default: least bias errors
        /// over simulated campaigns.
        forgetting_constant_with_temperature_per_k: f64 = 0.2, in 0.0..=1000.0, "1/K";
        /// xi of the prior P0 = xi I of the recursions, in deg/s and ratios. Source of the default: the patent
        /// says "very large"; beyond it the literal recursion loses more than the prior costs.
        initial_covariance: f64 = 1e8, in 1e-15..=1e15;
        /// Samples of a group beyond so many robust standard deviations (1.4826 MAD) from its median are left
        /// out; 0 keeps all. Source of the default: assumed, 1 of 16000 normal samples.
        outlier_threshold: f64 = 4.0, in 0.0..=1000.0;
    }
}

impl CalibrationConfig {
    /// The estimators that run, each once and in order, the applied one among them.
    #[must_use]
    pub fn kinds(&self) -> Vec<EstimatorKind> {
        let mut kinds: Vec<EstimatorKind> = Vec::new();
        for kind in self.estimators.iter().copied().chain([self.apply]) {
            if !kinds.contains(&kind) {
                kinds.push(kind);
            }
        }
        kinds
    }
}
