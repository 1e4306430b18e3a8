//! Values of a record that is read back.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

use serde_json::Value;

/// A word as the constants of the program spell theirs: units, fields and labels, a few dozen in all,
/// each kept once for as long as the program runs.
pub(crate) fn interned(word: &str) -> &'static str {
    static WORDS: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    let mut words = WORDS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = words.get(word) {
        return known;
    }
    let kept: &'static str = Box::leak(word.to_owned().into_boxed_str());
    words.insert(kept);
    kept
}

/// An array of numbers.
pub(in crate::report) fn numbers(values: &Value) -> Option<Vec<f64>> {
    values.as_array()?.iter().map(Value::as_f64).collect()
}

/// An array of indices.
pub(in crate::report) fn indices(values: &Value) -> Option<Vec<usize>> {
    let values = values.as_array()?.iter();
    values
        .map(|index| usize::try_from(index.as_u64()?).ok())
        .collect()
}

/// A number of a record.
pub(in crate::report) fn real(record: &Value, key: &str) -> Option<f64> {
    record.get(key)?.as_f64()
}

/// An array of numbers of a record.
pub(in crate::report) fn reals<const N: usize>(record: &Value, key: &str) -> Option<[f64; N]> {
    numbers(record.get(key)?)?.try_into().ok()
}

/// An array of texts.
pub(in crate::report) fn texts(values: &Value) -> Option<Vec<String>> {
    let values = values.as_array()?.iter();
    values
        .map(|text| text.as_str().map(str::to_owned))
        .collect()
}
