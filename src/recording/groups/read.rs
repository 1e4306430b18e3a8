//! Group means of a calibration that a user took: one line for each mounting and rate.

use std::path::Path;

use super::heading::{Heading, Quantity};
use crate::recording::bounds::{STANDARD_ERROR_MIN_DEG_PER_H, TEMPERATURE_C};
use crate::recording::error::{LogError, Place};
use crate::recording::input::read_whole;
use crate::recording::text::lines::{Lines, NumberError, finite, shown};
use crate::recording::text::table::fault;
use crate::recording::unit::kinds::RateUnit;
use crate::units::deg_per_h_to_deg_per_s;
use crate::wording::exact;

/// Fastest rate of a table that is believed, deg/s.
const TABLE_RATE_MAX_DEG_PER_S: f64 = 2000.0;
/// Largest rate that an output may stand for, deg/s: wide enough that outputs in a wrong unit come
/// as far as the comparison with the rates, which names the unit.
const RATE_MAX_DEG_PER_S: f64 = 1e9;
/// Most groups of a file.
pub const GROUPS_MAX: usize = 10_000;
/// Fastest change of temperatures, K/min.
const WARMING_MAX_K_PER_MIN: f64 = 1000.0;
/// Longest time and most turns that are believed: thirty years, in s, and as many turns.
const TIME_MAX_S: f64 = 1e9;
/// Latest start, s: stamps of a clock that counts from 1970, in s or ms.
const START_MAX_S: f64 = 1e13;

/// How the case sits on the table, whose axis is vertical.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mounting {
    /// Case axis along the table axis: 0 = x, 1 = y, 2 = z.
    pub axis: usize,
    /// Whether that case axis points up.
    pub is_up: bool,
}

/// One line of a groups file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RecordedGroup {
    /// Line in the file, from 1.
    pub line: usize,
    /// Name or number, where there is a column of it.
    pub name: Option<String>,
    /// How the case sat on the table.
    pub mounting: Mounting,
    /// Rate of the table, deg/s, counter-clockwise from above positive.
    pub rate_deg_per_s: f64,
    /// Rates about the case axes, Earth rate included, where the file gives them; deg/s.
    pub reference_rate_deg_per_s: Option<[f64; 3]>,
    /// Mean outputs, deg/h.
    pub output_deg_per_h: [f64; 3],
    /// Their standard errors, deg/h.
    pub standard_error_deg_per_h: Option<[f64; 3]>,
    /// Mean temperatures of the gyros, deg C.
    pub temperature_c: [f64; 3],
    /// Mean rates of these, K/min.
    pub temperature_rate_k_per_min: Option<[f64; 3]>,
    /// Time averaged over, s; 0: not known.
    pub averaging_time_s: Option<f64>,
    /// Start of the averaging, s.
    pub start_s: Option<f64>,
    /// Whole turns averaged over.
    pub turns: Option<f64>,
    /// Samples averaged over.
    pub samples: Option<usize>,
    /// Samples rejected as outliers.
    pub rejected: Option<[usize; 3]>,
}

/// A groups file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RecordedGroups {
    /// Name of the file without its folder.
    pub file: String,
    /// Digest of its bytes (BLAKE3).
    pub digest: String,
    /// Unit of the table rates.
    pub rate_unit: RateUnit,
    /// Units of the outputs x, y, z.
    pub output_unit: [RateUnit; 3],
    /// Groups in the order of the lines; at least one.
    pub groups: Vec<RecordedGroup>,
}

impl RecordedGroups {
    /// What is worth saying about the lines: the same numbers twice, an order other than that of
    /// taking.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        for (index, group) in self.groups.iter().enumerate() {
            let same = self.groups[..index]
                .iter()
                .find(|other| other.mounting == group.mounting && bits(other).eq(bits(group)));
            if let Some(other) = same {
                notes.push(format!(
                    "lines {} and {} hold the same rate and outputs: a group entered twice counts \
                     twice",
                    other.line, group.line
                ));
            }
        }
        let number = |group: &RecordedGroup| group.name.as_ref()?.parse::<u64>().ok();
        let pairs = || self.groups.iter().zip(self.groups.iter().skip(1));
        let by_number = pairs().find(|(old, new)| number(old) > number(new));
        let by_time = pairs().find(|(old, new)| old.start_s > new.start_s);
        if let Some((old, new)) = by_time.or(by_number) {
            notes.push(format!(
                "lines {} and {} are not in the order of {}: forgetting needs the order in which \
                 the groups were taken, and takes that of the lines",
                old.line,
                new.line,
                if by_time.is_some() {
                    "start_s"
                } else {
                    "group"
                },
            ));
        }
        notes
    }
}

/// The numbers that make two groups the same.
fn bits(group: &RecordedGroup) -> impl Iterator<Item = u64> {
    let rates = std::iter::once(group.rate_deg_per_s).chain(group.output_deg_per_h);
    rates.map(f64::to_bits)
}

/// Reads a groups file: CSV with a heading, in the order in which the groups were taken.
///
/// Columns go by their names and rates by the unit at the end of theirs; empty lines and lines that
/// begin with `#` are passed over. Required: `mounting` (x, y or z: the case axis along the table
/// axis, `-x` or `x down` if it points down), `rate_…`, `output_x_…`, `output_y_…`, `output_z_…` and
/// `temperature_c` or one temperature for each gyro.
///
/// # Errors
/// [`LogError`]: whatever the file system says; columns unknown, repeated or missing; cells that are
/// no number or out of range; a group named twice.
pub fn read_groups(path: &Path) -> Result<RecordedGroups, LogError> {
    let bytes = read_whole(path)?;
    let mut lines = Lines::new(&bytes[..], "no text in UTF-8");
    let complain = |number, error: GroupError| LogError::at(path, Place::Line(number), error);
    let first = lines.next_line().map_err(|error| fault(path, error))?;
    let Some(first) = first else {
        return Err(LogError::of_file(path, "holds no group"));
    };
    let heading = Heading::of(first.text)
        .map_err(|error| LogError::at(path, Place::Line(first.number), error))?;
    let mut groups: Vec<RecordedGroup> = Vec::new();
    while let Some(line) = lines.next_line().map_err(|error| fault(path, error))? {
        let number = line.number;
        if groups.len() == GROUPS_MAX {
            return Err(complain(number, GroupError::TooMany));
        }
        let width = heading.columns.len();
        let cells = heading.delimiter.cells_up_to(line.text, width);
        let group = Line::new(&heading, &cells)
            .and_then(|line| line.group(number))
            .map_err(|error| complain(number, error))?;
        let same = groups
            .iter()
            .find(|other| other.name.is_some() && other.name == group.name);
        if let Some(other) = same {
            let error = GroupError::NamedTwice {
                name: shown(other.name.as_deref().unwrap_or_default()),
                line: other.line,
            };
            return Err(complain(number, error));
        }
        groups.push(group);
    }
    if groups.is_empty() {
        return Err(LogError::of_file(path, "holds no group"));
    }
    if let Some((number, error)) = wrong_standard_error(&groups) {
        return Err(complain(number, error));
    }
    let unit = |quantity| heading.unit(quantity).unwrap_or(RateUnit::DEG_PER_H);
    Ok(RecordedGroups {
        file: path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned(),
        digest: blake3::hash(&bytes).to_hex().to_string(),
        rate_unit: unit(Quantity::TableRate),
        output_unit: [0, 1, 2].map(|axis| unit(Quantity::Output(axis))),
        groups,
    })
}

/// What is wrong with a line, or with the lines together.
#[derive(Debug, thiserror::Error)]
enum GroupError {
    #[error("more than {GROUPS_MAX} groups, the most that a file may have")]
    TooMany,
    #[error("column group: `{name}` is the group of line {line} too")]
    NamedTwice {
        name: String,
        /// Line of the other.
        line: usize,
    },
    #[error(
        "the standard error of {gyro}, {error_deg_per_h:?} deg/h, is out of range: allowed from \
         {STANDARD_ERROR_MIN_DEG_PER_H:e} deg/h on, or 0 in every line of {gyro} for data without \
         noise"
    )]
    StandardError {
        gyro: &'static str,
        error_deg_per_h: f64,
    },
    #[error("{got} cells where the heading has {expected}")]
    Width { got: usize, expected: usize },
    #[error("column {column}: {error}")]
    Cell { column: String, error: CellError },
    /// What is wrong with a rate.
    #[error("{0} (the unit is what the column's name ends with)")]
    Rate(Box<GroupError>),
    #[error("one of the gyros x, y, z has a value where another has an empty cell")]
    SomeOfThree,
    #[error("an empty cell where a value is needed")]
    Empty,
}

/// What is wrong with a cell.
#[derive(Debug, thiserror::Error)]
enum CellError {
    #[error("the cell is empty: expected {unit}")]
    Empty { unit: String },
    #[error("{error}: expected {unit}")]
    NotANumber { error: NumberError, unit: String },
    #[error("{} {unit} is out of range: expected {min} to {max} {unit}", exact(*value))]
    OutOfRange {
        value: f64,
        min: f64,
        max: f64,
        unit: String,
    },
    #[error("`{0}` is no count: expected a whole number, 0 or more")]
    NotACount(String),
    #[error(
        "`{0}` is no mounting: expected the case axis along the table axis, x, y or z, as `-x` or \
         `x down` where it points down"
    )]
    NotAMounting(String),
}

/// A standard error that no mean has, with its line: the covariance and the weighted residuals rest
/// on their ratios. Noise-free data have 0 in every line of a gyro.
fn wrong_standard_error(groups: &[RecordedGroup]) -> Option<(usize, GroupError)> {
    for (axis, gyro) in ["x", "y", "z"].into_iter().enumerate() {
        let errors = || {
            let lines = groups.iter();
            lines.filter_map(|group| Some((group.line, group.standard_error_deg_per_h?[axis])))
        };
        if errors().all(|(_, error)| error <= 0.0) {
            continue;
        }
        let small = errors().find(|(_, error)| *error < STANDARD_ERROR_MIN_DEG_PER_H);
        if let Some((line, error_deg_per_h)) = small {
            let error = GroupError::StandardError {
                gyro,
                error_deg_per_h,
            };
            return Some((line, error));
        }
    }
    None
}

/// One line under its heading.
struct Line<'a> {
    heading: &'a Heading,
    cells: &'a [&'a str],
}

impl<'a> Line<'a> {
    fn new(heading: &'a Heading, cells: &'a [&'a str]) -> Result<Self, GroupError> {
        let expected = heading.columns.len();
        if cells.len() != expected {
            return Err(GroupError::Width {
                got: cells.len(),
                expected,
            });
        }
        Ok(Self { heading, cells })
    }

    fn group(&self, line: usize) -> Result<RecordedGroup, GroupError> {
        let table = (-TABLE_RATE_MAX_DEG_PER_S, TABLE_RATE_MAX_DEG_PER_S);
        let table_rate = |quantity| self.rate(quantity, table);
        let any = (-RATE_MAX_DEG_PER_S, RATE_MAX_DEG_PER_S);
        let [x, y, z] = [0, 1, 2].map(|axis| self.rate(Quantity::Output(axis), any));
        let error = |axis| self.rate(Quantity::StandardError(axis), (0.0, RATE_MAX_DEG_PER_S));
        let reference = three(|axis| table_rate(Quantity::Reference(axis)))?;
        let temperature = self.common_or_each(Quantity::Temperature, TEMPERATURE_C, "deg C")?;
        let warming = (-WARMING_MAX_K_PER_MIN, WARMING_MAX_K_PER_MIN);
        let time = (0.0, TIME_MAX_S);
        Ok(RecordedGroup {
            line,
            name: self.cell(Quantity::Group).map(|(_, cell)| cell.to_owned()),
            mounting: self.mounting()?,
            rate_deg_per_s: deg_per_h_to_deg_per_s(present(table_rate(Quantity::TableRate)?)?),
            reference_rate_deg_per_s: reference.map(|it| it.map(deg_per_h_to_deg_per_s)),
            output_deg_per_h: [present(x?)?, present(y?)?, present(z?)?],
            standard_error_deg_per_h: three(error)?,
            temperature_c: present(temperature)?,
            temperature_rate_k_per_min: self.common_or_each(
                Quantity::TemperatureRate,
                warming,
                "K/min",
            )?,
            averaging_time_s: self.number(Quantity::AveragingTime, time, "s")?,
            start_s: self.number(Quantity::Start, (-START_MAX_S, START_MAX_S), "s")?,
            turns: self.number(Quantity::Turns, time, "turns")?,
            samples: self.count(Quantity::Samples)?,
            rejected: three(|axis| self.count(Quantity::Rejected(axis)))?,
        })
    }

    /// Name and cell of a quantity; nothing where there is no such column or the cell is empty.
    fn cell(&self, quantity: Quantity) -> Option<(&str, &str)> {
        let index = self.heading.find(quantity)?;
        let cell = self.cells[index];
        (!cell.is_empty() || quantity.is_required())
            .then_some((self.heading.columns[index].name.as_str(), cell))
    }

    fn number(
        &self,
        quantity: Quantity,
        (min, max): (f64, f64),
        unit: &str,
    ) -> Result<Option<f64>, GroupError> {
        let Some((name, cell)) = self.cell(quantity) else {
            return Ok(None);
        };
        let unit = unit.to_owned();
        if cell.is_empty() {
            return Err(of_cell(name, CellError::Empty { unit }));
        }
        match finite(cell) {
            Ok(value) if (min..=max).contains(&value) => Ok(Some(value)),
            Ok(value) => Err(of_cell(
                name,
                CellError::OutOfRange {
                    value,
                    min,
                    max,
                    unit,
                },
            )),
            Err(error) => Err(of_cell(name, CellError::NotANumber { error, unit })),
        }
    }

    /// A rate, deg/h; its range is in deg/s.
    fn rate(&self, quantity: Quantity, range: (f64, f64)) -> Result<Option<f64>, GroupError> {
        let Some(unit) = self.heading.unit(quantity) else {
            return Ok(None);
        };
        let one = deg_per_h_to_deg_per_s(unit.to_deg_per_h(1.0, 1.0));
        let in_unit = |limit: f64| {
            let digits = 1e6;
            (limit / one * digits).round() / digits
        };
        let range = (in_unit(range.0), in_unit(range.1));
        let value = self.number(quantity, range, &unit.to_string());
        let value = value.map_err(|error| GroupError::Rate(Box::new(error)))?;
        Ok(value.map(|value| unit.to_deg_per_h(value, 1.0)))
    }

    /// A quantity that one column gives for all gyros, or three for one each.
    fn common_or_each(
        &self,
        quantity: fn(Option<usize>) -> Quantity,
        range: (f64, f64),
        unit: &str,
    ) -> Result<Option<[f64; 3]>, GroupError> {
        match self.number(quantity(None), range, unit)? {
            Some(value) => Ok(Some([value; 3])),
            None => three(|axis| self.number(quantity(Some(axis)), range, unit)),
        }
    }

    fn count(&self, quantity: Quantity) -> Result<Option<usize>, GroupError> {
        let Some((name, cell)) = self.cell(quantity) else {
            return Ok(None);
        };
        let count = cell.parse();
        count
            .map(Some)
            .map_err(|_| of_cell(name, CellError::NotACount(shown(cell))))
    }

    fn mounting(&self) -> Result<Mounting, GroupError> {
        let (name, cell) = present(self.cell(Quantity::Mounting))?;
        let (sign, rest) = match cell.strip_prefix(['+', '-']) {
            Some(rest) => (Some(!cell.starts_with('-')), rest),
            None => (None, cell),
        };
        let mut words = rest.split_whitespace();
        let axis = words.next().and_then(|word| match word {
            "x" | "X" => Some(0),
            "y" | "Y" => Some(1),
            "z" | "Z" => Some(2),
            _ => None,
        });
        let sense = match (words.next(), sign) {
            (None, sign) => Some(sign.unwrap_or(true)),
            (Some("up"), None) => Some(true),
            (Some("down"), None) => Some(false),
            _ => None,
        };
        match (axis, sense, words.next()) {
            (Some(axis), Some(is_up), None) => Ok(Mounting { axis, is_up }),
            _ => Err(of_cell(name, CellError::NotAMounting(shown(cell)))),
        }
    }
}

fn of_cell(column: &str, error: CellError) -> GroupError {
    GroupError::Cell {
        column: shown(column),
        error,
    }
}

/// Three values of which all or none are there.
fn three<T>(
    of: impl Fn(usize) -> Result<Option<T>, GroupError>,
) -> Result<Option<[T; 3]>, GroupError> {
    match (of(0)?, of(1)?, of(2)?) {
        (Some(x), Some(y), Some(z)) => Ok(Some([x, y, z])),
        (None, None, None) => Ok(None),
        _ => Err(GroupError::SomeOfThree),
    }
}

/// A value whose column the heading was checked for.
fn present<T>(value: Option<T>) -> Result<T, GroupError> {
    value.ok_or(GroupError::Empty)
}
