//! Scale factor of a gyro from its mean outputs at constant rates.
//!
//! Least squares of the outputs `F_j` on the inputs `W_j`, `F_j = K W_j + F0`, and what is left
//! over. Nothing here weighs the points: the standards do not either, and a few quiet points must
//! not decide over the range.
//!
//! Source: IEEE Std 952, scale factor test; GJB 2426A has the same quantities. The intervals are
//! derived: every quantity below is linear in the outputs up to a ratio, and each output comes with
//! its own standard deviation.

use super::nonlinearity::{Nonlinearity, Residual};
use crate::metrics::estimate::interval;
use crate::metrics::estimate::magnitude::LargestOf;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::value::Estimate;

/// Inputs closer than this part of their span count as the same rate.
const DISTINCT_PER_SPAN: f64 = 1e-6;

/// Fewest distinct rates of which a scale factor and a nonlinearity are given.
pub const RATES_MIN: usize = 3;

/// Fewest distinct rates of one sense of which a scale factor of that sense is given.
pub const RATES_PER_SENSE_MIN: usize = 2;

/// Mean output at one constant input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RatePoint {
    /// Input W, deg/h.
    pub input_deg_per_h: f64,
    /// Mean output F, deg/h.
    pub output_deg_per_h: f64,
    /// Standard deviation of that mean, deg/h; 0 where it is not known.
    pub deviation_deg_per_h: f64,
    /// Degrees of freedom of that standard deviation.
    pub degrees_of_freedom: f64,
}

/// Input and output with the table at rest, means of before and after; both are subtracted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StaticZero {
    /// Input at rest (the Earth's rate), deg/h.
    pub input_deg_per_h: f64,
    /// Output at rest, deg/h.
    pub output_deg_per_h: f64,
}

/// What the outputs at constant rates say.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ScaleFactorFit {
    /// Slope K.
    pub factor: Estimate,
    /// Offset F0 at the input at rest, deg/h.
    pub offset_deg_per_h: f64,
    /// The same with its interval.
    pub offset: Estimate,
    /// Distances from the line in the order of the points.
    pub residuals: Vec<Residual>,
    /// Largest output in magnitude, that at rest subtracted, deg/h.
    pub full_scale_deg_per_h: f64,
    /// Largest residual over the largest output, a ratio (of full scale).
    pub nonlinearity: Nonlinearity,
    /// Largest residual over the line's own value at that point, a ratio (of reading); points at
    /// rest left out.
    pub nonlinearity_of_reading: Nonlinearity,
    /// Scale factors of the senses, if each has two distinct rates.
    pub asymmetry: Option<Asymmetry>,
}

/// Difference between the senses of rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Asymmetry {
    /// `|K+ - K-| / ((K+ + K-) / 2)`, a ratio.
    pub value: Estimate,
    /// K of the points with positive input.
    pub positive: f64,
    /// K of the points with negative input.
    pub negative: f64,
}

/// Number of rates that differ.
#[must_use]
pub fn distinct_rates(inputs: impl IntoIterator<Item = f64>) -> usize {
    let mut sorted: Vec<f64> = inputs.into_iter().collect();
    sorted.sort_by(f64::total_cmp);
    let span = match (sorted.first(), sorted.last()) {
        (Some(first), Some(last)) => last - first,
        _ => return 0,
    };
    let steps = sorted.windows(2);
    1 + steps
        .filter(|pair| pair[1] - pair[0] > DISTINCT_PER_SPAN * span)
        .count()
}

/// Rates of each sense that differ, `[positive, negative]`; a table at rest belongs to neither.
#[must_use]
pub fn distinct_rates_by_sense(inputs: &[f64], rest_deg_per_h: f64) -> [usize; 2] {
    let moved: Vec<f64> = inputs.iter().map(|input| input - rest_deg_per_h).collect();
    [1.0, -1.0].map(|sense| {
        let own = of_sense(&moved, sense).map(|index| moved[index]);
        distinct_rates(own)
    })
}

/// Indices of the inputs of one sense.
fn of_sense(inputs: &[f64], sense: f64) -> impl Iterator<Item = usize> {
    let largest = inputs
        .iter()
        .fold(0.0_f64, |max, input| max.max(input.abs()));
    let still = DISTINCT_PER_SPAN * largest;
    (0..inputs.len()).filter(move |&index| sense * inputs[index] > still)
}

/// Indices of the inputs at which the table moves.
fn moved(inputs: &[f64]) -> impl Iterator<Item = usize> {
    [1.0, -1.0]
        .into_iter()
        .flat_map(|sense| of_sense(inputs, sense))
}

/// Largest output of either sense.
fn full_scale(outputs: &[f64]) -> f64 {
    outputs.iter().fold(0.0_f64, |max, at| max.max(at.abs()))
}

/// Least-squares line through points with its mean subtracted first, so that no digits are lost.
struct Line {
    mean_input: f64,
    spread: f64,
    slope: f64,
    offset: f64,
}

impl Line {
    fn through(inputs: &[f64], outputs: &[f64]) -> Self {
        let (mean_input, mean_output) = (interval::mean(inputs), interval::mean(outputs));
        let (mut spread, mut cross) = (0.0, 0.0);
        for (input, output) in inputs.iter().zip(outputs) {
            spread += (input - mean_input) * (input - mean_input);
            cross += (input - mean_input) * (output - mean_output);
        }
        let slope = cross / spread;
        Self {
            mean_input,
            spread,
            slope,
            offset: mean_output - slope * mean_input,
        }
    }

    fn at(&self, input: f64) -> f64 {
        self.slope * input + self.offset
    }

    /// Weight of the output at `input` in the slope.
    fn slope_weight(&self, input: f64) -> f64 {
        (input - self.mean_input) / self.spread
    }

    /// Weight of the output at `other` in the line's value at `input`.
    fn leverage(&self, input: f64, other: f64, count: usize) -> f64 {
        1.0 / count as f64 + (input - self.mean_input) * self.slope_weight(other)
    }
}

/// Covariance of the outputs by slow noise, whose mean wanders from point to point, (deg/h)^2.
pub(crate) type DriftCovariance<'a> = &'a dyn Fn(usize, usize) -> f64;

/// Standard deviation of a weighted sum of outputs, and its degrees of freedom.
///
/// * `weights`: index of each point and its weight.
///
/// Source: Welch and Satterthwaite.
fn spread_of(weights: &[(usize, f64)], points: &[RatePoint], drift: DriftCovariance) -> (f64, f64) {
    let (mut variance, mut square) = (0.0, 0.0);
    for &(index, weight) in weights {
        let point = points[index];
        let part = (weight * point.deviation_deg_per_h).powi(2);
        variance += part;
        square += part * part / point.degrees_of_freedom.max(1.0);
        let others = weights.iter();
        let shared = others.map(|&(other, by)| weight * by * drift(index, other));
        variance += shared.sum::<f64>();
    }
    let freedom = if square > 0.0 {
        variance * variance / square
    } else {
        f64::INFINITY
    };
    (variance.max(0.0).sqrt(), freedom)
}

/// Fits the scale factor and everything that follows from it.
///
/// The intervals hold the noise of the outputs alone: what drifts from one point to the next is
/// part of the residuals, where the nonlinearity shows it.
///
/// # Errors
/// The reason, in words, with fewer than three distinct rates.
pub fn fit_scale_factor(
    points: &[RatePoint],
    rest: StaticZero,
) -> Result<ScaleFactorFit, Unavailable> {
    fit_drifting_scale_factor(points, rest, &|_, _| 0.0)
}

/// As [`fit_scale_factor`], with the slow noise in the intervals.
pub(crate) fn fit_drifting_scale_factor(
    points: &[RatePoint],
    rest: StaticZero,
    drift: DriftCovariance,
) -> Result<ScaleFactorFit, Unavailable> {
    let (inputs, outputs, line) = line_above_rest(points, rest)?;
    let residuals = residuals(points, (&inputs, &outputs), &line, drift);
    let full_scale = full_scale(&outputs);
    let weights: Vec<(usize, f64)> = inputs
        .iter()
        .map(|input| line.slope_weight(*input))
        .enumerate()
        .collect();
    let (deviation, freedom) = spread_of(&weights, points, drift);
    let by_rest = inputs
        .iter()
        .map(|input| line.leverage(0.0, *input, inputs.len()));
    let by_rest: Vec<(usize, f64)> = by_rest.enumerate().collect();
    let (of_offset, its_freedom) = spread_of(&by_rest, points, drift);
    Ok(ScaleFactorFit {
        factor: Estimate::symmetric(line.slope, interval::student_quantile(freedom) * deviation),
        offset_deg_per_h: line.offset,
        offset: Estimate::symmetric(
            line.offset,
            interval::student_quantile(its_freedom) * of_offset,
        ),
        full_scale_deg_per_h: full_scale,
        nonlinearity: Nonlinearity::of_full_scale(&residuals, full_scale),
        nonlinearity_of_reading: Nonlinearity::of_reading(&residuals),
        asymmetry: senses((&inputs, &outputs)).map(|senses| senses.asymmetry(points, drift)),
        residuals,
    })
}

/// What a scale factor test says in numbers alone, or how far these scatter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ScaleFactorFigures {
    /// Slope K.
    pub(crate) factor: f64,
    /// Largest residual over the largest output.
    pub(crate) nonlinearity: f64,
    /// Largest residual over the line there.
    pub(crate) nonlinearity_of_reading: f64,
    /// Difference of the senses, if each has two distinct rates.
    pub(crate) asymmetry: Option<f64>,
}

/// The values that a fit has, without intervals.
pub(crate) fn figures(
    points: &[RatePoint],
    rest: StaticZero,
) -> Result<ScaleFactorFigures, Unavailable> {
    let (inputs, outputs, line) = line_above_rest(points, rest)?;
    let full_scale = full_scale(&outputs);
    let distance = |at: usize| (outputs[at] - line.at(inputs[at])).abs();
    let largest = (0..inputs.len()).map(distance).fold(0.0, f64::max);
    let of_reading = moved(&inputs).map(|at| distance(at) / line.at(inputs[at]).abs());
    let senses = senses((&inputs, &outputs));
    Ok(ScaleFactorFigures {
        factor: line.slope,
        nonlinearity: largest / full_scale,
        nonlinearity_of_reading: of_reading.fold(0.0, f64::max),
        asymmetry: senses.map(|senses| senses.difference().abs()),
    })
}

/// Standard deviations of these by slow noise alone: of the largest residuals as they are.
pub(crate) fn figures_by_drift(
    points: &[RatePoint],
    rest: StaticZero,
    drift: DriftCovariance,
) -> Result<ScaleFactorFigures, Unavailable> {
    let (inputs, outputs, line) = line_above_rest(points, rest)?;
    let quiet = |point: &RatePoint| RatePoint {
        deviation_deg_per_h: 0.0,
        ..*point
    };
    let quiet: Vec<RatePoint> = points.iter().map(quiet).collect();
    let full_scale = full_scale(&outputs);
    let weights = inputs.iter().map(|input| line.slope_weight(*input));
    let weights: Vec<(usize, f64)> = weights.enumerate().collect();
    let residuals = residuals(&quiet, (&inputs, &outputs), &line, drift);
    let of_largest = |divisor: &dyn Fn(&Residual) -> f64| {
        let sizes = residuals.iter().map(|residual| {
            let over = divisor(residual);
            let size = residual.value_deg_per_h.abs() / over;
            (size, residual.deviation_deg_per_h / over)
        });
        sizes
            .fold(
                (0.0, 0.0),
                |most, part| if part.0 > most.0 { part } else { most },
            )
            .1
    };
    let senses = senses((&inputs, &outputs));
    Ok(ScaleFactorFigures {
        factor: spread_of(&weights, &quiet, drift).0,
        nonlinearity: of_largest(&|_| full_scale),
        nonlinearity_of_reading: of_largest(&|residual| {
            if residual.is_moved {
                residual.reading_deg_per_h.abs()
            } else {
                f64::INFINITY
            }
        }),
        asymmetry: senses.map(|senses| senses.deviation(&quiet, drift)),
    })
}

/// Inputs and outputs less those at rest, and the line through them.
fn line_above_rest(
    points: &[RatePoint],
    rest: StaticZero,
) -> Result<(Vec<f64>, Vec<f64>, Line), Unavailable> {
    let inputs: Vec<f64> = points
        .iter()
        .map(|point| point.input_deg_per_h - rest.input_deg_per_h)
        .collect();
    let outputs: Vec<f64> = points
        .iter()
        .map(|point| point.output_deg_per_h - rest.output_deg_per_h)
        .collect();
    let rates = distinct_rates(inputs.iter().copied());
    if rates < RATES_MIN {
        return Err(too_few_rates(rates));
    }
    let line = Line::through(&inputs, &outputs);
    Ok((inputs, outputs, line))
}

/// Why there is no scale factor.
pub(crate) fn too_few_rates(rates: usize) -> Unavailable {
    format!("a scale factor needs {RATES_MIN} distinct rates; there are {rates}").into()
}

/// Distances of the points from the line, each with the noise of all points.
fn residuals(
    points: &[RatePoint],
    (inputs, outputs): (&[f64], &[f64]),
    line: &Line,
    drift: DriftCovariance,
) -> Vec<Residual> {
    let count = inputs.len();
    let moved: Vec<usize> = moved(inputs).collect();
    let pooled = pooled(points);
    let pairs = inputs.iter().zip(outputs).enumerate();
    pairs
        .map(|(own, (input, output))| {
            let weights = inputs.iter().enumerate().map(|(other, input_other)| {
                let own_output = if other == own { 1.0 } else { 0.0 };
                own_output - line.leverage(*input, *input_other, count)
            });
            let weights: Vec<(usize, f64)> = weights.enumerate().collect();
            let (deviation, freedom) = spread_of(&weights, points, drift);
            let (by_all, _) = spread_of(&weights, &pooled, drift);
            Residual {
                value_deg_per_h: output - line.at(*input),
                deviation_deg_per_h: deviation,
                degrees_of_freedom: freedom,
                pooled_deviation_deg_per_h: by_all,
                reading_deg_per_h: line.at(*input),
                is_moved: moved.contains(&own),
            }
        })
        .collect()
}

/// The points with the noise that they have in common, as far as it is in common.
///
/// The variance of each is `m + w (s^2 - m)`, m their mean, with the part w of the scatter of the variances
/// that is beyond that of estimates of so many degrees of freedom. Each from ten blocks, the largest of many
/// deviations is large by chance, and would make the largest distance from the line scatter by more than it
/// does.
///
/// Source: Buehlmann, ASTIN Bulletin 4 (1967).
fn pooled(points: &[RatePoint]) -> Vec<RatePoint> {
    let variances: Vec<f64> = points
        .iter()
        .map(|point| point.deviation_deg_per_h.powi(2))
        .collect();
    let freedoms: Vec<f64> = points
        .iter()
        .map(|point| point.degrees_of_freedom)
        .collect();
    let (mean, scatter) = (
        interval::mean(&variances),
        interval::sample_variance(&variances),
    );
    let own_freedom = interval::mean(&freedoms);
    if !(scatter > 0.0 && own_freedom.is_finite()) {
        return points.to_vec();
    }
    let by_chance = 2.0 / own_freedom.max(1.0);
    let beyond = (scatter - by_chance * mean * mean) / (1.0 + by_chance);
    let own = (beyond / scatter).clamp(0.0, 1.0);
    let count = points.len() as f64;
    let with = |(point, variance): (&RatePoint, &f64)| {
        let by_all = (1.0 - own * own) / (count * own_freedom);
        RatePoint {
            deviation_deg_per_h: (mean + own * (variance - mean)).sqrt(),
            degrees_of_freedom: (own * own / point.degrees_of_freedom + by_all).recip(),
            ..*point
        }
    };
    points.iter().zip(&variances).map(with).collect()
}

/// Separate lines of the two senses, with offsets of their own.
struct Senses {
    positive: f64,
    negative: f64,
    /// Index of each point and its weight in the difference of the slopes.
    weights: Vec<(usize, f64)>,
}

/// The lines of both senses, if each has two distinct rates.
fn senses((inputs, outputs): (&[f64], &[f64])) -> Option<Senses> {
    let sense = |sense: f64| {
        let own: Vec<usize> = of_sense(inputs, sense).collect();
        let own_inputs: Vec<f64> = own.iter().map(|&index| inputs[index]).collect();
        let own_outputs: Vec<f64> = own.iter().map(|&index| outputs[index]).collect();
        let is_enough = distinct_rates(own_inputs.iter().copied()) >= RATES_PER_SENSE_MIN;
        is_enough.then(|| {
            let line = Line::through(&own_inputs, &own_outputs);
            let weighted: Vec<(usize, f64)> = own_inputs
                .iter()
                .zip(&own)
                .map(|(input, &index)| (index, sense * line.slope_weight(*input)))
                .collect();
            (line.slope, weighted)
        })
    };
    let ((positive, mut weights), (negative, others)) = (sense(1.0)?, sense(-1.0)?);
    weights.extend(others);
    Some(Senses {
        positive,
        negative,
        weights,
    })
}

impl Senses {
    fn mean(&self) -> f64 {
        0.5 * (self.positive + self.negative)
    }

    /// `(K+ - K-) / ((K+ + K-) / 2)`.
    fn difference(&self) -> f64 {
        (self.positive - self.negative) / self.mean()
    }

    /// Standard deviation of that difference by the noise of the points.
    fn deviation(&self, points: &[RatePoint], drift: DriftCovariance) -> f64 {
        spread_of(&self.weights, points, drift).0 / self.mean().abs()
    }

    fn asymmetry(&self, points: &[RatePoint], drift: DriftCovariance) -> Asymmetry {
        let size = (
            self.difference().abs(),
            self.deviation(&pooled(points), drift),
        );
        Asymmetry {
            value: LargestOf::of(&[size]),
            positive: self.positive,
            negative: self.negative,
        }
    }
}

/// Repeatability `Kr` of scale factors of repeated tests: standard deviation over mean, a ratio.
///
/// `(1 / K) sqrt(sum (K_q - K)^2 / (Q - 1))`; the standard asks for six tests. `None` below two.
#[must_use]
pub fn scale_factor_repeatability(factors: &[f64]) -> Option<f64> {
    let deviation = interval::sample_variance(factors).sqrt();
    (factors.len() > 1).then(|| deviation / interval::mean(factors).abs())
}

/// Temperature sensitivity `Kt` of the scale factor, a ratio per kelvin.
///
/// `max_i |K_i - K_m| / (K_m |T_i - T_m|)` about the reference test m, usually at room temperature.
/// Tests at the reference temperature are left out; `None` if there is no other.
///
/// * `reference`, `tests`: temperature, C, and scale factor.
#[must_use]
pub fn scale_factor_temperature_sensitivity(
    reference: (f64, f64),
    tests: &[(f64, f64)],
) -> Option<f64> {
    let (temperature_c, factor) = reference;
    tests
        .iter()
        .map(|(test_c, test)| ((test_c - temperature_c).abs(), (test - factor).abs()))
        .filter(|(distance_k, _)| *distance_k > 0.0)
        .map(|(distance_k, change)| change / (factor.abs() * distance_k))
        .reduce(f64::max)
}
