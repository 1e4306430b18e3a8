//! What a suite says across its scenarios, as JSON.

use serde_json::{Map, Value};

use crate::comparison::{Assumed, Cause, ColumnChange, ComparedColumn, ComparedTable, Comparison};
use crate::metrics::{AgainstOne, Estimate};
use crate::report::layout::json::{estimate, interval};
use crate::report::layout::json::{object, put, put_array};
use crate::scenario::ComparisonKind;

/// `published_tables`, `sensitivities`, `assumptions` and `figures`, those that there are.
pub(crate) fn comparison(across: &Comparison) -> Map<String, Value> {
    let of_kind = |kind: ComparisonKind| -> Vec<Value> {
        let tables = across.tables.iter();
        tables.filter(|one| one.kind == kind).map(table).collect()
    };
    let figures = across.figures.iter().map(|figure| {
        let fields = [
            ("name", figure.name.as_str().into()),
            ("file", figure.file.as_str().into()),
            ("shows", figure.shows.as_str().into()),
        ];
        object(fields).into()
    });
    let parts: [(&str, Vec<Value>); 4] = [
        ("published_tables", of_kind(ComparisonKind::Published)),
        ("sensitivities", of_kind(ComparisonKind::Sensitivity)),
        (
            "assumptions",
            across.assumptions.iter().map(assumption).collect(),
        ),
        ("figures", figures.collect()),
    ];
    let filled = parts.into_iter().filter(|(_, values)| !values.is_empty());
    filled
        .map(|(key, values)| (key.to_owned(), values.into()))
        .collect()
}

fn table(table: &ComparedTable) -> Value {
    let rows = table.rows.iter().map(|row| {
        let cells = row
            .cells
            .iter()
            .zip(&table.columns)
            .filter_map(|(cell, column)| {
                let cell = cell.as_ref()?;
                let what = column.text();
                let mut record = object([("metric", what.as_str().into())]);
                record.extend(estimate(&cell.simulated));
                if let Some((value, source)) = &cell.published {
                    put(&mut record, "published", *value);
                    record.insert("source".to_owned(), source.as_str().into());
                }
                record.insert("folder".to_owned(), cell.folder.as_str().into());
                Some(Value::from(record))
            });
        let mut record = object([
            ("label", row.label.as_str().into()),
            ("base", row.is_base.into()),
            ("cells", Value::Array(cells.collect())),
        ]);
        put(&mut record, "at", row.at);
        Value::from(record)
    });
    let mut record = object([
        ("name", table.name.as_str().into()),
        ("title", table.title.as_str().into()),
        ("file", format!("{}.csv", table.file_stem()).into()),
        ("rows", Value::Array(rows.collect())),
    ]);
    if !table.causes.is_empty() {
        record.insert(
            "causes".to_owned(),
            table.causes.iter().map(cause).collect(),
        );
    }
    if let Some(change) = &table.change {
        let columns = table.changes().into_iter().map(column_change);
        let record_of_change = object([
            ("key", change.key.as_str().into()),
            ("unit", change.unit.as_str().into()),
            ("from", change.from.as_str().into()),
            ("columns", Value::Array(columns.collect())),
        ]);
        record.insert("change_per_unit".to_owned(), record_of_change.into());
    }
    if !table.lacking.is_empty() {
        record.insert("lacking".to_owned(), table.lacking.clone().into());
    }
    record.into()
}

fn column_change((column, change): (&ComparedColumn, &ColumnChange)) -> Value {
    let what = column.text();
    let mut record = object([("metric", what.as_str().into())]);
    record.extend(interval(&change.estimate));
    record.extend(object([
        ("unit", change.unit.as_str().into()),
        ("at", change.at.as_str().into()),
        ("folder", change.folder.as_str().into()),
    ]));
    record.into()
}

fn cause(cause: &Cause) -> Value {
    let ends = |estimate: &Estimate| [estimate.value, estimate.low, estimate.high];
    let mut record = object([
        ("label", cause.label.as_str().into()),
        ("folder", cause.folder.as_str().into()),
        ("channel", cause.channel.as_str().into()),
        ("relative_to", cause.relative_to.as_str().into()),
        ("metric", cause.metric.as_str().into()),
    ]);
    put_array(&mut record, "ratio", &ends(&cause.ratio));
    if let Some(gain) = &cause.dc_gain {
        put_array(&mut record, "dc_gain_ratio", &ends(gain));
    }
    if let Some(left) = &cause.remainder {
        let word = match left.against_one {
            AgainstOne::Below => "below",
            AgainstOne::Equal => "equal",
            AgainstOne::Above => "above",
            AgainstOne::Undecided => "undecided",
        };
        put_array(&mut record, "over_dc_gain_ratio", &ends(&left.estimate));
        record.insert("over_dc_gain_ratio_against_one".to_owned(), word.into());
    }
    for (key, metric) in &cause.companions {
        put_array(&mut record, key, &ends(&metric.estimate));
    }
    record.into()
}

fn assumption(assumed: &Assumed) -> Value {
    let mut record = object([
        ("key", assumed.key.as_str().into()),
        ("values", assumed.values.clone().into()),
        ("values_read_otherwise", assumed.otherwise.clone().into()),
        ("statement", assumed.statement.as_str().into()),
        ("silence", assumed.silence.as_str().into()),
        ("alternatives", assumed.alternatives.as_str().into()),
    ]);
    if let Some(table) = &assumed.table {
        record.insert("table".to_owned(), table.as_str().into());
    }
    record.into()
}
