//! Sweeps: the Cartesian product of the arrays and ranges in `[matrix]`.

use std::cmp::Reverse;
use std::collections::BTreeSet;
use std::sync::Arc;

use crate::scenario::document::address::{self, AddressError, Step};
use crate::scenario::document::source::{Mark, Sources};
use crate::scenario::document::tree::{Node, Table, Value};
use crate::scenario::keys::schema::Key;
use crate::scenario::message::error::ScenarioError;
use crate::scenario::message::excerpt::excerpt;
use crate::scenario::read::draft::Draft;
use crate::scenario::read::files::script;
use crate::scenario::read::resolve::Unsound;
use crate::scenario::read::resolved::{Resolved, SweepPoint};
use crate::scenario::read::sweep::range::{self, RangeError};
use crate::scenario::read::sweep::template::Template;

/// Points tried, if none of them is sound: what they share is said by then.
const TRIALS_MAX: usize = 100;

/// Most numbers in the arrays of all points of one sweep: a script has two in a row.
const NUMBERS_MAX: usize = 10_000_000;

/// The path of a swept key, and where the matrix names it.
pub(in crate::scenario) type Swept = (Vec<Step>, Mark);

/// A swept key.
struct Axis {
    written: String,
    path: Vec<Step>,
    key: &'static Key,
    mark: Mark,
    values: Vec<Node>,
}

impl Axis {
    /// The value of one point, pointing at itself.
    fn value(&self, index: usize) -> Node {
        let mut value = self.values[index].clone();
        value.mark = value.mark.or(Some(self.mark));
        value
    }
}

/// Resolves every point of a sweep, in the order of their indices, and hands it over with what is
/// swept.
///
/// # Errors
/// Every complaint about the matrix; if it is in order, every complaint about its points.
pub(in crate::scenario) fn expand(
    draft: &Draft,
    matrix: &Node,
    set_paths: &[Vec<Step>],
    visit: &mut dyn FnMut(Resolved, &[Swept]),
) -> Result<(), Unsound> {
    let (axes, errors) = axes(draft, matrix, set_paths)?;
    if !errors.is_empty() {
        // What else is wrong is seen at the first point of the axes that are in order.
        let first = point(draft, &axes, &point_values(&axes, 0));
        let mut unsound = first.err().unwrap_or_default();
        unsound.errors.splice(0..0, errors);
        return Err(unsound);
    }
    let count = axes
        .iter()
        .try_fold(1_usize, |count, axis| count.checked_mul(axis.values.len()))
        .filter(|count| *count <= SweepPoint::COUNT_MAX);
    let Some(count) = count else {
        let max = SweepPoint::COUNT_MAX;
        let message = format!("matrix has too many points: allowed 1..={max}");
        let mark = matrix.mark.unwrap_or(draft.root_mark);
        return Err(vec![draft.sources.error(mark, message)].into());
    };
    let base = base_values(draft, &axes);
    let swept = axes.iter().map(|axis| (axis.path.clone(), axis.mark));
    let swept: Vec<Swept> = swept.collect();
    let mut unsound = Unsound::default();
    let mut points = Points::new(draft, &axes);
    for index in 0..count {
        let is_first = points.template.is_none() && points.has_template;
        match points.resolve(index, unsound.reading.is_none()) {
            Ok(mut resolved) => {
                if is_first {
                    check_size(&resolved, matrix, count).map_err(|error| vec![error])?;
                }
                resolved.sweep = Some(sweep_point(&resolved, &axes, index, count));
                if index == 0 {
                    resolved.remarks.extend(remarks(draft, &axes));
                }
                resolved.is_base_point = base.is_some() && base == values(&resolved, &axes);
                visit(resolved, &swept);
            }
            Err(more) => {
                unsound.errors.extend(more.errors);
                unsound.reading = unsound.reading.or(more.reading);
            }
        }
        let has_tried = points.template.is_none() && index + 1 >= TRIALS_MAX;
        if has_tried && !unsound.errors.is_empty() {
            break;
        }
    }
    if unsound.errors.is_empty() {
        Ok(())
    } else {
        Err(unsound)
    }
}

/// What is worth saying of a sweep: values that stand twice, and a kind that is replaced.
fn remarks(draft: &Draft, axes: &[Axis]) -> Vec<String> {
    let mut found = Vec::new();
    for axis in axes {
        let mut seen = BTreeSet::new();
        let texts = axis.values.iter().map(|value| value.value.to_toml());
        let twice = texts.filter(|text| !seen.insert(text.clone()));
        let twice: BTreeSet<String> = twice.collect();
        if let Some(first) = twice.first() {
            let more = match twice.len() - 1 {
                0 => String::new(),
                more => format!(", as do {more} more"),
            };
            found.push(format!(
                "{}: matrix: {} = {} stands more than once{more}: such points are the same run",
                draft.file,
                axis.written,
                excerpt(first)
            ));
        }
        if let Some(remark) = address::kind_replaced(&draft.root, &axis.path) {
            found.push(format!(
                "{}: matrix: {}: {remark}",
                draft.file, axis.written
            ));
        }
    }
    found
}

/// The points of a sweep, resolved by the pattern of the first sound one.
struct Points<'a> {
    draft: &'a Draft,
    axes: &'a [Axis],
    template: Option<Template>,
    /// Whether there is a pattern, or may still be one.
    has_template: bool,
}

impl<'a> Points<'a> {
    fn new(draft: &'a Draft, axes: &'a [Axis]) -> Self {
        Self {
            draft,
            axes,
            template: None,
            has_template: true,
        }
    }

    /// Resolves one point.
    ///
    /// * `is_thorough`: whether a point that is not sound is resolved from the beginning, which says
    ///   how it can be checked further.
    fn resolve(&mut self, index: usize, is_thorough: bool) -> Result<Resolved, Unsound> {
        let values = point_values(self.axes, index);
        let found = self.template.as_ref().map(|it| it.point(&values));
        match found {
            Some(Err(errors)) if !is_thorough => return Err(errors.into()),
            Some(Ok(resolved)) => return Ok(resolved),
            Some(Err(_)) | None => {}
        }
        let resolved = point(self.draft, self.axes, &values)?;
        if self.template.is_none() && self.has_template {
            let swept = self.axes.iter().map(|axis| (&axis.path[..], axis.key));
            self.template = Template::of(&resolved, swept);
            self.has_template = self.template.is_some();
        }
        Ok(resolved)
    }
}

/// The values of the swept keys without the sweep; `None` where it is the sweep that gives one.
fn base_values(draft: &Draft, axes: &[Axis]) -> Option<Vec<String>> {
    let base = draft.clone().resolve().ok()?;
    values(&base, axes)
}

/// The values of the swept keys.
fn values(resolved: &Resolved, axes: &[Axis]) -> Option<Vec<String>> {
    let mut paths = axes.iter().map(|axis| &axis.path);
    paths.try_fold(Vec::new(), |mut values, path| {
        values.push(resolved.value_toml(path)?);
        Some(values)
    })
}

/// The values of one point, in the order of the axes.
fn point_values(axes: &[Axis], index: usize) -> Vec<Node> {
    let mut rest = index;
    // The last axis varies fastest, hence the digits are taken off from the end.
    let digits = axes.iter().rev().map(|axis| {
        let value = axis.value(rest % axis.values.len());
        rest /= axis.values.len();
        value
    });
    let mut values: Vec<Node> = digits.collect();
    values.reverse();
    values
}

/// Resolves one point from the beginning.
fn point(draft: &Draft, axes: &[Axis], values: &[Node]) -> Result<Resolved, Unsound> {
    let mut draft = draft.clone();
    for (axis, value) in axes.iter().zip(values).rev() {
        let mark = value.mark.unwrap_or(axis.mark);
        address::assign(&mut draft.root, &axis.path, value.clone(), mark)
            .map_err(|error| vec![draft.sources.error(mark, error.to_string())])?;
    }
    draft.resolve()
}

/// Which point of the sweep a run is.
fn sweep_point(resolved: &Resolved, axes: &[Axis], index: usize, count: usize) -> SweepPoint {
    let assignments = axes.iter().map(|axis| {
        let value = resolved.value_toml(&axis.path).unwrap_or_default();
        (axis.written.clone(), value)
    });
    SweepPoint {
        index,
        count,
        assignments: assignments.collect(),
    }
}

/// Refuses a sweep whose points hold more numbers together than a computer remembers.
fn check_size(resolved: &Resolved, matrix: &Node, count: usize) -> Result<(), ScenarioError> {
    let numbers = resolved.numbers_in_arrays();
    if numbers.saturating_mul(count) <= NUMBERS_MAX {
        return Ok(());
    }
    let message = format!(
        "matrix: {count} points with {numbers} numbers in arrays each: allowed up to {NUMBERS_MAX} \
         in all; sweep fewer values or shorten the script"
    );
    Err(resolved.error(matrix.mark, message))
}

/// The swept keys in the order of the file, those of bases first, and what is wrong with others.
fn axes(
    draft: &Draft,
    matrix: &Node,
    set_paths: &[Vec<Step>],
) -> Result<(Vec<Axis>, Vec<ScenarioError>), Vec<ScenarioError>> {
    let sources: &Arc<Sources> = &draft.sources;
    let matrix_mark = matrix.mark.unwrap_or(draft.root_mark);
    let Value::Table(table) = &matrix.value else {
        let message = format!(
            "matrix has the wrong type: expected a table, written [matrix], got {}",
            matrix.value.type_name()
        );
        return Err(vec![sources.error(matrix_mark, message)]);
    };
    let mut entries = Vec::new();
    let root = &draft.root;
    flatten(root, "", table, matrix_mark, &mut entries);
    entries.sort_by_key(|(_, mark, _)| (Reverse(mark.source), mark.start));
    let mut axes: Vec<Axis> = Vec::new();
    let mut errors = Vec::new();
    for (written, mark, node) in entries {
        match axis(draft, &axes, set_paths, &written, node) {
            Ok((path, key, values)) => axes.push(Axis {
                written,
                path,
                key,
                mark,
                values,
            }),
            Err(error) => {
                let mark = error.mark().unwrap_or(mark);
                errors.push(sources.error(mark, format!("matrix: {error}")));
            }
        }
    }
    if axes.is_empty() && errors.is_empty() {
        errors.push(sources.error(
            matrix_mark,
            "matrix is empty: expected keys and their values, as in \"gyro.source.power_uw\" = [0.5, 1.0]",
        ));
    }
    Ok((axes, errors))
}

/// Why a key cannot be swept.
#[derive(Debug, thiserror::Error)]
enum AxisError {
    #[error(transparent)]
    Address(#[from] AddressError),
    #[error("{0} is a table: sweep the keys inside it")]
    Table(String),
    /// What makes a scenario rather than describes it.
    #[error("{0} cannot be swept")]
    Fixed(String),
    #[error("{written} is swept by {earlier} already")]
    Twice {
        /// The key as it is written here.
        written: String,
        /// The same key as it was written before.
        earlier: String,
    },
    #[error("{0} is swept here and given by --set: leave one of them out")]
    Set(String),
    #[error("{0} has no values: expected a non-empty array")]
    Empty(String),
    #[error(
        "{written} has the wrong type: expected an array of values, or a range as in {example}, \
         got {got}",
        example = range::EXAMPLE
    )]
    NotAnArray {
        /// The key as it is written.
        written: String,
        /// Type of what stands there.
        got: &'static str,
    },
    #[error(transparent)]
    Range(#[from] RangeError),
}

impl AxisError {
    /// The place inside the values, if one is meant.
    fn mark(&self) -> Option<Mark> {
        match self {
            Self::Range(error) => error.mark,
            _ => None,
        }
    }
}

/// Checks one swept key.
fn axis(
    draft: &Draft,
    earlier: &[Axis],
    set_paths: &[Vec<Step>],
    written: &str,
    node: &Node,
) -> Result<(Vec<Step>, &'static Key, Vec<Node>), AxisError> {
    let (path, key) = address::resolve(&draft.root, written)?;
    let shown = || written.to_owned();
    let key = key.ok_or_else(|| AxisError::Table(shown()))?;
    if matches!(
        key.path,
        "schema" | "name" | "extends" | "matrix" | "description" | script::FILE_KEY
    ) {
        return Err(AxisError::Fixed(shown()));
    }
    if let Some(other) = earlier.iter().find(|other| other.path == path) {
        return Err(AxisError::Twice {
            written: shown(),
            earlier: other.written.clone(),
        });
    }
    if set_paths.contains(&path) {
        return Err(AxisError::Set(shown()));
    }
    match &node.value {
        Value::Array(values) if values.is_empty() => Err(AxisError::Empty(shown())),
        Value::Array(values) => Ok((path, key, values.to_vec())),
        Value::Table(table) => Ok((path, key, range::values(written, key, table)?)),
        other => Err(AxisError::NotAnArray {
            written: shown(),
            got: other.type_name(),
        }),
    }
}

/// Gathers the arrays and ranges of a matrix; unquoted keys make nested tables, which are joined with
/// dots.
fn flatten<'a>(
    root: &Table,
    prefix: &str,
    table: &'a Table,
    mark: Mark,
    entries: &mut Vec<(String, Mark, &'a Node)>,
) {
    for (name, node) in table {
        let path = crate::scenario::keys::schema::join(prefix, name);
        let mark = node.mark.unwrap_or(mark);
        match &node.value {
            Value::Table(inner) if !range::is_meant(root, &path, inner) => {
                flatten(root, &path, inner, mark, entries);
            }
            _ => entries.push((path, mark, node)),
        }
    }
}
