//! `fogbench scale-factor`: a one-axis scale factor test from its points.

use std::io;

use crate::cli::commands::log::unreadable;
use crate::cli::options::points::ScaleFactorOptions;
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::metrics::fit_points;
use crate::recording::read_points;
use crate::report::{PointsReport, points_json, points_text};

/// Prints scale factor, offset, nonlinearity and asymmetry of the points in a file.
pub(in crate::cli) fn scale_factor(options: &ScaleFactorOptions) -> io::Result<Exit> {
    let points = match read_points(&options.file, &options.points()) {
        Ok(points) => points,
        Err(error) => return Ok(unreadable(&error)),
    };
    let pairs = points.rate_deg_per_h.iter().zip(&points.output);
    let pairs: Vec<(f64, f64)> = pairs.map(|(rate, output)| (*rate, *output)).collect();
    let fit = match fit_points(&pairs, points.error.as_deref()) {
        Ok(fit) => fit,
        Err(reason) => {
            output::talk(&format!("error: {}: {reason}", points.file));
            return Ok(Exit::Usage);
        }
    };
    let report = PointsReport {
        tool_version: env!("CARGO_PKG_VERSION"),
        file: &points.file,
        rate_deg_per_h: &points.rate_deg_per_h,
        is_in_counts: points.is_in_counts,
        has_errors: points.error.is_some(),
        fit: &fit,
    };
    output::data(&options.format.of(
        || points_text(&report, output::width()),
        || points_json(&report),
    )?)?;
    Ok(Exit::Success)
}
