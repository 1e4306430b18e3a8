//! Points of a scale factor test: a rate of the table and the mean output at it, one a row.

use std::path::Path;

use super::column::Column;
use super::error::LogError;
use super::input::Input;
use super::layout::Asked;
use super::layout::columns::Selection;
use super::log::format::LogFormat;
use super::log::gaps::Gaps;
use super::text::table::{self, Wanted};
use super::unit::convert::Conversion;
use super::unit::kinds::{LogUnit, Per};
use super::unit::spelling::Spelled;

/// Most points of a test: far above those of any table.
const POINTS_MAX: usize = 100_000;

/// Which columns hold what, by name or number from 1.
#[derive(Clone, Debug, PartialEq)]
pub struct PointsFormat {
    /// Rate of the table.
    pub rate: String,
    /// Mean output.
    pub output: String,
    /// Standard error of the mean output, in its unit; none where it is not known.
    pub error: Option<String>,
    /// Unit of the rate; that of its heading without one.
    pub rate_unit: Option<LogUnit>,
    /// Unit of the output; that of its heading without one, and counts without either.
    pub output_unit: Option<LogUnit>,
}

/// The points of a test in the order of the file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RecordedPoints {
    /// Name of the file without its folder.
    pub file: String,
    /// Rates of the table, deg/h.
    pub rate_deg_per_h: Vec<f64>,
    /// Mean outputs, deg/h or counts.
    pub output: Vec<f64>,
    /// Standard errors of the outputs, in their unit; none where they are not known.
    pub error: Option<Vec<f64>>,
    /// Whether the outputs are counts, or another unit without a name.
    pub is_in_counts: bool,
}

/// Why the points are none.
#[derive(Debug, thiserror::Error)]
enum PointsError {
    #[error("column {column}: {what}: a rate held by a table has a unit such as deg/s")]
    NoRate { column: String, what: String },
    #[error("the unit of the rates is not known: give --rate-unit, such as deg/s")]
    NoUnit,
    #[error("column {column} holds a standard error of {value:?}: expected 0 or more")]
    Error { column: String, value: f64 },
}

/// Reads the points of a test.
///
/// # Errors
/// [`LogError`]: whatever the file system says, unknown columns, cells that are no number, rates without a unit
/// or in one of angles, negative standard errors.
pub fn read_points(path: &Path, format: &PointsFormat) -> Result<RecordedPoints, LogError> {
    let both = [
        Asked::by(&format.rate, "rate"),
        Asked::by(&format.output, "output"),
    ];
    let error = format.error.as_deref();
    let error = error.map(|name| Asked::by(name, "error"));
    let asked = both.into_iter().chain(error);
    let layout = LogFormat::default();
    let columns = table::read(
        path,
        Input::open(path)?,
        &Wanted {
            columns: Selection::Each(asked.collect()),
            needs_time: false,
            gaps: Gaps::Unsaid,
            format: &layout,
            samples_max: POINTS_MAX,
        },
    )?;
    let refuse = |error: PointsError| LogError::of_file(path, error);
    let [rate, output, error @ ..] = &columns.data[..] else {
        return Err(LogError::of_file(path, "holds no point"));
    };
    let rate_deg_per_h = rates(rate, format.rate_unit)
        .map_err(refuse)?
        .ok_or_else(|| refuse(PointsError::NoUnit))?;
    let as_rates = rates(output, format.output_unit).map_err(refuse)?;
    let is_in_counts = as_rates.is_none();
    let error = match error.first() {
        None => None,
        Some(column) => {
            if let Some(row) = column.values.iter().position(|value| *value < 0.0) {
                let column_name = column.name.clone().unwrap_or_default();
                let wrong = PointsError::Error {
                    column: column_name,
                    value: column.values[row],
                };
                return Err(LogError::at(path, columns.place(row), wrong));
            }
            let same = Column {
                unit: output.unit,
                ..column.clone()
            };
            let as_rates = rates(&same, format.output_unit).map_err(refuse)?;
            Some(as_rates.unwrap_or_else(|| column.values.clone()))
        }
    };
    let file = path.file_name().unwrap_or(path.as_os_str());
    Ok(RecordedPoints {
        file: file.to_string_lossy().into_owned(),
        rate_deg_per_h,
        output: as_rates.unwrap_or_else(|| output.values.clone()),
        error,
        is_in_counts,
    })
}

/// The numbers of a column as rates, deg/h; nothing without a unit.
fn rates(column: &Column, unit: Option<LogUnit>) -> Result<Option<Vec<f64>>, PointsError> {
    let has_unit =
        unit.is_some() || matches!(column.unit, Some(Spelled::Rate(_) | Spelled::Angle(_)));
    if !has_unit {
        return Ok(None);
    }
    let format = LogFormat {
        unit,
        ..LogFormat::default()
    };
    let no_rate = |what: String| PointsError::NoRate {
        column: column.name.clone().unwrap_or_default(),
        what,
    };
    let conversion = Conversion::of(&format, column).map_err(|error| no_rate(error.to_string()))?;
    if conversion.running.is_some() || conversion.unit.per == Per::Sample {
        return Err(no_rate(format!("{} is an angle", conversion.shown())));
    }
    // A rate needs no sample rate.
    let values = column.values.iter();
    Ok(Some(
        values
            .map(|it| conversion.rate_deg_per_h(*it, 1.0))
            .collect(),
    ))
}
