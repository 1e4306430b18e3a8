//! Sweeps: the Cartesian product of the arrays in `[matrix]`.

use std::cmp::Reverse;
use std::sync::Arc;

use super::address::{self, Step};
use super::draft::{Draft, Unsound};
use super::error::ScenarioError;
use super::resolved::{Resolved, SweepPoint};
use super::script;
use super::source::{Mark, Sources};
use super::tree::{Node, Table, Value};

/// Most points of one sweep: folders are numbered with four digits.
const POINTS_MAX: usize = 10_000;

/// The path of a swept key, and where the matrix names it.
pub(crate) type Swept = (Vec<Step>, Mark);

/// A swept key.
struct Axis {
    written: String,
    path: Vec<Step>,
    mark: Mark,
    values: Vec<Node>,
}

/// Resolves every point of a sweep, in the order of their indices.
///
/// # Errors
/// Every complaint about the matrix; if it is in order, every complaint about its points.
pub(crate) fn expand(
    draft: &Draft,
    matrix: &Node,
    set_paths: &[Vec<Step>],
) -> Result<(Vec<Resolved>, Vec<Swept>), Unsound> {
    let (axes, errors) = axes(draft, matrix, set_paths)?;
    if !errors.is_empty() {
        // What else is wrong is seen at the first point of the axes that are in order.
        let mut unsound = point(draft, &axes, 0, 1).err().unwrap_or_default();
        unsound.errors.splice(0..0, errors);
        return Err(unsound);
    }
    let count = axes
        .iter()
        .try_fold(1_usize, |count, axis| count.checked_mul(axis.values.len()))
        .filter(|count| *count <= POINTS_MAX);
    let Some(count) = count else {
        let message = format!("matrix has too many points: allowed 1..={POINTS_MAX}");
        let mark = matrix.mark.unwrap_or(draft.root_mark);
        return Err(vec![draft.sources.error(mark, message)].into());
    };
    let base = base_values(draft, &axes);
    let mut points = Vec::with_capacity(count);
    let mut unsound = Unsound::default();
    for index in 0..count {
        match point(draft, &axes, index, count) {
            Ok(mut resolved) => {
                resolved.is_base_point = base.is_some() && base == values(&resolved, &axes);
                points.push(resolved);
            }
            Err(more) => {
                unsound.errors.extend(more.errors);
                unsound.reading = unsound.reading.or(more.reading);
            }
        }
    }
    if unsound.errors.is_empty() {
        let swept = axes.into_iter().map(|axis| (axis.path, axis.mark));
        Ok((points, swept.collect()))
    } else {
        Err(unsound)
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

/// Resolves one point.
fn point(draft: &Draft, axes: &[Axis], index: usize, count: usize) -> Result<Resolved, Unsound> {
    let mut draft = draft.clone();
    let mut rest = index;
    // The last axis varies fastest, hence the digits are taken off from the end.
    for axis in axes.iter().rev() {
        let value = axis.values[rest % axis.values.len()].clone();
        rest /= axis.values.len();
        let mark = value.mark.unwrap_or(axis.mark);
        address::assign(&mut draft.root, &axis.path, value, mark)
            .map_err(|message| vec![draft.sources.error(mark, message)])?;
    }
    let mut resolved = draft.resolve()?;
    let assignments = axes
        .iter()
        .map(|axis| {
            let value = resolved.value_toml(&axis.path).unwrap_or_default();
            (axis.written.clone(), value)
        })
        .collect();
    resolved.sweep = Some(SweepPoint {
        index,
        count,
        assignments,
    });
    Ok(resolved)
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
    flatten("", table, matrix_mark, &mut entries);
    entries.sort_by_key(|(_, mark, _)| (Reverse(mark.source), mark.start));
    let mut axes: Vec<Axis> = Vec::new();
    let mut errors = Vec::new();
    for (written, mark, node) in entries {
        match axis(draft, &axes, set_paths, &written, node) {
            Ok((path, values)) => axes.push(Axis {
                written,
                path,
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
    Ok((axes, errors))
}

/// Checks one swept key.
fn axis(
    draft: &Draft,
    earlier: &[Axis],
    set_paths: &[Vec<Step>],
    written: &str,
    node: &Node,
) -> Result<(Vec<Step>, Vec<Node>), String> {
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
        Value::Array(values) => Ok((path, values.clone())),
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
