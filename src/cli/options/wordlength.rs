//! What may be said of a search for word lengths.

use std::path::PathBuf;

use clap::Args;

use crate::cli::options::format::Format;
use crate::cli::options::numbers::within;

/// Options of `wordlength`.
#[derive(Args, Debug)]
pub(in crate::cli) struct WordLengthOptions {
    /// Scenario whose gyro gives the words
    pub(in crate::cli) path: PathBuf,
    /// Filter of the scenario, rls, lms or sign_lms; fixed-point words that it has are the start
    #[arg(long = "filter", value_name = "NAME")]
    pub(in crate::cli) name: String,
    /// Override a key of the scenario; `filter.<name>.<key>` reaches into a filter
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(in crate::cli) set: Vec<String>,
    /// Largest ratio of the Allan deviation at 0.1 s to that in binary64, and of that to it
    #[arg(long, value_name = "R", default_value_t = 1.01, value_parser = within(0.5, 100.0, ""))]
    pub(in crate::cli) max_arw_ratio: f64,
    /// Largest change of the delay of a swing against binary64, us
    #[arg(long, value_name = "US", default_value_t = 1.0, value_parser = within(1e-6, 1e6, "us"))]
    pub(in crate::cli) max_delay_change_us: f64,
    /// Time that the filter has to live, s [default: that of the scenario]
    #[arg(long, value_name = "S", value_parser = within(1e-3, 1e5, "s"))]
    pub(in crate::cli) survive_s: Option<f64>,
    /// Folder for wordlength.txt, wordlength.json and the picture pareto.svg [default: none is written]
    #[arg(short, long, value_name = "DIR")]
    pub(in crate::cli) output: Option<PathBuf>,
    /// Replace files in the folder that fogbench did not write
    #[arg(long, requires = "output")]
    pub(in crate::cli) force: bool,
    /// Form of the result
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(in crate::cli) format: Format,
}
