//! Plans and runs scenarios: the only module that knows every stage.
//!
//! Invariant: wiring only; what a stage does stands in the stage. Checks that need physics live in
//! `plan`, so that `check` and `run` refuse the same files.

mod allan_settings;
mod assembly_motion;
mod budget;
mod channel_filter;
mod comparison;
mod log_filters;
mod log_trial;
mod motion;
mod pipeline_check;
mod pipeline_export;
mod pipeline_filter;
mod pipeline_metrics;
mod pipeline_settings;
mod plan;
mod published_check;
mod rate_twins;
mod run;
mod simulate;
mod suite;
mod textbook;
mod theory;

pub use budget::{GyroBudget, gyro_budget};
pub use log_filters::{LogFilters, load_log_filters};
pub use log_trial::{LogMotion, LogSettings, LogTrial, LogTrialError, try_log};
pub use pipeline_export::{ExportForm, Stimulus, export_pipeline, scenario_stimulus};
pub use pipeline_filter::{HardwareFilter, HealthSummary};
pub use pipeline_settings::{CoreSettings, PipelineSettings, PipelineTiming};
pub use plan::{Plan, plan_suite};
pub use suite::{Observer, SuiteError, SuiteOptions, SuiteOutcome, run_suite};
