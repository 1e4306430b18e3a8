//! What a suite says across its scenarios, as JSON.

use serde_json::{Map, Value};

use crate::metrics::AgainstOne;
use crate::report::comparison::{
    Assumed, Cause, ColumnChange, ComparedColumn, ComparedTable, Comparison,
};
use crate::report::json::{number, object};
use crate::report::summary::estimate;
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
                if let Value::Object(fields) = estimate(&what, &cell.simulated) {
                    record.extend(fields);
                }
                if let Some((value, source)) = &cell.published {
                    record.insert("published".to_owned(), number(*value, &what));
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
        if let Some(at) = row.at {
            record.insert("at".to_owned(), number(at, &row.label));
        }
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
    object([
        ("metric", what.as_str().into()),
        ("value", number(change.estimate.value, &what)),
        ("low", number(change.estimate.low, &what)),
        ("high", number(change.estimate.high, &what)),
        ("confidence", number(change.estimate.confidence, &what)),
        ("unit", change.unit.as_str().into()),
        ("at", change.at.as_str().into()),
        ("folder", change.folder.as_str().into()),
    ])
    .into()
}

fn cause(cause: &Cause) -> Value {
    let interval = |estimate: &crate::metrics::Estimate| {
        let values = [estimate.value, estimate.low, estimate.high];
        Value::Array(values.map(|value| number(value, &cause.metric)).to_vec())
    };
    let mut record = object([
        ("label", cause.label.as_str().into()),
        ("folder", cause.folder.as_str().into()),
        ("channel", cause.channel.as_str().into()),
        ("relative_to", cause.relative_to.as_str().into()),
        ("metric", cause.metric.as_str().into()),
        ("ratio", interval(&cause.ratio)),
    ]);
    if let Some(gain) = &cause.dc_gain {
        record.insert("dc_gain_ratio".to_owned(), interval(gain));
    }
    if let Some(left) = &cause.remainder {
        let word = match left.against_one {
            AgainstOne::Below => "below",
            AgainstOne::Equal => "equal",
            AgainstOne::Above => "above",
            AgainstOne::Undecided => "undecided",
        };
        record.insert("over_dc_gain_ratio".to_owned(), interval(&left.estimate));
        record.insert("over_dc_gain_ratio_against_one".to_owned(), word.into());
    }
    for (key, metric) in &cause.companions {
        record.insert(key.clone(), interval(&metric.estimate));
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
