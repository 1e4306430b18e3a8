//! Words of the calibration.

use super::word::words;

words! {
    /// How the outputs of an assembly are turned back into rates.
    pub enum CompensationForm {
        /// `XA^-1 (Wm - XB)`.
        Exact = "exact",
        /// The patent's `Wm - (K_G Wm + theta_G Wm + B_G)`, equations (23) and (24).
        ///
        /// The true rate is replaced by the output, so that errors of second order remain.
        FirstOrder = "first-order",
    }

    /// How the forgetting factor falls with the temperature step `dT = |T_{j+1} - T_j|`.
    ///
    /// The patent's equation (17) is an image that is lost. Its symbol list names no constant beside
    /// the temperatures; the forms agree but for the fourth to first order in `c dT`, and results
    /// depend on the resulting weights, hardly on the form.
    pub enum ForgettingForm {
        /// F1: `1 - c dT`.
        Linear = "linear",
        /// F2: `exp(-c dT)`.
        Exponential = "exponential",
        /// F3: `1 / (1 + c dT)`.
        Rational = "rational",
        /// F4: `exp(-(c dT)^2)`.
        Gaussian = "gaussian",
    }

    /// An estimator of the twelve parameters.
    pub enum EstimatorKind {
        /// Least squares over all groups.
        Batch = "batch",
        /// The same with a temperature coefficient of each bias.
        BatchTemperature = "batch-temperature",
        /// The patent's recursion with temperature-driven forgetting, in square-root form.
        Arls = "arls",
        /// The same recursion of covariances, to the letter.
        ArlsCovariance = "arls-covariance",
        /// Least squares with the weights of the recursion and a temperature coefficient of each bias.
        ArlsTemperature = "arls-temperature",
        /// Least squares over all samples with the rate that the table's encoder shows, changes of rate included,
        /// and a temperature coefficient of each bias.
        EncoderRate = "encoder-rate",
    }
}

impl EstimatorKind {
    /// Whether it fits a temperature coefficient of each bias.
    #[must_use]
    pub const fn fits_temperature(self) -> bool {
        matches!(
            self,
            Self::BatchTemperature | Self::ArlsTemperature | Self::EncoderRate
        )
    }

    /// Whether it takes the samples of the gyros, with the angle of an encoder, in place of their means.
    #[must_use]
    pub const fn takes_samples(self) -> bool {
        matches!(self, Self::EncoderRate)
    }
}
