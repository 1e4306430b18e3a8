//! Words of filters and calibration.

use super::word::words;

words! {
    /// Unit in which the constants of a line enhancer are meant.
    pub enum ConstantUnit {
        /// Degrees per hour, the unit of the words.
        DegPerH = "deg/h",
        /// Degrees per second.
        DegPerS = "deg/s",
        /// Radians per second.
        RadPerS = "rad/s",
    }

    /// What an adaptive filter aims at.
    pub enum DesiredSignal {
        /// The current sample.
        Current = "current",
        /// The mean of the newest two samples.
        TwoSampleMean = "two-sample-mean",
    }

    /// Where a hardware pipeline divides.
    pub enum Division {
        /// Once per sample; the products are multiplied by the reciprocal.
        Reciprocal = "reciprocal",
        /// Once for each element of the matrix.
        Elementwise = "elementwise",
    }

    /// Weights of a line enhancer at the start.
    pub enum InitialWeights {
        /// 1/M in every tap: the mean of the taps.
        Mean = "mean",
        /// Zero.
        Zero = "zero",
    }

    /// Words of a hardware pipeline.
    pub enum NumberFormat {
        /// IEEE 754 binary64.
        Binary64 = "binary64",
        /// IEEE 754 binary32.
        Binary32 = "binary32",
        /// binary64 whose subnormal numbers count as zero.
        Binary64FlushToZero = "binary64-ftz",
        /// binary32 whose subnormal numbers count as zero.
        Binary32FlushToZero = "binary32-ftz",
    }

    /// When a filter's result appears.
    pub enum OutputRegister {
        /// At the next sample tick.
        NextSample = "next-sample",
        /// As soon as it is computed.
        Immediate = "immediate",
    }

    /// Arithmetic of a filter.
    pub enum Pipeline {
        /// The textbook recursion.
        Textbook = "textbook",
        /// The pipeline of the hardware: every bit and every clock.
        Fpga = "fpga",
    }

    /// How the weights of a line enhancer are corrected.
    pub enum SignLmsForm {
        /// By the sign of the error, over the energy: the patent's.
        Sign = "sign",
        /// By the error, over the energy.
        Nlms = "nlms",
        /// By the error, over the energy, the sum of the weights left alone.
        UnityGain = "unity-gain",
    }

    /// Order of the products in the update of the inverse correlation matrix.
    pub enum UpdateOrder {
        /// `(t_i t_j) r`, the hardware's: the matrix stays symmetric to the last bit.
        Schedule = "schedule",
        /// `(t_i r) t_j`, the gain vector first: fails below a forgetting factor of 1.
        GainFirst = "gain-first",
    }

    /// Sign before the error term of the weight update.
    pub enum UpdateSign {
        /// Plus: the form that converges.
        Corrected = "corrected",
        /// Minus, as the paper's equations (6) and (9) print it: diverges.
        AsPrinted = "as-printed",
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
    }

    /// How the forgetting factor falls with the step of temperature.
    pub enum ForgettingLaw {
        /// `1 - c dT`.
        Linear = "linear",
        /// `exp(-c dT)`.
        Exponential = "exponential",
        /// `1 / (1 + c dT)`.
        Rational = "rational",
        /// `exp(-(c dT)^2)`.
        Gaussian = "gaussian",
    }

    /// How rates follow from the outputs.
    pub enum CompensationRule {
        /// `XA^-1 (Wm - XB)`.
        Exact = "exact",
        /// `Wm - (K_G Wm + theta_G Wm + B_G)`, the patent's equations (23) and (24).
        FirstOrder = "first-order",
    }

    /// Averaging times of an Allan curve.
    pub enum AveragingTimes {
        /// 1, 2, 4, 8, ... samples.
        Octave = "octave",
        /// 1, 2, 5, 10, ... samples.
        Decade = "decade",
        /// Every number of samples, up to 1000 of them.
        All = "all",
    }
}

impl EstimatorKind {
    /// The word in files.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Batch => "batch",
            Self::BatchTemperature => "batch-temperature",
            Self::Arls => "arls",
            Self::ArlsCovariance => "arls-covariance",
            Self::ArlsTemperature => "arls-temperature",
        }
    }

    /// Whether it fits a temperature coefficient of each bias.
    #[must_use]
    pub fn fits_temperature(self) -> bool {
        matches!(self, Self::BatchTemperature | Self::ArlsTemperature)
    }
}
