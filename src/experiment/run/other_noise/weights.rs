//! Weights that noise left where they are before the motion came, and that the motion keeps there.
//!
//! A gradient moves weights along the regressors it sees. Under a rate far above the noise these are
//! nearly all alike, and what the weights hold across them is forgotten at the pace of the noise's share
//! in their power: beyond any record. Blocks of the record then agree to many digits, and records of other
//! seeds do not. Whether that is so is tried, not assumed: the filter runs again from its initial state on
//! the same motion with the noise of other parts of the record.
//!
//! The runs are over a part of the record, and what they differ by fades a little more over all of it. Along
//! an eigenvector of the mean of `x x' / x'x` with the eigenvalue l a normalised gradient of step m keeps
//! `exp(-m l t)` after t samples: of the mean over the first P samples that over N has
//!
//! ```text
//! f(m l N) / f(m l P),    f(z) = (1 - exp(-z)) / z
//! ```

use nalgebra::{DMatrix, DVector, Dyn, SymmetricEigen};

use crate::experiment::channel_filter::{ChannelFilter, FinishedFilter};
use crate::experiment::run::{RecordLength, count};
use crate::filters::FilterKind;

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
    let finished = filter.words.as_ref().ok()?;
    let blocks = &finished.block_weights;
    let part = RecordLength {
        measured: length.measured / PARTS,
        ..length
    };
    let measured = &words[length.warm_up..];
    if filter.restarts || blocks.len() != PARTS {
        return None;
    }
    let shares = power_shares(measured, filter.shape.taps?)?;
    // At any stable step.
    if shares.eigenvalues.min() * STEP_MAX * count(part.measured) > 1.0 {
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
    let differ = runs.len() > 2 && scatter(&runs) > of_blocks;
    let step = normalised_step(kind);
    let faded = |runs: Vec<Vec<f64>>| match (&finished.mean_weights, step) {
        (Some(mean), Some(step)) => {
            let spans = [part.measured, length.measured].map(|samples| step * count(samples));
            over_record(&runs, mean, &shares, spans)
        }
        _ => runs,
    };
    differ.then(|| faded(runs))
}

/// Step of a normalised gradient; none of another rule, whose step has a unit or is a sign.
fn normalised_step(kind: &FilterKind) -> Option<f64> {
    match kind {
        FilterKind::Lms(settings) if settings.normalised => Some(settings.step_size),
        _ => None,
    }
}

/// Weights of runs over the first part of the record, as their differences are in the mean over all of it.
///
/// * `mean`: the weights of the filter over the record, about which they then lie.
/// * `spans`: samples of the part and of the record, times the step.
fn over_record(
    runs: &[Vec<f64>],
    mean: &[f64],
    shares: &SymmetricEigen<f64, Dyn>,
    spans: [f64; 2],
) -> Vec<Vec<f64>> {
    let kept = |share: f64| {
        let [of_part, of_record] = spans.map(|span| {
            let faded = (share * span).max(f64::EPSILON);
            -(-faded).exp_m1() / faded
        });
        of_record / of_part
    };
    let factors = shares.eigenvalues.map(kept);
    let vectors = &shares.eigenvectors;
    let of_runs = runs.iter().map(|own| DVector::from_column_slice(own));
    let centre = of_runs.clone().sum::<DVector<f64>>() / count(runs.len());
    let moved = of_runs.map(|own| {
        let along = (vectors.transpose() * (own - &centre)).component_mul(&factors);
        DVector::from_column_slice(mean) + vectors * along
    });
    moved.map(|own| own.as_slice().to_vec()).collect()
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

/// The mean of `x x' / x'x` over the regressors x, newest first, by its eigenvectors.
///
/// Its eigenvalues are what a normalised step of 1 forgets in a sample.
fn power_shares(words: &[f64], taps: usize) -> Option<SymmetricEigen<f64, Dyn>> {
    if words.len() < taps {
        return None;
    }
    let stride = (words.len() / REGRESSORS_MAX).max(1);
    let mut shares = DMatrix::<f64>::zeros(taps, taps);
    let mut number = 0.0;
    for window in words.windows(taps).step_by(stride) {
        let energy: f64 = window.iter().map(|word| word * word).sum();
        if energy > 0.0 {
            let newest_first = DVector::from_iterator(taps, window.iter().rev().copied());
            shares.syger(1.0 / energy, &newest_first, &newest_first, 1.0);
            number += 1.0;
        }
    }
    if number == 0.0 {
        return None;
    }
    shares.fill_upper_triangle_with_lower_triangle();
    Some((shares / number).symmetric_eigen())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_along_what_is_seen_fade_and_those_across_it_stay() {
        // Regressors along (1, 1) alone, but for a millionth across.
        let words: Vec<f64> = (0..20_000_i32)
            .map(|at| 100.0 + 0.1 * f64::from(at % 2))
            .collect();
        let shares = power_shares(&words, 2).unwrap();
        let runs = [
            vec![1.0, 1.0],
            vec![-1.0, -1.0],
            vec![1.0, -1.0],
            vec![-1.0, 1.0],
        ];
        let moved = over_record(&runs, &[0.5, 0.5], &shares, [10.0, 100.0]);
        // A tenth of the part's mean is left over ten times as long, of what has faded by then.
        let seen = moved[0][0] - 0.5;
        assert!((seen - 0.1).abs() < 1e-3, "{seen}");
        let unseen = moved[2][0] - 0.5;
        assert!((unseen - 1.0).abs() < 1e-3, "{unseen}");
    }
}
