//! The closing lines of a table: how far its columns move per unit of a key that its rows differ in.

use super::table::{ChangePerUnit, ColumnChange, ComparedTable};
use crate::metrics::{ConditionPoint, change_divisor, find, largest_change_per_unit};
use crate::scenario::{ComparisonConfig, ComparisonRowConfig, Resolved, ScenarioError};

/// The closing lines of a table whose rows carry their value of `key`; `None` with fewer than two
/// values.
///
/// They start from the base point of a sweep, else from the middle value, of an even number the
/// lower of the two.
pub(super) fn change_per_unit(
    table: &ComparedTable,
    key: &str,
    unit: &str,
) -> Option<ChangePerUnit> {
    let mut values: Vec<f64> = table.rows.iter().filter_map(|row| row.at).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    if values.len() < 2 {
        return None;
    }
    let middle = values[(values.len() - 1) / 2];
    let bases = table.rows.iter().filter(|row| row.is_base);
    let from = bases.filter_map(|row| row.at).next().unwrap_or(middle);
    let start = table.rows.iter().find(|row| row.at == Some(from))?;
    let columns = table.columns.iter().enumerate();
    let columns = columns.map(|(index, column)| {
        let mut rows = Vec::new();
        let mut points = Vec::new();
        for row in &table.rows {
            if let (Some(condition), Some(cell)) = (row.at, &row.cells[index]) {
                rows.push((row.label.clone(), cell));
                points.push(ConditionPoint {
                    condition,
                    estimate: cell.simulated.estimate,
                });
            }
        }
        let reference = points.iter().find(|point| is_same(point.condition, from))?;
        let (change, at) = largest_change_per_unit(*reference, &points)?;
        let divisor = match column.relative_to {
            None => {
                let key = find(&column.metric)?;
                change_divisor(key, reference.estimate.value)
            }
            Some(_) => 1.0,
        };
        let (label, cell) = &rows[at];
        let per = if unit.is_empty() { "unit" } else { unit };
        Some(ColumnChange {
            estimate: change.scaled(1.0 / divisor),
            unit: format!("{} per {per}", cell.simulated.unit),
            at: label.clone(),
            folder: cell.folder.clone(),
        })
    });
    Some(ChangePerUnit {
        key: key.to_owned(),
        unit: unit.to_owned(),
        from: start.label.clone(),
        columns: columns.collect(),
    })
}

/// Complaints about tables whose rows have no value of `per_change_of`, several of it, or all one.
pub(super) fn contradictions(
    comparisons: &[&ComparisonConfig],
    rows: &[&ComparisonRowConfig],
    suite: &[&Resolved],
) -> Vec<ScenarioError> {
    let complaints = comparisons.iter().filter_map(|comparison| {
        let key = comparison.per_change_of.as_deref()?;
        let rows = rows.iter().filter(|row| row.comparison == comparison.name);
        let rows: Vec<&ComparisonRowConfig> = rows.copied().collect();
        let complaint = complaint(key, &rows, suite)?;
        let carries = |resolved: &&Resolved| {
            let mut own = resolved.scenario.comparisons.iter();
            let index = own.position(|one| one == *comparison)?;
            let written = format!("comparison[{index}].per_change_of");
            let message = format!("{written} = \"{key}\": {complaint}");
            Some(ScenarioError::at(resolved.locate(&written), message))
        };
        suite.iter().find_map(carries)
    });
    complaints.collect()
}

/// What is wrong with the rows of one table; those of which only a part runs may share a value.
fn complaint(key: &str, rows: &[&ComparisonRowConfig], suite: &[&Resolved]) -> Option<String> {
    let mut all: Vec<f64> = Vec::new();
    let mut is_whole = !rows.is_empty();
    for row in rows {
        let mut fixed: Option<(f64, &str)> = None;
        for name in &row.scenarios {
            let mut own = suite
                .iter()
                .filter(|resolved| resolved.scenario.name == *name)
                .peekable();
            is_whole &= own.peek().is_some();
            for resolved in own {
                let Some(value) = resolved.number_of(key) else {
                    return Some(format!("{name} of row \"{}\" has no such key", row.label));
                };
                all.push(value);
                if let Some(point) = &resolved.sweep {
                    let mut swept = point.assignments.iter().map(|(swept, _)| swept);
                    if let Some(other) = swept.find(|swept| *swept != key) {
                        return Some(format!(
                            "{name} of row \"{}\" sweeps {other} too",
                            row.label
                        ));
                    }
                    continue;
                }
                match fixed {
                    Some((other, first)) if !is_same(other, value) => {
                        return Some(format!(
                            "the scenarios of row \"{}\" differ in it: {other} in {first}, {value} in \
                             {name}",
                            row.label
                        ));
                    }
                    _ => fixed = Some((value, name)),
                }
            }
        }
    }
    let first = *all.first()?;
    let is_one = all.iter().all(|value| is_same(*value, first));
    (is_whole && is_one).then(|| format!("every row has the same value, {first}"))
}

/// Whether two settled values of a key are the same number.
fn is_same(left: f64, right: f64) -> bool {
    (left - right).abs() <= 0.0
}
