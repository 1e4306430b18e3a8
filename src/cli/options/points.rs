//! What may be said of a scale factor test of points.

use std::path::PathBuf;

use clap::Args;

use crate::cli::options::format::Format;
use crate::recording::{LogUnit, PointsFormat};

/// Options of `scale-factor`.
#[derive(Args, Debug)]
pub(in crate::cli) struct ScaleFactorOptions {
    /// Text with a point a row: rate of the table and mean output at it
    pub(in crate::cli) file: PathBuf,
    /// Column of the rate, by its heading, a part of it or its number from 1
    #[arg(long, value_name = "COLUMN", default_value = "1")]
    rate: String,
    /// Column of the mean output
    #[arg(long, value_name = "COLUMN", default_value = "2")]
    output: String,
    /// Column of the standard error of the mean output, in its unit [default: what is left of the line is taken
    /// as noise]
    #[arg(long, value_name = "COLUMN")]
    error: Option<String>,
    /// Unit of the rate, such as deg/s [default: that of its heading]
    #[arg(long, value_name = "UNIT")]
    rate_unit: Option<LogUnit>,
    /// Unit of the output, if it is a rate [default: that of its heading, counts without one]
    #[arg(long, value_name = "UNIT")]
    output_unit: Option<LogUnit>,
    /// Form of the results on stdout
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(in crate::cli) format: Format,
}

impl ScaleFactorOptions {
    /// What is read.
    pub(in crate::cli) fn points(&self) -> PointsFormat {
        PointsFormat {
            rate: self.rate.clone(),
            output: self.output.clone(),
            error: self.error.clone(),
            rate_unit: self.rate_unit,
            output_unit: self.output_unit,
        }
    }
}
