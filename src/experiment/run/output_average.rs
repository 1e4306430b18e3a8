//! Output samples that are means of several rate words.

use super::records::count;
use crate::scenario::Scenario;

/// Mean of the next `count` words; one word is itself, to the bit.
#[inline]
pub(crate) fn mean(count: usize, mut next_word: impl FnMut() -> f64) -> f64 {
    let first = next_word();
    if count == 1 {
        return first;
    }
    let mut sum = first;
    for _ in 1..count {
        sum += next_word();
    }
    sum / super::records::count(count)
}

/// Warm-up as the table counts it, s: its record begins with the first measured output sample.
///
/// The table makes `parts` segments of `part_s` an output sample. Half a segment less than whole ones, so
/// that the table's rounding up to whole ones cannot go astray.
pub(crate) fn table_warm_up_s(
    scenario: &Scenario,
    warm_up_samples: usize,
    (parts, part_s): (usize, f64),
) -> f64 {
    if parts == 1 || warm_up_samples == 0 {
        return scenario.warm_up_s;
    }
    (count(warm_up_samples * parts) - 0.5) * part_s
}
