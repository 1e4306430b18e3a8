//! Scale factor metrics of a staircase of rates.

use std::collections::BTreeMap;
use std::ops::Range;

use super::estimate::{ChannelMetrics, Estimate};
use super::interval;
use super::record::{Dwell, Record, Staircase};
use super::scale_factor::{
    RATES_MIN, RATES_PER_SENSE_MIN, RatePoint, ScaleFactorFit, StaticZero, distinct_rates,
    distinct_rates_by_sense, fit_scale_factor, too_few_rates,
};
use super::steady::equal_block_means;
use crate::units::ratio_to_ppm;

/// Blocks of a dwell whose scatter gives the error of its mean.
const DWELL_BLOCKS: usize = 10;

/// Fewest settled samples of a dwell that counts.
const DWELL_SAMPLES_MIN: usize = 2 * DWELL_BLOCKS;

const FACTOR: &str = "scale_factor_error_ppm";
const NONLINEARITY: &str = "scale_factor_nonlinearity_ppm";
const ASYMMETRY: &str = "scale_factor_asymmetry_ppm";

/// The samples of a dwell inside a record of `samples`; `None` where too few of them have settled.
fn counted(dwell: &Dwell, samples: usize) -> Option<Range<usize>> {
    let end = dwell.samples.end.min(samples);
    let start = dwell.samples.start;
    (end >= start.saturating_add(DWELL_SAMPLES_MIN)).then_some(start..end)
}

/// Why a staircase cannot support one of the scale factor metrics, if it cannot.
pub(crate) fn lack(metric: &str, staircase: &Staircase, samples: usize) -> Option<String> {
    if ![FACTOR, NONLINEARITY, ASYMMETRY].contains(&metric) {
        return None;
    }
    let rates: Vec<f64> = staircase
        .dwells
        .iter()
        .filter(|dwell| counted(dwell, samples).is_some())
        .map(|dwell| dwell.rate_deg_per_h)
        .collect();
    let distinct = distinct_rates(rates.iter().copied());
    let settle_s = staircase.settle_s;
    if distinct < RATES_MIN {
        return Some(format!(
            "{} among the dwells that hold {DWELL_SAMPLES_MIN} samples after {settle_s} s of \
             settling",
            too_few_rates(distinct)
        ));
    }
    let senses = distinct_rates_by_sense(&rates, staircase.rest_deg_per_h);
    let is_one_sided = senses.iter().any(|&rates| rates < RATES_PER_SENSE_MIN);
    (metric == ASYMMETRY && is_one_sided).then(|| {
        let [positive, negative] = senses;
        format!(
            "asymmetry needs {RATES_PER_SENSE_MIN} distinct rates of each sense; there are \
             {positive} positive and {negative} negative"
        )
    })
}

/// Enters the scale factor, its errors and the response curve.
///
/// Input and output of a dwell are the means of truth and channel over its settled samples. The
/// Earth's rate, which the axis sees at rest, is subtracted from both.
pub(crate) fn measure_scale_factor(
    record: &Record,
    staircase: &Staircase,
    metrics: &mut ChannelMetrics,
) {
    let samples = record.channel_deg_per_h.len();
    let points: Vec<RatePoint> = staircase
        .dwells
        .iter()
        .filter_map(|dwell| counted(dwell, samples))
        .map(|range| rate_point(record, range))
        .collect();
    put_response(&points, metrics);
    let rest = StaticZero {
        input_deg_per_h: staircase.rest_deg_per_h,
        output_deg_per_h: staircase.rest_deg_per_h,
    };
    match fit_scale_factor(&points, rest) {
        Ok(fit) => put_fit(&fit, staircase, points.len(), metrics),
        // The truth may hold fewer rates than were told, under a servo that has not settled.
        Err(reason) => {
            for name in [FACTOR, NONLINEARITY, ASYMMETRY] {
                let told = lack(name, staircase, samples);
                metrics.miss(name, told.unwrap_or_else(|| reason.clone()));
            }
        }
    }
}

fn rate_point(record: &Record, range: Range<usize>) -> RatePoint {
    let output = &record.channel_deg_per_h[range.clone()];
    let blocks = equal_block_means(output, DWELL_BLOCKS);
    RatePoint {
        input_deg_per_h: interval::mean(&record.truth_deg_per_h[range]),
        output_deg_per_h: interval::mean(output),
        deviation_deg_per_h: (interval::sample_variance(&blocks) / blocks.len() as f64).sqrt(),
        degrees_of_freedom: blocks.len() as f64 - 1.0,
    }
}

fn put_fit(
    fit: &ScaleFactorFit,
    staircase: &Staircase,
    dwells: usize,
    metrics: &mut ChannelMetrics,
) {
    let in_ppm = |estimate: Estimate| estimate.scaled(ratio_to_ppm(1.0));
    let Estimate {
        value, low, high, ..
    } = fit.factor;
    let error = in_ppm(Estimate::with_interval(value - 1.0, low - 1.0, high - 1.0));
    let mut put = |name, estimate| {
        let fields = &mut metrics.put(name, estimate).fields;
        fields.insert("settle_s", staircase.settle_s);
        fields.insert("count", dwells as f64);
    };
    put(FACTOR, error);
    put(NONLINEARITY, in_ppm(fit.nonlinearity));
    if let Some(asymmetry) = &fit.asymmetry {
        put(ASYMMETRY, in_ppm(asymmetry.value));
    }
    let extra = [
        (FACTOR, "offset_deg_per_h", Some(fit.offset_deg_per_h)),
        (
            NONLINEARITY,
            "of_reading_ppm",
            Some(ratio_to_ppm(fit.nonlinearity_of_reading)),
        ),
        (
            ASYMMETRY,
            "positive_error_ppm",
            fit.asymmetry
                .map(|sense| ratio_to_ppm(sense.positive - 1.0)),
        ),
        (
            ASYMMETRY,
            "negative_error_ppm",
            fit.asymmetry
                .map(|sense| ratio_to_ppm(sense.negative - 1.0)),
        ),
    ];
    for (name, field, value) in extra {
        if let (Some(metric), Some(value)) = (metrics.metrics.get_mut(name), value)
            && value.is_finite()
        {
            metric.fields.insert(field, value);
        }
    }
}

/// Enters output and error of each dwell, with the interval of the error.
fn put_response(points: &[RatePoint], metrics: &mut ChannelMetrics) {
    if points.is_empty() {
        return;
    }
    let error = |point: &RatePoint| point.output_deg_per_h - point.input_deg_per_h;
    let half_width = |point: &RatePoint| {
        interval::student_quantile(point.degrees_of_freedom) * point.deviation_deg_per_h
    };
    let column = |pick: &dyn Fn(&RatePoint) -> f64| points.iter().map(pick).collect();
    let columns: [(&str, Vec<f64>); 5] = [
        ("input_deg_per_h", column(&|point| point.input_deg_per_h)),
        ("output_deg_per_h", column(&|point| point.output_deg_per_h)),
        ("error_deg_per_h", column(&error)),
        (
            "error_low_deg_per_h",
            column(&|point| error(point) - half_width(point)),
        ),
        (
            "error_high_deg_per_h",
            column(&|point| error(point) + half_width(point)),
        ),
    ];
    let curve: BTreeMap<String, Vec<f64>> = columns
        .into_iter()
        .map(|(name, values)| (name.to_owned(), values))
        .collect();
    metrics.curves.insert("response".to_owned(), curve);
}
