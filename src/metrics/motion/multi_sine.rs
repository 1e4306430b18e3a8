//! Metrics of a record of several sines at once.

use super::mean::{MEAN_RATIO, put_mean, ratio_of_means_lack};
use super::steady::LAGS_MIN;
use super::swing::{AMPLITUDE_RATIO, DELAY_VS_RAW, DELAY_VS_TRUTH};
use super::tracking::TRACKING_ERROR_RMS;
use crate::metrics::estimate::blocks::{RATIO_BLOCKS, equal_block_means};
use crate::metrics::estimate::interval;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::curve::CurveKey;
use crate::metrics::key::metric::{Applies, Headline, MetricKey, Needs, Table};
use crate::metrics::noise::autocovariance::LaggedProducts;
use crate::metrics::noise::by_weights::NoiseByWeights;
use crate::metrics::noise::level::{put_noise_gain, put_noise_std};
use crate::metrics::noise::truth_response::{Shown, shown};
use crate::metrics::record::{FilterFacts, Record};
use crate::metrics::sine::tones::{
    RESPONSE_COLUMNS, ToneClock, ToneFits, ToneResponse, fit_tones, put_responses,
};

/// Frequency response to the true rate.
pub static FREQUENCY_RESPONSE: CurveKey = CurveKey::new(
    "frequency_response",
    RESPONSE_COLUMNS,
    "response of the channel to the true rate at every tone",
)
.picture("bode.svg");

/// Frequency response of a filter to raw.
pub static FREQUENCY_RESPONSE_VS_RAW: CurveKey = CurveKey::new(
    "frequency_response_vs_raw",
    RESPONSE_COLUMNS,
    "response of a filter to raw at every tone, while it adapts",
)
.picture("filter-response.svg");

/// Bandwidth.
pub static BANDWIDTH: MetricKey = MetricKey::new(
    "bandwidth_hz",
    "Hz",
    Applies::MultiSine,
    "where the gain against the true rate first falls through 1/sqrt(2) of that of the lowest sine",
)
.higher_is_better()
.heading("bandwidth")
.needs(Needs::TwoSines)
.of_turned_axis()
.tables(&[Table::MultiSine])
.headlines(&[Headline::MultiSine]);

/// Order of the series in the joint fit.
const CHANNEL: usize = 0;
const TRUTH: usize = 1;
const RAW: usize = 2;

/// What channel and raw show of the true rate, and the place of the first in the joint fit.
struct Motion {
    channel: Option<Shown>,
    raw: Option<Shown>,
    first: usize,
}

impl Motion {
    fn series(&self) -> impl Iterator<Item = &[f64]> {
        let shown = self.channel.iter().chain(&self.raw);
        shown.map(|shown| shown.series.as_slice())
    }
}

/// Measures everything a record of several sines supports.
///
/// # Errors
/// The reason, in words, if the record does not determine the sines.
pub(crate) fn measure_multi_sine(
    record: &Record,
    frequencies_hz: &[f64],
    filter: Option<&FilterFacts>,
    metrics: &mut ChannelMetrics,
) -> Result<(), Unavailable> {
    let clock = ToneClock {
        frequencies_hz,
        sample_period_s: record.sample_period_s,
        first_stamp_s: record.first_stamp_s,
    };
    let truth = record.truth_deg_per_h.words();
    let mut series = vec![record.channel_deg_per_h, &truth];
    if filter.is_some() {
        series.push(record.raw_deg_per_h);
    }
    let motion = Motion {
        channel: shown(record, filter),
        raw: filter.and_then(|_| shown(record, None)),
        first: series.len(),
    };
    series.extend(motion.series());
    let fits = fit_tones(&series, &clock)?;
    let duration_s = record.channel_deg_per_h.len() as f64 * record.sample_period_s;
    let truth_offset = fits.offset(TRUTH).value;
    put_mean(
        fits.offset(CHANNEL),
        Some(truth_offset),
        duration_s,
        metrics,
    );
    let latency_s = filter.map_or(0.0, |facts| facts.latency_s);
    let behind_truth = later(fits.response(CHANNEL, TRUTH), latency_s);
    let period_s = record.sample_period_s;
    put_lowest(&DELAY_VS_TRUTH, &behind_truth, period_s, metrics);
    let reference = if filter.is_some() {
        let behind_raw = later(fits.response(CHANNEL, RAW), latency_s);
        put_lowest(&DELAY_VS_RAW, &behind_raw, period_s, metrics);
        put_responses(&FREQUENCY_RESPONSE_VS_RAW, &behind_raw, metrics);
        behind_raw
    } else {
        behind_truth.clone()
    };
    put_responses(&FREQUENCY_RESPONSE, &behind_truth, metrics);
    if let Some(lowest) = reference.first() {
        let metric = metrics.put(&AMPLITUDE_RATIO, lowest.gain);
        metric.fields.insert("frequency_hz", lowest.frequency_hz);
    }
    match fits.bandwidth_hz(CHANNEL, TRUTH) {
        Ok(bandwidth) => {
            metrics.put(&BANDWIDTH, bandwidth);
        }
        Err(reason) => metrics.miss(&BANDWIDTH, reason),
    }
    measure_tracking(record, metrics);
    measure_noise(record, &fits, &motion, filter, metrics);
    Ok(())
}

/// Responses with a pipeline's latency, which is part of its delays.
fn later(responses: Vec<ToneResponse>, latency_s: f64) -> Vec<ToneResponse> {
    responses
        .into_iter()
        .map(|response| ToneResponse {
            phase_rad: response
                .phase_rad
                .shifted(-std::f64::consts::TAU * response.frequency_hz * latency_s),
            delay_s: response.delay_s.shifted(latency_s),
            ..response
        })
        .collect()
}

/// Enters the delay at the lowest tone.
fn put_lowest(
    key: &MetricKey,
    responses: &[ToneResponse],
    sample_period_s: f64,
    metrics: &mut ChannelMetrics,
) {
    if let Some(lowest) = responses.first() {
        let metric = metrics.put_delay(key, lowest.delay_s, sample_period_s);
        metric.fields.insert("frequency_hz", lowest.frequency_hz);
    }
}

/// Root mean square difference from the truth, with Student's t on the blocks' squares.
fn measure_tracking(record: &Record, metrics: &mut ChannelMetrics) {
    let squares: Vec<f64> = record
        .channel_deg_per_h
        .iter()
        .zip(record.truth_deg_per_h.iter())
        .map(|(rate, truth)| (rate - truth) * (rate - truth))
        .collect();
    let parts = equal_block_means(&squares, RATIO_BLOCKS);
    let square = interval::from_parts(interval::mean(&squares), &parts);
    let estimate = Estimate::with_interval(
        square.value.sqrt(),
        square.low.max(0.0).sqrt(),
        square.high.sqrt(),
    );
    metrics.put(&TRACKING_ERROR_RMS, estimate);
}

/// Noise about the tones; against raw's for a filter.
fn measure_noise(
    record: &Record,
    fits: &ToneFits,
    motion: &Motion,
    filter: Option<&FilterFacts>,
    metrics: &mut ChannelMetrics,
) {
    let tones = fits.response(CHANNEL, TRUTH).len();
    let products = |series: usize, values: &[f64], shown: Option<&Shown>, place: usize| {
        let mut residuals = fits.residuals(series, values);
        if let Some(shown) = shown {
            shown.remove_from(&mut residuals, &fits.residuals(place, &shown.series));
        }
        let blocks = filter.map_or(RATIO_BLOCKS, FilterFacts::blocks);
        LaggedProducts::new(&residuals, 0.0, LAGS_MIN, blocks)
    };
    let own = motion.channel.as_ref();
    let channel = products(CHANNEL, record.channel_deg_per_h, own, motion.first);
    let of_raw = motion.raw.as_ref();
    let raw = filter.map(|_| products(RAW, record.raw_deg_per_h, of_raw, motion.first + 1));
    let samples = record.channel_deg_per_h.len();
    let by_weights = match (filter, &raw) {
        (Some(facts), Some(raw)) => NoiseByWeights::new(facts, raw, samples, 0.0),
        _ => NoiseByWeights::none(),
    };
    put_noise_std(
        &channel,
        &by_weights,
        (samples, 2 * tones + 1),
        record.sample_period_s,
        metrics,
    );
    if let Some(raw) = raw {
        let words = record.raw_deg_per_h.iter();
        let level = words.fold(0.0_f64, |max, rate| max.max(rate.abs()));
        put_noise_gain(&channel, &raw, &by_weights, level, metrics);
        let offset = fits.offset(RAW);
        if let Some(reason) = ratio_of_means_lack(&offset) {
            metrics.miss(&MEAN_RATIO, reason);
        } else {
            metrics.put(&MEAN_RATIO, fits.offset_ratio(CHANNEL, RAW));
        }
    }
}
