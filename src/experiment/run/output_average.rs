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
/// Half a word less than whole words, so that the table's rounding up to whole words cannot go astray.
pub(crate) fn table_warm_up_s(
    scenario: &Scenario,
    warm_up_samples: usize,
    word_period_s: f64,
) -> f64 {
    if scenario.gyro.output.average_samples == 1 || warm_up_samples == 0 {
        return scenario.warm_up_s;
    }
    let words = count(warm_up_samples) * f64::from(scenario.gyro.output.average_samples);
    (words - 0.5) * word_period_s
}
