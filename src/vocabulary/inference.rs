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
