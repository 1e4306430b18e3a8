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
    /// Folder for infer.json and infer.txt [default: neither is written]
    #[arg(short, long, value_name = "DIR")]
    pub(in crate::cli) output: Option<PathBuf>,
    /// Replace files in the folder that fogbench did not write
    #[arg(long, requires = "output")]
    pub(in crate::cli) force: bool,
    /// Form of the answer on stdout
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(in crate::cli) format: Format,
}
