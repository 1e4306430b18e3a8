//! The heading of a groups file: which column holds what, in which unit.

use crate::recording::text::lines::{Delimiter, shown};
use crate::recording::unit::kinds::{RateUnit, SUFFIXES};

const AXES: [&str; 3] = ["x", "y", "z"];
/// Most columns of a heading: twice as many as there are quantities.
const COLUMNS_MAX: usize = 64;

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::recording) enum Quantity {
    Group,
    Mounting,
    TableRate,
    Reference(usize),
    Output(usize),
    StandardError(usize),
    /// Of one gyro, or with none of all three.
    Temperature(Option<usize>),
    TemperatureRate(Option<usize>),
    AveragingTime,
    Start,
    Turns,
    Samples,
    Rejected(usize),
}

impl Quantity {
    /// Whether an empty cell is an error.
    pub(in crate::recording) fn is_required(self) -> bool {
        matches!(
            self,
            Self::Mounting | Self::TableRate | Self::Output(_) | Self::Temperature(_)
        )
    }
}

/// The quantity of a gyro, 0 to 2.
type OfAxis = fn(usize) -> Quantity;

/// A column of the file.
#[derive(Clone, Debug)]
pub(in crate::recording) struct HeadedColumn {
    pub(in crate::recording) name: String,
    pub(in crate::recording) quantity: Quantity,
    /// Unit of a rate.
    pub(in crate::recording) unit: Option<RateUnit>,
}

/// What is wrong with a heading.
#[derive(Debug, thiserror::Error)]
pub(in crate::recording) enum GroupsHeadingError {
    #[error("{0} columns: expected at most {COLUMNS_MAX}")]
    TooMany(usize),
    /// Columns that are unknown, there twice or missing, all of them.
    #[error("{}", .0.join("; "))]
    Columns(Vec<String>),
}

/// The heading of a file.
#[derive(Clone, Debug)]
pub(in crate::recording) struct Heading {
    pub(in crate::recording) delimiter: Delimiter,
    pub(in crate::recording) columns: Vec<HeadedColumn>,
}

impl Heading {
    /// Reads the names of the columns.
    ///
    /// # Errors
    /// Unknown, repeated and missing columns, all of them in one message.
    pub(in crate::recording) fn of(line: &str) -> Result<Self, GroupsHeadingError> {
        let delimiter = Delimiter::of(line);
        let known = known();
        let mut columns: Vec<HeadedColumn> = Vec::new();
        let mut complaints = Vec::new();
        let cells = delimiter.first_cells(line);
        if cells.len() > COLUMNS_MAX {
            return Err(GroupsHeadingError::TooMany(cells.len()));
        }
        for cell in cells {
            match known.iter().find(|column| column.name == cell) {
                Some(column) => {
                    let mut before = columns.iter();
                    if let Some(other) = before.find(|other| other.quantity == column.quantity) {
                        let (old, new) = (&other.name, &column.name);
                        complaints.push(format!("columns `{old}` and `{new}` hold the same"));
                    }
                    columns.push(column.clone());
                }
                None => complaints.push(unknown(&shown(cell), &known)),
            }
        }
        complaints.extend(missing(&columns));
        if complaints.is_empty() {
            Ok(Self { delimiter, columns })
        } else {
            Err(GroupsHeadingError::Columns(complaints))
        }
    }

    /// Index of the column of a quantity.
    pub(in crate::recording) fn find(&self, quantity: Quantity) -> Option<usize> {
        let mut columns = self.columns.iter();
        columns.position(|column| column.quantity == quantity)
    }

    /// Unit of the column of a rate.
    pub(in crate::recording) fn unit(&self, quantity: Quantity) -> Option<RateUnit> {
        self.columns[self.find(quantity)?].unit
    }
}

/// Every column that a file may have.
fn known() -> Vec<HeadedColumn> {
    let mut columns = Vec::new();
    let mut plain = |name: String, quantity| {
        columns.push(HeadedColumn {
            name,
            quantity,
            unit: None,
        });
    };
    plain("group".to_owned(), Quantity::Group);
    plain("mounting".to_owned(), Quantity::Mounting);
    plain("temperature_c".to_owned(), Quantity::Temperature(None));
    let rate = "temperature_rate_k_per_min".to_owned();
    plain(rate, Quantity::TemperatureRate(None));
    plain("averaging_time_s".to_owned(), Quantity::AveragingTime);
    plain("start_s".to_owned(), Quantity::Start);
    plain("turns".to_owned(), Quantity::Turns);
    plain("samples".to_owned(), Quantity::Samples);
    for (axis, name) in AXES.into_iter().enumerate() {
        let temperature = format!("temperature_{name}_c");
        plain(temperature, Quantity::Temperature(Some(axis)));
        let rate = format!("temperature_rate_{name}_k_per_min");
        plain(rate, Quantity::TemperatureRate(Some(axis)));
        plain(format!("rejected_{name}"), Quantity::Rejected(axis));
    }
    for (suffix, unit) in SUFFIXES {
        let mut rate = |stem: String, quantity| {
            columns.push(HeadedColumn {
                name: format!("{stem}_{suffix}"),
                quantity,
                unit: Some(unit),
            });
        };
        rate("rate".to_owned(), Quantity::TableRate);
        for (axis, name) in AXES.into_iter().enumerate() {
            rate(format!("output_{name}"), Quantity::Output(axis));
            rate(format!("reference_{name}"), Quantity::Reference(axis));
            let error = format!("standard_error_{name}");
            rate(error, Quantity::StandardError(axis));
        }
    }
    columns
}

fn unknown(cell: &str, known: &[HeadedColumn]) -> String {
    let likeness = |name: &str| strsim::jaro_winkler(name, cell);
    let nearest = known
        .iter()
        .max_by(|a, b| likeness(&a.name).total_cmp(&likeness(&b.name)))
        .map_or("", |column| &column.name);
    if cell.is_empty() {
        return "a column has no name".to_owned();
    }
    let without_unit = SUFFIXES
        .iter()
        .any(|(suffix, _)| known.iter().any(|it| it.name == format!("{cell}_{suffix}")));
    if without_unit {
        return format!("column `{cell}` has no unit: expected {}", with_units(cell));
    }
    format!("unknown column `{cell}`: the nearest known is `{nearest}`")
}

fn with_units(stem: &str) -> String {
    let ends: Vec<String> = SUFFIXES[1..]
        .iter()
        .map(|(suffix, _)| format!("_{suffix}"))
        .collect();
    format!("`{stem}_{}` (or {})", SUFFIXES[0].0, ends.join(", "))
}

/// Quantities that are not there, and threes of which some are.
fn missing(columns: &[HeadedColumn]) -> Vec<String> {
    let has = |quantity| columns.iter().any(|column| column.quantity == quantity);
    let mut lacking = Vec::new();
    if !has(Quantity::Mounting) {
        lacking.push("`mounting`".to_owned());
    }
    if !has(Quantity::TableRate) {
        lacking.push("`rate_deg_per_s`".to_owned());
    }
    let axes = || AXES.into_iter().enumerate();
    for (axis, name) in axes().filter(|(axis, _)| !has(Quantity::Output(*axis))) {
        let stem = format!("output_{name}");
        let others = (0..3).filter(|other| *other != axis);
        let is_first = others.clone().all(|other| has(Quantity::Output(other))) || axis == 0;
        lacking.push(if is_first {
            with_units(&stem)
        } else {
            format!("`{stem}_{}`", SUFFIXES[0].0)
        });
    }
    let some = |of: OfAxis| (0..3).any(|axis| has(of(axis)));
    if !has(Quantity::Temperature(None)) {
        if some(|axis| Quantity::Temperature(Some(axis))) {
            for (_, name) in axes().filter(|(axis, _)| !has(Quantity::Temperature(Some(*axis)))) {
                lacking.push(format!("`temperature_{name}_c`"));
            }
        } else {
            lacking.push("`temperature_c`".to_owned());
        }
    }
    let threes: [(OfAxis, &str, &str); 4] = [
        (Quantity::Reference, "reference", "deg_per_s"),
        (Quantity::StandardError, "standard_error", "deg_per_h"),
        (
            |axis| Quantity::TemperatureRate(Some(axis)),
            "temperature_rate",
            "k_per_min",
        ),
        (Quantity::Rejected, "rejected", ""),
    ];
    for (of, stem, suffix) in threes.into_iter().filter(|(of, _, _)| some(*of)) {
        for (_, name) in axes().filter(|(axis, _)| !has(of(*axis))) {
            let end = if suffix.is_empty() { "" } else { "_" };
            lacking.push(format!("`{stem}_{name}{end}{suffix}`"));
        }
    }
    if lacking.is_empty() {
        return Vec::new();
    }
    vec![format!("missing: {}", lacking.join(", "))]
}
