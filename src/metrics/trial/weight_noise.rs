//! Allan deviation of a filter's output over raw's: well beyond its memory, where only the wandering of its
//! weights changes it, and inside, where smoothing does.

use std::ops::Range;

use super::dc_gain::{DC_GAIN, dc_gain_lack};
use crate::metrics::allan::overlapping::{NoiseType, degrees_of_freedom};
use crate::metrics::estimate::blocks::samples_in;
use crate::metrics::estimate::influence::{Spread, spread};
use crate::metrics::estimate::interval;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::{Applies, MetricKey, Table};
use crate::metrics::record::{FilterFacts, Record};
use crate::metrics::theory::memory::memory_samples;

/// Weight noise.
pub static WEIGHT_NOISE_RATIO: MetricKey = MetricKey::of_filters(
    "weight_noise_ratio",
    "1",
    Applies::Steady,
    "Allan deviation at averaging_time_s over DC gain times raw's: 1 when the weights stand still",
)
.lower_is_better()
.heading("weight noise")
.tables(&[Table::Rest]);

/// Allan deviation inside the memory.
pub static ALLAN_RATIO_INSIDE_MEMORY: MetricKey = MetricKey::of_filters(
    "allan_ratio_inside_memory",
    "1",
    Applies::Steady,
    "Allan deviation at 1 s over DC gain times raw's, if the filter reaches into it: no less noise beyond",
)
.heading("inside memory");

/// Averaging time at which the ratio is taken, s, if the record supports it.
const AVERAGING_TIME_S: f64 = 1.0;

/// Fewest degrees of freedom of the Allan variance of white noise at the averaging time.
const FREEDOM_MIN: f64 = 20.0;

/// Averaging times asked for, and needed, over the samples that a filter reaches back: an average of p
/// samples lowers the ratio by p over three averaging times.
const REACHES: usize = 10;
const REACHES_MIN: usize = 5;

/// Most and fewest blocks of the jackknife; second differences reach two averaging times, so that
/// blocks of four are nearly independent.
const BLOCKS_MAX: usize = 20;
const BLOCKS_MIN: usize = 3;
const AVERAGING_TIMES_PER_BLOCK: usize = 4;

/// Enters `weight_noise_ratio`: `ADEV(output) / (DC gain ADEV(raw))` at 1 s or ten reaches of the
/// filter, or at the longest averaging time below at which the record has 20 degrees of freedom.
///
/// A filter whose weights stand still passes what is slower than its taps with its DC gain, and the
/// ratio is 1. Weights that wander multiply the mean rate by a noise of their own, which no DC gain
/// restores. The averaging time must be long against the taps: at a few samples the ratio shows the
/// filter's smoothing instead.
///
/// Interval: jackknife over blocks of time, output and raw leaving together. A filter gives a difference of
/// raw back by its delay later: raw's blocks lie that much earlier, as else each end of a block would count
/// for what the next block takes back; the ends of the record are added. Source: derived.
pub(crate) fn measure_weight_noise(
    record: &Record,
    facts: &FilterFacts,
    metrics: &mut ChannelMetrics,
) {
    let (dc_gain, m, ratio) = match beyond_memory(record, facts) {
        Ok(found) => found,
        Err(reason) => return metrics.miss(&WEIGHT_NOISE_RATIO, reason),
    };
    let metric = metrics.put(&WEIGHT_NOISE_RATIO, ratio);
    // The time asked for where it is the nearest whole number of samples.
    let averaging_time_s = if m == samples_in(AVERAGING_TIME_S, record.sample_period_s) {
        AVERAGING_TIME_S
    } else {
        m as f64 * record.sample_period_s
    };
    metric.fields.insert("averaging_time_s", averaging_time_s);
    metric.fields.insert(DC_GAIN.name, dc_gain);
}

/// DC gain, averaging time in samples, and the ratio there, or why there is none.
fn beyond_memory(
    record: &Record,
    facts: &FilterFacts,
) -> Result<(f64, usize, Estimate), Unavailable> {
    let dc_gain = restorable_gain(facts)?;
    let count = record.raw_deg_per_h.len();
    let reach = reach_samples(facts);
    let asked = samples_in(AVERAGING_TIME_S, record.sample_period_s).max(REACHES * reach);
    let longest = asked.min(count / 4);
    let Some(m) = (1..=longest).rev().find(|m| is_supported(count, *m)) else {
        return Err(format!("no averaging time has {FREEDOM_MIN} degrees of freedom").into());
    };
    if m < REACHES_MIN * reach {
        return Err(format!(
            "no averaging time long against the {reach} samples that the filter reaches back"
        )
        .into());
    }
    Ok((dc_gain, m, restored_ratio(record, facts, dc_gain, m)?))
}

/// Enters `allan_ratio_inside_memory`: the same ratio at 1 s, where the filter reaches into it.
///
/// White noise through a low pass has less of an Allan deviation there, as `Claim` has it in closed form:
/// an angle random walk read off at 1 s seems to gain what `weight_noise_ratio` does not show.
pub(crate) fn measure_inside_memory(
    record: &Record,
    facts: &FilterFacts,
    metrics: &mut ChannelMetrics,
) {
    let m = samples_in(AVERAGING_TIME_S, record.sample_period_s);
    let reach = reach_samples(facts);
    match inside_memory(record, facts, m, reach) {
        Ok(ratio) => {
            let fields = &mut metrics.put(&ALLAN_RATIO_INSIDE_MEMORY, ratio).fields;
            fields.insert("averaging_time_s", m as f64 * record.sample_period_s);
            fields.insert("reach_samples", reach as f64);
        }
        Err(reason) => metrics.miss(&ALLAN_RATIO_INSIDE_MEMORY, reason),
    }
}

/// The ratio at `m` samples, of a filter that reaches so many back, or why there is none.
fn inside_memory(
    record: &Record,
    facts: &FilterFacts,
    m: usize,
    reach: usize,
) -> Result<Estimate, Unavailable> {
    let dc_gain = restorable_gain(facts)?;
    if m >= REACHES * reach {
        return Err(
            format!("1 s is well beyond the {reach} samples that the filter reaches back").into(),
        );
    }
    let count = record.raw_deg_per_h.len();
    if !(1..=count / 4).contains(&m) || !is_supported(count, m) {
        return Err(
            format!("an averaging time of 1 s has no {FREEDOM_MIN} degrees of freedom").into(),
        );
    }
    restored_ratio(record, facts, dc_gain, m)
}

/// DC gain by which an output can be restored.
fn restorable_gain(facts: &FilterFacts) -> Result<f64, Unavailable> {
    let dc_gain = facts
        .dc_gain
        .ok_or("the DC gain of this filter is not known")?;
    if dc_gain <= 1e-6 || !dc_gain.is_finite() {
        return Err(dc_gain_lack(dc_gain));
    }
    Ok(dc_gain)
}

/// Samples that a filter reaches back.
fn reach_samples(facts: &FilterFacts) -> usize {
    memory_samples(&facts.shape) + facts.shape.newest_age_samples
}

/// Whether so many samples have degrees of freedom enough at an averaging time of `m`.
fn is_supported(count: usize, m: usize) -> bool {
    degrees_of_freedom(NoiseType::White, count + 1, m) >= FREEDOM_MIN
}

/// `ADEV(output) / (DC gain ADEV(raw))` at `m` samples, or that the raw channel has no noise.
fn restored_ratio(
    record: &Record,
    facts: &FilterFacts,
    dc_gain: f64,
    m: usize,
) -> Result<Estimate, Unavailable> {
    let (own, raw) = (record.channel_deg_per_h, record.raw_deg_per_h);
    let count = raw.len();
    let blocks = (count / (AVERAGING_TIMES_PER_BLOCK * m)).clamp(BLOCKS_MIN, BLOCKS_MAX);
    let all = 0..(count + 1).saturating_sub(2 * m);
    let sum = |values: &[f64]| -> f64 {
        let blocks = second_difference_squares(values, m, all.clone(), blocks);
        blocks.iter().sum()
    };
    let (own_sum, raw_sum) = (sum(own), sum(raw));
    let scatter = (raw_sum / count as f64).sqrt() / m as f64;
    if scatter <= 1e-12 * interval::mean(raw).abs() || raw_sum <= 0.0 {
        return Err("the raw channel has no noise".into());
    }
    let ratio = |own: f64, raw: f64| (own / raw).max(0.0).sqrt() / dc_gain;
    let value = ratio(own_sum, raw_sum);
    let delay = facts.delay_at_dc_samples().clamp(0.0, all.end as f64 / 4.0);
    let whole = interval::round_to_count(delay.floor());
    let later = (whole + 1).min(all.end);
    let own = second_difference_squares(own, m, later..all.end, blocks);
    let [near, far] = [whole, whole + 1].map(|shift| {
        let shifted = later.saturating_sub(shift)..all.end.saturating_sub(shift);
        second_difference_squares(raw, m, shifted, blocks)
    });
    let part = delay - delay.floor();
    let raw: Vec<f64> = near
        .iter()
        .zip(&far)
        .map(|(near, far)| (1.0 - part) * near + part * far)
        .collect();
    let (own_sum, raw_sum): (f64, f64) = (own.iter().sum(), raw.iter().sum());
    let left_out: Vec<f64> = own
        .iter()
        .zip(&raw)
        .map(|(own, raw)| ratio(own_sum - own, raw_sum - raw))
        .collect();
    // At either end of the record as many squares as the delay are of one channel alone, alike next to
    // each other; the square of a normal number has twice the square of its mean as its variance.
    let ends = Spread::known((value * delay / all.end as f64).powi(2));
    let spread = spread(&left_out, None).plus(ends);
    let estimate = spread.about(value);
    Ok(estimate.clamped(0.0, f64::INFINITY))
}

/// Sums, in blocks of the differences that start in a range, of the squared differences between the sums of
/// `m` samples and of the `m` before: the terms of the overlapping Allan variance.
///
/// The difference slides by `x[k+2m] - 2x[k+m] + x[k]` and starts afresh in every block, so that
/// rounding does not pile up and no angle has to be stored.
fn second_difference_squares(
    values: &[f64],
    m: usize,
    starts: Range<usize>,
    blocks: usize,
) -> Vec<f64> {
    (0..blocks)
        .map(|block| {
            let start = starts.start + starts.len() * block / blocks;
            let end = starts.start + starts.len() * (block + 1) / blocks;
            if start == end {
                return 0.0;
            }
            let sum = |from: usize| values[from..from + m].iter().sum::<f64>();
            let mut difference = sum(start + m) - sum(start);
            let mut squares = difference * difference;
            for k in start..end - 1 {
                difference += (values[k + 2 * m] - values[k + m]) - (values[k + m] - values[k]);
                squares += difference * difference;
            }
            squares
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::overlapping_allan_at;

    #[test]
    fn sliding_differences_are_those_of_the_allan_variance() {
        let values: Vec<f64> = (0..5000).map(|k| f64::from((k * k) % 1013)).collect();
        for (m, blocks) in [(1, 3), (7, 20), (300, 4)] {
            let starts = 0..values.len() + 1 - 2 * m;
            let squares = second_difference_squares(&values, m, starts, blocks);
            let sum: f64 = squares.iter().sum();
            let point = overlapping_allan_at(&values, 1.0, &[m])[0];
            let m_f = m as f64;
            let variance = sum / (2.0 * m_f * m_f * point.count as f64);
            assert!((variance / point.variance() - 1.0).abs() < 1e-10);
        }
    }
}
