//! Tables over several scenarios, ready to be written down.

use super::beside::Beside;
use crate::metrics::{Estimate, Finding, Metric};
use crate::scenario::ComparisonKind;

/// Tables over several scenarios, with what a publication leaves open.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Comparison {
    /// Tables with at least one number, in the order of the files.
    pub tables: Vec<ComparedTable>,
    /// What a publication leaves open.
    pub assumptions: Vec<Assumed>,
    /// Published figures that were drawn again.
    pub figures: Vec<DrawnFigure>,
    /// Filters side by side.
    pub beside: Vec<Beside>,
}

/// One table.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedTable {
    /// Name, as a publication calls it.
    pub name: String,
    /// Name as part of a file name.
    pub slug: String,
    /// What it compares.
    pub title: String,
    /// What it is for.
    pub kind: ComparisonKind,
    /// Columns.
    pub columns: Vec<ComparedColumn>,
    /// Rows with at least one number.
    pub rows: Vec<ComparedRow>,
    /// Why noise is lower in one channel than in another, row by row.
    pub causes: Vec<Cause>,
    /// Largest changes per unit of a key, if the table asks for them.
    pub change: Option<ChangePerUnit>,
    /// What is missing, and why.
    pub lacking: Vec<String>,
}

/// One column.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedColumn {
    /// Channel.
    pub channel: String,
    /// Metric key.
    pub metric: String,
    /// Channel whose same metric divides this one.
    pub relative_to: Option<String>,
}

/// One row; a cell for each column.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedRow {
    /// What it stands for.
    pub label: String,
    /// Whether it is the point of a sweep that the other scenarios take.
    pub is_base: bool,
    /// Value of the key that changes are counted in.
    pub at: Option<f64>,
    /// Numbers, absent where no scenario of the row gives one.
    pub cells: Vec<Option<ComparedCell>>,
}

/// A simulated number with the published one.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedCell {
    /// Folder of the run that it comes from.
    pub folder: String,
    /// Number, unit and defining fields.
    pub simulated: Metric,
    /// The published figure and where it was published.
    pub published: Option<(f64, String)>,
}

/// Largest changes of the columns of a table per unit of a key.
#[derive(Clone, Debug, PartialEq)]
pub struct ChangePerUnit {
    /// Key.
    pub key: String,
    /// Its unit.
    pub unit: String,
    /// Label of the row that they start from.
    pub from: String,
    /// One for each column, absent where fewer than two rows give a number.
    pub columns: Vec<Option<ColumnChange>>,
}

/// Largest change of one column.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnChange {
    /// Magnitude.
    pub estimate: Estimate,
    /// Unit, e.g. `ppm per C`.
    pub unit: String,
    /// Label of the row where it is largest.
    pub at: String,
    /// Folder of the run behind that row.
    pub folder: String,
}

/// A ratio of noise beside the ratio of DC gains.
#[derive(Clone, Debug, PartialEq)]
pub struct Cause {
    /// Label of the row.
    pub label: String,
    /// Folder of the run.
    pub folder: String,
    /// Channel.
    pub channel: String,
    /// Channel that it is compared with.
    pub relative_to: String,
    /// Metric whose ratio is explained.
    pub metric: String,
    /// That ratio.
    pub ratio: Estimate,
    /// What is left of it once divided by the ratio of DC gains.
    pub remainder: Option<Finding>,
    /// Ratio of DC gains.
    pub dc_gain: Option<Estimate>,
    /// Other metrics of the channel that bear on it, by key.
    pub companions: Vec<(String, Metric)>,
}

/// What a publication leaves open.
#[derive(Clone, Debug, PartialEq)]
pub struct Assumed {
    /// Key that settles it.
    pub key: String,
    /// Its values in this suite, sweeps of it aside.
    pub values: Vec<String>,
    /// Values that differ from the one for which the statement holds.
    pub otherwise: Vec<String>,
    /// How it is read.
    pub statement: String,
    /// Where the publication is silent.
    pub silence: String,
    /// Other readings.
    pub alternatives: String,
    /// Table that shows how results move with it, if it holds a number.
    pub table: Option<String>,
}

/// A published figure that was drawn again.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnFigure {
    /// Name.
    pub name: String,
    /// File below the output folder.
    pub file: String,
    /// What it shows.
    pub shows: String,
}

impl ComparedColumn {
    /// The column as scenario files write it.
    #[must_use]
    pub fn text(&self) -> String {
        match &self.relative_to {
            None => format!("{}.{}", self.channel, self.metric),
            Some(other) => format!("{}.{} / {other}", self.channel, self.metric),
        }
    }

    /// The channel, or the two of a ratio.
    pub(crate) fn channels(&self) -> String {
        match &self.relative_to {
            None => self.channel.clone(),
            Some(other) => format!("{} / {other}", self.channel),
        }
    }
}

impl ComparedTable {
    /// The columns that have a change per unit, with it.
    pub(crate) fn changes(&self) -> Vec<(&ComparedColumn, &ColumnChange)> {
        let changes = self.change.iter().flat_map(|change| &change.columns);
        let both = self.columns.iter().zip(changes);
        both.filter_map(|(column, change)| Some((column, change.as_ref()?)))
            .collect()
    }

    /// What these changes are, e.g. `largest change per C of <key> from 25 C`.
    pub(crate) fn change_heading(&self) -> Option<String> {
        let change = self.change.as_ref()?;
        let unit = match change.unit.as_str() {
            "" => "unit",
            unit => unit,
        };
        Some(format!(
            "largest change per {unit} of {} from row \"{}\"",
            change.key, change.from
        ))
    }

    /// Name of its files without the extension.
    pub(crate) fn file_stem(&self) -> String {
        file_stem(self.kind, &self.slug)
    }

    /// Whether a column holds a number.
    pub(crate) fn is_filled(&self, column: usize) -> bool {
        self.rows.iter().any(|row| row.cells[column].is_some())
    }

    /// Whether a column holds a published figure.
    pub(crate) fn is_published(&self, column: usize) -> bool {
        let published = |cell: &ComparedCell| cell.published.is_some();
        let mut rows = self.rows.iter();
        rows.any(|row| row.cells[column].as_ref().is_some_and(published))
    }

    /// The metrics of the filled columns, in order, each with its columns.
    pub(crate) fn metrics(&self) -> Vec<(&str, Vec<usize>)> {
        let mut groups: Vec<(&str, Vec<usize>)> = Vec::new();
        for (index, column) in self.columns.iter().enumerate() {
            if !self.is_filled(index) {
                continue;
            }
            match groups.iter_mut().find(|(key, _)| *key == column.metric) {
                Some((_, columns)) => columns.push(index),
                None => groups.push((&column.metric, vec![index])),
            }
        }
        groups
    }

    /// A number of a column, for its unit and defining fields.
    pub(crate) fn sample(&self, column: usize) -> Option<&Metric> {
        let mut rows = self.rows.iter();
        rows.find_map(|row| Some(&row.cells[column].as_ref()?.simulated))
    }
}

/// Name of a table's files without its extension.
pub(crate) fn file_stem(kind: ComparisonKind, slug: &str) -> String {
    let kind = match kind {
        ComparisonKind::Published => "published",
        ComparisonKind::Sensitivity => "sensitivity",
    };
    format!("{kind}-{slug}")
}
