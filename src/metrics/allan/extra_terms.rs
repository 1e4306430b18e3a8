//! Terms beyond the classical five, where a record asks for them: exponentially correlated noise, and a
//! sine.

use super::noise_fit::{NoiseFit, Sine};
use super::overlapping::AllanPoint;
use crate::metrics::estimate::fit_sheet::{FitSheet, FitTerm};
use crate::metrics::estimate::interval;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::{Applies, MetricKey, Needs};

/// Exponentially correlated noise.
pub static CORRELATED_NOISE: MetricKey = MetricKey::new(
    "correlated_noise_deg_per_h",
    "deg/h",
    Applies::Steady,
    "standard deviation of exponentially correlated (Gauss-Markov) noise, where the Allan variance asks for it",
)
.lower_is_better()
.synonyms(&["gauss_markov", "markov", "exponentially_correlated_noise"])
.heading("correlated noise")
.needs(Needs::AllanFit)
.by_choice()
.closing_tables();

/// Its correlation time.
pub static CORRELATION_TIME: MetricKey = MetricKey::new(
    "correlation_time_s",
    "s",
    Applies::Steady,
    "correlation time of that noise",
)
.synonyms(&["correlation_time", "markov_time"])
.heading("correlation time")
.needs(Needs::AllanFit)
.by_choice()
.closing_tables();

/// Amplitude of a sine in the words.
pub static SINE_AMPLITUDE: MetricKey = MetricKey::new(
    "sine_amplitude_deg_per_h",
    "deg/h",
    Applies::Steady,
    "amplitude of a sine in the words, found by a line test and taken out before the fit",
)
.lower_is_better()
.synonyms(&["sinusoidal_noise", "sine", "sine_amplitude"])
.heading("sine")
.needs(Needs::AllanFit)
.by_choice()
.closing_tables();

/// Period of the sine.
pub static SINE_PERIOD: MetricKey =
    MetricKey::new("sine_period_s", "s", Applies::Steady, "period of that sine")
        .synonyms(&["sine_period"])
        .heading("sine period")
        .needs(Needs::AllanFit)
        .by_choice()
        .closing_tables();

/// Why a record has none of them.
const NOT_ASKED_FOR: &str = "the record does not ask for it";

/// Field of the independent frequencies among which a sine was found.
const TRIED: &str = "frequencies_tried";

/// Enters the terms that a fit has beyond the five.
pub(crate) fn put_extra_terms(fit: &NoiseFit, metrics: &mut ChannelMetrics) {
    let is_adequate = fit.goodness.is_adequate();
    let correlated = fit.correlated.filter(|_| is_adequate);
    let mut put = |key: &MetricKey, estimate: Option<Estimate>| match estimate {
        Some(estimate) if estimate.high.is_finite() => {
            let metric = metrics.put(key, estimate);
            metric.fields.insert("tau_min_s", fit.tau_range_s[0]);
            metric.fields.insert("tau_max_s", fit.tau_range_s[1]);
        }
        _ => {
            metrics.metrics.remove(key.name);
            metrics.miss(key, NOT_ASKED_FOR);
        }
    };
    put(
        &CORRELATED_NOISE,
        correlated.map(|noise| noise.deviation_deg_per_h.estimate()),
    );
    put(
        &CORRELATION_TIME,
        correlated.map(|noise| noise.correlation_time_s),
    );
    // A line stands by itself, whatever the rest is.
    put(
        &SINE_AMPLITUDE,
        fit.sine.map(|sine| sine.amplitude_deg_per_h),
    );
    put(&SINE_PERIOD, fit.sine.map(|sine| sine.period_s));
    if let (Some(sine), Some(metric)) = (fit.sine, metrics.get_mut(&SINE_AMPLITUDE)) {
        let tried = sine.frequencies_tried as f64;
        metric.fields.insert(TRIED, tried);
    }
}

/// Enters them into the sheet of the fit, in which also an inadequate one is told.
pub(crate) fn add_to_sheet(fit: &NoiseFit, sheet: &mut FitSheet) {
    if let Some(noise) = fit.correlated {
        let term = FitTerm {
            square: noise.deviation_deg_per_h.square,
            standard_error: noise.deviation_deg_per_h.standard_error,
            unit: format!("({})^2", CORRELATED_NOISE.unit),
            is_in_model: true,
        };
        sheet.terms.insert(CORRELATED_NOISE.name.to_owned(), term);
        let time = noise.correlation_time_s.value;
        sheet.numbers.insert(CORRELATION_TIME.name.to_owned(), time);
    }
}

/// The sine that a channel was found to have.
pub(crate) fn found_sine(channel: &ChannelMetrics) -> Option<Sine> {
    let amplitude = channel.get(&SINE_AMPLITUDE)?;
    Some(Sine {
        amplitude_deg_per_h: amplitude.estimate,
        period_s: channel.get(&SINE_PERIOD)?.estimate,
        frequencies_tried: interval::round_to_count(*amplitude.fields.get(TRIED)?),
    })
}

/// The curve that is left of one without its sine.
pub(crate) fn without_sine(points: &[AllanPoint], sine: Option<Sine>) -> Vec<AllanPoint> {
    let rest = points.iter().map(|point| {
        let taken = sine.map_or(0.0, |sine| sine.allan_variance(point.tau_s));
        point.with_variance((point.variance() - taken).max(0.0))
    });
    rest.collect()
}

/// The sine of most of several records, with the mean of its squares as that of its amplitude; none
/// where less than half of them have it.
///
/// * `found`: those of the records that have one; `records`: how many there are.
pub(crate) fn pooled_sine(found: &[Sine], records: usize) -> Option<Sine> {
    if found.is_empty() || 2 * found.len() < records {
        return None;
    }
    let periods: Vec<f64> = found.iter().map(|it| it.period_s.value).collect();
    let squares: f64 = found
        .iter()
        .map(|it| it.amplitude_deg_per_h.value.powi(2))
        .sum();
    let amplitude = (squares / records as f64).sqrt();
    let half = |it: &Estimate| (it.high - it.low) / 2.0;
    let pooled_half = |pick: fn(&Sine) -> &Estimate| {
        let sum: f64 = found.iter().map(|it| half(pick(it)).powi(2)).sum();
        sum.sqrt() / found.len() as f64
    };
    Some(Sine {
        amplitude_deg_per_h: Estimate::symmetric(
            amplitude,
            pooled_half(|it| &it.amplitude_deg_per_h),
        ),
        period_s: Estimate::symmetric(interval::mean(&periods), pooled_half(|it| &it.period_s)),
        frequencies_tried: found[0].frequencies_tried,
    })
}
