//! Counts of samples: where the record begins and where a staircase steps.

use crate::turntable::Stairs;

/// Index of the first measured sample, `ceil(warm_up_s / T)`; the first dwell begins there.
#[must_use]
pub fn first_measured_index(warm_up_s: f64, sample_period_s: f64) -> u64 {
    whole_samples((warm_up_s / sample_period_s).ceil())
}

/// Indices of the samples at which the commanded rate changes, one fewer than there are rates.
///
/// Entry `j` is the first sample that lies wholly at rate `j + 1`: `ceil(warm_up_s / T) +
/// round(end_s / T)` with the end of rate `j`, so that no error builds up over the dwells. The step
/// itself is at the start of that sample, which is the stamp of the sample before it.
#[must_use]
pub fn step_indices(stairs: &Stairs, warm_up_s: f64, sample_period_s: f64) -> Vec<u64> {
    let mut indices = dwell_ends(stairs, warm_up_s, sample_period_s);
    indices.pop();
    indices
}

/// Index of the first sample after each rate; see [`step_indices`].
#[must_use]
pub fn dwell_ends(stairs: &Stairs, warm_up_s: f64, sample_period_s: f64) -> Vec<u64> {
    let first = first_measured_index(warm_up_s, sample_period_s);
    let ends_s = stairs.ends_s.iter();
    ends_s
        .map(|end_s| first + whole_samples((end_s / sample_period_s).round()))
        .collect()
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a rounded count of samples; the cast saturates"
)]
fn whole_samples(count: f64) -> u64 {
    count as u64
}
