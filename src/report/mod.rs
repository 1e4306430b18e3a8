//! Formats results: JSON, JUnit, SVG, CSV, text.
//!
//! Invariant: formats, does not compute. The same records give the same bytes: nothing here reads
//! a clock, a host name or an environment variable.

mod artefacts;
mod budget;
mod calibrate;
mod calibration;
mod calibration_text;
mod columns;
mod comparison_files;
mod comparison_json;
mod comparison_text;
mod compensation;
mod csv;
mod failed;
mod json;
mod junit;
mod log;
mod measured;
mod plot;
mod record;
mod repeats;
mod restore;
mod restore_calibration;
mod scale_factor;
mod suite_table;
mod summary;
mod table;
mod text;
mod verdict_text;

pub use artefacts::{
    Artefact, ENCODER_SAMPLES, JUNIT, Place, SAMPLES, SAMPLES_CSV, SUITE_SUMMARY, TIME_SAMPLES,
    TRUTH_SAMPLES, artefacts, budget_files, calibration_files, log_files, plots, run_files,
    run_pictures,
};
pub use budget::{budget_json, budget_text};
pub use calibrate::{CalibrateReport, calibrate_json, calibrate_text};
pub use calibration::{CalibrationProvenance, calibration_json};
pub use calibration_text::calibration_text;
pub use comparison_files::{comparison_file_names, comparison_files};
pub use comparison_text::comparison_text;
pub use csv::curve_csv;
pub use failed::{FailedRun, failed_run_json};
pub use junit::junit_xml;
pub use log::{LogReport, log_json, log_text};
pub use plot::{Pictures, SVG_BYTES_MAX};
pub use record::{ChannelOutcome, RunOutcome, RunReport, RunStatus};
pub use restore::RestoredRun;
pub use suite_table::suite_text;
pub use summary::{run_summary_json, suite_summary_json};
pub use table::table_text;
