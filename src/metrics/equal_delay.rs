//! Noise of a filter beside that of a mean of the same delay, and what a word costs it.

use super::trial::black_box::{LOOK_AHEAD, SINE_DELAY_MS, SINE_GAIN};
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::MetricKey;
use crate::metrics::record::FilterFacts;
use crate::metrics::theory::operations::operations_per_word;
use crate::metrics::verdict::filter_verdict;

/// Noise at equal delay.
pub static NOISE_AT_EQUAL_DELAY: MetricKey = MetricKey::of_twins(
    "noise_at_equal_delay",
    "1",
    "noise power gain at restored scale over that of a mean of white words with the same delay, a look-ahead being as much delay; 1 of a mean, and of one pole",
)
.lower_is_better()
.heading("noise at equal delay");

/// Operations for a word.
pub static OPERATIONS_PER_WORD: MetricKey = MetricKey::of_twins(
    "operations_per_word",
    "1",
    "multiplications, additions and divisions of the plain equations for one word, by the shape of the filter; a gradient counts as normalised least mean squares",
)
.lower_is_better()
.heading("operations a word");

/// Why nobody knows what a word costs a program.
const UNSEEN: &str =
    "a program's operations are not seen; the time that it took stands in .fogbench/programs.log";

/// Enters both, once the twins have told of the filter.
pub(crate) fn put_beside_others(
    facts: &FilterFacts,
    sample_period_s: f64,
    metrics: &mut ChannelMetrics,
) {
    match operations_per_word(&facts.shape) {
        Some(count) => {
            metrics.put(&OPERATIONS_PER_WORD, Estimate::exact(count as f64));
        }
        None => metrics.miss(&OPERATIONS_PER_WORD, UNSEEN),
    }
    match at_equal_delay(facts, sample_period_s, metrics) {
        Err(reason) => metrics.miss(&NOISE_AT_EQUAL_DELAY, reason),
        Ok((estimate, fields)) => {
            let own = &mut metrics.put(&NOISE_AT_EQUAL_DELAY, estimate).fields;
            own.extend(fields);
        }
    }
    metrics.keep_finite();
}

/// Names and values beside a figure.
type Fields = [(&'static str, f64); 2];

/// The ratio, and the delay and the number of words of the mean.
///
/// A mean of N words delays by `(N - 1) / 2` and leaves `1 / N` of the power of white noise; one pole of the
/// same delay leaves as much. The register and the latency of the filter are the mean's as well.
fn at_equal_delay(
    facts: &FilterFacts,
    sample_period_s: f64,
    metrics: &ChannelMetrics,
) -> Result<(Estimate, Fields), Unavailable> {
    let ahead = metrics.get(&LOOK_AHEAD).ok_or_else(|| {
        let why = metrics.why_unavailable(&LOOK_AHEAD);
        Unavailable::from(why.unwrap_or("its look-ahead is not known").to_owned())
    })?;
    let ahead = ahead.estimate.value;
    let verdict = filter_verdict(metrics);
    let noise = verdict.and_then(|verdict| verdict.fast_noise_restored);
    let noise = noise.ok_or("the motion shows no noise gain, or the filter no gain")?;
    let of_motion = verdict.and_then(|verdict| verdict.delay_ms);
    let of_motion = of_motion.map(|delay| delay.value / (1e3 * sample_period_s));
    let of_sine = || {
        let delay_ms = metrics.get(&SINE_GAIN)?.fields.get(SINE_DELAY_MS)?;
        Some(delay_ms / (1e3 * sample_period_s))
    };
    let of_weights = || {
        let latency = facts.latency_s / sample_period_s;
        Some(facts.mean_delay_at_dc_samples()? + latency)
    };
    let delay = of_motion.or_else(of_weights).or_else(of_sine);
    let delay = delay.ok_or("neither the motion nor its weights nor a slow sine tell its delay")?;
    let late = facts.shape.register_samples as f64 + facts.latency_s / sample_period_s;
    let delay = (delay - late + ahead).max(0.0);
    let words = 2.0 * delay + 1.0;
    let fields = [("delay_samples", delay), ("mean_of_words", words)];
    Ok((noise.estimate.scaled(words), fields))
}
