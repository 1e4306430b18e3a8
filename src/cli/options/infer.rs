//! What may be said of an inference.

use std::path::PathBuf;

use clap::Args;

use crate::cli::options::format::Format;

/// Options of `infer`.
#[derive(Args, Debug)]
pub(in crate::cli) struct InferOptions {
    /// Problem file
    pub(in crate::cli) path: PathBuf,
    /// Read and check the problem and its scenarios, and search nothing
    #[arg(long, conflicts_with = "output")]
    pub(in crate::cli) check: bool,
    /// Draw settings from the priors so often, infer them from their own figures, and judge by the levels
    /// that then hold the truth in 95 % (the time is printed beforehand)
    #[arg(long, value_name = "DRAWS", value_parser = clap::value_parser!(u32).range(20..=100_000),
          conflicts_with = "check")]
    pub(in crate::cli) calibrate: Option<u32>,
    /// Simulate the records of these draws instead of drawing their figures from the forecasts
    #[arg(long, requires = "calibrate")]
    pub(in crate::cli) simulated: bool,
    /// Simulate the most likely settings and the ends of their ridges: so often on the rate model and once
    /// on the loop model (the time is printed beforehand)
    #[arg(long, value_name = "REPEATS", num_args = 0..=1, require_equals = true,
          default_missing_value = "4", value_parser = clap::value_parser!(u32).range(1..=1000),
          conflicts_with = "check")]
    pub(in crate::cli) confirm: Option<u32>,
    /// Leave the loop model out of the confirmation: it takes most of the time
    #[arg(long, requires = "confirm")]
    pub(in crate::cli) without_loop_model: bool,
    /// Folder for infer.json, infer.txt, the page with its pictures and ready scenarios [default: none is
    /// written]
    #[arg(short, long, value_name = "DIR")]
    pub(in crate::cli) output: Option<PathBuf>,
    /// Replace files in the folder that fogbench did not write
    #[arg(long, requires = "output")]
    pub(in crate::cli) force: bool,
    /// Form of the answer on stdout
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(in crate::cli) format: Format,
}
