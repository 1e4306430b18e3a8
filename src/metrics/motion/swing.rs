//! Metrics of a swing record.

use std::f64::consts::TAU;

use super::mean::{
    MEAN_RATIO, filter_reach, mean_spread_of, paired_scatter, put_mean, ratio_of_means_lack,
};
use super::steady::LAGS_MIN;
use super::swing_response::{Against, Fits, Response};
use super::tracking::{TRACKING_ERROR_RMS, root};
use crate::metrics::estimate::influence::{Learned, Spread};
use crate::metrics::estimate::interval;
use crate::metrics::estimate::paired::mean_spread;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::{Estimate, Metric};
use crate::metrics::key::metric::{Against as Compared, Applies, Headline, MetricKey, Table};
use crate::metrics::noise::autocovariance::LaggedProducts;
use crate::metrics::noise::by_weights::NoiseByWeights;
use crate::metrics::noise::level::{put_noise_gain, put_noise_std};
use crate::metrics::noise::truth_response::shown;
use crate::metrics::pipeline::LATENCY;
use crate::metrics::record::{FilterFacts, Record, WeightScatter};
use crate::metrics::sine::correlation::correlation_delay_s;
use crate::metrics::sine::fit::{SwingClock, SwingFit, fit_swing};
use crate::metrics::theory::bound::{LeastNoise, filter_bound_at, noise_power_gain};
use crate::metrics::theory::learning::{Learning, NOT_FROM_ONE_RECORD};
use crate::metrics::theory::prediction::{lags_needed, predict, prediction_lack};
use crate::metrics::trial::noise_delay::OverBound;
use crate::metrics::trial::predicted::DC_GAIN_PREDICTED;
use crate::metrics::trial::readaptation;
use crate::metrics::trial::readaptation::{GainUnits, adapts};
use crate::units;

/// Delay vs raw.
pub static DELAY_VS_RAW: MetricKey = MetricKey::of_filters(
    "delay_vs_raw_ms",
    "ms",
    Applies::Tones,
    "phase delay behind the raw channel at the swing frequency; of several sines the lowest",
)
.lower_is_better()
.synonyms(&["delay"])
.heading("delay vs raw")
.run_column(9)
.tables(&[Table::Swing, Table::MultiSine])
.headlines(&[Headline::Swing]);

/// Predicted delay.
pub static DELAY_PREDICTED: MetricKey = MetricKey::of_filters(
    "delay_predicted_ms",
    "ms",
    Applies::Swing,
    "phase delay of the Wiener weights behind raw at the swing frequency, register included",
)
.heading("predicted")
.tables(&[Table::Swing]);

/// Delay vs truth.
pub static DELAY_VS_TRUTH: MetricKey = MetricKey::new(
    "delay_vs_truth_ms",
    "ms",
    Applies::Tones,
    "phase delay behind the true rate at the swing frequency; of several sines the lowest",
)
.lower_is_better()
.heading("delay vs truth")
.against(Compared::Truth)
.of_turned_axis()
.tables(&[Table::Swing, Table::MultiSine])
.headlines(&[Headline::MultiSine]);

/// Delay vs encoder.
pub static DELAY_VS_ENCODER: MetricKey = MetricKey::new(
    "delay_vs_encoder_ms",
    "ms",
    Applies::Swing,
    "phase delay behind the rate implied by a sine fit of the encoder's angle",
)
.lower_is_better()
.heading("delay vs encoder")
.against(Compared::Encoder)
.of_turned_axis()
.by_choice()
.tables(&[Table::Swing]);

/// Delay by correlation.
pub static DELAY_BY_CORRELATION: MetricKey = MetricKey::new(
    "delay_by_correlation_ms",
    "ms",
    Applies::Swing,
    "delay behind the true rate again, by the peak of their correlation: a check of the sine fit",
)
.lower_is_better()
.against(Compared::Truth)
.of_turned_axis();

/// Amplitude ratio.
pub static AMPLITUDE_RATIO: MetricKey = MetricKey::new(
    "amplitude_ratio",
    "1",
    Applies::Tones,
    "fitted amplitude over raw's, for raw itself over the true rate's; of several sines the lowest",
)
.heading("amplitude ratio")
.against(Compared::TruthForRaw)
.run_column(10)
.tables(&[Table::Swing, Table::MultiSine])
.headlines(&[Headline::Swing]);

/// Harmonic distortion.
pub static HARMONIC_DISTORTION: MetricKey = MetricKey::new(
    "harmonic_distortion_percent",
    "%",
    Applies::Swing,
    "root sum of squares of harmonics 2 to 5 over the fundamental, noise power subtracted",
)
.lower_is_better()
.synonyms(&["thd", "distortion"])
.heading("harmonic distortion")
.tables(&[Table::Swing]);

/// Measures everything a swing record supports.
///
/// With `is_from_rest` the swing begins with the record, and filters must adapt to it.
///
/// # Errors
/// The reason, in words, if the record holds no three whole cycles.
pub(crate) fn measure_swing(
    record: &Record,
    frequency_hz: f64,
    is_from_rest: bool,
    filter: Option<&FilterFacts>,
    metrics: &mut ChannelMetrics,
) -> Result<(), Unavailable> {
    let clock = SwingClock {
        frequency_hz,
        sample_period_s: record.sample_period_s,
        first_stamp_s: record.first_stamp_s,
    };
    let fits = Fits {
        channel: fit_swing(record.channel_deg_per_h, &clock)?,
        raw: fit_swing(record.raw_deg_per_h, &clock)?,
        truth: match record.truth() {
            Some(truth) => Some(fit_swing(&truth.words(), &clock)?),
            None => None,
        },
        encoder: match record.encoder_rad {
            Some(angles) => Some(fit_swing(angles, &clock)?.derivative()),
            None => None,
        },
    };
    let duration_s = fits.channel.samples() as f64 * record.sample_period_s;
    let residuals = fits.channel.residuals(record.channel_deg_per_h);
    let offset = fits.channel.whole.offset;
    let mean = match mean_spread_of(record, &residuals, filter, false) {
        Ok(spread) => spread.about(offset),
        Err(reason) => Estimate::without_interval(offset, reason),
    };
    put_mean(
        mean,
        fits.truth.as_ref().map(|truth| truth.whole.offset),
        duration_s,
        metrics,
    );
    let response = Response::new(record, &fits, &clock, filter);
    measure_sines(&fits, &response, &clock, filter, metrics);
    if let Some(truth) = record.truth() {
        let truth = &truth.words();
        measure_correlation(truth, record, &response, filter, metrics);
        let by_weights = response.tracking_by_weights(&fits, filter);
        measure_tracking(truth, record, &fits, by_weights, metrics);
    }
    metrics.put(
        &HARMONIC_DISTORTION,
        fits.channel.harmonic_distortion_percent(&residuals),
    );
    let (channel, raw, by_weights) = noise_about_sine(record, &fits, &clock, filter);
    let words = record.channel_deg_per_h[..fits.channel.samples()].iter();
    let count = words.filter(|word| !word.is_nan()).count();
    put_noise_std(
        &channel,
        &by_weights,
        (count, 3),
        record.sample_period_s,
        metrics,
    );
    if let (Some(facts), Some(raw)) = (filter, raw) {
        let level = fits.raw.whole.amplitude + fits.raw.whole.offset.abs();
        put_noise_gain(&channel, &raw, &by_weights, level, metrics);
        measure_mean_ratio(record, &fits, &clock, facts, metrics);
        measure_predictions(&fits, &clock, facts, &raw, metrics);
        measure_bound(&fits, &response, facts, (&channel, &raw), metrics);
        let predicted = metrics.get(&DELAY_PREDICTED);
        let final_gain = predicted.and_then(|metric| metric.fields.get(AMPLITUDE_RATIO.name));
        if let Some(&final_gain) = final_gain.filter(|_| is_from_rest && adapts(&facts.shape)) {
            let (own, other) = (record.channel_deg_per_h, record.raw_deg_per_h);
            let units = GainUnits::of_swing(own, other, &clock);
            readaptation::put(&units, final_gain, metrics);
        }
    }
    Ok(())
}

/// Noise of the channel and of raw about their sines, and how the weights of the filter scatter.
fn noise_about_sine(
    record: &Record,
    fits: &Fits,
    clock: &SwingClock,
    filter: Option<&FilterFacts>,
) -> (LaggedProducts, Option<LaggedProducts>, NoiseByWeights) {
    let lags = LAGS_MIN.max(filter.map_or(0, |facts| lags_needed(&facts.shape)));
    let blocks = filter
        .and_then(|facts| facts.learning.as_ref())
        .map_or(fits.channel.block_count(), Learning::stretches);
    // The table's own harmonics are known, and no noise.
    let noise = |mut residuals: Vec<f64>, of: Option<&FilterFacts>| {
        if let Some(shown) = shown(record, of)
            && let Ok(fit) = fit_swing(&shown.series, clock)
        {
            shown.remove_from(&mut residuals, &fit.residuals(&shown.series));
        }
        LaggedProducts::new(&residuals, 0.0, lags, blocks)
    };
    let channel = noise(fits.channel.residuals(record.channel_deg_per_h), filter);
    let raw = filter.map(|_| noise(fits.raw.residuals(record.raw_deg_per_h), None));
    let by_weights = match (filter, &raw) {
        (Some(facts), Some(raw)) => {
            NoiseByWeights::new(facts, raw, record.raw_deg_per_h.len(), 0.0)
        }
        _ => NoiseByWeights::none(),
    };
    (channel, raw, by_weights)
}

/// Delays and amplitude ratio. A pipeline's latency is part of its delays.
fn measure_sines(
    fits: &Fits,
    response: &Response,
    clock: &SwingClock,
    filter: Option<&FilterFacts>,
    metrics: &mut ChannelMetrics,
) {
    let latency_s = filter.map_or(0.0, |facts| facts.latency_s);
    let describe = |metric: &mut Metric| {
        metric.fields.insert("frequency_hz", clock.frequency_hz);
        metric.fields.insert("cycles", fits.channel.cycles as f64);
        // The start-up before the record, and the part of a cycle at its end.
        let start_s = (clock.first_stamp_s - clock.sample_period_s).max(0.0);
        metric.fields.insert("excluded_s", start_s);
    };
    let mut put_delay = |key: &MetricKey, reference: &SwingFit, against: Against| {
        let delay_s = fits.channel.delay_behind_s(reference);
        let delay_s = response.delay(delay_s, against).shifted(latency_s);
        let metric = metrics.put_delay(key, delay_s, clock.sample_period_s);
        describe(metric);
        if latency_s > 0.0 {
            let latency_us = units::s_to_us(latency_s);
            metric.fields.insert(LATENCY.name, latency_us);
        }
    };
    if let Some(truth) = &fits.truth {
        put_delay(&DELAY_VS_TRUTH, truth, Against::Truth);
    }
    if let Some(encoder) = &fits.encoder {
        put_delay(&DELAY_VS_ENCODER, encoder, Against::Truth);
    }
    if filter.is_some() {
        put_delay(&DELAY_VS_RAW, &fits.raw, Against::Raw);
    }
    let reference = filter.map_or(fits.truth.as_ref(), |_| Some(&fits.raw));
    if let Some(reference) = reference {
        let ratio = fits.channel.amplitude_over(reference);
        describe(metrics.put(&AMPLITUDE_RATIO, response.amplitude(ratio)));
    }
}

/// The delay behind the truth that [`measure_sines`] finds, by another estimator.
///
/// Not behind raw: raw's noise is in the filter's output too and correlates with it at small lags.
/// Near the peak a swing's own correlation is so flat that this would move it by some 50 us.
fn measure_correlation(
    truth_deg_per_h: &[f64],
    record: &Record,
    response: &Response,
    filter: Option<&FilterFacts>,
    metrics: &mut ChannelMetrics,
) {
    let latency_s = filter.map_or(0.0, |facts| facts.latency_s);
    let clock = response.clock;
    match correlation_delay_s(truth_deg_per_h, record.channel_deg_per_h, &clock) {
        Ok(delay_s) => {
            // What weights on their way add to the channel's noise is in what they have learned.
            let by_raw = response
                .is_learned()
                .then(|| correlation_delay_s(truth_deg_per_h, record.raw_deg_per_h, &clock).ok())
                .flatten();
            let delay_s = by_raw.map_or(delay_s, |raw| Spread::of(&raw).about(delay_s.value));
            let delay_ms = response.with_weights(delay_s);
            let delay_ms = delay_ms.shifted(latency_s).scaled(units::s_to_ms(1.0));
            let metric = metrics.put(&DELAY_BY_CORRELATION, delay_ms);
            metric.fields.insert("frequency_hz", clock.frequency_hz);
        }
        Err(reason) => metrics.miss(&DELAY_BY_CORRELATION, reason),
    }
}

/// Root mean square difference from the truth, by the squares of blocks of whole cycles.
///
/// Weights that forget nothing are still on their way in the record, which many blocks show less of,
/// and scatter from seed to seed, by which response and noise differ.
fn measure_tracking(
    truth_deg_per_h: &[f64],
    record: &Record,
    fits: &Fits,
    by_weights: Option<Learned>,
    metrics: &mut ChannelMetrics,
) {
    let errors: Vec<f64> = record.channel_deg_per_h[..fits.channel.samples()]
        .iter()
        .zip(truth_deg_per_h)
        .map(|(rate, truth)| rate - truth)
        .collect();
    let blocks = by_weights
        .as_ref()
        .map_or(fits.channel.block_count(), |_| TRACKING_BLOCKS);
    let mean_squares = fits.channel.block_mean_squares(&errors, blocks);
    let square = interval::mean(&mean_squares);
    let count = mean_squares.len() as f64;
    let spread = Spread {
        variance: interval::sample_variance(&mean_squares) / count,
        freedom: count - 1.0,
    };
    let spread = by_weights.map_or(spread, |learned| spread.plus(learned.spread()));
    metrics.put(&TRACKING_ERROR_RMS, root(square, spread));
}

/// Blocks of the squared differences from the truth of a filter that forgets nothing.
const TRACKING_BLOCKS: usize = 150;

/// Ratio of the offsets, if raw's offset can be told from zero.
fn measure_mean_ratio(
    record: &Record,
    fits: &Fits,
    clock: &SwingClock,
    facts: &FilterFacts,
    metrics: &mut ChannelMetrics,
) {
    let raw = fits.raw.residuals(record.raw_deg_per_h);
    let offset = fits.raw.whole.offset;
    let fast = mean_spread(&raw, filter_reach(None));
    let raw_mean = fast
        .plus(Spread::known(record.drift_variance()))
        .about(offset);
    if let Some(reason) = ratio_of_means_lack(&raw_mean) {
        return metrics.miss(&MEAN_RATIO, reason);
    }
    let ratio = fits.channel.whole.offset / offset;
    let own = fits.channel.residuals(record.channel_deg_per_h);
    let cycle = 1.0 / (clock.frequency_hz * clock.sample_period_s);
    let scatter = paired_scatter((&own, &raw), ratio, facts, Some(cycle));
    let samples = own.len();
    // The offset is a constant rate beside the swing: the mean weights make it what it is.
    let weights = facts.weight_scatter(record.raw_deg_per_h.len(), 0.0);
    let learned = weights.of(facts.mean_weights.as_deref(), |weights| {
        weights.iter().sum()
    });
    let estimate = match (weights, learned) {
        (WeightScatter::Blocks, _) => scatter.over(samples).scaled(1.0 / offset).about(ratio),
        (WeightScatter::Runs { .. }, Some(learned)) => {
            let blocks = scatter.over(samples).scaled(1.0 / offset);
            learned.spread().plus(blocks).about(ratio)
        }
        (WeightScatter::Learned(_), Some(learned)) => {
            let ends = scatter.ends_over(samples).scaled(1.0 / offset);
            learned.spread().plus(ends).about(ratio)
        }
        _ => Estimate::without_interval(ratio, NOT_FROM_ONE_RECORD),
    };
    metrics.put(&MEAN_RATIO, estimate);
}

/// Wiener prediction for the fitted sine plus the measured noise: delay behind raw and DC gain.
///
/// Second moment by lag: `A^2/2 cos(w l T) + c^2 + R(l)`, A and c from the sine fit of raw, R the
/// autocovariance of its residuals; the intervals are jackknifed over sub-blocks of R.
fn measure_predictions(
    fits: &Fits,
    clock: &SwingClock,
    facts: &FilterFacts,
    raw: &LaggedProducts,
    metrics: &mut ChannelMetrics,
) {
    let turns_per_sample = clock.frequency_hz * clock.sample_period_s;
    let sine = &fits.raw.whole;
    let under = |autocovariance: &[f64]| {
        let second_moment: Vec<f64> = autocovariance
            .iter()
            .enumerate()
            .map(|(lag, noise)| {
                let swing = sine.amplitude * sine.amplitude / 2.0
                    * (TAU * turns_per_sample * lag as f64).cos();
                swing + sine.offset * sine.offset + noise
            })
            .collect();
        let prediction = predict(&facts.shape, &second_moment)?;
        let delay_s =
            prediction.delay_s(clock.frequency_hz, clock.sample_period_s) + facts.latency_s;
        let amplitude = prediction.amplitude(clock.frequency_hz, clock.sample_period_s);
        Some((units::s_to_ms(delay_s), prediction.dc_gain(), amplitude))
    };
    let Some((delay_ms, dc_gain, amplitude)) = under(&raw.autocovariance()) else {
        metrics.miss(&DELAY_PREDICTED, prediction_lack(&facts.shape));
        metrics.miss(&DC_GAIN_PREDICTED, prediction_lack(&facts.shape));
        return;
    };
    let parts: Vec<_> = (0..raw.blocks())
        .filter_map(|block| under(&raw.autocovariance_without(block)))
        .collect();
    let delays: Vec<f64> = parts.iter().map(|part| part.0).collect();
    let gains: Vec<f64> = parts.iter().map(|part| part.1).collect();
    let metric = metrics.put(&DELAY_PREDICTED, interval::jackknife(delay_ms, &delays));
    metric.fields.insert("frequency_hz", clock.frequency_hz);
    metric.fields.insert(AMPLITUDE_RATIO.name, amplitude);
    metrics.put(&DC_GAIN_PREDICTED, interval::jackknife(dc_gain, &gains));
}

/// Noise-delay bound at the measured delay behind raw, for the measured colour of raw's noise.
///
/// A pipeline's latency makes the samples as much older as it delays the output, so the bound takes
/// neither into account.
fn measure_bound(
    fits: &Fits,
    response: &Response,
    facts: &FilterFacts,
    (channel, raw): (&LaggedProducts, &LaggedProducts),
    metrics: &mut ChannelMetrics,
) {
    let clock = response.clock;
    let delay_s = response.delay(fits.channel.delay_behind_s(&fits.raw), Against::Raw);
    let delay = delay_s.scaled(1.0 / clock.sample_period_s);
    let at = |delay_samples: f64, autocovariance: &[f64]| {
        filter_bound_at(&facts.shape, delay_samples, autocovariance)
    };
    let autocovariance = raw.autocovariance();
    let without: Vec<Result<LeastNoise, Unavailable>> = (0..raw.blocks())
        .map(|block| at(delay.value, &raw.autocovariance_without(block)))
        .collect();
    let bound = at(delay.value, &autocovariance);
    let over = response.by_weights(facts, |frozen, weights| {
        let delay_s = frozen.delay_s(clock.frequency_hz, clock.sample_period_s);
        let least = at(delay_s / clock.sample_period_s, &autocovariance);
        let least = least.map_or(f64::NAN, |least| least.noise_gain);
        noise_power_gain(weights, &autocovariance) / least
    });
    let of = OverBound {
        channel,
        raw,
        bound: &bound,
        bounds_without: &without,
    };
    of.put_at(&delay, facts, over.as_ref(), clock.sample_period_s, metrics);
}
