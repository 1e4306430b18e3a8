//! Words too coarse for their noise to be judged by: a handful of values, or counted pulses.

use std::cmp::Ordering;

use crate::metrics::estimate::interval::median;

/// Fewest distinct values of words whose scatter says what is far out.
pub(crate) const DISTINCT_MIN: usize = 8;

/// Words whose running sum is looked at in one piece, and pieces looked at.
const PIECE: usize = 64;
const PIECES_MAX: usize = 4096;

/// Largest scatter, in pulses, of the running sum of pulse words about a straight line. Carried
/// remainders keep it at 0.29, words rounded one by one raise it with the root of their number.
const PULSE_SCATTER_MAX: f64 = 0.6;

/// Part of a step by which whole steps may miss a whole number.
const WHOLE_WITHIN: f64 = 1e-6;

/// Number of distinct values, counted up to [`DISTINCT_MIN`].
pub(crate) fn distinct_values(words: &[f64]) -> usize {
    let mut seen: Vec<f64> = Vec::with_capacity(DISTINCT_MIN);
    for word in words {
        if !seen
            .iter()
            .any(|it| it.partial_cmp(word) == Some(Ordering::Equal))
        {
            seen.push(*word);
            if seen.len() == DISTINCT_MIN {
                break;
            }
        }
    }
    seen.len()
}

/// Smallest change from one word to the next; infinite where the words never change.
pub(crate) fn smallest_change(words: &[f64]) -> f64 {
    let mut least = f64::INFINITY;
    for two in words.windows(2) {
        let change = (two[1] - two[0]).abs();
        least = if change > 0.0 {
            least.min(change)
        } else {
            least
        };
    }
    least
}

/// Whether the words are whole numbers of pulses of angle whose remainders are carried on.
///
/// All of them are whole steps of the smallest change between two of them, and their running sum stays
/// within a pulse of a straight line over 64 words, as the angle of a gyro at rest does. Words that are
/// rounded one by one forget what they rounded, and wander off.
pub(crate) fn are_pulses(words: &[f64], step: f64) -> bool {
    if !step.is_finite() {
        return false;
    }
    let stride = (words.len() / PIECES_MAX).max(PIECE);
    let mut scatters = Vec::new();
    for start in (0..words.len()).step_by(stride) {
        let Some(piece) = words.get(start..start + PIECE) else {
            break;
        };
        let mut sum = 0.0;
        let mut angles = Vec::with_capacity(PIECE);
        for word in piece {
            let count = word / step;
            if (count - count.round()).abs() > WHOLE_WITHIN * count.abs().max(1.0) {
                return false;
            }
            sum += count;
            angles.push(sum);
        }
        scatters.push(scatter_about_line(&angles));
    }
    !scatters.is_empty() && median(&mut scatters) < PULSE_SCATTER_MAX
}

/// Standard deviation about the straight line of least squares.
fn scatter_about_line(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let middle = (count - 1.0) / 2.0;
    let mean = values.iter().sum::<f64>() / count;
    let (mut product, mut square, mut total) = (0.0, 0.0, 0.0);
    for (index, value) in values.iter().enumerate() {
        let (at, rise) = (index as f64 - middle, value - mean);
        product += at * rise;
        square += at * at;
        total += rise * rise;
    }
    ((total - product * product / square).max(0.0) / count).sqrt()
}
