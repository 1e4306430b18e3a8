//! Hardware pipelines on the bench: from a filter's keys to its pipeline, that pipeline as a filter,
//! the watch over its matrix, its timing and its exports.
//!
//! One file per kind says which pipeline its keys stand for: `rls`, `lms`, `sign_lms`.
//!
//! Invariant: the only part of the bench that knows [`fpga`](crate::fpga).

#[cfg(feature = "hdl")]
mod export;
mod filter;
mod fixed;
mod fixed_core;
mod lms;
mod monitor;
mod pipeline;
mod rls;
mod settings;
mod sign_lms;
mod timing;

#[cfg(feature = "hdl")]
pub use export::{HardwareParts, Stimulus, export_pipeline, export_pipeline_of};
pub use filter::HardwareFilter;
pub use fixed::{FixedSettings, FixedSummary};
pub(super) use lms::lms;
pub use monitor::HealthSummary;
pub use pipeline::{Around, PipelineSettings, has_hardware, kind_names};
pub(super) use rls::rls;
pub use settings::FloatSettings;
pub(super) use sign_lms::sign_lms;
pub use timing::PipelineTiming;
