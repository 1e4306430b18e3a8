//! What a calibration hands on.

use super::error_model::ErrorParameters;

/// A coefficient of the gyros x, y, z with its standard error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct AxisCoefficients {
    /// Values.
    pub value: [f64; 3],
    /// Standard errors from the measurement noise.
    pub standard_error: [f64; 3],
}

/// Temperature coefficients, where the estimator fitted them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct TemperatureCoefficients {
    /// Of the bias, deg/s per K.
    pub bias: Option<AxisCoefficients>,
    /// Of the bias on the rate of temperature, deg/s per K/min.
    pub bias_rate: Option<AxisCoefficients>,
    /// Of the scale factor, 1/K.
    pub scale: Option<AxisCoefficients>,
}

/// What double precision cost the covariance recursion: largest differences from the square-root form.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RoundingLoss {
    /// Of a bias, deg/s.
    pub bias_deg_per_s: f64,
    /// Of an element of `XA`, ratio.
    pub sensitivity: f64,
}

impl RoundingLoss {
    pub(super) fn between(literal: &[f64; 12], exact: &[f64; 12]) -> Self {
        let mut loss = Self {
            bias_deg_per_s: 0.0,
            sensitivity: 0.0,
        };
        for (index, (one, other)) in literal.iter().zip(exact).enumerate() {
            let is_bias = index % 4 == 3;
            let largest = if is_bias {
                &mut loss.bias_deg_per_s
            } else {
                &mut loss.sensitivity
            };
            *largest = largest.max((one - other).abs());
        }
        loss
    }
}

/// What samples tell beside the parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SampleFindings {
    /// Delays of the gyros x, y, z behind the encoder, s.
    pub delay_s: AxisCoefficients,
    /// Samples left out as outliers, by gyro.
    pub rejected: [usize; 3],
}

/// Estimated parameters of an assembly, with what they rest on.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Calibration {
    /// The twelve parameters, at the reference temperature.
    pub parameters: ErrorParameters,
    /// Covariance of `x1..x12` from the measurement noise, `G Sigma G^T`: what the weights do not
    /// model (drift) is not in it. deg/s, 1.
    pub covariance: [[f64; 12]; 12],
    /// Temperature coefficients, where fitted.
    pub temperature: TemperatureCoefficients,
    /// Temperature of the gyros x, y, z that bias and scale factor belong to, deg C.
    pub reference_temperature_c: [f64; 3],
    /// Forgetting factors `sigma` by group, of the gyros x, y, z.
    pub forgetting_factors: Vec<[f64; 3]>,
    /// Weights the groups are left with, of the gyros x, y, z.
    pub weights: Vec<[f64; 3]>,
    /// Output minus model by group, deg/s; of the square-root form for the covariance recursion.
    pub residual_deg_per_s: Vec<[f64; 3]>,
    /// Squared residuals over their expectation for measurement noise alone; much above 1: drift or
    /// another effect that the model lacks. None without noise or without a group to spare.
    pub reduced_chi_square: [Option<f64>; 3],
    /// Condition number of the weighted rows of the gyros x, y, z.
    pub condition_number: [f64; 3],
    /// For the covariance recursion: what rounding cost.
    pub rounding_loss: Option<RoundingLoss>,
    /// For a calibration from samples: what these tell beside.
    pub of_samples: Option<SampleFindings>,
}

impl Calibration {
    /// Standard errors of `x1..x12` from the measurement noise; deg/s, 1.
    #[must_use]
    pub fn standard_errors(&self) -> [f64; 12] {
        std::array::from_fn(|index| self.covariance[index][index].sqrt())
    }
}
