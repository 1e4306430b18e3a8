//! The family of Allan deviations: plain, overlapping, modified, Hadamard; records with gaps.

use rayon::prelude::*;

use super::angle::angle_about_mean;
use super::angle::sums::second_difference_sums_of_record;
use super::bridges::BridgedAngle;
use super::combined_freedom::{Differences, combined_degrees_of_freedom};
use super::noise_identification::{PowerLaw, identify_noise, identify_noise_of_record};
use super::overlapping::AllanPoint;
use crate::metrics::estimate::interval;
use crate::metrics::estimate::value::CONFIDENCE;
use crate::signal::Bridge;
use crate::vocabulary::AveragingTimes;

/// Most averaging times of [`AveragingTimes::All`].
const ALL_MAX: usize = 1000;

/// Fewest of them that a long record is cut down to.
const ALL_MIN: usize = 100;

/// Differences, counted as longest averaging factor times averaging times, up to which there are
/// more than that: 2e9 in all, since a record is four times its longest factor.
const ALL_WORK: usize = 500_000_000;

/// Averaging times that a running sum covers before it is formed afresh, an eighth of the work.
const RUN_PER_TAU: usize = 8;

/// Which mean square of differences of the angle is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AllanEstimator {
    /// Allan deviation over every start: the usual one.
    #[default]
    Overlapping,
    /// Allan deviation of neighbouring blocks, starts one averaging time apart.
    Plain,
    /// Modified Allan deviation: angles averaged over tau first, which tells white from flicker
    /// angle noise.
    Modified,
    /// Overlapping Hadamard deviation: third differences, blind to a constant rate ramp.
    Hadamard,
    /// Hadamard deviation with starts one averaging time apart.
    PlainHadamard,
}

impl AllanEstimator {
    /// Averaging times that one difference spans.
    fn span(self) -> usize {
        match self {
            Self::Overlapping | Self::Plain => 2,
            Self::Modified | Self::Hadamard | Self::PlainHadamard => 3,
        }
    }

    /// Name as in a scenario: `overlapping`, `plain`, `modified`, `hadamard`, `plain-hadamard`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Overlapping => "overlapping",
            Self::Plain => "plain",
            Self::Modified => "modified",
            Self::Hadamard => "hadamard",
            Self::PlainHadamard => "plain-hadamard",
        }
    }

    /// Order of the difference, whether starts are a sample apart, whether angles are averaged.
    fn differences(self) -> Differences {
        Differences {
            order: match self {
                Self::Hadamard | Self::PlainHadamard => 3,
                _ => 2,
            },
            overlapping: !matches!(self, Self::Plain | Self::PlainHadamard),
            modified: self == Self::Modified,
        }
    }
}

impl AveragingTimes {
    /// Averaging factors up to `largest`, rising.
    #[must_use]
    pub fn averaging_factors(self, largest: usize) -> Vec<usize> {
        let decades = || (0..).map_while(|power| 10_usize.checked_pow(power));
        match self {
            Self::Octave => (0..usize::BITS)
                .map(|power| 1 << power)
                .take_while(|&factor| factor <= largest)
                .collect(),
            Self::Decade => decades()
                .flat_map(|decade| [1, 2, 5].map(|step: usize| decade.saturating_mul(step)))
                .take_while(|&factor| factor <= largest)
                .collect(),
            Self::All => {
                let affordable = ALL_WORK / largest.max(1);
                spread(largest, affordable.clamp(ALL_MIN, ALL_MAX))
            }
        }
    }
}

/// At most `count` factors from 1 to `largest`: each in its turn takes an equal part of the way that is
/// left, on a logarithmic scale, or one step if that is longer.
fn spread(largest: usize, count: usize) -> Vec<usize> {
    let mut factors = Vec::with_capacity(count);
    let mut factor = 1;
    while factor <= largest && factors.len() < count {
        factors.push(factor);
        let left = (count - factors.len()).max(1) as f64;
        let ratio = (largest as f64 / factor as f64).powf(1.0 / left);
        let next = interval::round_to_count(factor as f64 * ratio);
        factor = next.max(factor + 1);
    }
    factors
}

/// How a curve is estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AllanOptions {
    /// The mean square taken.
    pub estimator: AllanEstimator,
    /// The averaging times.
    pub taus: AveragingTimes,
    /// Two-sided coverage of the intervals, between 0 and 1.
    pub confidence: f64,
}

impl Default for AllanOptions {
    fn default() -> Self {
        Self {
            estimator: AllanEstimator::default(),
            taus: AveragingTimes::Octave,
            confidence: CONFIDENCE,
        }
    }
}

/// One point of a curve with what was found about the noise at its averaging time.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct AllanVariantPoint {
    /// The deviation, its interval, degrees of freedom and number of differences.
    pub point: AllanPoint,
    /// Noise whose degrees of freedom the interval uses.
    pub noise: PowerLaw,
    /// Whether the noise was identified at this very tau; otherwise it is that of the longest
    /// shorter one that has the blocks (white rate noise if there is none).
    pub noise_identified: bool,
    /// Differences left out because they touch a missing sample.
    pub left_out: usize,
}

/// A deviation of the Allan family over a grid of averaging times.
///
/// * `rate_deg_per_h`: `[n]`, deg/h, uniformly spaced; NaN marks a missing sample.
/// * `sample_period_s`: s, > 0.
///
/// The grid ends where the record is two averaging times longer than one difference: m <= n/4 for
/// the Allan deviations, n/5 for the modified and the Hadamard deviation, which span three tau.
/// Everything else as [`allan_variant_at`].
#[must_use]
pub fn allan_variant(
    rate_deg_per_h: &[f64],
    sample_period_s: f64,
    options: &AllanOptions,
) -> Vec<AllanVariantPoint> {
    let factors = grid(rate_deg_per_h.len(), options);
    allan_variant_at(rate_deg_per_h, sample_period_s, &factors, options)
}

/// Averaging factors of a record of so many samples.
fn grid(samples: usize, options: &AllanOptions) -> Vec<usize> {
    let largest = samples / (options.estimator.span() + 2);
    options.taus.averaging_factors(largest)
}

/// As [`allan_variant`], with differences that span some gaps of the record.
///
/// A difference exists where its angles do: none within a gap does, that on either side of a spanned one does.
/// Where the mean rate over a gap is only assumed, a difference is left out unless nine tenths of each of its
/// mean rates are words. The modified deviation averages angles and spans no gap.
#[must_use]
pub fn allan_variant_across(
    rate_deg_per_h: &[f64],
    sample_period_s: f64,
    options: &AllanOptions,
    bridges: &[Bridge],
) -> Vec<AllanVariantPoint> {
    let estimator = options.estimator;
    if bridges.is_empty() || estimator == AllanEstimator::Modified {
        return allan_variant(rate_deg_per_h, sample_period_s, options);
    }
    let bridged = BridgedAngle::of(rate_deg_per_h, bridges);
    let factors = grid(rate_deg_per_h.len(), options);
    let order = estimator.differences().order;
    let find = |&m: &usize| {
        let holds = |start: usize| bridged.holds(start, m, estimator.span());
        let (sum, count) = sum_of_squares(&bridged.angle, m, estimator, holds);
        FoundSum {
            averaged_samples: m,
            noise: identify_noise(&bridged.angle, Some(&bridged.missing), m, order),
            sum,
            weight: count,
            count,
            possible: possible_differences(bridged.angle.len(), m, estimator),
        }
    };
    let found: Vec<FoundSum> = factors.par_iter().map(find).collect();
    let angles = bridged.angle.len();
    points_of(found.into_iter(), angles, sample_period_s, options)
}

/// A deviation of the Allan family at given averaging factors.
///
/// With the angle `x` integrated from the rate (in units of one sample period), d the order of the
/// difference and M the differences available:
/// Allan `sum (x[k+2m] - 2x[k+m] + x[k])^2 / (2 m^2 M)`;
/// modified `sum (sum_(i=k)^(k+m-1) (x[i+2m] - 2x[i+m] + x[i]))^2 / (2 m^4 M)`;
/// Hadamard `sum (x[k+3m] - 3x[k+2m] + 3x[k+m] - x[k])^2 / (6 m^2 M)`.
/// Starts k are one sample apart, or m samples for the plain forms. A difference that touches a
/// missing sample is left out and counted; a tau without any difference gives no point.
///
/// The noise is identified at each tau (lag-1 autocorrelation), the interval is chi-square with the
/// degrees of freedom of that noise (Greenhall and Riley), times the share of
/// differences that gaps have left. `options.taus` is not used.
///
/// Source: NIST SP 1065 (Riley 2008), equations 10, 11, 15, 18 to 20.
#[must_use]
pub fn allan_variant_at(
    rate_deg_per_h: &[f64],
    sample_period_s: f64,
    averaging_factors: &[usize],
    options: &AllanOptions,
) -> Vec<AllanVariantPoint> {
    let missing = missing_before(rate_deg_per_h);
    let missing = missing.as_deref();
    let estimator = options.estimator;
    let factors: Vec<usize> = averaging_factors
        .iter()
        .copied()
        .filter(|&m| m > 0 && m <= rate_deg_per_h.len() / estimator.span())
        .collect();
    let order = estimator.differences().order;
    let angles = rate_deg_per_h.len() + 1;
    let possible = |m: usize| possible_differences(angles, m, estimator);
    // The overlapping deviation of a whole record goes through the cache once for all tau.
    let is_whole = missing.is_none() && estimator == AllanEstimator::Overlapping;
    let (identified, sums): (Vec<Option<PowerLaw>>, Vec<(f64, usize)>) = if is_whole {
        let identified = identify_noise_of_record(rate_deg_per_h, &factors, order);
        let sums = second_difference_sums_of_record(rate_deg_per_h, &factors).into_iter();
        let sums = sums.zip(&factors).map(|(sum, &m)| (sum, possible(m)));
        (identified, sums.collect())
    } else {
        let angle = angle_about_mean(rate_deg_per_h);
        let find = |&m: &usize| {
            let reach = reach(m, estimator);
            let whole = |start: usize| missing.is_none_or(|sum| sum[start + reach] == sum[start]);
            let noise = identify_noise(&angle, missing, m, order);
            (noise, sum_of_squares(&angle, m, estimator, whole))
        };
        factors.par_iter().map(find).unzip()
    };
    let found = factors.iter().zip(identified).zip(sums);
    let found = found.map(|((&m, noise), (sum, count))| FoundSum {
        averaged_samples: m,
        noise,
        sum,
        weight: count,
        count,
        possible: possible(m),
    });
    points_of(found, angles, sample_period_s, options)
}

/// What was found at an averaging factor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FoundSum {
    /// The factor.
    pub(crate) averaged_samples: usize,
    /// Noise that was identified at it.
    pub(crate) noise: Option<PowerLaw>,
    /// Sum of the squared differences.
    pub(crate) sum: f64,
    /// Starts that the sum stands for.
    pub(crate) weight: usize,
    /// Differences it is made of.
    pub(crate) count: usize,
    /// Differences of a record that misses no sample.
    pub(crate) possible: usize,
}

/// The points of a curve of the family.
///
/// * `found`: with the averaging factor rising.
/// * `angles`: angles of the record, one more than its samples.
pub(crate) fn points_of(
    found: impl Iterator<Item = FoundSum>,
    angles: usize,
    sample_period_s: f64,
    options: &AllanOptions,
) -> Vec<AllanVariantPoint> {
    let estimator = options.estimator;
    let mut noise = PowerLaw::RateWhite;
    let mut points = Vec::new();
    for at in found {
        noise = at.noise.unwrap_or(noise);
        if at.count == 0 {
            continue;
        }
        let m = at.averaged_samples;
        let m_f = m as f64;
        let scale = match estimator {
            AllanEstimator::Overlapping | AllanEstimator::Plain => 2.0 * m_f * m_f,
            AllanEstimator::Modified => 2.0 * m_f * m_f * m_f * m_f,
            AllanEstimator::Hadamard | AllanEstimator::PlainHadamard => 6.0 * m_f * m_f,
        };
        let whole = combined_degrees_of_freedom(noise, estimator.differences(), angles, m);
        let freedom = (whole * at.count as f64 / at.possible as f64).max(1.0);
        let deviation = (at.sum / (scale * at.weight as f64)).sqrt();
        points.push(AllanVariantPoint {
            point: AllanPoint {
                tau_s: m_f * sample_period_s,
                averaged_samples: m,
                deviation_deg_per_h: interval::deviation_at(deviation, freedom, options.confidence),
                degrees_of_freedom: freedom,
                count: at.count,
            },
            noise,
            noise_identified: at.noise.is_some(),
            left_out: at.possible - at.count,
        });
    }
    points
}

/// Number of missing samples before each angle, or nothing if the record is whole.
fn missing_before(rate_deg_per_h: &[f64]) -> Option<Vec<usize>> {
    rate_deg_per_h.iter().any(|rate| rate.is_nan()).then(|| {
        let mut missing = Vec::with_capacity(rate_deg_per_h.len() + 1);
        let mut sum = 0;
        missing.push(sum);
        for rate in rate_deg_per_h {
            sum += usize::from(rate.is_nan());
            missing.push(sum);
        }
        missing
    })
}

/// Rate samples that one difference takes in.
fn reach(m: usize, estimator: AllanEstimator) -> usize {
    match estimator {
        // The last angle of the averages is one short of three averaging times.
        AllanEstimator::Modified => 3 * m - 1,
        _ => estimator.span() * m,
    }
}

/// Differences in a record without gaps.
fn possible_differences(angles: usize, m: usize, estimator: AllanEstimator) -> usize {
    let stride = if estimator.differences().overlapping {
        1
    } else {
        m
    };
    angles
        .checked_sub(reach(m, estimator) + 1)
        .map_or(0, |last| last / stride + 1)
}

/// Sum of the squared differences that are whole, and their number.
///
/// * `whole`: whether that which starts at an angle is.
fn sum_of_squares(
    angle: &[f64],
    m: usize,
    estimator: AllanEstimator,
    whole: impl Fn(usize) -> bool,
) -> (f64, usize) {
    let possible = possible_differences(angle.len(), m, estimator);
    let mut total = (0.0, 0);
    let mut add = |start: usize, difference: f64| {
        if whole(start) {
            total.0 += difference * difference;
            total.1 += 1;
        }
    };
    let second = |k: usize| (angle[k + 2 * m] - angle[k + m]) - (angle[k + m] - angle[k]);
    let third = |k: usize| second(k + m) - second(k);
    match estimator {
        AllanEstimator::Overlapping => (0..possible).for_each(|k| add(k, second(k))),
        AllanEstimator::Plain => (0..possible).for_each(|k| add(k * m, second(k * m))),
        AllanEstimator::Hadamard => (0..possible).for_each(|k| add(k, third(k))),
        AllanEstimator::PlainHadamard => (0..possible).for_each(|k| add(k * m, third(k * m))),
        AllanEstimator::Modified => {
            let mut start = 0;
            while start < possible {
                // Summed afresh now and then: the error of a running sum grows with its length.
                let end = (start + RUN_PER_TAU * m).min(possible);
                let mut window: f64 = (start..start + m).map(second).sum();
                add(start, window);
                for k in start + 1..end {
                    window += third(k - 1);
                    add(k, window);
                }
                start = end;
            }
        }
    }
    total
}
