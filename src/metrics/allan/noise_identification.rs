//! Which power law the noise follows at an averaging time.

use rayon::prelude::*;

use super::angle::{angles_at_multiples, starts_of_parts};

/// Fewest block means from which the lag-1 autocorrelation tells one power law from the next.
const MEANS_MIN: usize = 30;

/// Most block means looked at, from the start of the record: their autocorrelation is then known to
/// 0.003, where the laws lie 0.3 and more apart.
pub(crate) const MEANS_MAX: usize = 1 << 17;

/// Least order of integration that calls for another difference; white noise has 0.
const DIFFERENCE_FROM: f64 = 0.25;

/// Standard errors by which the autocorrelation of angle noise lies below that of white rate noise.
const ANGLE_NOISE_SIGNIFICANCE: f64 = 2.0;

/// Noise whose rate has a spectrum `f^alpha`.
///
/// Rate takes the place of frequency in the clock literature, angle that of phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PowerLaw {
    /// White angle (angle quantisation), alpha 2.
    AngleWhite,
    /// Flicker angle, alpha 1.
    AngleFlicker,
    /// White rate (angle random walk), alpha 0.
    RateWhite,
    /// Flicker rate (bias instability), alpha -1.
    RateFlicker,
    /// Rate random walk, alpha -2.
    RateRandomWalk,
    /// Flicker walk of the rate, alpha -3; the Hadamard deviation alone converges.
    RateFlickerWalk,
    /// Random run of the rate, alpha -4; the Hadamard deviation alone converges.
    RateRandomRun,
}

impl PowerLaw {
    /// All laws, alpha falling.
    pub const ALL: [Self; 7] = [
        Self::AngleWhite,
        Self::AngleFlicker,
        Self::RateWhite,
        Self::RateFlicker,
        Self::RateRandomWalk,
        Self::RateFlickerWalk,
        Self::RateRandomRun,
    ];

    /// Exponent of the rate's spectrum.
    #[must_use]
    pub fn alpha(self) -> i32 {
        match self {
            Self::AngleWhite => 2,
            Self::AngleFlicker => 1,
            Self::RateWhite => 0,
            Self::RateFlicker => -1,
            Self::RateRandomWalk => -2,
            Self::RateFlickerWalk => -3,
            Self::RateRandomRun => -4,
        }
    }

    /// Name for people, after the quantity that is integrated or not: `white angle`, `white rate`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::AngleWhite => "white angle",
            Self::AngleFlicker => "flicker angle",
            Self::RateWhite => "white rate",
            Self::RateFlicker => "flicker rate",
            Self::RateRandomWalk => "random walk rate",
            Self::RateFlickerWalk => "flicker walk rate",
            Self::RateRandomRun => "random run rate",
        }
    }

    /// The law nearest to an exponent, the steeper of two.
    pub(crate) fn nearest_of_all(alpha: f64) -> Self {
        Self::nearest(alpha, 3)
    }

    /// The law nearest to an exponent among those a difference of this order has a variance for.
    fn nearest(alpha: f64, order: usize) -> Self {
        let steepest = if order >= 3 { -4 } else { -2 };
        let distance = |law: Self| (f64::from(law.alpha()) - alpha).abs();
        Self::ALL
            .into_iter()
            .filter(|law| law.alpha() >= steepest)
            .min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
            .unwrap_or(Self::RateWhite)
    }
}

/// The power law at an averaging time, from the lag-1 autocorrelation of the block means.
///
/// The means of `averaged_samples` rates, freed of a straight line, have the lag-1 autocorrelation
/// r; `delta = r/(1+r)` is the order of integration of the noise that shows it. While it is 0.25 or
/// more the means are differenced, once at most for the second differences of the Allan deviation
/// and twice for third ones (`order`). After d differences `alpha = -2 (delta + d)`, rounded.
///
/// * `angle`: `[n + 1]`, integrated rate; `missing`: number of missing rates before each angle.
///   Means over a missing rate are left out, pairs likewise.
///
/// Angle noise has many degrees of freedom, and thirty means of white rate noise pass for it one
/// time in five: it is taken for angle noise only where r, corrected for the line (-2/n), lies two
/// standard errors of `1/sqrt(n)` below zero. Without this a 90 % interval holds 83 %.
///
/// Of a long record the first 131 072 means are used. Nothing if there are fewer than 30, or if they do not vary.
///
/// Source: Riley and Greenhall, Power law noise identification using the lag 1 autocorrelation,
/// 18th EFTF (2004); NIST SP 1065 section 5.5.6.
pub(crate) fn identify_noise(
    angle: &[f64],
    missing: Option<&[usize]>,
    averaged_samples: usize,
    order: usize,
) -> Option<PowerLaw> {
    let m = averaged_samples;
    let means: Vec<f64> = (0..means_of(angle.len(), m))
        .map(|block| {
            let (start, end) = (block * m, (block + 1) * m);
            if missing.is_some_and(|sum| sum[end] > sum[start]) {
                f64::NAN
            } else {
                (angle[end] - angle[start]) / m as f64
            }
        })
        .collect();
    identify_by_means(means, order)
}

/// Means of so many samples that are used of a record of so many angles.
fn means_of(angles: usize, averaged_samples: usize) -> usize {
    (angles.saturating_sub(1) / averaged_samples).min(MEANS_MAX)
}

/// Angles that are held at a time, 8 MB.
const ANGLES_HELD: usize = 1 << 20;

/// As [`identify_noise`] of every averaging factor of a record that misses nothing, without its angles.
pub(crate) fn identify_noise_of_record(
    rates: &[f64],
    factors: &[usize],
    order: usize,
) -> Vec<Option<PowerLaw>> {
    let (mean, starts) = starts_of_parts(rates);
    let mut identified = Vec::with_capacity(factors.len());
    let mut left = factors;
    while !left.is_empty() {
        let held = left.iter().scan(0, |sum, &m| {
            *sum += means_of(rates.len() + 1, m) + 1;
            Some(*sum)
        });
        let together = held.take_while(|held| *held <= ANGLES_HELD).count().max(1);
        let (now, later) = left.split_at(together);
        let angles = angles_at_multiples(rates, (mean, &starts), now, MEANS_MAX);
        let identify = |(angle, &m): (&Vec<f64>, &usize)| {
            let means = angle.windows(2).map(|two| (two[1] - two[0]) / m as f64);
            identify_by_means(means.collect(), order)
        };
        identified.par_extend(angles.par_iter().zip(now).map(identify));
        left = later;
    }
    identified
}

/// As [`identify_noise`] by the block means themselves, of which missing ones are NaN.
pub(crate) fn identify_by_means(mut means: Vec<f64>, order: usize) -> Option<PowerLaw> {
    let present = means.iter().filter(|mean| !mean.is_nan()).count();
    if present < MEANS_MIN {
        return None;
    }
    let count = present as f64;
    remove_line(&mut means);
    let mut differences = 0;
    loop {
        let r = lag_one_autocorrelation(&means)?;
        let delta = r / (1.0 + r);
        if delta < DIFFERENCE_FROM || differences + 1 >= order {
            let alpha = -2.0 * (delta + differences as f64);
            if alpha > 0.0 && r + 2.0 / count > -ANGLE_NOISE_SIGNIFICANCE / count.sqrt() {
                return Some(PowerLaw::RateWhite);
            }
            return Some(PowerLaw::nearest(alpha, order));
        }
        means = means.windows(2).map(|two| two[1] - two[0]).collect();
        differences += 1;
    }
}

/// Takes the straight line of least squares away from the values that are there.
pub(crate) fn remove_line(values: &mut [f64]) {
    let pairs = || {
        let indexed = values.iter().enumerate();
        indexed
            .filter(|(_, value)| !value.is_nan())
            .map(|(index, value)| (index as f64, *value))
    };
    let count = pairs().count() as f64;
    let mean_t = pairs().map(|(t, _)| t).sum::<f64>() / count;
    let mean_v = pairs().map(|(_, value)| value).sum::<f64>() / count;
    let square: f64 = pairs().map(|(t, _)| (t - mean_t) * (t - mean_t)).sum();
    let product: f64 = pairs().map(|(t, v)| (t - mean_t) * (v - mean_v)).sum();
    let slope = if square > 0.0 { product / square } else { 0.0 };
    for (index, value) in values.iter_mut().enumerate() {
        *value -= mean_v + slope * (index as f64 - mean_t);
    }
}

/// Sum of lag-1 products over the sum of squares, both about the mean; missing values left out.
fn lag_one_autocorrelation(values: &[f64]) -> Option<f64> {
    let present = || values.iter().copied().filter(|value| !value.is_nan());
    let count = present().count();
    let mean = present().sum::<f64>() / count as f64;
    let square: f64 = present().map(|value| (value - mean) * (value - mean)).sum();
    let (mut product, mut pairs) = (0.0, 0_usize);
    for two in values.windows(2) {
        let term = (two[0] - mean) * (two[1] - mean);
        if !term.is_nan() {
            product += term;
            pairs += 1;
        }
    }
    // Gaps take more pairs than values; a whole record has one pair fewer than values.
    let completed = (count as f64 - 1.0) / pairs as f64;
    (square > 0.0 && pairs > 0).then(|| product * completed / square)
}
