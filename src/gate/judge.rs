//! The rule: an interval against limits.

use crate::gate::number::limits_text;
use crate::gate::{Verdict, VerdictKind};
use crate::metrics::catalogue::DIVERGED_AT;
use crate::metrics::{
    ChannelFailure, ChannelMetrics, Estimate, IntervalKind, Metric, estimate_text, is_exact, plain,
};
use crate::scenario::{GateConfig, GateDecision, InconclusivePolicy};

/// Digits of the half width shown in reasons: one more than in tables, so that a near miss shows.
const REASON_DIGITS: i32 = 3;

/// Judges one gate.
///
/// Pass: the interval `[low, high]` lies inside `[min, max]`; fail: it is disjoint from it; else
/// inconclusive, which is accepted only if the gate says `inconclusive = "allow"`. With
/// `decide = "value"` the value alone is compared. With `relative_to` the metric is divided by the
/// same metric of that channel; the interval of the ratio holds the quotients of all ends. A metric
/// that is unknown, missing, unavailable or not finite, or that belongs to a failed channel, fails
/// with the reason.
#[must_use]
pub fn judge(
    gate: &GateConfig,
    channels: &[(String, ChannelMetrics)],
    location: Option<String>,
) -> Verdict {
    let mut verdict = Verdict {
        metric: gate.metric.clone(),
        kind: VerdictKind::Fail,
        accepted: false,
        value: None,
        low: None,
        high: None,
        min: gate.min,
        max: gate.max,
        unit: String::new(),
        relative_to: gate.relative_to.clone(),
        reason: String::new(),
        location,
    };
    match measured(gate, channels) {
        Err(reason) => verdict.reason = reason.to_string(),
        Ok((quotient, unit)) => decide(&mut verdict, gate, &quotient, unit),
    }
    verdict.accepted = match verdict.kind {
        VerdictKind::Pass => true,
        VerdictKind::Fail => false,
        VerdictKind::Inconclusive => gate.inconclusive == InconclusivePolicy::Allow,
    };
    verdict
}

/// Whether a gate on `<channel>.diverged_at_s` expects the channel to fail.
#[must_use]
pub fn expects_failure(verdicts: &[Verdict], channel: &str) -> bool {
    let metric = format!("{channel}.{}", DIVERGED_AT.name);
    verdicts.iter().any(|verdict| verdict.metric == metric)
}

/// What is judged: a value, and its interval unless that is unbounded.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Quotient {
    value: f64,
    interval: Option<(f64, f64)>,
    /// Why there is no interval.
    lack: &'static str,
    confidence: f64,
}

/// Why a quotient has no interval although both parts have one.
const DIVISOR_AT_ZERO: &str = "the interval of the divisor touches 0";

/// Why an estimate has no interval; none if it has one.
fn lack(estimate: &Estimate) -> Option<&'static str> {
    match estimate.interval {
        IntervalKind::Absent(reason) => Some(reason),
        _ => None,
    }
}

/// Why there is no number to judge.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
enum NoNumber {
    #[error("the gate has neither min nor max")]
    NoLimit,
    #[error("`{0}` is not of the form <channel>.<metric>")]
    Form(String),
    #[error("there is no channel `{0}`")]
    Channel(String),
    #[error("channel `{channel}` failed at sample {} ({}): {}", failure.sample, failure.kind, failure.message)]
    Failed {
        channel: String,
        failure: ChannelFailure,
    },
    #[error("channel `{0}` did not diverge")]
    NotDiverged(String),
    #[error("`{metric}` is unavailable: {reason}")]
    Unavailable { metric: String, reason: String },
    #[error("`{0}` was not measured in this run")]
    NotMeasured(String),
    #[error("`{0}` is 0, so that the ratio to it has no value")]
    ZeroDivisor(String),
    #[error("`{metric}` is not a finite value with a finite interval: {value}{interval}")]
    NotFinite {
        metric: String,
        value: f64,
        interval: String,
    },
}

/// The number a gate asks for, with its unit, or the reason why there is none.
fn measured<'a>(
    gate: &GateConfig,
    channels: &'a [(String, ChannelMetrics)],
) -> Result<(Quotient, &'a str), NoNumber> {
    if gate.min.is_none() && gate.max.is_none() {
        return Err(NoNumber::NoLimit);
    }
    let (channel, key) = gate
        .metric
        .rsplit_once('.')
        .ok_or_else(|| NoNumber::Form(gate.metric.clone()))?;
    let metric = lookup(channel, key, channels)?;
    let quotient = match &gate.relative_to {
        None => Quotient {
            value: metric.estimate.value,
            // Without an interval nothing but the value can be judged.
            interval: lack(&metric.estimate)
                .is_none()
                .then_some((metric.estimate.low, metric.estimate.high)),
            lack: lack(&metric.estimate).unwrap_or_default(),
            confidence: metric.estimate.confidence,
        },
        Some(other) => {
            let divisor = &lookup(other, key, channels)?.estimate;
            if divisor.value == 0.0 {
                return Err(NoNumber::ZeroDivisor(format!("{other}.{key}")));
            }
            ratio(&metric.estimate, divisor)
        }
    };
    let in_order = quotient
        .interval
        .is_none_or(|(low, high)| low.is_finite() && high.is_finite() && low <= high);
    if !quotient.value.is_finite() || !in_order {
        let interval = quotient.interval;
        return Err(NoNumber::NotFinite {
            metric: gate.metric.clone(),
            value: quotient.value,
            interval: interval
                .map_or_else(String::new, |(low, high)| format!(" in [{low}, {high}]")),
        });
    }
    let unit = if gate.relative_to.is_some() {
        "1"
    } else {
        metric.unit
    };
    Ok((quotient, unit))
}

/// The metric `key` of `channel`, or why there is none.
fn lookup<'a>(
    channel: &str,
    key: &str,
    channels: &'a [(String, ChannelMetrics)],
) -> Result<&'a Metric, NoNumber> {
    let (_, metrics) = channels
        .iter()
        .find(|(name, _)| name == channel)
        .ok_or_else(|| NoNumber::Channel(channel.to_owned()))?;
    if let Some(metric) = metrics.metrics.get(key) {
        return Ok(metric);
    }
    let channel = channel.to_owned();
    if let Some(failure) = &metrics.error {
        let failure = failure.clone();
        return Err(NoNumber::Failed { channel, failure });
    }
    if key == DIVERGED_AT.name {
        return Err(NoNumber::NotDiverged(channel));
    }
    let metric = format!("{channel}.{key}");
    Err(match metrics.unavailable.get(key) {
        Some(reason) => NoNumber::Unavailable {
            metric,
            reason: reason.to_string(),
        },
        None => NoNumber::NotMeasured(metric),
    })
}

/// Quotient of two estimates by interval arithmetic.
///
/// The interval is the hull of the four quotients of the ends: for positive values
/// `[a.low / b.high, a.high / b.low]`. It takes no advantage of noise that both channels share, so
/// it is wider than the true interval (at least 90 % coverage for two 95 % intervals by
/// Bonferroni's inequality, usually far more). It is unbounded where the divisor's interval
/// touches zero.
fn ratio(numerator: &Estimate, denominator: &Estimate) -> Quotient {
    let missing = lack(numerator).or_else(|| lack(denominator));
    let bounded = (denominator.low > 0.0 || denominator.high < 0.0) && missing.is_none();
    let interval = bounded.then(|| {
        let ends = [
            numerator.low / denominator.low,
            numerator.low / denominator.high,
            numerator.high / denominator.low,
            numerator.high / denominator.high,
        ];
        let low = ends.iter().copied().fold(f64::INFINITY, f64::min);
        let high = ends.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        (low, high)
    });
    Quotient {
        value: numerator.value / denominator.value,
        interval,
        lack: missing.unwrap_or(DIVISOR_AT_ZERO),
        confidence: numerator.confidence.min(denominator.confidence),
    }
}

/// Quotient of two estimates with the interval that a gate with `relative_to` judges: the hull of
/// the four quotients of the ends. `None` where it has no value or is unbounded.
#[must_use]
pub fn quotient(numerator: &Estimate, denominator: &Estimate) -> Option<Estimate> {
    let quotient = ratio(numerator, denominator);
    let (low, high) = quotient.interval?;
    let is_finite = quotient.value.is_finite() && low.is_finite() && high.is_finite();
    is_finite.then_some(Estimate {
        confidence: quotient.confidence,
        ..Estimate::with_interval(quotient.value, low, high)
    })
}

/// Compares and words the result.
fn decide(verdict: &mut Verdict, gate: &GateConfig, quotient: &Quotient, unit: &str) {
    let by_value = gate.decide == GateDecision::Value;
    let judged = if by_value {
        Some((quotient.value, quotient.value))
    } else {
        quotient.interval
    };
    let (min, max) = (
        gate.min.unwrap_or(f64::NEG_INFINITY),
        gate.max.unwrap_or(f64::INFINITY),
    );
    verdict.value = Some(quotient.value);
    (verdict.low, verdict.high) = quotient.interval.unzip();
    unit.clone_into(&mut verdict.unit);
    verdict.kind = match judged {
        Some((low, high)) if min <= low && high <= max => VerdictKind::Pass,
        Some((low, high)) if high < min || max < low => VerdictKind::Fail,
        _ => VerdictKind::Inconclusive,
    };
    verdict.reason = words(verdict, quotient, by_value);
}

/// `0.340 ±0.001 ms (95 % interval) lies inside [0.33, 0.35] ms`.
fn words(verdict: &Verdict, quotient: &Quotient, by_value: bool) -> String {
    let estimate = quotient.interval.map(|(low, high)| Estimate {
        confidence: quotient.confidence,
        ..Estimate::with_interval(quotient.value, low, high)
    });
    let number = match &estimate {
        Some(estimate) => estimate_text(estimate, REASON_DIGITS),
        None => plain(quotient.value),
    };
    let unit = match verdict.unit.as_str() {
        "" | "1" => String::new(),
        unit => format!(" {unit}"),
    };
    let what = match &verdict.relative_to {
        Some(other) => format!(" relative to {other}"),
        None => String::new(),
    };
    let basis = if by_value {
        "value alone".to_owned()
    } else if estimate.as_ref().is_some_and(is_exact) {
        "no interval".to_owned()
    } else {
        format!("{} % interval", plain(100.0 * quotient.confidence))
    };
    let relation = match verdict.kind {
        VerdictKind::Pass => "lies inside",
        VerdictKind::Fail => "lies outside",
        VerdictKind::Inconclusive => "straddles a limit of",
    };
    let limits = limits_text(verdict.min, verdict.max);
    if estimate.is_none() && !by_value {
        return format!(
            "{number}{unit}{what} has no interval to compare with {limits}{unit}: {}; decide = \"value\" \
             judges the value alone",
            quotient.lack
        );
    }
    format!("{number}{unit}{what} ({basis}) {relation} {limits}{unit}")
}
