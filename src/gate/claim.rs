//! Published figures as claims: whether what is simulated is consistent with them.

use super::judge::quotient;
use crate::metrics::catalogue::{LOOK_AHEAD, MEMORY_1_PERCENT};
use crate::metrics::{
    AgainstOne, Better, ChannelMetrics, Estimate, Metric, estimate_text, filter_verdict, find,
    plain,
};
use crate::scenario::PublishedConfig;

/// Digits of an interval's half width.
const DIGITS: i32 = 2;

/// What becomes of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClaimKind {
    /// Interval and rounding overlap.
    Consistent,
    /// What is simulated is worse, or other where neither is better.
    NotReached,
    /// What is simulated is better than what was published.
    Exceeded,
    /// The run does not give the figure.
    NotTestable,
}

impl ClaimKind {
    /// The words in results.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Consistent => "consistent with",
            Self::NotReached => "not reached",
            Self::Exceeded => "exceeded",
            Self::NotTestable => "not testable",
        }
    }
}

/// The verdict on a claim.
#[derive(Clone, Debug, PartialEq)]
pub struct ClaimVerdict {
    /// What becomes of it.
    pub kind: ClaimKind,
    /// What decided, in words.
    pub reason: String,
}

/// What is simulated of a published figure, a ratio where it is relative to another channel.
#[must_use]
pub fn simulated(
    figure: &PublishedConfig,
    channels: &[(String, ChannelMetrics)],
) -> Option<Metric> {
    let (channel, key) = figure.metric.rsplit_once('.')?;
    let of = |name: &str| {
        let (_, metrics) = channels.iter().find(|(known, _)| known == name)?;
        metrics.metrics.get(key)
    };
    let own = of(channel)?;
    let Some(reference) = &figure.relative_to else {
        return Some(own.clone());
    };
    let ratio = quotient(&own.estimate, &of(reference)?.estimate)?;
    Some(Metric::new(ratio, "1"))
}

/// Judges a published figure whose rounding is given; none of the others.
#[must_use]
pub fn judge_claim(
    figure: &PublishedConfig,
    channels: &[(String, ChannelMetrics)],
) -> Option<ClaimVerdict> {
    let rounding = figure.rounding?;
    let published = format!("{} ±{}", plain(figure.value), plain(rounding));
    let (channel, key) = figure.metric.rsplit_once('.')?;
    let metrics = channels.iter().find(|(name, _)| name == channel);
    let Some(found) = simulated(figure, channels) else {
        let why = metrics.and_then(|(_, metrics)| {
            let failed = metrics.error.as_ref().map(|error| error.message.clone());
            let failed = failed.or_else(|| metrics.unavailable.get(key).map(ToString::to_string));
            failed.or_else(|| near_zero(figure, key, channels))
        });
        let why = why.unwrap_or_else(|| "the run does not give it".to_owned());
        return Some(ClaimVerdict {
            kind: ClaimKind::NotTestable,
            reason: format!("{why}; published {published}"),
        });
    };
    let estimate = found.estimate;
    let kind = kind(figure, key, rounding, &estimate);
    let found = estimate_text(&estimate, DIGITS);
    let conditions = metrics.map_or_else(String::new, |(_, metrics)| conditions(metrics));
    Some(ClaimVerdict {
        kind,
        reason: format!("{found} found, {published} published{conditions}"),
    })
}

/// That a ratio has no value as what divides it is not told apart from zero.
fn near_zero(
    figure: &PublishedConfig,
    key: &str,
    channels: &[(String, ChannelMetrics)],
) -> Option<String> {
    let reference = figure.relative_to.as_ref()?;
    let (_, metrics) = channels.iter().find(|(name, _)| name == reference)?;
    let estimate = metrics.metrics.get(key)?.estimate;
    let text = estimate_text(&estimate, DIGITS);
    Some(format!("{text} of {reference} is not told apart from 0"))
}

fn kind(figure: &PublishedConfig, key: &str, rounding: f64, found: &Estimate) -> ClaimKind {
    let (low, high) = (figure.value - rounding, figure.value + rounding);
    if found.low <= high && low <= found.high {
        return ClaimKind::Consistent;
    }
    match find(key).map_or(Better::Neither, |known| known.better) {
        Better::Lower if found.high < low => ClaimKind::Exceeded,
        Better::Higher if found.low > high => ClaimKind::Exceeded,
        _ => ClaimKind::NotReached,
    }
}

/// DC gain, look-ahead and memory, under which a figure counts.
fn conditions(metrics: &ChannelMetrics) -> String {
    let mut said = String::new();
    let gain = filter_verdict(metrics).and_then(|verdict| verdict.dc_gain);
    if let Some(gain) = gain {
        let text = estimate_text(&gain.estimate, DIGITS);
        let attenuates = match gain.against_one {
            AgainstOne::Below => ", which attenuates the signal too",
            _ => "",
        };
        said.push_str(&format!("; at a DC gain of {text}{attenuates}"));
    }
    if let Some(ahead) = metrics.get(&LOOK_AHEAD)
        && ahead.estimate.value > 0.0
    {
        let samples = plain(ahead.estimate.value);
        said.push_str(&format!("; it looks {samples} samples ahead"));
    }
    if let Some(memory) = metrics.get(&MEMORY_1_PERCENT) {
        let time_s = estimate_text(&memory.estimate, DIGITS);
        said.push_str(&format!("; it remembers a word for {time_s} s"));
    }
    said
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(value: f64, rounding: Option<f64>) -> PublishedConfig {
        PublishedConfig {
            metric: "f.angle_random_walk_deg_per_sqrt_h".to_owned(),
            value,
            unit: "1".to_owned(),
            source: "a paper".to_owned(),
            relative_to: Some("raw".to_owned()),
            rounding,
        }
    }

    fn channels() -> Vec<(String, ChannelMetrics)> {
        let with = |low: f64, high: f64| {
            let mut metrics = ChannelMetrics::default();
            let estimate = Estimate::with_interval(0.5 * (low + high), low, high);
            let metric = Metric::new(estimate, "deg/sqrt(h)");
            let name = "angle_random_walk_deg_per_sqrt_h".to_owned();
            metrics.metrics.insert(name, metric);
            metrics
        };
        vec![
            ("raw".to_owned(), with(0.0099, 0.0101)),
            ("f".to_owned(), with(0.0049, 0.0051)),
        ]
    }

    #[test]
    fn intervals_and_rounding_that_overlap_are_consistent() {
        let kind = |value: f64| {
            judge_claim(&figure(value, Some(0.005)), &channels())
                .unwrap()
                .kind
        };
        assert_eq!(kind(0.49), ClaimKind::Consistent);
        assert_eq!(kind(0.3), ClaimKind::NotReached);
        assert_eq!(kind(0.9), ClaimKind::Exceeded);
        assert_eq!(judge_claim(&figure(0.48, None), &channels()), None);
    }

    #[test]
    fn a_ratio_over_what_may_be_zero_is_not_testable_and_says_so() {
        let mut channels = channels();
        let raw = channels[0].1.metrics.values_mut().next().unwrap();
        raw.estimate = Estimate::symmetric(0.10, 0.13);
        let verdict = judge_claim(&figure(0.48, Some(0.005)), &channels).unwrap();
        assert_eq!(verdict.kind, ClaimKind::NotTestable);
        let said = "0.10 \u{b1}0.13 of raw is not told apart from 0";
        assert!(verdict.reason.contains(said), "{verdict:?}");
    }

    #[test]
    fn what_a_run_does_not_give_is_not_testable() {
        let alone = vec![("raw".to_owned(), ChannelMetrics::default())];
        let verdict = judge_claim(&figure(0.48, Some(0.005)), &alone).unwrap();
        assert_eq!(verdict.kind, ClaimKind::NotTestable);
        assert!(verdict.reason.contains("does not give it"), "{verdict:?}");
    }
}
