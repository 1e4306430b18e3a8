//! What may be said of recorded logs.

use std::path::PathBuf;

use clap::{ArgGroup, Args, ValueEnum};

use crate::cli::options::format::Format;
use crate::cli::options::layout::LayoutOptions;
use crate::cli::options::numbers::within;
use crate::scenario::AllanEstimatorConfig;
use crate::vocabulary::{AveragingTimes, CompensationForm};

/// Shortest time that an option names, s: a sample at the fastest rate that is analysed in blocks.
const TIME_MIN_S: f64 = 1e-9;
/// Longest such time, s: 115 days.
const TIME_MAX_S: f64 = 1e7;

/// A log and how to measure it.
#[derive(Args, Debug)]
#[command(group(ArgGroup::new("written").multiple(true)))]
pub(in crate::cli) struct LogOptions {
    /// Recorded log: NPY, NPZ, or text with columns between `,`, `;`, tabs or blanks; `-` is standard input
    pub(in crate::cli) file: PathBuf,
    /// File with a table [log] that says how the log is read; options stand above it
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) layout: Option<PathBuf>,
    /// Print how the log is read, as a table [log] for --layout, and nothing else
    #[arg(long, conflicts_with_all = ["written", "columns"])]
    pub(in crate::cli) explain: bool,
    #[command(flatten)]
    pub(in crate::cli) keys: LayoutOptions,
    /// Columns of the gyros x, y, z of an assembly, to be compensated
    #[arg(
        long,
        value_name = "X,Y,Z",
        value_delimiter = ',',
        conflicts_with = "column",
        requires = "calibration",
        requires = "axis"
    )]
    pub(in crate::cli) columns: Vec<String>,
    /// How rates follow from the outputs of an assembly: `exact`, or `first-order` as in the patent
    #[arg(
        long,
        value_name = "FORM",
        default_value = "exact",
        requires = "columns"
    )]
    pub(in crate::cli) compensation_form: CompensationForm,
    /// File whose [[gate]] tables are held against what is measured: a scenario, a base or gates alone; exit
    /// code 1 if one fails
    #[arg(long, value_name = "FILE", conflicts_with = "explain")]
    pub(in crate::cli) gates: Option<PathBuf>,
    /// Time at the start that metrics leave out, s
    #[arg(long, value_name = "S", default_value_t = 0.0, allow_negative_numbers = true,
          value_parser = within(0.0, TIME_MAX_S, "s"))]
    pub(in crate::cli) warm_up_s: f64,
    /// Averaging time of the plain bias stability, s: a sample of the log or longer
    #[arg(long, value_name = "S", default_value_t = 100.0, allow_negative_numbers = true,
          value_parser = within(TIME_MIN_S, TIME_MAX_S, "s"))]
    pub(in crate::cli) bias_averaging_time_s: f64,
    /// Deviation of the Allan curve: `overlapping`, `plain`, `modified`, `hadamard`; the noise terms are
    /// fitted to the overlapping one
    #[arg(long, value_name = "ESTIMATOR", default_value = "overlapping")]
    pub(in crate::cli) allan_estimator: AllanEstimatorConfig,
    /// Averaging times of the Allan curve: `octave`, `decade`, `all` (up to 1000)
    #[arg(long, value_name = "TIMES", default_value = "octave")]
    pub(in crate::cli) averaging_times: AveragingTimes,
    /// Folder for summary.json, curves, pictures and filtered samples [default: none is written]
    #[arg(short, long, value_name = "DIR", group = "written")]
    pub(in crate::cli) output: Option<PathBuf>,
    /// Replace files that fogbench did not write
    #[arg(long, requires = "written")]
    pub(in crate::cli) force: bool,
    /// Form of the results on stdout
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(in crate::cli) format: Format,
}

/// Options that act on what is measured, kept or started.
const OF_MEASURING: [&str; 16] = [
    "output",
    "force",
    "csv",
    "format",
    "gates",
    "explain",
    "warm_up_s",
    "bias_averaging_time_s",
    "fit_tau_min_s",
    "motion",
    "allan_estimator",
    "averaging_times",
    "calibration",
    "axis",
    "columns",
    "allow_programs",
];

/// Form in which filtered words are passed on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum PassForm {
    /// Rows of text below a heading
    Text,
    /// binary64, the low byte first
    F8,
    /// binary32, the low byte first
    F4,
}

/// Options of `analyze`.
#[derive(Args, Debug)]
pub(in crate::cli) struct AnalyzeOptions {
    #[command(flatten)]
    pub(in crate::cli) log: LogOptions,
    /// File for the noise as a linear system at the log's rate (F, Q_d, H, R, S and P0 as JSON), for a
    /// Kalman filter
    #[arg(long, value_name = "FILE", group = "written")]
    pub(in crate::cli) kalman: Option<PathBuf>,
    /// File for the significant coefficients of the temperature, as a table [temperature] (with --axis
    /// [temperature.x]) that --calibration takes out of other logs: a new one, or a calibration.toml, all
    /// else of which stays
    #[arg(long, value_name = "FILE", group = "written")]
    pub(in crate::cli) temperature_model: Option<PathBuf>,
}

/// Options of `filter`.
#[derive(Args, Debug)]
pub(in crate::cli) struct FilterLogOptions {
    #[command(flatten)]
    pub(in crate::cli) log: LogOptions,
    /// Scenario or base file whose [[filter]] tables the log runs through
    #[arg(long, value_name = "SCENARIO")]
    pub(in crate::cli) filters: PathBuf,
    /// Override a key of that file; `filter.<name>.<key>` reaches into a filter
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(in crate::cli) set: Vec<String>,
    /// Start the programs that filters of the kind `process` name; without it nothing is started
    #[arg(long)]
    pub(in crate::cli) allow_programs: bool,
    /// Pass the filtered words on to stdout as they come, deg/h, a column for each filter: `text`, or words
    /// `f8` or `f4`, the low byte first; nothing is measured, and nothing kept
    #[arg(long, value_name = "FORM", conflicts_with_all = OF_MEASURING)]
    pub(in crate::cli) pass: Option<PassForm>,
    /// Write the filtered samples as CSV as well
    #[arg(long, requires = "output")]
    pub(in crate::cli) csv: bool,
}
