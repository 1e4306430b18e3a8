//! Mean of a record, its error, its ratio to that of raw, and the extremes.

use std::borrow::Cow;
use std::ops::Range;

use crate::metrics::estimate::influence::{Learned, Spread};
use crate::metrics::estimate::interval;
use crate::metrics::estimate::paired::{Made, MeanScatter, Values, delayed, density_at_zero};
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::{Against, Applies, Headline, MetricKey, Needs, OfBlocks, Table};
use crate::metrics::noise::truth_response::moves;
use crate::metrics::record::{FilterFacts, Record, WeightScatter};
use crate::metrics::theory::learning::NOT_FROM_ONE_RECORD;
use crate::metrics::theory::memory::memory_samples;
use crate::signal::WeightRule;
use crate::wording::decimals;

/// Mean.
pub static MEAN: MetricKey = MetricKey::new(
    "mean_deg_per_h",
    "deg/h",
    Applies::Always,
    "mean over the record; in a swing the offset of the sine fit over whole cycles",
)
.of_blocks(OfBlocks::Mean)
.synonyms(&["average"])
.heading("mean")
.run_column(1)
.of_one_motion()
.tables(&[Table::Rest, Table::Steps])
.headlines(&[Headline::Rest]);

/// Mean error.
pub static MEAN_ERROR: MetricKey = MetricKey::new(
    "mean_error_deg_per_h",
    "deg/h",
    Applies::Always,
    "the mean minus that of the true rate",
)
.heading("mean error")
.against(Against::Truth)
.run_column(2)
.of_one_motion()
.tables(&[Table::Rest, Table::Steps])
.headlines(&[Headline::Steps, Headline::General]);

/// Mean over that of raw.
pub static MEAN_RATIO: MetricKey = MetricKey::of_filters(
    "mean_ratio",
    "1",
    Applies::Always,
    "mean of the channel over the mean of raw",
)
.heading("mean / raw mean")
.of_one_motion()
.tables(&[Table::Rest, Table::Steps]);

/// Minimum.
pub static MINIMUM: MetricKey = MetricKey::new(
    "minimum_deg_per_h",
    "deg/h",
    Applies::Always,
    "smallest sample of the record",
)
.needs(Needs::Samples)
.run_column(4);

/// Maximum.
pub static MAXIMUM: MetricKey = MetricKey::new(
    "maximum_deg_per_h",
    "deg/h",
    Applies::Always,
    "largest sample of the record",
)
.needs(Needs::Samples)
.run_column(5);

/// Samples over which the words of a gyro are correlated.
pub(crate) const GYRO_REACH: usize = 15;

/// Enters the mean and, where the truth is known, its error against the mean truth.
pub(crate) fn put_mean(
    mean: Estimate,
    truth_deg_per_h: Option<f64>,
    averaging_time_s: f64,
    metrics: &mut ChannelMetrics,
) {
    metrics
        .put(&MEAN, mean)
        .fields
        .insert("averaging_time_s", averaging_time_s);
    let Some(truth_deg_per_h) = truth_deg_per_h else {
        return;
    };
    metrics
        .put(&MEAN_ERROR, mean.shifted(-truth_deg_per_h))
        .fields
        .insert("averaging_time_s", averaging_time_s);
}

/// Enters what every record has, whatever its motion: the smallest and the largest sample.
pub(crate) fn put_extremes(record: &Record, metrics: &mut ChannelMetrics) {
    let values = record.channel_deg_per_h;
    put_range(extremes(values), metrics);
}

/// Smallest and largest of some values.
pub(crate) fn extremes(values: &[f64]) -> [f64; 2] {
    let smallest = values.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    [smallest, largest]
}

/// Enters the smallest and the largest sample.
pub(crate) fn put_range([smallest, largest]: [f64; 2], metrics: &mut ChannelMetrics) {
    metrics.put(&MINIMUM, Estimate::exact(smallest));
    metrics.put(&MAXIMUM, Estimate::exact(largest));
}

/// Samples over which what a filter does to its words has died out.
pub(crate) fn filter_reach(filter: Option<&FilterFacts>) -> usize {
    let of = |facts: &FilterFacts| memory_samples(&facts.shape) + facts.shape.newest_age_samples;
    filter.map_or(0, of) + GYRO_REACH
}

/// How sure the mean of a channel over the record is.
///
/// * `noise`: samples without the motion, of all the record or of a settled part of it.
/// * `is_at_rest`: whether the mean rate is no more than noise to a filter that learns.
///
/// Fast noise by its spectral density at zero frequency; slow noise, of which a record shows next to
/// nothing, as the gyro has it, times the gain for a rate that is there from the first word on; and
/// what weights that forget nothing have learned.
pub(crate) fn mean_spread_of(
    record: &Record,
    noise: &[f64],
    filter: Option<&FilterFacts>,
    is_at_rest: bool,
) -> Result<Spread, &'static str> {
    let samples = record.channel_deg_per_h.len();
    let gain = filter
        .and_then(|facts| facts.dc_gain_adapted)
        .unwrap_or(1.0);
    let drift = Spread::known(record.drift_variance()).scaled(gain);
    let fast = || {
        // What is missing is not waited for: noise on either side of a few words is hardly nearer.
        let present = present(noise);
        let count = samples - (noise.len() - present.len());
        MeanScatter::of(&*present, filter_reach(filter)).over(count)
    };
    let scatter = filter.map_or(WeightScatter::Blocks, |facts| {
        facts.weight_scatter(samples, 0.0)
    });
    match scatter {
        WeightScatter::Blocks => Ok(fast().plus(drift)),
        WeightScatter::Unknown(reason) => Err(reason),
        WeightScatter::Runs { .. } => {
            let gain = scatter.of(None, |weights| weights.iter().sum());
            let level = interval::mean(record.raw_deg_per_h);
            let by_gain = gain.map_or(Spread::known(0.0), |gain| gain.scaled(level).spread());
            Ok(fast().plus(drift).plus(by_gain))
        }
        WeightScatter::Learned(_) => {
            let learning = filter.and_then(|facts| facts.learning.as_ref());
            let learned = learning.and_then(|known| known.output_mean(is_at_rest));
            let learned = learned.ok_or(NOT_FROM_ONE_RECORD)?.spread();
            let spread = learned.plus(drift);
            Ok(if is_at_rest {
                spread
            } else {
                spread.plus(fast())
            })
        }
    }
}

/// The words that are there; no copy of a record that misses none.
fn present(words: &[f64]) -> Cow<'_, [f64]> {
    let is_there = |word: &&f64| !word.is_nan();
    if words.iter().all(|word| !word.is_nan()) {
        return Cow::Borrowed(words);
    }
    words.iter().filter(is_there).copied().collect()
}

/// Ratio of the means of the record, if raw's mean can be told from zero.
///
/// * `settled`: samples in which the channel is raw times the ratio but for noise.
pub(crate) fn measure_mean_ratio(
    record: &Record,
    settled: Range<usize>,
    facts: &FilterFacts,
    metrics: &mut ChannelMetrics,
) {
    let samples = record.raw_deg_per_h.len();
    let raw = interval::mean(record.raw_deg_per_h);
    let fast = MeanScatter::of(&record.raw_deg_per_h[settled.clone()], GYRO_REACH).over(samples);
    let raw_mean = fast.plus(Spread::known(record.drift_variance())).about(raw);
    if let Some(reason) = ratio_of_means_lack(&raw_mean) {
        return metrics.miss(&MEAN_RATIO, reason);
    }
    let of = RatioOfMeans {
        ratio: interval::mean(record.channel_deg_per_h) / raw,
        raw_deg_per_h: raw,
        samples,
    };
    let learning = facts.learning.as_ref();
    let learned = learning.and_then(|learning| learning.mean_ratio(raw));
    metrics.put(
        &MEAN_RATIO,
        paired_ratio(record, settled, of, facts, learned),
    );
}

/// A mean of the channel over that of raw.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RatioOfMeans {
    /// The ratio.
    pub(crate) ratio: f64,
    /// Raw's mean, deg/h.
    pub(crate) raw_deg_per_h: f64,
    /// Samples in both means.
    pub(crate) samples: usize,
}

/// A ratio of means, by the noise of a settled part of the record and by what weights have learned.
///
/// What a filter makes of a word comes a little later: the noise of both means cancels but for the
/// ends.
pub(crate) fn paired_ratio(
    record: &Record,
    settled: Range<usize>,
    of: RatioOfMeans,
    facts: &FilterFacts,
    learned: Option<Learned>,
) -> Estimate {
    let own = &record.channel_deg_per_h[settled.clone()];
    let still = !moves(record, settled.start);
    let raw = &record.raw_deg_per_h[settled];
    let scatter = paired_scatter((own, raw), of.ratio, facts, None);
    let scatter = match facts.response().filter(|_| still) {
        Some(response) => scatter.or_ends_of(&response, raw, GYRO_REACH),
        None => scatter,
    };
    let over_level = 1.0 / of.raw_deg_per_h;
    let blocks = scatter.over(of.samples).scaled(over_level);
    let weights = facts.weight_scatter(record.raw_deg_per_h.len(), 0.0);
    let by_runs = weights.of(None, |weights| weights.iter().sum());
    match (weights, learned) {
        (WeightScatter::Blocks, _) => blocks.about(of.ratio),
        (WeightScatter::Runs { .. }, _) => {
            let by_runs = by_runs.map_or(Spread::known(0.0), |runs| runs.spread());
            by_runs.plus(blocks).about(of.ratio)
        }
        (WeightScatter::Learned(_), Some(learned)) => {
            let ends = scatter.ends_over(of.samples).scaled(over_level);
            learned.spread().plus(ends).about(of.ratio)
        }
        _ => Estimate::without_interval(of.ratio, NOT_FROM_ONE_RECORD),
    }
}

/// How the mean of a channel minus its gain times raw scatters, both without motion.
///
/// Of given weights with the gain G the density at zero frequency is `(G - gain)^2` times raw's: blocks
/// of a short record do not tell it from what is near it.
///
/// * `cycle`: samples of a swing that was taken out, whose phase the ends share.
pub(crate) fn paired_scatter(
    (own, raw): (&[f64], &[f64]),
    gain: f64,
    facts: &FilterFacts,
    cycle: Option<f64>,
) -> MeanScatter {
    // None of these is held: each would be as long as the record.
    let plain = Made {
        count: own.len(),
        of: |index: usize| own[index] - gain * raw[index],
    };
    let reach = filter_reach(Some(facts));
    if let Some(given) = facts.given() {
        let density = density_at_zero(raw).scaled(given.dc_gain() - gain);
        let density = density.plus(rounding_density((own, raw), facts));
        return MeanScatter::of_known_density(plain, density, reach, None);
    }
    let input = delayed(raw, facts.delay_at_dc_samples());
    // Delayed, the first samples have no input.
    let whole = reach.min(own.len() / 2);
    let aligned = Made {
        count: own.len() - whole,
        of: |index: usize| own[whole + index] - gain * input.at(whole + index),
    };
    match cycle {
        Some(cycle) => MeanScatter::of_paired_about_swing(plain, aligned, reach, cycle),
        None => MeanScatter::of_paired(plain, aligned, reach, None),
    }
}

/// Samples at the end of a record that show the rounding of a filter in hardware.
const ROUNDED_SAMPLES: usize = 2000;

/// Spectral density of what given weights do not explain of a channel: the rounding of its words.
pub(crate) fn rounding_density((own, raw): (&[f64], &[f64]), facts: &FilterFacts) -> Spread {
    let WeightRule::Fixed(weights) = &facts.shape.rule else {
        return Spread::known(0.0);
    };
    let newest = facts.shape.newest_age_samples;
    let first = (newest + weights.len()).max(own.len().saturating_sub(ROUNDED_SAMPLES));
    let rest: Vec<f64> = (first..own.len())
        .map(|index| {
            let ages = weights.iter().zip(newest..);
            let explained = ages.map(|(weight, age)| weight * raw[index - age]);
            own[index] - explained.sum::<f64>()
        })
        .collect();
    let variance = if rest.len() < 2 {
        0.0
    } else {
        interval::sample_variance(&rest)
    };
    Spread::known(variance)
}

/// Why nothing can be divided by raw's mean; nothing if it can be told from zero.
pub(crate) fn ratio_of_means_lack(raw_mean: &Estimate) -> Option<Unavailable> {
    (raw_mean.low <= 0.0 && raw_mean.high >= 0.0).then(|| {
        format!(
            "the raw mean, {} deg/h, cannot be told from zero",
            decimals(raw_mean.value, 4)
        )
        .into()
    })
}
