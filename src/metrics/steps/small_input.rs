//! Threshold, resolution and dead band: the smallest inputs that a gyro answers.
//!
//! Source: IEEE Std 528, threshold and resolution: the smallest input, or change of it, that gives
//! half of the output to expect or more. The decision by intervals is derived here: a rate counts
//! as answered, or as not answered, only where the noise of its mean leaves no doubt.

use super::scale_factor::RatePoint;
use crate::metrics::estimate::interval;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::{Applies, MetricKey, Table};
use crate::metrics::record::Staircase;
use crate::wording::decimals;

/// Threshold.
pub static THRESHOLD: MetricKey = MetricKey::new(
    "threshold_deg_per_h",
    "deg/h",
    Applies::Steps,
    "smallest input of the record from which on all give half of themselves, from zero input",
)
.lower_is_better()
.heading("threshold")
.of_turned_axis()
.by_choice()
.tables(&[Table::Steps]);

/// Dead band.
pub static DEAD_BAND: MetricKey = MetricKey::new(
    "dead_band_deg_per_h",
    "deg/h",
    Applies::Steps,
    "sum of the smallest such inputs of both senses: where the output stays below half",
)
.lower_is_better()
.heading("dead band")
.of_turned_axis()
.by_choice()
.tables(&[Table::Steps]);

/// Resolution.
pub static RESOLUTION: MetricKey = MetricKey::new(
    "resolution_deg_per_h",
    "deg/h",
    Applies::Steps,
    "the same from the rate held most often: smallest answered increment",
)
.lower_is_better()
.heading("resolution")
.of_turned_axis()
.by_choice()
.tables(&[Table::Steps]);

/// Part of the output to expect at which an input counts as answered.
const ANSWERED: f64 = 0.5;

/// Inputs closer than this part of the largest count as the same.
const SAME_PER_LARGEST: f64 = 1e-6;

/// What one change of the input became.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Answer {
    /// Size of the change, deg/h.
    change_deg_per_h: f64,
    /// Change of the output over it.
    ratio: f64,
    half_width: f64,
}

/// Smallest answered changes of the input upwards and downwards of a base, deg/h.
///
/// * `points`: means at constant inputs.
/// * `base_deg_per_h`: the input at which the changes begin; at least one point must be there.
///
/// The value is the smallest input of the record from which on every input is answered; the interval
/// reaches down to the largest input that is surely not answered, or to 0 where each is: the true
/// one lies between the two. A direction without inputs is `None`.
///
/// # Errors
/// The reason, in words: no point at the base, or the largest input itself is not answered or lost
/// in noise.
pub fn smallest_answered(
    points: &[RatePoint],
    base_deg_per_h: f64,
) -> Result<[Option<Estimate>; 2], Unavailable> {
    let largest = points
        .iter()
        .fold(0.0_f64, |max, point| max.max(point.input_deg_per_h.abs()));
    let is_base = |point: &&RatePoint| {
        (point.input_deg_per_h - base_deg_per_h).abs() <= SAME_PER_LARGEST * largest
    };
    let bases: Vec<&RatePoint> = points.iter().filter(is_base).collect();
    let count = bases.len() as f64;
    if bases.is_empty() {
        return Err(format!(
            "no dwell has an input of {} deg/h",
            decimals(base_deg_per_h, 4)
        )
        .into());
    }
    let output = bases
        .iter()
        .map(|point| point.output_deg_per_h)
        .sum::<f64>()
        / count;
    let base_deviations = bases.iter().map(|point| {
        let deviation = point.deviation_deg_per_h / count;
        (deviation, point.degrees_of_freedom)
    });
    let base_deviations: Vec<(f64, f64)> = base_deviations.collect();
    let others = points.len() - bases.len();
    let direction = |sign: f64| {
        let own = points.iter().filter(|point| {
            !is_base(point) && sign * (point.input_deg_per_h - base_deg_per_h) > 0.0
        });
        let mut answers: Vec<Answer> = own
            .map(|point| {
                let change = point.input_deg_per_h - base_deg_per_h;
                let own = (point.deviation_deg_per_h, point.degrees_of_freedom);
                let parts = base_deviations.iter().copied().chain([own]);
                Answer {
                    change_deg_per_h: change.abs(),
                    ratio: (point.output_deg_per_h - output) / change,
                    half_width: half_width(parts, others) / change.abs(),
                }
            })
            .collect();
        answers.sort_by(|a, b| a.change_deg_per_h.total_cmp(&b.change_deg_per_h));
        (!answers.is_empty()).then(|| decide(&answers)).transpose()
    };
    Ok([direction(1.0)?, direction(-1.0)?])
}

/// Half width of the interval of a sum of independent means, of `count` that shall hold at once.
///
/// Source: Welch and Satterthwaite.
fn half_width(parts: impl Iterator<Item = (f64, f64)>, count: usize) -> f64 {
    let (variance, square) = parts.fold((0.0, 0.0), |(variance, square), (deviation, freedom)| {
        let part = deviation * deviation;
        (variance + part, square + part * part / freedom.max(1.0))
    });
    if square <= 0.0 {
        return 0.0;
    }
    let freedom = variance * variance / square;
    interval::student_quantile_of_many(freedom, count) * f64::sqrt(variance)
}

/// The smallest input from which on every input is answered; `answers` ascend and are not empty.
fn decide(answers: &[Answer]) -> Result<Estimate, Unavailable> {
    let is_answered = |answer: &&Answer| answer.ratio - answer.half_width >= ANSWERED;
    let is_not = |answer: &&Answer| answer.ratio + answer.half_width < ANSWERED;
    let sure = answers.iter().rev().take_while(is_answered).last();
    let Some(sure) = sure else {
        let last = answers[answers.len() - 1];
        let change = decimals(last.change_deg_per_h, 4);
        let percent = 100.0 * last.half_width;
        let reason = if is_not(&&last) {
            format!("not even {change} deg/h gives half of itself")
        } else if percent.is_finite() {
            format!(
                "noise forbids: the mean output at {change} deg/h is known to +-{} % of it",
                decimals(percent, 0)
            )
        } else {
            format!("noise forbids: the mean output at {change} deg/h is not known at all")
        };
        return Err(reason.into());
    };
    let below = answers.iter().rfind(is_not);
    Ok(Estimate::with_interval(
        sure.change_deg_per_h,
        below.map_or(0.0, |answer| answer.change_deg_per_h),
        sure.change_deg_per_h,
    ))
}

/// Enters threshold, dead band and resolution of a staircase.
pub(crate) fn measure_small_inputs(
    points: &[RatePoint],
    staircase: &Staircase,
    metrics: &mut ChannelMetrics,
) {
    match smallest_answered(points, 0.0) {
        Ok(senses) => put_threshold(senses, metrics),
        Err(reason) => {
            for key in [&THRESHOLD, &DEAD_BAND] {
                metrics.miss(key, reason.clone());
            }
        }
    }
    let resolution = bias_rate(points, staircase).and_then(|base| smallest_answered(points, base));
    match resolution.map(larger) {
        Ok(Some(estimate)) => {
            metrics.put(&RESOLUTION, estimate);
        }
        Ok(None) => metrics.miss(&RESOLUTION, "no rate departs from the one held twice"),
        Err(reason) => metrics.miss(&RESOLUTION, reason),
    }
}

fn put_threshold(senses: [Option<Estimate>; 2], metrics: &mut ChannelMetrics) {
    match senses {
        [Some(up), Some(down)] => {
            let [value, low, high] = [
                up.value + down.value,
                up.low + down.low,
                up.high + down.high,
            ];
            metrics.put(&DEAD_BAND, Estimate::with_interval(value, low, high));
        }
        _ => metrics.miss(&DEAD_BAND, "it needs inputs of both senses"),
    }
    match larger(senses) {
        Some(estimate) => {
            metrics.put(&THRESHOLD, estimate);
        }
        None => metrics.miss(&THRESHOLD, "no dwell has an input beside zero"),
    }
}

/// The larger of both directions; its interval holds for both.
fn larger(senses: [Option<Estimate>; 2]) -> Option<Estimate> {
    senses.into_iter().flatten().reduce(|a, b| {
        let (value, low) = (a.value.max(b.value), a.low.max(b.low));
        Estimate::with_interval(value, low, a.high.max(b.high))
    })
}

/// The rate other than zero that is held most often, twice at least: increments start from it.
fn bias_rate(points: &[RatePoint], staircase: &Staircase) -> Result<f64, Unavailable> {
    let none = "no rate other than zero is held twice, from which increments could start";
    if staircase.has_static_zeros {
        return Err(none.into());
    }
    let inputs = || points.iter().map(|point| point.input_deg_per_h);
    let largest = inputs().fold(0.0_f64, |max, input| max.max(input.abs()));
    let same = SAME_PER_LARGEST * largest;
    let mut best: Option<(usize, f64)> = None;
    for input in inputs().filter(|input| input.abs() > same) {
        let times = inputs()
            .filter(|other| (other - input).abs() <= same)
            .count();
        if times > best.map_or(1, |(most, _)| most) {
            best = Some((times, input));
        }
    }
    best.map(|(_, input)| input).ok_or_else(|| none.into())
}
