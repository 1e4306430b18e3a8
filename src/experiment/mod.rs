//! Plans and runs scenarios: the only module that knows every stage.
//!
//! Invariant: wiring only; what a stage does stands in the stage. Checks that need physics live in
//! `plan`, so that `check` and `run` refuse the same files.

mod allan_settings;
mod assembly_motion;
mod budget;
mod build;
mod calibrate;
mod calibration_sheet;
mod calibration_units;
mod campaign;
mod campaign_metrics;
mod change_per_unit;
mod channel_filter;
mod comparison;
mod compensation;
mod group_findings;
mod in_memory;
mod ledger;
mod line_enhancer;
mod log_compensation;
mod log_filters;
mod log_trial;
mod measurement;
mod motion;
mod output_average;
mod pipeline_check;
mod pipeline_export;
mod pipeline_filter;
mod pipeline_metrics;
mod pipeline_settings;
mod plan;
mod plan_filters;
mod plan_metrics;
mod progress;
mod published_check;
mod rate_twins;
mod record_length;
mod results;
mod resume;
mod run;
mod run_files;
mod simulate;
mod suite;
mod suite_output;
mod survey;
mod textbook;
mod theory;
mod threads;

pub use budget::{GyroBudget, gyro_budget};
pub use build::BUILD;
pub use calibrate::{
    CalibrateError, CalibrationTrial, GroupsSettings, calibrate_campaign, calibrate_groups,
};
pub use calibration_sheet::calibration_sheet;
pub use campaign::calibrate_scenario;
pub use in_memory::{Run, RunError, Samples, Scenario, UnknownName};
pub use log_compensation::{
    CompensatedLog, LogCompensation, compensate_log, load_log_compensation,
};
pub use log_filters::{LogFilters, load_log_filters};
pub use log_trial::{LogInput, LogMotion, LogSettings, LogTrial, LogTrialError, try_log};
pub use pipeline_export::{Stimulus, export_pipeline, scenario_stimulus};
pub use pipeline_filter::{HardwareFilter, HealthSummary};
pub use pipeline_settings::{PipelineSettings, PipelineTiming};
pub use plan::{Plan, plan_suite};
pub use progress::Progress;
pub use resume::Resume;
pub use suite::{Observer, SuiteError, SuiteOptions, SuiteOutcome, run_suite, write_runs};
pub use survey::{Sound, check_suite};
pub use threads::{THREADS_MAX, start_threads, thread_count};
