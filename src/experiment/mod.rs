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
mod ledger;
mod log_compensation;
mod log_filters;
mod log_trial;
mod measurement;
mod motion;
mod output_average;
mod pipeline_metrics;
mod plan;
mod plan_filters;
mod plan_metrics;
mod published_check;
mod rate_twins;
mod record_length;
mod resume;
mod run;
mod run_files;
mod simulate;
mod stimulus;
mod stop;
mod suite;
mod suite_output;
mod survey;
mod theory;
mod threads;

pub use budget::{GyroBudget, gyro_budget};
pub use build::BUILD;
pub use calibrate::{
    CalibrateError, CalibrationTrial, GroupsSettings, calibrate_campaign, calibrate_groups,
};
pub use calibration_sheet::calibration_sheet;
pub use campaign::calibrate_scenario;
pub use log_compensation::{
    CompensatedLog, LogCompensation, compensate_log, load_log_compensation,
};
pub use log_filters::{LogFilters, load_log_filters};
pub use log_trial::{LogInput, LogMotion, LogSettings, LogTrial, LogTrialError, try_log};
pub use plan::{Plan, plan_suite};
pub use resume::Resume;
pub use stimulus::scenario_stimulus;
pub use suite::{Observer, SuiteError, SuiteOptions, SuiteOutcome, run_suite};
pub use survey::{Sound, check_suite};
pub use threads::{THREADS_MAX, start_threads, thread_count};
