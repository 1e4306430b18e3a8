//! A second run of an adaptive filter: the same motion, the noise of another part of the record.
//!
//! The words of the record are motion m and noise n, those of the second run m and the noise n' of half a
//! record later. With the weights w and w' of the runs their outputs differ by
//!
//! ```text
//! y - y' = (w n - w' n') + (w - w') m
//! ```
//!
//! the noise of the words through the weights of each run, and what noise has done to the weights, times the
//! motion. Each word is made with the weights as the word before left them.

use std::collections::VecDeque;

use crate::experiment::channel_filter::{Arithmetic, FinishedFilter};
use crate::experiment::run::RecordLength;
use crate::metrics::TwoRuns;

/// Blocks of the record whose sums are kept apart.
const BLOCKS: usize = 20;

/// One of the runs.
struct Run {
    filter: Arithmetic,
    /// Noise of the words that the weights see, newest first.
    noise: VecDeque<f64>,
}

/// What one word of a run is made of.
struct Word {
    output: f64,
    through_weights: f64,
}

impl Run {
    /// Takes a word and gives its output, and what the weights make of its noise.
    ///
    /// * `seen`: noise of the newest regressor.
    fn step(&mut self, word: f64, seen: f64) -> Option<Word> {
        self.noise.rotate_right(1);
        self.noise[0] = seen;
        let weights = self.filter.as_filter().weights();
        let through_weights = weights.iter().zip(&self.noise).map(|(w, n)| w * n).sum();
        Some(Word {
            output: self.filter.step(word).ok()?.value_deg_per_h,
            through_weights,
        })
    }
}

/// How the outputs of two runs of a filter differ over the record.
///
/// * `words`, `motion`: input of the filter, and what of it is no noise, warm-up included.
///
/// None for a filter without taps, one that starts afresh within the record, and one that diverges.
pub(in crate::experiment::run) fn two_runs(
    filter: &FinishedFilter,
    (words, motion): (&[f64], &[f64]),
    length: RecordLength,
    sample_period_s: f64,
) -> Option<TwoRuns> {
    let kind = filter.kind.as_ref()?;
    let taps = filter.shape.taps.filter(|_| !filter.restarts)?;
    let lag = filter.shape.newest_age_samples - filter.shape.register_samples;
    let noise = |at: usize| words[at] - motion[at];
    let other = |at: usize| noise((at + words.len() / 2) % words.len());
    let run = || Run {
        filter: Arithmetic::new(kind, length, sample_period_s),
        noise: VecDeque::from(vec![0.0; taps]),
    };
    let (mut own, mut second) = (run(), run());
    let mut seen_motion = VecDeque::from(vec![0.0; taps]);
    let mut runs = TwoRuns::of_blocks(BLOCKS);
    for at in 0..words.len() {
        let seen = at.checked_sub(lag);
        let of = |series: &dyn Fn(usize) -> f64| seen.map_or(0.0, series);
        seen_motion.rotate_right(1);
        seen_motion[0] = of(&|at| motion[at]);
        let of_weights = difference_times(&own, &second, &seen_motion);
        let first = own.step(words[at], of(&noise))?;
        let second = second.step(motion[at] + other(at), of(&other))?;
        let Some(measured) = at.checked_sub(length.warm_up) else {
            continue;
        };
        let block = (measured * BLOCKS / length.measured.max(1)).min(BLOCKS - 1);
        runs.whole[block].take(first.output - second.output);
        runs.through_weights[block].take(first.through_weights - second.through_weights);
        runs.of_weights[block].take(of_weights);
    }
    Some(runs)
}

/// The difference of the weights of two runs, times the motion that they see.
fn difference_times(own: &Run, second: &Run, motion: &VecDeque<f64>) -> f64 {
    let weights = own.filter.as_filter().weights().iter();
    let differences = weights.zip(second.filter.as_filter().weights());
    let products = differences
        .zip(motion)
        .map(|((own, second), motion)| (own - second) * motion);
    products.sum()
}
