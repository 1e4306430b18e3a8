//! Figures of steps in runs on other noise, of a filter that forgets nothing.
//!
//! Least squares that forgets nothing and meets a step learns more from it than from all words before:
//! its weights move within a stretch of its record, and how its figures scatter from seed to seed is in
//! no stretch. It is in runs from its initial state on the same motion with noise like the record's. Only
//! what these weights move is worked out of each.

use crate::experiment::channel_filter::{Arithmetic, FinishedFilter};
use crate::experiment::run::{RecordLength, count};
use crate::metrics::{StepFigures, noise_beside_steps, noise_like};

/// Runs; their scatter has as many degrees of freedom less one.
const RUNS: u64 = 8;

/// Figures of runs of a filter from its initial state on other noise.
///
/// * `words`, `motion`: input of the filter, and what of it is no noise, warm-up included.
/// * `figures`: those of a run, by its output, its input and its DC gain.
///
/// None for a filter that cannot run again here, and where one of the runs fails.
pub(in crate::experiment::run) fn figures_of_other_runs(
    filter: &FinishedFilter,
    (words, motion): (&[f64], &[f64]),
    length: RecordLength,
    sample_period_s: f64,
    figures: impl Fn(&[f64], &[f64], f64) -> Option<StepFigures>,
) -> Option<Vec<StepFigures>> {
    let kind = filter.kind.as_ref().filter(|_| !filter.restarts)?;
    let noise = noise_beside_steps(words, motion);
    let run = |run: u64| {
        let mut input = noise_like(&noise, run);
        for (word, motion) in input.iter_mut().zip(motion) {
            *word += motion;
        }
        let mut made = Vec::with_capacity(input.len());
        let mut again = Arithmetic::but_for_rounding(kind, length, sample_period_s);
        again.step_all(&input, &mut made).ok()?;
        let gains = made[length.warm_up..].iter().map(|word| word.weight_sum);
        let dc_gain = gains.sum::<f64>() / count(length.measured);
        let output: Vec<f64> = made.iter().map(|word| word.value_deg_per_h).collect();
        figures(&output, &input, dc_gain)
    };
    (0..RUNS).map(run).collect()
}
