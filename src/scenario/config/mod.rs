//! The configuration of one run: the keys of the scenario file that belong to no stage.
//!
//! Invariant: declarations only. A value that reaches a stage has been checked by the reader.

mod allan;
pub(in crate::scenario) mod channels;
mod comparison;
mod judging;
mod output;
mod range;
mod run;
mod trial;

pub use allan::{AllanConfig, AllanEstimatorConfig};
pub use comparison::{
    AssumptionConfig, ComparisonColumn, ComparisonConfig, ComparisonKind, ComparisonRowConfig,
    FigureConfig,
};
pub use judging::{GateConfig, GateDecision, InconclusivePolicy, PublishedConfig};
pub use output::{OutputConfig, ReportedRuns, SamplesFormat};
pub use range::{RangeConfig, Spacing};
pub use run::Scenario;
pub use trial::{BlackBoxTrial, FilterState, TrialConfig};
