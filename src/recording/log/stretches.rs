//! Parts of a log: rows, times, a table of stretches.

use std::ops::Range;
use std::path::Path;

use super::format::LogFormat;
use super::gaps::Gaps;
use super::rows::LogRows;
use crate::recording::column::Columns;
use crate::recording::error::LogError;
use crate::recording::input::Input;
use crate::recording::layout::Asked;
use crate::recording::layout::columns::Selection;
use crate::recording::text::table::{self, Wanted};

/// Columns of a table of stretches.
const BOUNDS: [&str; 2] = ["from_s", "to_s"];

/// Why no part is taken.
#[derive(Debug, thiserror::Error)]
enum PartError {
    #[error("--rows {rows} leaves no row: the log has {count}")]
    NoRow { rows: LogRows, count: usize },
    #[error(
        "no sample lies from {from_s} s on{}, which --from-s, --to-s or --segments asks for: the log ends at \
         {end_s} s",
        until(*.to_s)
    )]
    NoTime { from_s: f64, to_s: f64, end_s: f64 },
    #[error("it says from {from_s} s to {to_s} s: expected stretches that end behind their start")]
    Backwards { from_s: f64, to_s: f64 },
    #[error("its stretches from {0} s on and from {1} s on overlap or are not in order")]
    Overlap(f64, f64),
    #[error(
        "a part by its time, as --from-s, --to-s or --segments asks for, needs a column of the time, or --rate-hz"
    )]
    NoClock,
}

impl PartError {
    /// Key of `[log]`, or option, that asks for what cannot be.
    fn key(&self, format: &LogFormat) -> Option<&'static str> {
        match self {
            Self::NoRow { .. } => Some("rows"),
            _ if format.segments.is_some() => Some("segments"),
            _ if format.from_s.is_some() => Some("from_s"),
            _ => Some("to_s"),
        }
    }
}

/// The end of a part, if it has one.
fn until(to_s: f64) -> String {
    match to_s.is_finite() {
        true => format!(" to {to_s} s"),
        false => String::new(),
    }
}

/// The rows of the parts that are asked for, in order; all of them where none is.
///
/// * `count`: rows of the log.
///
/// # Errors
/// Parts that hold no row, a table of stretches that overlap.
pub(in crate::recording) fn parts(
    path: &Path,
    columns: &Columns,
    count: usize,
    format: &LogFormat,
) -> Result<Vec<Range<usize>>, LogError> {
    let refuse = |error: PartError| LogError::of_file(path, &error).about(error.key(format));
    let rows = match format.rows {
        Some(rows) => rows
            .within(count)
            .ok_or_else(|| refuse(PartError::NoRow { rows, count }))?,
        None => 0..count,
    };
    let is_cut = format.from_s.is_some() || format.to_s.is_some();
    let whole = (
        format.from_s.unwrap_or(0.0),
        format.to_s.unwrap_or(f64::INFINITY),
    );
    let bounds = match &format.segments {
        Some(file) => table_of(&path.parent().unwrap_or(Path::new("")).join(file), file)?,
        None if is_cut => vec![whole],
        None => return Ok(vec![rows]),
    };
    let stamp = clock(columns, format).ok_or_else(|| refuse(PartError::NoClock))?;
    let no_time = |(from_s, to_s): (f64, f64)| {
        let end_s = stamp(count - 1);
        refuse(PartError::NoTime {
            from_s,
            to_s,
            end_s,
        })
    };
    let bounds = within(&bounds, whole);
    if bounds.is_empty() {
        return Err(no_time(whole));
    }
    let mut parts: Vec<Range<usize>> = Vec::new();
    for (from_s, to_s) in bounds {
        // Stamps rise, so that the rows of a stretch follow one another.
        let mut inside = rows
            .clone()
            .filter(|row| (from_s..=to_s).contains(&stamp(*row)));
        let first = inside.next();
        let last = inside.next_back().or(first);
        let (Some(first), Some(last)) = (first, last) else {
            return Err(no_time((from_s, to_s)));
        };
        // The sample at a time that ends one stretch and begins the next is one sample.
        match parts.last_mut() {
            Some(before) if first < before.end => before.end = last + 1,
            _ => parts.push(first..last + 1),
        }
    }
    Ok(parts)
}

/// The stretches of time within a longer one, as far as they lie in it.
fn within(bounds: &[(f64, f64)], (from_s, to_s): (f64, f64)) -> Vec<(f64, f64)> {
    let cut = bounds
        .iter()
        .map(|(from, to)| (from.max(from_s), to.min(to_s)));
    cut.filter(|(from, to)| from <= to).collect()
}

/// Time of a row from the first one on, s.
fn clock<'a>(columns: &'a Columns, format: &LogFormat) -> Option<Box<dyn Fn(usize) -> f64 + 'a>> {
    #[expect(
        clippy::cast_precision_loss,
        reason = "sample counts are far below 2^53"
    )]
    let by_rate = |rate: f64| move |row: usize| row as f64 / rate;
    match (&columns.time, format.rate_hz) {
        (Some(time), None) if time.is_counter() => None,
        (Some(time), Some(rate)) if time.is_counter() => {
            Some(Box::new(move |row| time.stamps[row] / rate))
        }
        (Some(time), _) => Some(Box::new(|row| time.stamps[row])),
        (None, Some(rate)) => Some(Box::new(by_rate(rate))),
        (None, None) => None,
    }
}

/// Stretches of a table.
fn table_of(path: &Path, shown: &str) -> Result<Vec<(f64, f64)>, LogError> {
    let refuse = |error: PartError| LogError::of_file(Path::new(shown), error);
    let format = LogFormat::default();
    let columns = table::read(
        path,
        Input::open(path)?,
        &Wanted {
            columns: Selection::Each(BOUNDS.map(|name| Asked { name, key: None }).into()),
            needs_time: false,
            gaps: Gaps::Unsaid,
            format: &format,
            samples_max: usize::MAX,
        },
    )?;
    let [from, to] = &columns.data[..] else {
        return Err(LogError::of_file(path, "holds no stretch"));
    };
    let bounds: Vec<(f64, f64)> = from
        .values
        .iter()
        .copied()
        .zip(to.values.iter().copied())
        .collect();
    for &(from_s, to_s) in &bounds {
        if from_s >= to_s {
            return Err(refuse(PartError::Backwards { from_s, to_s }));
        }
    }
    if let Some(two) = bounds.windows(2).find(|two| two[1].0 < two[0].1) {
        return Err(refuse(PartError::Overlap(two[0].0, two[1].0)));
    }
    Ok(bounds)
}
