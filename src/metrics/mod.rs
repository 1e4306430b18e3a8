//! Measures: what a record of rate words says, and how sure it is.
//!
//! Invariant: metrics see samples, a sample period and plain parameters; never a scenario, a gyro
//! or a filter. Everything is in deg/h and s.

mod estimate;

pub use estimate::{ChannelFailure, ChannelMetrics, Estimate, Metric};
