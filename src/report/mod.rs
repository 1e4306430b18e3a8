//! Formats results: JSON, JUnit, SVG, CSV, text.
//!
//! Invariant: formats, does not compute. The same records give the same bytes: nothing here reads
//! a clock, a host name or an environment variable.
//!
//! The rooms, each of which uses those before it alone:
//!
//! | room | subject |
//! |---|---|
//! | `record` | what a report is made of, and which metrics it shows |
//! | `layout` | aligned text and readable JSON |
//! | `calibration` | a calibration as text, JSON, parameters and groups |
//! | `text` | tables of runs and suites |
//! | `infer` | answers of an inference as text and JSON |
//! | `plot` | pictures |
//! | `comparison` | tables over several scenarios |
//! | `csv` | metrics, curves and repeats |
//! | `baseline` | a comparison with earlier results |
//! | `build_server` | JUnit, annotations, Markdown and metrics for build servers |
//! | `json` | `summary.json` of runs and suites |
//! | `page` | pages for a browser |
//! | `restore` | `summary.json` read back |
//!
//! [`artefacts`](fn@artefacts) lists every file that is written, with what makes it.

mod artefacts;
mod baseline;
mod budget;
mod build_server;
mod calibration;
mod claim;
mod comparison;
mod csv;
mod infer;
mod json;
mod kalman;
mod layout;
mod log;
mod page;
mod plot;
mod record;
mod records;
mod restore;
mod scale_factor_points;
mod starter;
mod text;

pub use artefacts::{
    Artefact, Contents, FILTERS, INDEX, JUNIT, METRICS, OutputFile, PAGE, Place, SUITE_SUMMARY,
    artefacts, budget_files, calibration_files, input_digest_toml, log_files, plots,
    run_file_names, run_files, run_pages, run_pictures, suite_files,
};
pub use baseline::json::comparison_with_baseline_json;
pub use baseline::markdown::comparison_with_baseline_markdown;
pub use baseline::rows::ComparedSides;
pub use baseline::text::comparison_with_baseline_text;
pub use budget::{budget_assumed_text, budget_json, budget_text};
pub use build_server::bencher::{BencherMetrics, is_bencher_metrics};
pub use build_server::github::github_annotations;
pub use build_server::junit::{SuiteTimes, is_junit_xml, junit_xml};
pub use build_server::markdown::{is_suite_markdown, suite_markdown};
pub use calibration::calibrate::{CalibrateReport, calibrate_json, calibrate_text};
pub use calibration::documents::{CalibrationProvenance, calibration_json};
pub use calibration::temperature::{
    TemperatureReport, TemperatureTableError, is_calibration_toml, with_temperature,
};
pub use calibration::text::calibration_text;
pub use claim::{claim_json, claim_text};
pub use comparison::files::{comparison_file_names, comparison_files};
pub use comparison::text::{comparison_lines, comparison_text};
pub use csv::curves::curve_csv;
pub use csv::metrics::SuiteMetrics;
pub use infer::{InferenceSheet, infer_json, infer_text};
pub use json::failed::{FailedRun, failed_run_json};
pub use json::suite::{SuiteReport, write_suite_summary};
pub use json::summary::run_summary_json;
pub use kalman::{KalmanReport, is_kalman_json, kalman_json};
pub use log::{LogReport, log_json, log_text};
pub use page::against::{comparison_page, is_comparison_page};
pub use page::beside::filters_page;
pub use page::infer::infer_page;
pub use page::suite::suite_page;
pub use plot::infer::infer_pictures;
pub use plot::word_length::{WordLengthPoint, WordLengthSheet, word_length_pictures};
pub use plot::{Pictures, SVG_BYTES_MAX, SweepPictures, sweep_pictures};
pub use record::run::{ChannelOutcome, RunOutcome, RunReport, RunStatus};
pub use record::sweep::{PointFigure, PointOfSweep, assignments_text, swept_value};
pub use records::{RecordLine, RecordSheet, record_sheet};
pub use restore::run::RestoredRun;
pub(crate) use restore::values::interned;
pub use scale_factor_points::{PointsReport, points_json, points_text};
pub use starter::{Starter, starter_toml};
pub use text::suite::{SuiteStyle, closing_text, scenario_text, suite_text, sweep_text};
pub use text::table::table_text;
