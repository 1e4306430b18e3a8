//! Overlapping Allan deviation of a rate record.

use rayon::prelude::*;

use super::angle::sums::second_difference_sums_of_record;
use super::bridges::BridgedAngle;
use super::gaps::{missing_stretches, second_difference_sums_with_gaps};
use crate::metrics::estimate::interval;
use crate::metrics::estimate::interval::round_to_count;
use crate::metrics::estimate::value::Estimate;
use crate::signal::Bridge;

/// Averaging factors per decade of tau.
const POINTS_PER_DECADE: f64 = 12.0;

/// One point of an Allan deviation curve.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct AllanPoint {
    /// Averaging time, s.
    pub tau_s: f64,
    /// Samples averaged, m.
    pub averaged_samples: usize,
    /// Overlapping Allan deviation with its chi-square interval, deg/h.
    pub deviation_deg_per_h: Estimate,
    /// Equivalent degrees of freedom behind the interval.
    pub degrees_of_freedom: f64,
    /// Second differences averaged.
    pub count: usize,
}

impl AllanPoint {
    /// The point with another number of degrees of freedom and the interval that follows.
    #[must_use]
    pub fn with_degrees_of_freedom(self, degrees_of_freedom: f64) -> Self {
        Self {
            deviation_deg_per_h: interval::deviation(
                self.deviation_deg_per_h.value,
                degrees_of_freedom,
            ),
            degrees_of_freedom,
            ..self
        }
    }

    /// The point of an averaging factor, with the degrees of freedom of white noise.
    pub(crate) fn of_differences(
        averaged_samples: usize,
        differences: Differences,
        angle_count: usize,
        sample_period_s: f64,
    ) -> Self {
        let m = averaged_samples as f64;
        // The angle is in units of one sample period, which cancels against tau.
        let deviation = (differences.sum / (2.0 * m * m * differences.weight as f64)).sqrt();
        let white = degrees_of_freedom(NoiseType::White, angle_count, averaged_samples);
        let freedom = (white * differences.share).max(1.0);
        Self {
            tau_s: m * sample_period_s,
            averaged_samples,
            deviation_deg_per_h: interval::deviation(deviation, freedom),
            degrees_of_freedom: freedom,
            count: differences.count,
        }
    }

    /// The point with another Allan variance, (deg/h)^2, whose interval is not looked at.
    pub(crate) fn with_variance(mut self, variance: f64) -> Self {
        self.deviation_deg_per_h.value = variance.sqrt();
        self
    }

    /// Allan variance, (deg/h)^2.
    #[must_use]
    pub fn variance(&self) -> f64 {
        self.deviation_deg_per_h.value * self.deviation_deg_per_h.value
    }
}

/// Second differences of the angle at one averaging factor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Differences {
    /// Sum of their squares.
    pub(crate) sum: f64,
    /// Starts that the sum stands for.
    pub(crate) weight: usize,
    /// How many they are.
    pub(crate) count: usize,
    /// Share of those possible.
    pub(crate) share: f64,
}

/// Noise type that sets the degrees of freedom of an Allan variance of rate.
///
/// Rate takes the place of frequency in the clock literature, angle that of phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoiseType {
    /// Angle quantisation: white phase modulation.
    Quantisation,
    /// Angle random walk: white frequency modulation.
    White,
    /// Bias instability: flicker frequency modulation.
    Flicker,
    /// Rate random walk, and the formal stand-in for a rate ramp: random walk frequency modulation.
    RandomWalk,
}

/// Equivalent degrees of freedom of the overlapping Allan variance.
///
/// * `angle_count`: number of angle points, one more than the rate samples.
/// * `averaged_samples`: m, at least 1; `angle_count > 2 m`.
///
/// White rate noise: `(3(N-1)/2m - 2(N-2)/N) 4m^2/(4m^2+5)`, about `1.5 T/tau - 2`; flicker:
/// `2(N-2)^2/(2.3N-4.9)` for m = 1, else `5N^2/4m(N+3m)`; random walk:
/// `((N-2)/m) ((N-1)^2-3m(N-1)+4m^2)/(N-3)^2`; quantisation: `(N+1)(N-2m)/2(N-m)`. Never below 1.
///
/// Source: NIST SP 1065 (Riley 2008), section 5.4.1, table 4; Howe, Allan, Barnes 1981.
#[must_use]
pub fn degrees_of_freedom(noise: NoiseType, angle_count: usize, averaged_samples: usize) -> f64 {
    let n = angle_count as f64;
    let m = averaged_samples as f64;
    let freedom = match noise {
        NoiseType::Quantisation => (n + 1.0) * (n - 2.0 * m) / (2.0 * (n - m)),
        NoiseType::White => {
            let four_m_squared = 4.0 * m * m;
            (3.0 * (n - 1.0) / (2.0 * m) - 2.0 * (n - 2.0) / n) * four_m_squared
                / (four_m_squared + 5.0)
        }
        NoiseType::Flicker if averaged_samples == 1 => {
            2.0 * (n - 2.0) * (n - 2.0) / (2.3 * n - 4.9)
        }
        NoiseType::Flicker => 5.0 * n * n / (4.0 * m * (n + 3.0 * m)),
        NoiseType::RandomWalk => {
            let span = n - 1.0;
            (n - 2.0) / m * (span * span - 3.0 * m * span + 4.0 * m * m)
                / ((n - 3.0) * (n - 3.0)).max(1.0)
        }
    };
    freedom.max(1.0)
}

/// Overlapping Allan deviation at about twelve averaging times per decade.
///
/// `AVAR(mT) = sum (theta[k+2m] - 2 theta[k+m] + theta[k])^2 / (2 (mT)^2 (N - 2m))` over the angle
/// `theta` integrated from the rate, for every distinct m on a logarithmic grid from 1 to a quarter
/// of the record. Degrees of freedom are those of white noise; a fit may refine them
/// ([`AllanPoint::with_degrees_of_freedom`]).
///
/// * `rate_deg_per_h`: `[n]`, deg/h, uniformly spaced; NaN marks a missing sample, and differences that
///   touch one are left out.
/// * `sample_period_s`: s, > 0.
///
/// Fewer than four samples give no point.
///
/// Source: IEEE Std 952-1997 annex C; NIST SP 1065 section 5.2.4.
///
/// ```
/// use fogbench::metrics::overlapping_allan;
/// use fogbench::random::Streams;
///
/// // White noise of 2 deg/h in words of 10 ms: sigma(tau) = 2 sqrt(0.01 / tau).
/// let mut words = vec![0.0; 20_000];
/// Streams::new(1, 0).stream("words").fill_normal(&mut words);
/// words.iter_mut().for_each(|word| *word *= 2.0);
/// for point in overlapping_allan(&words, 0.01).iter().take(20) {
///     let expected = 2.0 * (0.01 / point.tau_s).sqrt();
///     assert!((point.deviation_deg_per_h.value / expected - 1.0).abs() < 0.1);
/// }
/// ```
#[must_use]
pub fn overlapping_allan(rate_deg_per_h: &[f64], sample_period_s: f64) -> Vec<AllanPoint> {
    let factors = averaging_factors(rate_deg_per_h.len() / 4);
    overlapping_allan_at(rate_deg_per_h, sample_period_s, &factors)
}

/// Overlapping Allan deviation at given averaging factors (each at most half the samples).
///
/// As [`overlapping_allan`]; factors for which no second difference exists are left out.
#[must_use]
pub fn overlapping_allan_at(
    rate_deg_per_h: &[f64],
    sample_period_s: f64,
    averaging_factors: &[usize],
) -> Vec<AllanPoint> {
    let angle_count = rate_deg_per_h.len() + 1;
    let factors: Vec<usize> = averaging_factors
        .iter()
        .copied()
        .filter(|&m| m > 0 && 2 * m < angle_count)
        .collect();
    let possible = |m: usize| angle_count - 2 * m;
    let missing = missing_stretches(rate_deg_per_h);
    let sums: Vec<(f64, usize)> = if missing.is_empty() {
        let sums = second_difference_sums_of_record(rate_deg_per_h, &factors).into_iter();
        let counts = factors.iter().map(|&m| possible(m));
        sums.zip(counts).collect()
    } else {
        second_difference_sums_with_gaps(rate_deg_per_h, &missing, &factors)
    };
    points_of_sums(&factors, sums, angle_count, sample_period_s)
}

/// Overlapping Allan deviation whose differences span some gaps of the record.
///
/// As [`overlapping_allan`]; which differences exist says
/// [`allan_variant_across`](super::variants::allan_variant_across).
#[must_use]
pub fn overlapping_allan_across(
    rate_deg_per_h: &[f64],
    sample_period_s: f64,
    bridges: &[Bridge],
) -> Vec<AllanPoint> {
    if bridges.is_empty() {
        return overlapping_allan(rate_deg_per_h, sample_period_s);
    }
    let bridged = BridgedAngle::of(rate_deg_per_h, bridges);
    let factors = averaging_factors(rate_deg_per_h.len() / 4);
    let sum = |&m: &usize| bridged.second_difference_sum(m);
    let sums: Vec<(f64, usize)> = factors.par_iter().map(sum).collect();
    points_of_sums(&factors, sums, bridged.angle.len(), sample_period_s)
}

/// Points of averaging factors with their sums of squared differences and the numbers of these.
fn points_of_sums(
    factors: &[usize],
    sums: Vec<(f64, usize)>,
    angle_count: usize,
    sample_period_s: f64,
) -> Vec<AllanPoint> {
    let supported = factors
        .iter()
        .zip(sums)
        .filter(|(_, (_, count))| *count > 0);
    supported
        .map(|(&m, (sum, count))| {
            let share = count as f64 / (angle_count - 2 * m) as f64;
            let differences = Differences {
                sum,
                weight: count,
                count,
                share,
            };
            AllanPoint::of_differences(m, differences, angle_count, sample_period_s)
        })
        .collect()
}

/// Distinct averaging factors on a logarithmic grid from 1 to `largest`.
pub(crate) fn averaging_factors(largest: usize) -> Vec<usize> {
    let mut factors: Vec<usize> = (0_i32..)
        .map(|step| round_to_count(10.0_f64.powf(f64::from(step) / POINTS_PER_DECADE)))
        .take_while(|&factor| factor <= largest)
        .collect();
    factors.dedup();
    factors
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_distinct_and_reach_a_quarter_of_the_record() {
        let factors = averaging_factors(1000);
        assert!(factors.windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!((factors[0], *factors.last().unwrap()), (1, 1000));
    }

    #[test]
    fn a_constant_rate_has_no_allan_deviation() {
        let points = overlapping_allan(&[1.25; 64], 0.1);
        assert!(
            points
                .iter()
                .all(|point| point.deviation_deg_per_h.value < 1e-12)
        );
    }
}
