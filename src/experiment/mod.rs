//! Plans and runs scenarios: the only module that knows every stage.
//!
//! Invariant: wiring only; what a stage does stands in the stage. Checks that need physics live in
//! `plan`, so that `check` and `run` refuse the same files.

#[cfg(feature = "report")]
mod baseline;
mod black_box;
mod budget;
mod build;
mod campaign;
mod channel_filter;
#[cfg(feature = "report")]
mod infer;
mod log;
#[cfg(feature = "report")]
mod output_file;
mod outside;
mod pipeline_metrics;
mod plan;
#[cfg(feature = "report")]
mod reference_records;
mod run;
mod scenario;
#[cfg(feature = "report")]
mod shard;
#[cfg(feature = "report")]
mod starter;
#[cfg(feature = "hdl")]
mod stimulus;
#[cfg(feature = "report")]
mod suite;
mod word_length;

#[cfg(feature = "report")]
pub use baseline::{SideError, read_baseline_file, read_output, read_side, side_of_runs};
pub use budget::{GyroBudget, gyro_budget};
pub use build::BUILD;
#[cfg(feature = "report")]
pub use campaign::{
    CalibrateError, CalibrationTrial, GroupsSettings, calibrate_campaign, calibrate_groups,
};
#[cfg(feature = "report")]
pub use infer::{
    CalibrateInference, ConfirmationRun, Figures, Inference, SimulationError, check_problem, infer,
};
pub use log::{
    CompensatedLog, LogCompensation, LogFilters, LogGates, LogInput, LogSettings, LogTemperature,
    LogTrial, LogTrialError, PassError, SETTLE_S, compensate_log, compensate_temperature,
    load_log_compensation, load_log_filters, load_log_gates, load_own_temperature, pass_log,
    try_log, try_log_stream,
};
pub use outside::{ProgramFiles, program_files};
#[cfg(feature = "cli")]
pub use outside::{SUPERVISE, exchange_times};
pub use plan::{Plan, Sound, check_suite, plan_suite};
#[cfg(feature = "report")]
pub use reference_records::{RecordsError, ReferenceRecord, reference_records, write_records};
pub use run::{Progress, Run, RunError, Samples, UnknownName};
pub use scenario::Scenario;
#[cfg(feature = "report")]
pub use shard::{
    Damaged, GatherError, Gathered, Listing, PlanFile, PlanFileError, RunList, Selected,
    ShardError, ShardHead, ShardObserver, ShardOptions, ShardOutcome, ShardStatus, Wanted,
    estimated_s, list_suite, merge_shards, ranges_text, run_shard, shard_status,
};
#[cfg(feature = "report")]
pub use starter::{StarterGyro, starter_scenario};
#[cfg(feature = "hdl")]
pub use stimulus::{input_digest, scenario_stimulus};
#[cfg(feature = "report")]
pub use suite::{
    Against, Earlier, Observer, Resume, SuiteError, SuiteOptions, SuiteOutcome, THREADS_MAX,
    run_suite, start_threads, thread_count, write_runs,
};
pub use word_length::{
    WordLengthError, WordLengthLimits, WordLengthTrial, WordLengths, word_lengths,
};
