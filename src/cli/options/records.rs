//! What may be said of the reference records.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;

use crate::experiment::reference_records;

/// Options of `records`.
#[derive(Args, Debug)]
pub(in crate::cli) struct RecordsOptions {
    /// Records to write [default: all]
    #[arg(value_name = "NAME",
          value_parser = PossibleValuesParser::new(reference_records().iter().map(|record| record.name)))]
    pub(in crate::cli) names: Vec<String>,
    /// Folder for the records, their data sheet and checksums
    #[arg(short = 'o', long = "output", value_name = "DIR")]
    pub(in crate::cli) folder: PathBuf,
    /// Replace files in the folder that fogbench did not write
    #[arg(long)]
    pub(in crate::cli) force: bool,
}
