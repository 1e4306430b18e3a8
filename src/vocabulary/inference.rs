//! Words of problems of inference.

use super::word::words;

words! {
    /// How likely the values of a parameter are before any figure is read.
    pub enum Prior {
        /// Equal steps are equally likely.
        Uniform = "uniform",
        /// Equal ratios are equally likely.
        LogUniform = "log-uniform",
    }
}

words! {
    /// What a gate of a problem judges.
    pub enum InferredQuantity {
        /// Number of figures that the others do not explain.
        UnexplainedFigures = "unexplained-figures",
        /// Largest magnitude of a pull.
        LargestPull = "largest-pull",
        /// Number of readings accepted.
        AcceptedReadings = "accepted-readings",
        /// Probability of the most probable reading.
        WeightOfBest = "weight-of-best",
        /// Number of forecasts that a confirmation does not bear out; none without one.
        DisagreeingForecasts = "disagreeing-forecasts",
    }
}
