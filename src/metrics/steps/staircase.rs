//! Scale factor metrics of a staircase of rates.

use std::ops::Range;

use super::scale_factor::{
    RATES_MIN, RATES_PER_SENSE_MIN, RatePoint, ScaleFactorFigures, ScaleFactorFit, StaticZero,
    distinct_rates, distinct_rates_by_sense, figures, figures_by_drift, fit_drifting_scale_factor,
    too_few_rates,
};
use super::small_input::measure_small_inputs;
use crate::metrics::estimate::blocks::equal_block_means;
use crate::metrics::estimate::interval;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::curve::{Column, CurveKey};
use crate::metrics::key::metric::{Applies, Headline, MetricKey, Needs, Table};
use crate::metrics::record::{Dwell, Record, Staircase};
use crate::units::{deg_per_h_to_deg_per_s, ratio_to_ppm};
use crate::wording::plain;

/// Input of a dwell.
pub static INPUT: Column = Column::new(
    "input_deg_per_h",
    "deg/h",
    "mean true rate of the dwell; in `scale_factor` less that at rest",
);

/// Output of a dwell.
pub static OUTPUT: Column = Column::new(
    "output_deg_per_h",
    "deg/h",
    "mean of the channel over its settled samples; in `scale_factor` less that at rest",
);

/// Error of a dwell.
pub static ERROR: Column = Column::new("error_deg_per_h", "deg/h", "output minus input");

/// Lower end of the error.
pub static ERROR_LOW: Column = Column::low("error_low_deg_per_h", &ERROR);

/// Upper end of the error.
pub static ERROR_HIGH: Column = Column::high("error_high_deg_per_h", &ERROR);

/// Output and error of every dwell.
pub static RESPONSE: CurveKey = CurveKey::new(
    "response",
    &[&INPUT, &OUTPUT, &ERROR, &ERROR_LOW, &ERROR_HIGH],
    "output and error at each rate of a staircase",
)
.picture("response.svg");

/// Output of a dwell as it is.
pub static MEAN_OUTPUT: Column = Column::new(
    "mean_output_deg_per_h",
    "deg/h",
    "mean of the channel over its settled samples",
);

/// Time that a dwell was measured.
pub static MEASURED: Column = Column::new("measured_s", "s", "time of its settled samples");

/// Turns of the table.
pub static TURNS: Column = Column::new("turns", "1", "turns of the table in that time");

/// Whether they are whole.
pub static WHOLE_TURNS: Column = Column::new(
    "whole_turns",
    "1",
    "1 where they are whole, so that an error that goes with the angle averages out, else 0",
);

/// Residual of full scale.
pub static RESIDUAL: Column = Column::new(
    "residual_ppm_of_full_scale",
    "ppm",
    "distance from the line through all rates, of the largest rate",
);

/// Its lower end.
pub static RESIDUAL_LOW: Column = Column::low("residual_low_ppm_of_full_scale", &RESIDUAL);

/// Its upper end.
pub static RESIDUAL_HIGH: Column = Column::high("residual_high_ppm_of_full_scale", &RESIDUAL);

/// Residual of reading.
pub static RESIDUAL_OF_READING: Column = Column::new(
    "residual_ppm_of_reading",
    "ppm",
    "the same of the rate itself",
);

/// Its lower end.
pub static RESIDUAL_OF_READING_LOW: Column =
    Column::low("residual_low_ppm_of_reading", &RESIDUAL_OF_READING);

/// Its upper end.
pub static RESIDUAL_OF_READING_HIGH: Column =
    Column::high("residual_high_ppm_of_reading", &RESIDUAL_OF_READING);

/// Columns of [`SCALE_FACTOR`].
const SCALE_FACTOR_COLUMNS: &[&Column; 12] = &[
    &INPUT,
    &MEAN_OUTPUT,
    &OUTPUT,
    &MEASURED,
    &TURNS,
    &WHOLE_TURNS,
    &RESIDUAL,
    &RESIDUAL_LOW,
    &RESIDUAL_HIGH,
    &RESIDUAL_OF_READING,
    &RESIDUAL_OF_READING_LOW,
    &RESIDUAL_OF_READING_HIGH,
];

/// Residuals of every rate about the line of the scale factor.
pub static SCALE_FACTOR: CurveKey = CurveKey::new(
    "scale_factor",
    SCALE_FACTOR_COLUMNS,
    "what the line through all rates of a scale factor test leaves at each of them",
)
.csv("scale-factor.csv")
.picture("scale-factor.svg");

/// Scale factor error.
pub static SCALE_FACTOR_ERROR: MetricKey = MetricKey::new(
    "scale_factor_error_ppm",
    "ppm",
    Applies::Steps,
    "slope of the line through mean output against mean true rate of the settled dwells, minus 1",
)
.heading("scale factor error")
.needs(Needs::Dwells)
.of_turned_axis()
.tables(&[Table::Steps])
.headlines(&[Headline::Steps, Headline::ScaleFactor]);

/// Offset of the scale factor.
pub static SCALE_FACTOR_OFFSET: MetricKey = MetricKey::new(
    "scale_factor_offset_deg_per_h",
    "deg/h",
    Applies::Log,
    "that line at a reference of zero, of a log whose dwells were found",
)
.heading("offset")
.needs(Needs::Dwells)
.tables(&[Table::Steps]);

/// Nonlinearity of full scale.
pub static SCALE_FACTOR_NONLINEARITY: MetricKey = MetricKey::new(
    "scale_factor_nonlinearity_ppm",
    "ppm",
    Applies::Steps,
    "largest distance of a dwell from that line over the largest output (of full scale)",
)
.lower_is_better()
.heading("nonlinearity")
.needs(Needs::Dwells)
.of_turned_axis()
.tables(&[Table::Steps])
.headlines(&[Headline::ScaleFactor]);

/// Nonlinearity of reading.
pub static SCALE_FACTOR_NONLINEARITY_OF_READING: MetricKey = MetricKey::new(
    "scale_factor_nonlinearity_of_reading_ppm",
    "ppm",
    Applies::Steps,
    "largest distance of a dwell from that line over the line there (of reading)",
)
.lower_is_better()
.heading("nonlinearity of reading")
.needs(Needs::Dwells)
.of_turned_axis()
.tables(&[Table::Steps])
.headlines(&[Headline::ScaleFactor]);

/// Asymmetry of the scale factor.
pub static SCALE_FACTOR_ASYMMETRY: MetricKey = MetricKey::new(
    "scale_factor_asymmetry_ppm",
    "ppm",
    Applies::Steps,
    "difference of the slopes of separate lines for the two senses over their mean",
)
.lower_is_better()
.heading("asymmetry")
.needs(Needs::DwellsOfBothSenses)
.of_turned_axis()
.tables(&[Table::Steps])
.headlines(&[Headline::ScaleFactor]);

/// Blocks of a dwell whose scatter gives the error of its mean.
const DWELL_BLOCKS: usize = 10;

/// Fewest settled samples of a dwell that counts.
const DWELL_SAMPLES_MIN: usize = 2 * DWELL_BLOCKS;

/// Samples by which a dwell may miss its whole turns: both ends and the settling are rounded.
const DWELL_SLACK_SAMPLES: f64 = 1.5;

/// Metrics of the line through the dwells.
static OF_FIT: [&MetricKey; 4] = [
    &SCALE_FACTOR_ERROR,
    &SCALE_FACTOR_NONLINEARITY,
    &SCALE_FACTOR_NONLINEARITY_OF_READING,
    &SCALE_FACTOR_ASYMMETRY,
];

/// The samples of a dwell inside a record of `samples`; `None` where too few of them have settled.
fn counted(dwell: &Dwell, samples: usize) -> Option<Range<usize>> {
    let end = dwell.samples.end.min(samples);
    let start = dwell.samples.start;
    (end >= start.saturating_add(DWELL_SAMPLES_MIN)).then_some(start..end)
}

/// Why a staircase cannot support one of the scale factor metrics, if it cannot.
pub(crate) fn lack(key: &MetricKey, staircase: &Staircase, samples: usize) -> Option<Unavailable> {
    if !matches!(key.needs, Needs::Dwells | Needs::DwellsOfBothSenses) {
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
        let reason = format!(
            "{} among the dwells that hold {DWELL_SAMPLES_MIN} samples after {} s of \
             settling",
            too_few_rates(distinct),
            plain(settle_s)
        );
        return Some(reason.into());
    }
    let senses = distinct_rates_by_sense(&rates, staircase.rest_deg_per_h);
    let is_one_sided = senses.iter().any(|&rates| rates < RATES_PER_SENSE_MIN);
    (key.needs == Needs::DwellsOfBothSenses && is_one_sided).then(|| {
        let [positive, negative] = senses;
        format!(
            "asymmetry needs {RATES_PER_SENSE_MIN} distinct rates of each sense; there are \
             {positive} positive and {negative} negative"
        )
        .into()
    })
}

/// Enters the scale factor, its errors and the curves.
///
/// Input and output of a dwell are the means of truth and channel over its settled samples. What is
/// there at rest is subtracted from both: the means of the static zeros where there are some,
/// otherwise the Earth's rate, which the axis sees at rest.
pub(crate) fn measure_scale_factor(
    record: &Record,
    staircase: &Staircase,
    metrics: &mut ChannelMetrics,
) {
    let samples = record.channel_deg_per_h.len();
    let dwells = counted_dwells(record, staircase);
    let every = means(&dwells);
    put_response(&every, metrics);
    measure_small_inputs(&every, staircase, metrics);
    let above = match AboveRest::new(staircase, dwells) {
        Ok(above) => above,
        Err(reason) => {
            for key in OF_FIT {
                metrics.miss(key, reason.clone());
            }
            return;
        }
    };
    match fit_drifting_scale_factor(&above.points, above.rest, &above.drift(record)) {
        Ok(fit) => {
            put_fit(&fit, staircase, above.points.len(), metrics);
            put_rates(record.sample_period_s, staircase, &above, &fit, metrics);
        }
        // The truth may hold fewer rates than were told, under a servo that has not settled.
        Err(reason) => {
            for key in OF_FIT {
                let told = lack(key, staircase, samples);
                metrics.miss(key, told.unwrap_or_else(|| reason.clone()));
            }
        }
    }
}

/// Scale factor and its errors in numbers alone; none where the dwells give no line.
pub(crate) fn scale_factor_figures(
    record: &Record,
    staircase: &Staircase,
) -> Option<ScaleFactorFigures> {
    let above = AboveRest::new(staircase, counted_dwells(record, staircase)).ok()?;
    figures(&above.points, above.rest).ok()
}

/// Standard deviations of these over seeds by slow noise alone.
pub(crate) fn scale_factor_figures_by_drift(
    record: &Record,
    staircase: &Staircase,
) -> Option<ScaleFactorFigures> {
    let above = AboveRest::new(staircase, counted_dwells(record, staircase)).ok()?;
    figures_by_drift(&above.points, above.rest, &above.drift(record)).ok()
}

/// A dwell of which enough samples have settled.
struct Counted<'a> {
    dwell: &'a Dwell,
    samples: Range<usize>,
    means: RatePoint,
}

/// The dwells that count.
fn counted_dwells<'a>(record: &Record, staircase: &'a Staircase) -> Vec<Counted<'a>> {
    let length = record.channel_deg_per_h.len();
    let settled = |dwell| {
        let samples = counted(dwell, length)?;
        Some(Counted {
            dwell,
            means: rate_point(record, samples.clone()),
            samples,
        })
    };
    staircase.dwells.iter().filter_map(settled).collect()
}

fn means(dwells: &[Counted]) -> Vec<RatePoint> {
    dwells.iter().map(|counted| counted.means).collect()
}

/// The dwells that count but for the static zeros, and what is there at rest.
struct AboveRest<'a> {
    dwells: Vec<Counted<'a>>,
    points: Vec<RatePoint>,
    rest: StaticZero,
}

impl<'a> AboveRest<'a> {
    fn new(staircase: &Staircase, mut dwells: Vec<Counted<'a>>) -> Result<Self, Unavailable> {
        let rest = static_zero(staircase, &mut dwells)?;
        Ok(Self {
            points: means(&dwells),
            dwells,
            rest,
        })
    }

    /// Covariance of the means of two dwells by slow noise.
    fn drift(&self, record: &Record) -> impl Fn(usize, usize) -> f64 {
        let samples = |dwell: usize| &self.dwells[dwell].samples;
        move |one, other| record.drift_covariance(samples(one), samples(other))
    }
}

/// Input and output at rest; takes the static zeros out of the dwells.
fn static_zero(
    staircase: &Staircase,
    dwells: &mut Vec<Counted>,
) -> Result<StaticZero, Unavailable> {
    if !staircase.has_static_zeros {
        return Ok(StaticZero {
            input_deg_per_h: staircase.rest_deg_per_h,
            output_deg_per_h: staircase.rest_deg_per_h,
        });
    }
    let is_whole = dwells.len() == staircase.dwells.len() && dwells.len() > 1;
    if !is_whole {
        return Err(format!(
            "the test is not whole: {} of {} dwells hold {DWELL_SAMPLES_MIN} settled samples",
            dwells.len(),
            staircase.dwells.len()
        )
        .into());
    }
    let (before, after) = (dwells.remove(0).means, dwells.pop().map(|last| last.means));
    let after = after.unwrap_or(before);
    Ok(StaticZero {
        input_deg_per_h: 0.5 * (before.input_deg_per_h + after.input_deg_per_h),
        output_deg_per_h: 0.5 * (before.output_deg_per_h + after.output_deg_per_h),
    })
}

fn rate_point(record: &Record, range: Range<usize>) -> RatePoint {
    let output = &record.channel_deg_per_h[range.clone()];
    let blocks = equal_block_means(output, DWELL_BLOCKS);
    RatePoint {
        input_deg_per_h: record.truth_deg_per_h.cut(range).mean(),
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
    let mut put = |key: &MetricKey, estimate, extra: &[(&'static str, f64)]| {
        let fields = &mut metrics.put(key, estimate).fields;
        fields.insert("settle_s", staircase.settle_s);
        fields.insert("count", dwells as f64);
        let finite = extra.iter().filter(|(_, value)| value.is_finite());
        fields.extend(finite.copied());
    };
    put(
        &SCALE_FACTOR_ERROR,
        error,
        &[("offset_deg_per_h", fit.offset_deg_per_h)],
    );
    if staircase.is_found {
        put(&SCALE_FACTOR_OFFSET, fit.offset, &[]);
    }
    for (key, found) in [
        (&SCALE_FACTOR_NONLINEARITY, &fit.nonlinearity),
        (
            &SCALE_FACTOR_NONLINEARITY_OF_READING,
            &fit.nonlinearity_of_reading,
        ),
    ] {
        let floor = ratio_to_ppm(found.noise_floor);
        put(key, in_ppm(found.value), &[("noise_floor_ppm", floor)]);
    }
    if let Some(asymmetry) = &fit.asymmetry {
        let error_ppm = |factor: f64| ratio_to_ppm(factor - 1.0);
        let senses = [
            ("positive_error_ppm", error_ppm(asymmetry.positive)),
            ("negative_error_ppm", error_ppm(asymmetry.negative)),
        ];
        put(&SCALE_FACTOR_ASYMMETRY, in_ppm(asymmetry.value), &senses);
    }
}

/// Enters the table of the rates: input and output over rest, distance from the line with its own
/// interval of 95 %, and how the table turned. Points at rest have no reading and are left out.
fn put_rates(
    sample_period_s: f64,
    staircase: &Staircase,
    above: &AboveRest,
    fit: &ScaleFactorFit,
    metrics: &mut ChannelMetrics,
) {
    let mut rows: Vec<[f64; 12]> = Vec::new();
    for (Counted { dwell, means, .. }, residual) in above.dwells.iter().zip(&fit.residuals) {
        if !residual.is_moved {
            continue;
        }
        let table_deg_per_h = dwell.rate_deg_per_h - staircase.rest_deg_per_h;
        let counted = dwell.samples.end - dwell.samples.start;
        let measured_s = counted as f64 * sample_period_s;
        let turns = deg_per_h_to_turns_per_s(table_deg_per_h) * measured_s;
        let slack =
            DWELL_SLACK_SAMPLES * deg_per_h_to_turns_per_s(table_deg_per_h.abs()) * sample_period_s;
        let is_whole = turns.round().abs() >= 1.0 && (turns - turns.round()).abs() <= slack;
        let quantile = interval::student_quantile(residual.degrees_of_freedom);
        let half_width = quantile * residual.deviation_deg_per_h;
        let of_full_scale = ratio_to_ppm(1.0 / fit.full_scale_deg_per_h);
        let of_reading = ratio_to_ppm(1.0 / residual.reading_deg_per_h.abs());
        let [low, high] = [-half_width, half_width].map(|shift| residual.value_deg_per_h + shift);
        rows.push([
            means.input_deg_per_h - above.rest.input_deg_per_h,
            means.output_deg_per_h,
            means.output_deg_per_h - above.rest.output_deg_per_h,
            measured_s,
            turns,
            f64::from(u8::from(is_whole)),
            of_full_scale * residual.value_deg_per_h,
            of_full_scale * low,
            of_full_scale * high,
            of_reading * residual.value_deg_per_h,
            of_reading * low,
            of_reading * high,
        ]);
    }
    if !rows.is_empty() && rows.as_flattened().iter().all(|value| value.is_finite()) {
        let columns = SCALE_FACTOR_COLUMNS.iter().enumerate();
        let columns =
            columns.map(|(at, column)| (*column, rows.iter().map(|row| row[at]).collect()));
        metrics.put_curve(&SCALE_FACTOR, columns);
    }
}

/// Turns of the table per second.
fn deg_per_h_to_turns_per_s(rate_deg_per_h: f64) -> f64 {
    deg_per_h_to_deg_per_s(rate_deg_per_h) / 360.0
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
    let columns = [
        (&INPUT, column(&|point| point.input_deg_per_h)),
        (&OUTPUT, column(&|point| point.output_deg_per_h)),
        (&ERROR, column(&error)),
        (
            &ERROR_LOW,
            column(&|point| error(point) - half_width(point)),
        ),
        (
            &ERROR_HIGH,
            column(&|point| error(point) + half_width(point)),
        ),
    ];
    metrics.put_curve(&RESPONSE, columns);
}
