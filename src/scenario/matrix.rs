//! Sweeps: the Cartesian product of the arrays in `[matrix]`.

use std::cmp::Reverse;
use std::sync::Arc;

use super::address::{self, Step};
use super::error::ScenarioError;
use super::resolved::{Draft, Resolved, SweepPoint};
use super::schema::Key;
use super::script;
use super::source::{Mark, Sources};
use super::template::Template;
use super::tree::{Node, Table, Value};

/// Most points of one sweep: folders are numbered with four digits.
pub(super) const POINTS_MAX: usize = 10_000;

/// Points tried, if none of them is sound: what they share is said by then.
const TRIALS_MAX: usize = 100;

/// Most numbers in the arrays of all points of one sweep: a script has two in a row.
const NUMBERS_MAX: usize = 10_000_000;

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

/// Resolves every point of a sweep, in the order of their indices.
///
/// # Errors
/// Every complaint about the matrix; if it is in order, every complaint about its points.
pub(crate) fn expand(
    draft: &Draft,
    matrix: &Node,
    set_paths: &[Vec<Step>],
    visit: &mut dyn FnMut(Resolved),
) -> Result<(), Vec<ScenarioError>> {
    let axes = axes(draft, matrix, set_paths)?;
    let count = axes
        .iter()
        .try_fold(1_usize, |count, axis| count.checked_mul(axis.values.len()))
        .filter(|count| *count <= POINTS_MAX);
    let Some(count) = count else {
        let message = format!("matrix has too many points: allowed 1..={POINTS_MAX}");
        return Err(vec![
            draft
                .sources
                .error(matrix.mark.unwrap_or(draft.root_mark), message),
        ]);
    };
    let base = base_values(draft, &axes);
    let mut errors = Vec::new();
    let mut template: Option<Template> = None;
    let mut has_template = true;
    for index in 0..count {
        let swept = point_values(&axes, index);
        let run = match &template {
            Some(template) => template.point(&swept),
            None => point(draft, &axes, &swept),
        };
        match run {
            Ok(mut resolved) => {
                if template.is_none() && has_template {
                    let swept = axes.iter().map(|axis| (&axis.path[..], axis.key));
                    template = Template::of(&resolved, swept);
                    has_template = template.is_some();
                    if let Err(error) = check_size(&resolved, matrix, count) {
                        return Err(vec![error]);
                    }
                }
                resolved.sweep = Some(sweep_point(&resolved, &axes, index, count));
                resolved.is_base_point = base.is_some() && base == values(&resolved, &axes);
                visit(resolved);
            }
            Err(more) => errors.extend(more),
        }
        if template.is_none() && index + 1 >= TRIALS_MAX && !errors.is_empty() {
            break;
        }
    }
    if errors.is_empty() {
        Ok(())
    } else {
        Err(errors)
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
fn point(draft: &Draft, axes: &[Axis], values: &[Node]) -> Result<Resolved, Vec<ScenarioError>> {
    let mut draft = draft.clone();
    for (axis, value) in axes.iter().zip(values).rev() {
        let mark = value.mark.unwrap_or(axis.mark);
        address::assign(&mut draft.root, &axis.path, value.clone(), mark)
            .map_err(|message| vec![draft.sources.error(mark, message)])?;
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

/// The swept keys in the order of the file, those of bases first.
fn axes(
    draft: &Draft,
    matrix: &Node,
    set_paths: &[Vec<Step>],
) -> Result<Vec<Axis>, Vec<ScenarioError>> {
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
    flatten("", table, matrix_mark, &mut entries);
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
            Err(message) => errors.push(sources.error(mark, format!("matrix: {message}"))),
        }
    }
    if axes.is_empty() && errors.is_empty() {
        errors.push(sources.error(
            matrix_mark,
            "matrix is empty: expected keys and their values, as in \"gyro.source.power_uw\" = [0.5, 1.0]",
        ));
    }
    if errors.is_empty() {
        Ok(axes)
    } else {
        Err(errors)
    }
}

/// Checks one swept key.
fn axis(
    draft: &Draft,
    earlier: &[Axis],
    set_paths: &[Vec<Step>],
    written: &str,
    node: &Node,
) -> Result<(Vec<Step>, &'static Key, Vec<Node>), String> {
    let (path, key) = address::resolve(&draft.root, written)?;
    let Some(key) = key else {
        return Err(format!("{written} is a table: sweep the keys inside it"));
    };
    if matches!(
        key.path,
        "schema" | "name" | "extends" | "matrix" | "description" | script::FILE_KEY
    ) {
        return Err(format!("{written} cannot be swept"));
    }
    if let Some(other) = earlier.iter().find(|other| other.path == path) {
        return Err(format!("{written} is swept by {} already", other.written));
    }
    if set_paths.contains(&path) {
        return Err(format!(
            "{written} is swept here and given by --set: leave one of them out"
        ));
    }
    match &node.value {
        Value::Array(values) if values.is_empty() => Err(format!(
            "{written} has no values: expected a non-empty array"
        )),
        Value::Array(values) => Ok((path, key, values.to_vec())),
        other => Err(format!(
            "{written} has the wrong type: expected an array of values, got {}",
            other.type_name()
        )),
    }
}

/// Gathers the arrays of a matrix; unquoted keys make nested tables, which are joined with dots.
fn flatten<'a>(
    prefix: &str,
    table: &'a Table,
    mark: Mark,
    entries: &mut Vec<(String, Mark, &'a Node)>,
) {
    for (name, node) in table {
        let path = super::schema::join(prefix, name);
        let mark = node.mark.unwrap_or(mark);
        match &node.value {
            Value::Table(inner) => flatten(&path, inner, mark, entries),
            _ => entries.push((path, mark, node)),
        }
    }
}
