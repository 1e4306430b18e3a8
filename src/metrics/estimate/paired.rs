//! How sure the mean of a difference is whose slow part is small against its ends.
//!
//! What a filter makes of a word it gives back a little later: the mean of output minus gain times
//! input hardly scatters but for the words that the two ends of the record cut off. Its variance over
//! n samples is `S/n + E/n^2`, where S is the spectral density at zero frequency and E that of the
//! ends. Blocks of a twentieth of the record show `20 E/n^2` in place of `E/n^2`, an interval 4.5
//! times too wide.
//!
//! Source: derived. S is taken from tapered blocks, whose ends count for next to nothing, E from what
//! plain blocks have beyond it.

use std::f64::consts::TAU;

use super::influence::Spread;
use super::interval;

/// Tapered blocks that fit beside each other; they overlap by half.
const LONG_BLOCKS: usize = 16;

/// Cycles of a swing from which on a tapered block tells its frequency from zero.
const CYCLES_APART: f64 = 4.0;

/// Plain blocks, at most, and the reaches of the filter that each spans at least.
const SHORT_BLOCKS_MAX: usize = 2000;
const REACHES_PER_BLOCK: usize = 16;

/// The same where the density is known: so long that the two ends of a block have nothing in common.
const REACHES_PER_KNOWN_BLOCK: usize = 2;

/// Fewest degrees of freedom of ends that plain blocks show.
const ENDS_FREEDOM_MIN: f64 = 5.0;

/// Fewest samples of a tapered block.
const SAMPLES_MIN: usize = 4;

/// Independent windows over windows where Hann windows overlap by half: neighbours' sums correlate by
/// 1/6, their squares by 1/36.
const WINDOW_FREEDOM: f64 = 1.0 / (1.0 + 2.0 / 36.0);

/// Values by their index: those of a slice, or made one by one where a record of them would be as long as
/// that of a channel.
pub(crate) trait Values: Copy {
    /// How many there are.
    fn count(self) -> usize;
    /// The value of an index below that.
    fn at(self, index: usize) -> f64;
    /// All of them in their order.
    fn each(self) -> impl Iterator<Item = f64> {
        (0..self.count()).map(move |index| self.at(index))
    }
}

impl Values for &[f64] {
    fn count(self) -> usize {
        self.len()
    }

    fn at(self, index: usize) -> f64 {
        self[index]
    }
}

/// Values that a function makes of their index.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Made<F> {
    /// How many there are.
    pub(crate) count: usize,
    /// What makes them.
    pub(crate) of: F,
}

impl<F: Fn(usize) -> f64 + Copy> Values for Made<F> {
    fn count(self) -> usize {
        self.count
    }

    fn at(self, index: usize) -> f64 {
        (self.of)(index)
    }
}

/// How the mean of values scatters with their number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MeanScatter {
    /// S and its degrees of freedom.
    density: Spread,
    /// E and its degrees of freedom.
    ends: Spread,
}

impl MeanScatter {
    /// Of values whose ends reach over `reach` samples.
    pub(crate) fn of(values: impl Values, reach: usize) -> Self {
        let count = values.count();
        let long = count / LONG_BLOCKS;
        if long < SAMPLES_MIN {
            let freedom = count.max(2) as f64 - 1.0;
            let of = |variance: f64| Spread { variance, freedom };
            return Self {
                density: of(interval::sample_variance(
                    &values.each().collect::<Vec<_>>(),
                )),
                ends: of(0.0),
            };
        }
        let density = tapered_density(values, long);
        Self {
            density,
            ends: ends(
                values,
                density,
                whole(REACHES_PER_BLOCK * reach, None)
                    .max(count as f64 / SHORT_BLOCKS_MAX as f64)
                    .min(long as f64),
            ),
        }
    }

    /// Of the differences between a channel and the response to its input.
    ///
    /// * `differences`: channel minus response times input, whose mean is asked for.
    /// * `aligned`: the same with the input delayed as the channel is, which leaves the density at
    ///   zero frequency and takes what is near it: a delay of D samples has `(2 pi f D)^2` there, which
    ///   windows do not tell from it.
    /// * `cycle`: samples of a swing, whose phase the ends of all blocks share.
    pub(crate) fn of_paired(
        differences: impl Values,
        aligned: impl Values,
        reach: usize,
        cycle: Option<f64>,
    ) -> Self {
        let long = aligned.count() / LONG_BLOCKS;
        if long < SAMPLES_MIN {
            return Self::of(differences, reach);
        }
        let density = tapered_density(aligned, long);
        Self::of_blocks(differences, density, REACHES_PER_BLOCK * reach, cycle)
    }

    /// Of the differences that are left of a swing, of so many samples a cycle.
    ///
    /// What weights on their way add to its noise stands about the frequency of the swing. A tapered block
    /// of few cycles does not tell it from frequency zero, but where it holds two whole ones or more: these
    /// are zeros of its window.
    pub(crate) fn of_paired_about_swing(
        differences: impl Values,
        aligned: impl Values,
        reach: usize,
        cycle: f64,
    ) -> Self {
        let long = (aligned.count() / LONG_BLOCKS) as f64;
        let whole = interval::round_to_count((long / cycle).ceil().max(2.0) * cycle);
        if long >= CYCLES_APART * cycle || 2 * whole > aligned.count() {
            return Self::of_paired(differences, aligned, reach, None);
        }
        let density = tapered_density(aligned, whole);
        let least = REACHES_PER_BLOCK * reach;
        Self::of_blocks(differences, density, least, Some(cycle))
    }

    /// Of differences whose spectral density at zero frequency is known.
    ///
    /// * `cycle`: samples of a swing, whose phase the ends of all blocks share.
    pub(crate) fn of_known_density(
        differences: impl Values,
        density: Spread,
        reach: usize,
        cycle: Option<f64>,
    ) -> Self {
        Self::of_blocks(differences, density, REACHES_PER_KNOWN_BLOCK * reach, cycle)
    }

    /// Of a density and ends that are both known.
    pub(crate) fn known(density: Spread, ends: Spread) -> Self {
        Self { density, ends }
    }

    /// The same with the ends of a response in closed form, where the values hold too few blocks to show
    /// their own.
    ///
    /// * `response`: what the filter makes of an impulse, by age.
    /// * `input`: its noise, correlated over `reach` samples.
    pub(crate) fn or_ends_of(self, response: &[f64], input: &[f64], reach: usize) -> Self {
        if self.ends.freedom >= ENDS_FREEDOM_MIN {
            return self;
        }
        let ends = ends_of_response(response, input, reach);
        Self { ends, ..self }
    }

    /// Of differences with this density, in blocks of so many samples at least.
    fn of_blocks(
        differences: impl Values,
        density: Spread,
        least: usize,
        cycle: Option<f64>,
    ) -> Self {
        let short = whole(least, cycle).max(differences.count() as f64 / SHORT_BLOCKS_MAX as f64);
        Self {
            density,
            ends: ends(
                differences,
                density,
                short.min(differences.count() as f64 / 2.0),
            ),
        }
    }

    /// Spread of the mean of so many values.
    pub(crate) fn over(&self, count: usize) -> Spread {
        self.density_over(count).plus(self.ends_over(count))
    }

    /// The same without what the ends do to it.
    pub(crate) fn density_over(&self, count: usize) -> Spread {
        self.density.scaled((count.max(1) as f64).sqrt().recip())
    }

    /// What the two ends alone do to it.
    pub(crate) fn ends_over(&self, count: usize) -> Spread {
        self.ends.scaled(1.0 / count.max(1) as f64)
    }
}

/// E of what a response makes of its input, less its gain times that.
///
/// The mean of the output lacks, of the words at the end of the record, what they still add to it, and has
/// that of the words before: of the word k before either end `c_k = h_(k+1) + h_(k+2) + ...`, with the
/// variance `2 sum_kl c_k c_l R(k - l)` of both ends, R the autocovariance of the input.
fn ends_of_response(response: &[f64], input: &[f64], reach: usize) -> Spread {
    let later = response.iter().skip(1).rev().scan(0.0, |sum, weight| {
        *sum += weight;
        Some(*sum)
    });
    let sums: Vec<f64> = later.collect();
    let lags = reach.min(sums.len().saturating_sub(1)).min(input.len() / 2);
    let colour = covariance_at_lags(input, lags);
    let of_lag = |(lag, covariance): (usize, &f64)| {
        let pairs = sums.iter().zip(sums.iter().skip(lag));
        let product: f64 = pairs.map(|(one, other)| one * other).sum();
        let both = if lag == 0 { 1.0 } else { 2.0 };
        both * covariance * product
    };
    let end: f64 = colour.iter().enumerate().map(of_lag).sum();
    Spread {
        variance: 2.0 * end.max(0.0),
        freedom: input.len() as f64 / (lags + 1) as f64,
    }
}

/// E of the real and the imaginary part of what a response makes of its input at a swing's frequency, less
/// its value there times that.
///
/// As [`ends_of_response`], with `S_k = h_k + h_(k+1) exp(-i w) + h_(k+2) exp(-2 i w) + ...` of the word k
/// before either end, turned by the phase at that end. Blocks of whole cycles end within half a sample of
/// this phase: next to where the one part vanishes they show that half sample.
///
/// * `angular_per_sample`: frequency of the swing, rad.
/// * `phases_rad`: of the swing in the output at the first sample and behind the last.
pub(crate) fn ends_about_swing(
    response: &[f64],
    (input, reach): (&[f64], usize),
    angular_per_sample: f64,
    phases_rad: [f64; 2],
) -> [Spread; 2] {
    let (sine, cosine) = angular_per_sample.sin_cos();
    let later = response.iter().skip(1).rev();
    let sums: Vec<[f64; 2]> = later
        .scan([0.0, 0.0], |[re, im], weight| {
            (*re, *im) = (
                weight + cosine * *re + sine * *im,
                cosine * *im - sine * *re,
            );
            Some([*re, *im])
        })
        .collect();
    let lags = reach.min(sums.len().saturating_sub(1)).min(input.len() / 2);
    let colour = covariance_at_lags(input, lags);
    let power = |values: &[f64]| {
        let of_lag = |(lag, covariance): (usize, &f64)| {
            let pairs = values.iter().zip(values.iter().skip(lag));
            let product: f64 = pairs.map(|(one, other)| one * other).sum();
            let both = if lag == 0 { 1.0 } else { 2.0 };
            both * covariance * product
        };
        colour.iter().enumerate().map(of_lag).sum::<f64>().max(0.0)
    };
    let mut variances = [0.0, 0.0];
    for phase in phases_rad {
        let (s, c) = phase.sin_cos();
        let real: Vec<f64> = sums.iter().map(|[re, im]| re * c + im * s).collect();
        let imaginary: Vec<f64> = sums.iter().map(|[re, im]| im * c - re * s).collect();
        variances[0] += power(&real);
        variances[1] += power(&imaginary);
    }
    variances.map(|variance| Spread {
        variance,
        freedom: input.len() as f64 / (lags + 1) as f64,
    })
}

/// Spectral density of values at zero frequency, variance times samples.
pub(crate) fn density_at_zero(values: &[f64]) -> Spread {
    MeanScatter::of(values, 1).density
}

/// Autocovariance of values about their mean at lags from 0 on.
pub(crate) fn covariance_at_lags(values: &[f64], largest_lag: usize) -> Vec<f64> {
    let mean = interval::mean(values);
    let at = |lag: usize| {
        let pairs = values.iter().zip(values.iter().skip(lag));
        let sum: f64 = pairs
            .map(|(one, other)| (one - mean) * (other - mean))
            .sum();
        sum / values.len().saturating_sub(lag).max(1) as f64
    };
    (0..=largest_lag).map(at).collect()
}

/// Spread of the mean of values whose ends reach over `reach` samples.
pub(crate) fn mean_spread(values: &[f64], reach: usize) -> Spread {
    MeanScatter::of(values, reach).over(values.len())
}

/// Shortest block of so many samples at least, in whole cycles of a swing, samples.
fn whole(least: usize, cycle: Option<f64>) -> f64 {
    let least = least.max(1) as f64;
    cycle.map_or(least, |cycle| (least / cycle).ceil() * cycle)
}

/// E of plain blocks of so many samples: what their means have beyond the density.
fn ends(values: impl Values, density: Spread, length: f64) -> Spread {
    let count = values.count();
    let blocks = interval::round_to_count((count as f64 / length).floor());
    let border = |block: usize| interval::round_to_count(block as f64 * length);
    let means: Vec<f64> = (0..blocks)
        .map(|block| {
            let (first, end) = (border(block), border(block + 1).min(count));
            let sum: f64 = (first..end).map(|index| values.at(index)).sum();
            sum / (end - first).max(1) as f64
        })
        .collect();
    let beyond = interval::sample_variance(&means) - density.variance / length;
    Spread {
        variance: (beyond * length * length).max(0.0),
        freedom: means.len() as f64 - 1.0,
    }
}

/// Values delayed by a number of samples that need not be whole, linear between two, in their order.
///
/// The first ones, for which there is no earlier sample, stay as they are.
pub(crate) fn delayed(values: &[f64], samples: f64) -> impl Values {
    let samples = samples.clamp(0.0, values.len() as f64 / 4.0);
    let whole = interval::round_to_count(samples.floor());
    let part = samples - samples.floor();
    let back = move |index: usize, samples: usize| {
        index
            .checked_sub(samples)
            .map_or(values[index], |index| values[index])
    };
    Made {
        count: values.len(),
        of: move |index| (1.0 - part) * back(index, whole) + part * back(index, whole + 1),
    }
}

/// Spectral density at zero frequency: variance of a mean times its length, from Hann windows.
///
/// Source: Welch, IEEE Trans. Audio Electroacoust. 15 (1967).
fn tapered_density(values: impl Values, length: usize) -> Spread {
    let window: Vec<f64> = (0..length)
        .map(|k| 1.0 - (TAU * (k as f64 + 0.5) / length as f64).cos())
        .collect();
    let power: f64 = window.iter().map(|weight| weight * weight).sum();
    let step = length / 2;
    let sums: Vec<f64> = (0..=(values.count() - length) / step)
        .map(|block| {
            let part = (block * step..).zip(&window);
            part.map(|(index, weight)| values.at(index) * weight).sum()
        })
        .collect();
    Spread {
        variance: interval::sample_variance(&sums) / power,
        freedom: WINDOW_FREEDOM * sums.len() as f64 - 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn normal(state: &mut u64) -> f64 {
        let uniform = (0..12).map(|_| {
            *state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (*state >> 11) as f64 / (1_u64 << 53) as f64
        });
        uniform.sum::<f64>() - 6.0
    }

    #[test]
    fn the_ends_of_a_response_are_what_its_mean_has_beside_that_of_its_input() {
        let mut state = 11;
        let (taps, count, trials) = (8, 500, 400);
        let response = vec![1.0 / taps as f64; taps];
        let (mut found, mut stated) = (0.0, 0.0);
        for _ in 0..trials {
            let white: Vec<f64> = (0..count + taps).map(|_| normal(&mut state)).collect();
            let means = white.windows(taps).map(interval::mean);
            let filtered: f64 = means.skip(1).take(count).sum();
            let input = &white[taps..];
            found += (filtered - input.iter().sum::<f64>()).powi(2);
            stated += ends_of_response(&response, input, 3).variance;
        }
        // 2 (7^2 + 6^2 + ... + 1) / 8^2; four standard errors of 400 squares.
        let expected = 2.0 * 140.0 / 64.0 * f64::from(trials);
        assert!((found / expected - 1.0).abs() < 0.3, "{found} {expected}");
        assert!(
            (stated / expected - 1.0).abs() < 0.05,
            "{stated} {expected}"
        );
    }

    #[test]
    fn the_ends_of_a_response_about_a_swing_are_what_it_has_beside_its_input() {
        let mut state = 13;
        let (taps, count, trials, angular) = (8, 500, 400, 0.11_f64);
        let response = vec![1.0 / taps as f64; taps];
        let phases = [0.3, 0.3 + angular * count as f64];
        let at_frequency = (0..taps).fold([0.0, 0.0], |[re, im], age| {
            let (s, c) = (angular * age as f64).sin_cos();
            [re + c / taps as f64, im - s / taps as f64]
        });
        let mut found = [0.0, 0.0];
        let mut stated = [0.0, 0.0];
        for _ in 0..trials {
            let white: Vec<f64> = (0..count + taps).map(|_| normal(&mut state)).collect();
            let mut sums = [0.0, 0.0];
            for at in 0..count {
                let own = interval::mean(&white[at + 1..=at + taps]);
                let [re, im] = at_frequency.map(|part| part * white[at + taps]);
                let (s, c) = (phases[0] + angular * at as f64).sin_cos();
                sums[0] += (own - re) * c - im * s;
                sums[1] += -im * c - (own - re) * s;
            }
            let ends = ends_about_swing(&response, (&white[taps..], 3), angular, phases);
            for part in [0, 1] {
                found[part] += sums[part] * sums[part] / f64::from(trials);
                stated[part] += ends[part].variance / f64::from(trials);
            }
        }
        // Four standard errors of 400 squares.
        for part in [0, 1] {
            let ratio = found[part] / stated[part];
            assert!((ratio - 1.0).abs() < 0.3, "{part}: {ratio}");
        }
    }

    #[test]
    fn white_values_and_differences_of_white_ones_have_the_spread_of_their_means() {
        let mut state = 7;
        let count = 16_000;
        let (mut of_white, mut of_differences) = (0.0, 0.0);
        let trials = 40;
        for _ in 0..trials {
            let white: Vec<f64> = (0..=count).map(|_| normal(&mut state)).collect();
            let differences: Vec<f64> = white.windows(2).map(|two| two[1] - two[0]).collect();
            let n = count as f64;
            of_white += mean_spread(&white[1..], 1).variance * n / f64::from(trials);
            // The mean is the last minus the first over n.
            of_differences +=
                mean_spread(&differences, 1).variance * n * n / 2.0 / f64::from(trials);
        }
        assert!((of_white - 1.0).abs() < 0.15, "{of_white}");
        assert!((of_differences - 1.0).abs() < 0.15, "{of_differences}");
    }
}
