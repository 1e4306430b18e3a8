//! Weights that noise left where they are before the motion came, and that the motion keeps there.
//!
//! A gradient moves weights along the regressors it sees. Under a rate far above the noise these are
//! nearly all alike, and what the weights hold across them is forgotten at the pace of the noise's share
//! in their power: beyond any record. Blocks of the record then agree to many digits, and records of other
//! seeds do not. Whether that is so is tried, not assumed: the filter runs again from its initial state on
//! the same motion with the noise of other parts of the record.

use nalgebra::{DMatrix, DVector};

use crate::experiment::channel_filter::{ChannelFilter, FinishedFilter};
use crate::experiment::run::RecordLength;

/// Runs on the noise of other parts of the record.
const RUNS: usize = 6;

/// Part of the record over whose beginning the weights are compared: that of a block.
const PARTS: usize = 10;

/// Largest step for which a normalised gradient is stable.
const STEP_MAX: f64 = 2.0;

/// Most regressors of which the power across the greatest is taken.
const REGRESSORS_MAX: usize = 20_000;

/// Scatter of the runs over that of the blocks, in variance, from which the blocks do not show it. For
/// weights that forget within a block it is 1; six runs and ten blocks exceed 9 once in a thousand times.
const RATIO_MAX: f64 = 9.0;

/// Scatter that changes no figure, over the weights.
const FLOOR: f64 = 1e-5;

/// Mean weights of runs of a filter that follows a gradient, its own first, if the blocks of its record
/// do not show how they scatter; else none.
///
/// * `words`, `motion`: input of the filter, and what of it is no noise, warm-up included.
pub(in crate::experiment::run) fn runs_that_differ(
    filter: &FinishedFilter,
    (words, motion): (&[f64], &[f64]),
    length: RecordLength,
    sample_period_s: f64,
) -> Option<Vec<Vec<f64>>> {
    let kind = filter.kind.as_ref()?;
    let blocks = &filter.words.as_ref().ok()?.block_weights;
    let part = RecordLength {
        measured: length.measured / PARTS,
        ..length
    };
    let measured = &words[length.warm_up..];
    let may_differ = !filter.restarts
        && blocks.len() == PARTS
        && forgets_slower_than(measured, filter.shape.taps?, part.measured);
    if !may_differ {
        return None;
    }
    let others = (1..=RUNS).filter_map(|run| {
        let shift = words.len() * run / (RUNS + 1);
        let noise = |at: usize| {
            let from = (at + shift) % words.len();
            words[from] - motion[from]
        };
        let input: Vec<f64> = (0..part.total()).map(|at| motion[at] + noise(at)).collect();
        let name = filter.name.clone();
        let mut again = ChannelFilter::new(name, kind, part, sample_period_s, false);
        again.process(&input);
        again.finish().words.ok()?.mean_weights
    });
    let own = &blocks[0];
    let runs: Vec<Vec<f64>> = std::iter::once(own.clone()).chain(others).collect();
    let power: f64 = own.iter().map(|weight| weight * weight).sum();
    let of_blocks = RATIO_MAX * scatter(blocks) + FLOOR.powi(2) * power;
    (runs.len() > 2 && scatter(&runs) > of_blocks).then_some(runs)
}

/// Sum over the taps of the variance of the weights.
fn scatter(weights: &[Vec<f64>]) -> f64 {
    let count = weights.len() as f64;
    let taps = weights.first().map_or(0, Vec::len);
    let of_tap = |tap: usize| {
        let mean = weights.iter().map(|own| own[tap]).sum::<f64>() / count;
        let squares = weights.iter().map(|own| (own[tap] - mean).powi(2));
        squares.sum::<f64>() / (count - 1.0)
    };
    (0..taps).map(of_tap).sum()
}

/// Whether weights across the greatest regressors forget slower than so many samples at any stable step.
///
/// The least eigenvalue of the mean of `x x' / x'x` is what a normalised step of 1 forgets in a sample.
fn forgets_slower_than(words: &[f64], taps: usize, samples: usize) -> bool {
    if words.len() < taps {
        return false;
    }
    let stride = (words.len() / REGRESSORS_MAX).max(1);
    let mut shares = DMatrix::<f64>::zeros(taps, taps);
    let mut count = 0.0;
    for window in words.windows(taps).step_by(stride) {
        let energy: f64 = window.iter().map(|word| word * word).sum();
        if energy > 0.0 {
            let window = DVector::from_column_slice(window);
            shares.syger(1.0 / energy, &window, &window, 1.0);
            count += 1.0;
        }
    }
    if count == 0.0 {
        return false;
    }
    shares.fill_upper_triangle_with_lower_triangle();
    let least = (shares / count).symmetric_eigenvalues().min();
    least * STEP_MAX * samples as f64 <= 1.0
}
