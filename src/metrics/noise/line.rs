//! A sine in the words of a gyro at rest: found by a line test on their spectrum, and removed.

use std::f64::consts::{PI, TAU};

use realfft::RealFftPlanner;

use crate::metrics::allan::noise_fit::{ChosenFit, FitRange, NoiseFit, Sine, sine_allan_variance};
use crate::metrics::allan::noise_identification::remove_line;
use crate::metrics::allan::overlapping::{AllanPoint, overlapping_allan};
use crate::metrics::estimate::interval;
use crate::metrics::estimate::interval::NORMAL_QUANTILE;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::sine::fit::SwingClock;
use crate::metrics::sine::free_frequency::{FreeSineFit, fit_sine_to};

/// Most means that the spectrum is made of.
const MEANS_MAX: usize = 1 << 17;

/// Periods looked at: from so many shortest averaging times to such a part of the record.
const PERIOD_PER_TAU_MIN: f64 = 4.0;
const PERIODS_PER_RECORD: f64 = 3.0;

/// Probability that noise without a line passes for one, all frequencies counted.
const FALSE_ALARM: f64 = 0.002;

/// Coefficients of a sine: amplitude, phase, frequency.
const COEFFICIENTS: f64 = 3.0;

/// Change of the phase at the ends of the record below which a fitted sine stands, rad: a thousandth of
/// its standard error where a line just passes.
const PHASE_TOLERANCE_RAD: f64 = 3e-4;

/// Part of what a line must have that a peak over its neighbours must have to be looked at.
const WORTH_A_LOOK: f64 = 0.7;

/// Part of the power that a line must have, as its bin shows it, from which on a sine is fitted, and as
/// the fit shows it, from which on it is taken out of the words: most peaks of noise end at the first,
/// nearly all at the second, and both cost little beside what they save.
const WORTH_A_FIT: f64 = 0.5;
const WORTH_REMOVING: f64 = 0.8;

/// Least part of an Allan variance that is left of it without a sine: the variances of both add on
/// average only.
const REST_MIN: f64 = 0.1;

/// Neighbours of a bin are those within this ratio of frequency, at least so many bins of the record on
/// either side; those as near as the window's own width do not count.
const NEIGHBOUR_RATIO: f64 = 1.4;
const NEIGHBOURS_MIN: f64 = 10.0;
const OWN_WIDTH: f64 = 3.0;

/// Power of a line over that of noise in a spectrum with the Hann window, of what it is without.
const HANN: f64 = 2.0 / 3.0;

/// Fits the noise of a record whose words hold a sine: to the record without it.
///
/// Nothing if no frequency stands out, with periods from
/// four shortest averaging times to a third of the record.
///
/// * `points`: overlapping Allan deviation of the words.
/// * `inverse_square`: `tau^2` times the Allan variance of a known quantisation, arcsec^2.
pub(crate) fn fit_beside_sine(
    words_deg_per_h: &[f64],
    sample_period_s: f64,
    points: &[AllanPoint],
    range: FitRange,
    inverse_square: Option<f64>,
) -> Option<NoiseFit> {
    let means = BlockMeans::new(words_deg_per_h, sample_period_s, range.tau_min_s);
    let band = means.band(range.tau_min_s)?;
    let threshold = means.threshold(band);
    let peak = means.peak(band, threshold)?;
    let duration_s = words_deg_per_h.len() as f64 * sample_period_s;
    let power = |amplitude: f64| amplitude * amplitude * duration_s / 4.0;
    let stands_out = |frequency_hz: f64, amplitude: f64, part: f64| {
        let rest = curve_without(points, frequency_hz, amplitude);
        let chosen = ChosenFit::beside_known(&rest, range, inverse_square).ok()?;
        let density = chosen.cautious_density(frequency_hz);
        (power(amplitude) > part * threshold * density).then_some(())
    };
    stands_out(peak.frequency_hz, peak.amplitude, WORTH_A_FIT)?;
    let clock = SwingClock {
        frequency_hz: peak.frequency_hz,
        sample_period_s: means.period_s,
        first_stamp_s: 0.0,
    };
    let found = fit_sine_to(&means.values, &clock, PHASE_TOLERANCE_RAD)?;
    if found.frequency_hz < band[0] || found.frequency_hz > band[1] {
        return None;
    }
    let amplitude = found.amplitude / means.gain(found.frequency_hz);
    stands_out(found.frequency_hz, amplitude, WORTH_REMOVING)?;
    let rest = without(words_deg_per_h, sample_period_s, &found, amplitude, &means);
    let points = overlapping_allan(&rest, sample_period_s);
    let chosen = ChosenFit::beside_known(&points, range, inverse_square).ok()?;
    let density = chosen.cautious_density(found.frequency_hz);
    if power(amplitude) < threshold * density {
        return None;
    }
    // Bounds of Cramer and Rao: 2 S/T of the amplitude, 6 S/(pi^2 A^2 T^3) of the frequency.
    let amplitude_error = (2.0 * density / duration_s).sqrt();
    let frequency_error = (6.0 * density / duration_s.powi(3)).sqrt() / (PI * amplitude);
    let half = NORMAL_QUANTILE * frequency_error;
    let period = |frequency: f64| 1.0 / frequency;
    let sine = Sine {
        amplitude_deg_per_h: Estimate::symmetric(amplitude, NORMAL_QUANTILE * amplitude_error),
        period_s: Estimate::with_interval(
            period(found.frequency_hz),
            period(found.frequency_hz + half),
            period((found.frequency_hz - half).max(band[0] / 2.0)),
        ),
        frequencies_tried: interval::round_to_count(means.tried(band)),
    };
    Some(chosen.judged().beside(sine))
}

/// The curve that words would have without a sine, up to what the two have in common by chance.
fn curve_without(points: &[AllanPoint], frequency_hz: f64, amplitude: f64) -> Vec<AllanPoint> {
    let period_s = 1.0 / frequency_hz;
    let without = points.iter().map(|point| {
        let sine = amplitude * amplitude * sine_allan_variance(point.tau_s, period_s);
        let variance = point.variance();
        point.with_variance((variance - sine).max(REST_MIN * variance))
    });
    without.collect()
}

/// The words without the sine, whose phase counts from the middle of the means.
fn without(
    words: &[f64],
    sample_period_s: f64,
    sine: &FreeSineFit,
    amplitude: f64,
    means: &BlockMeans,
) -> Vec<f64> {
    // The first mean is stamped zero and stands for the middle of its words.
    let first_s = -0.5 * (means.block as f64 - 1.0) * sample_period_s;
    words
        .iter()
        .enumerate()
        .map(|(index, word)| {
            let time_s = first_s + index as f64 * sample_period_s;
            word - amplitude * sine.phase_at_rad(time_s).cos()
        })
        .collect()
}

/// A bin that stands out.
struct Peak {
    frequency_hz: f64,
    /// Amplitude of a sine of this frequency, deg/h.
    amplitude: f64,
}

/// Means of consecutive words about a straight line.
struct BlockMeans {
    values: Vec<f64>,
    /// Words in each.
    block: usize,
    period_s: f64,
}

impl BlockMeans {
    /// Of half the shortest averaging time, so that the shortest period is four of them, or longer.
    fn new(words: &[f64], sample_period_s: f64, tau_min_s: f64) -> Self {
        let half = (tau_min_s / sample_period_s / 2.0 + 1e-9).floor();
        let least = words.len().div_ceil(MEANS_MAX);
        let block = interval::round_to_count(half).max(least).max(1);
        let means = words.chunks_exact(block).map(interval::mean_of_present);
        let mut values: Vec<f64> = means.collect();
        remove_line(&mut values);
        // A mean that is missing says nothing of a line: it gets what its neighbours have in common.
        for value in values.iter_mut().filter(|value| value.is_nan()) {
            *value = 0.0;
        }
        Self {
            values,
            block,
            period_s: block as f64 * sample_period_s,
        }
    }

    fn duration_s(&self) -> f64 {
        self.values.len() as f64 * self.period_s
    }

    /// Lowest and highest frequency looked at, Hz; nothing where there is none.
    fn band(&self, tau_min_s: f64) -> Option<[f64; 2]> {
        let lowest = PERIODS_PER_RECORD / self.duration_s();
        let highest = (1.0 / (PERIOD_PER_TAU_MIN * tau_min_s)).min(0.45 / self.period_s);
        (highest > 2.0 * lowest).then_some([lowest, highest])
    }

    /// Independent frequencies in the band.
    fn tried(&self, [lowest, highest]: [f64; 2]) -> f64 {
        (highest - lowest) * self.duration_s()
    }

    /// Power over that of the noise from which on a line is one: by the probability that noise has it
    /// somewhere, and by the criterion that also chooses the other terms.
    fn threshold(&self, band: [f64; 2]) -> f64 {
        let tested = (self.tried(band) / FALSE_ALARM).ln();
        let criterion = COEFFICIENTS / 2.0 * (self.values.len() as f64).ln();
        tested.max(criterion)
    }

    /// Gain of the mean over a block.
    fn gain(&self, frequency_hz: f64) -> f64 {
        let word = PI * frequency_hz * self.period_s / self.block as f64;
        let count = self.block as f64;
        (count * word).sin() / (count * word.sin())
    }

    /// Bin whose power stands out most from that of its neighbours, if it may be a line.
    fn peak(&self, [lowest, highest]: [f64; 2], threshold: f64) -> Option<Peak> {
        let power = self.power();
        let bins = 2 * (power.len() - 1);
        let step_hz = 1.0 / (bins as f64 * self.period_s);
        // Bins of the padded spectrum in one of the record.
        let width = 1.0 / (self.duration_s() * step_hz);
        let mut sums = Vec::with_capacity(power.len() + 1);
        sums.push(0.0);
        for value in &power {
            sums.push(sums[sums.len() - 1] + value);
        }
        let edge = |frequency: f64| {
            interval::round_to_count((frequency / step_hz).max(2.0 * width)).min(power.len() - 1)
        };
        let sum = |from: usize, to: usize| {
            if from < to {
                sums[to] - sums[from]
            } else {
                0.0
            }
        };
        let mut best = (0.0, 0);
        let (first, last) = (edge(lowest), edge(highest));
        for (bin, own_power) in power.iter().enumerate().take(last + 1).skip(first) {
            let centre = bin as f64;
            let least = NEIGHBOURS_MIN * width;
            let from = edge((centre / NEIGHBOUR_RATIO).min(centre - least) * step_hz);
            let to = edge((centre * NEIGHBOUR_RATIO).max(centre + least) * step_hz);
            let own = OWN_WIDTH * width;
            let left = interval::round_to_count((centre - own).max(0.0));
            let right = interval::round_to_count(centre + own);
            let total = sum(from, left) + sum(right, to);
            let count = left.saturating_sub(from) + to.saturating_sub(right);
            let level = total / count.max(1) as f64;
            let ratio = own_power / level.max(f64::MIN_POSITIVE);
            if count > 0 && ratio > best.0 {
                best = (ratio, bin);
            }
        }
        let (ratio, bin) = best;
        let frequency_hz = bin as f64 * step_hz;
        // The window halves the sum of `A N/2` that a sine has.
        let amplitude = 4.0 * power[bin].sqrt() / self.values.len() as f64;
        (ratio / HANN > WORTH_A_LOOK * threshold).then(|| Peak {
            frequency_hz,
            amplitude: amplitude / self.gain(frequency_hz),
        })
    }

    /// Power spectrum with the Hann window, zeros appended, in arbitrary units.
    fn power(&self) -> Vec<f64> {
        let count = self.values.len();
        let transform =
            RealFftPlanner::<f64>::new().plan_fft_forward((2 * count).next_power_of_two());
        let mut input = transform.make_input_vec();
        for (index, (slot, value)) in input.iter_mut().zip(&self.values).enumerate() {
            let angle = TAU * (index as f64 + 0.5) / count as f64;
            *slot = value * (0.5 - 0.5 * angle.cos());
        }
        let mut output = transform.make_output_vec();
        // Buffers of the plan's own length do not fail; without a spectrum no line is found.
        if transform.process(&mut input, &mut output).is_err() {
            output.clear();
        }
        output.iter().map(|bin| bin.norm_sqr()).collect()
    }
}
