//! One channel in `summary.json`: metrics, verdict, repeats, curves, and reasons for what is missing.

use serde_json::{Map, Value};

use crate::metrics::{ChannelMetrics, FitSheet, FitTerm, OutlierEntry, RepeatStatistics};
use crate::report::layout::json::{METRICS, array, estimate, numbers, object, put, put_array};
use crate::report::text::quality::smoothing_words;
use crate::report::text::verdict::verdict_text;

/// One channel of `channels`.
pub(crate) fn channel(metrics: &ChannelMetrics) -> Value {
    let own = metrics.metrics.iter();
    let own = own.map(|(key, metric)| (key.clone(), estimate(metric).into()));
    let mut record: Map<String, Value> = own.collect();
    // The same once more by themselves: beside them stand texts and curves.
    record.insert(METRICS.to_owned(), record.clone().into());
    if let Some(verdict) = verdict_text(metrics) {
        record.insert("verdict".to_owned(), verdict.into());
    }
    if let Some(sheet) = &metrics.noise_fit {
        record.insert("noise_fit".to_owned(), noise_fit(sheet));
    }
    if !metrics.pulse_words.is_empty() {
        let words = metrics.pulse_words.iter();
        let words: Map<String, Value> = words
            .map(|(key, words)| (key.clone(), words.as_str().into()))
            .collect();
        record.insert("pulse_words".to_owned(), words.into());
    }
    if let Some(words) = smoothing_words(metrics) {
        record.insert("smoothing".to_owned(), words.into());
    }
    if !metrics.outliers.is_empty() {
        let list: Vec<Value> = metrics.outliers.iter().map(outlier).collect();
        record.insert("outlier_list".to_owned(), list.into());
    }
    if !metrics.repeats.is_empty() {
        record.insert("repeats".to_owned(), repeats_json(metrics));
    }
    if !metrics.curves.is_empty() {
        let curves: Map<String, Value> = metrics
            .curves
            .iter()
            .map(|(curve, columns)| {
                let labels = metrics.curve_labels.get(curve).into_iter().flatten();
                let words = labels.map(|(column, words)| (column.clone(), words_of(words)));
                let columns: Map<String, Value> = columns
                    .iter()
                    .filter_map(|(column, values)| Some((column.clone(), array(values)?)))
                    .chain(words)
                    .collect();
                (curve.clone(), columns.into())
            })
            .collect();
        record.insert("curves".to_owned(), curves.into());
    }
    if !metrics.unavailable.is_empty() {
        let reasons: Map<String, Value> = metrics
            .unavailable
            .iter()
            .map(|(key, reason)| (key.clone(), reason.as_str().into()))
            .collect();
        record.insert("unavailable".to_owned(), reasons.into());
    }
    if let Some(failure) = &metrics.error {
        let error = object([
            ("kind", failure.kind.as_str().into()),
            ("sample", failure.sample.into()),
            ("message", failure.message.as_str().into()),
        ]);
        record.insert("error".to_owned(), error.into());
    }
    record.into()
}

/// `channels.<name>.noise_fit` of the summary.
fn noise_fit(sheet: &FitSheet) -> Value {
    let mut record = object([
        ("criterion", "bic".into()),
        ("adequate", sheet.is_adequate.into()),
    ]);
    for (name, value) in &sheet.numbers {
        put(&mut record, name, *value);
    }
    put_array(&mut record, "missed_tau_s", &sheet.missed_tau_s);
    let term = |(key, term): (&String, &FitTerm)| {
        let mut entry = numbers([
            ("square", term.square),
            ("standard_error", term.standard_error),
        ]);
        entry.insert("unit".to_owned(), term.unit.as_str().into());
        entry.insert("in_model".to_owned(), term.is_in_model.into());
        (key.clone(), Value::Object(entry))
    };
    let terms: Map<String, Value> = sheet.terms.iter().map(term).collect();
    record.insert("terms".to_owned(), terms.into());
    record.into()
}

/// One of `channels.<name>.outlier_list`.
fn outlier(entry: &OutlierEntry) -> Value {
    let mut record = object([("index", entry.index.into()), ("words", entry.words.into())]);
    record.extend(numbers([
        ("time_s", entry.time_s),
        ("size_deg_per_h", entry.size_deg_per_h),
        ("size_deviations", entry.size_deviations),
    ]));
    record.into()
}

/// A column of words; one that holds for all points stands alone.
fn words_of(words: &[&str]) -> Value {
    match words {
        [one] => (*one).into(),
        all => all.iter().copied().collect(),
    }
}

/// Percentiles of a metric over the repeats.
const PERCENTILES: [(&str, f64); 5] = [
    ("percentile_5", 5.0),
    ("percentile_25", 25.0),
    ("percentile_50", 50.0),
    ("percentile_75", 75.0),
    ("percentile_95", 95.0),
];

/// `channels.<name>.repeats` of the summary.
pub(crate) fn repeats_json(metrics: &ChannelMetrics) -> Value {
    let of = |(key, statistics): (&String, &RepeatStatistics)| {
        let mut record = object([("unit", statistics.unit.into())]);
        put_array(&mut record, "values", &statistics.values);
        record.extend(numbers([
            ("mean", statistics.mean),
            ("standard_deviation", statistics.standard_deviation),
            ("minimum", statistics.minimum),
            ("maximum", statistics.maximum),
        ]));
        for (key, percent) in PERCENTILES {
            put(&mut record, key, statistics.percentile(percent));
        }
        if !statistics.lacking.is_empty() {
            record.insert("lacking".to_owned(), statistics.lacking.clone().into());
        }
        (key.clone(), Value::Object(record))
    };
    let records: Map<String, Value> = metrics.repeats.iter().map(of).collect();
    records.into()
}
