//! Counts of samples: where the record begins and where a staircase steps.

use crate::scenario::StepsConfig;

/// Index of the first measured sample, `ceil(warm_up_s / T)`; the first dwell begins there.
#[must_use]
pub fn first_measured_index(warm_up_s: f64, sample_period_s: f64) -> u64 {
    whole_samples((warm_up_s / sample_period_s).ceil())
}

/// Indices of the samples at which the commanded rate changes, one fewer than there are rates.
///
/// Entry `j` is the first sample that lies wholly at rate `j + 1`:
/// `ceil(warm_up_s / T) + round((j + 1) dwell_s / T)`, so that no error builds up over the dwells.
/// The step itself is at the start of that sample, which is the stamp of the sample before it.
#[must_use]
pub fn step_indices(steps: &StepsConfig, warm_up_s: f64, sample_period_s: f64) -> Vec<u64> {
    let first = first_measured_index(warm_up_s, sample_period_s);
    let dwell_samples = steps.dwell_s / sample_period_s;
    (1..steps.rates_deg_per_s.len())
        .map(|dwells| first + whole_samples((dwells as f64 * dwell_samples).round()))
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
