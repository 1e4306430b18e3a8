//! Power density of a record of any length in logarithmic bins, from its lowest frequency to half the rate.

use std::f64::consts::{PI, TAU};

use realfft::RealFftPlanner;

use crate::metrics::allan::noise_identification::remove_line;
use crate::metrics::estimate::interval::{mean_of_present, round_to_count};

/// Most values of one spectrum.
const VALUES_MAX: usize = 1 << 17;

/// Fewest words of a record.
const WORDS_MIN: usize = 1000;

/// Words of short stretches in means of the long spectrum, and of a stretch at least.
const PER_MEAN: usize = 40;
const STRETCH_MIN: usize = 4096;

/// Words of all short stretches together, at most.
const SHORT_MAX: usize = 1 << 20;

/// Fewest bins.
const BINS_MIN: usize = 16;

/// Ratio of the ends of a bin.
const RATIO: f64 = 1.08;

/// Highest frequency of the spectrum of means of which the means lose nothing, over the rate of means.
const UNBENT: f64 = 0.1;

/// Lowest bin of a Hann window that a straight line and the mean do not touch.
const FIRST: usize = 3;

/// Part of the ordinates of a Hann window that are worth one of their own.
const HANN_INDEPENDENT: f64 = 0.5;

/// Places in a bin at which a response is looked at.
const PLACES: usize = 12;

/// Density of the upper half of the band over that of the largest bin, above which nothing falls off.
const FALL_MAX: f64 = 0.05;

/// One bin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bin {
    /// Mean frequency, of the rate of the words.
    pub(crate) frequency: f64,
    ends: [f64; 2],
    /// One-sided density, power of the words per frequency.
    pub(crate) density: f64,
    /// Independent ordinates.
    pub(crate) count: f64,
}

impl Bin {
    /// Power of the words in the bin.
    pub(crate) fn power(&self) -> f64 {
        self.density * (self.ends[1] - self.ends[0])
    }

    /// Mean of a response over the bin.
    pub(crate) fn mean(&self, response: impl Fn(f64) -> f64) -> f64 {
        let [low, high] = self.ends;
        let step = (high - low) / PLACES as f64;
        let at = |place: usize| response(low + (place as f64 + 0.5) * step);
        (0..PLACES).map(at).sum::<f64>() / PLACES as f64
    }
}

/// Density of a record.
#[derive(Clone, Debug)]
pub(crate) struct Density {
    /// Bins with rising frequency.
    pub(crate) bins: Vec<Bin>,
}

impl Density {
    /// That of a record, whose missing words are NaN; nothing of too few.
    ///
    /// Long records are seen twice: whole, in means of their words, and in stretches of words.
    pub(crate) fn new(words: &[f64]) -> Option<Self> {
        if words.len() < WORDS_MIN {
            return None;
        }
        let block = words.len().div_ceil(VALUES_MAX);
        let means: Vec<f64> = words.chunks_exact(block).map(mean_of_present).collect();
        let rate = 1.0 / block as f64;
        let whole = Periodogram::of(std::iter::once(means))?;
        let mut bins = Vec::new();
        if block == 1 {
            whole.bin(rate, FIRST, 0.5, &mut bins);
        } else {
            let border = UNBENT * rate;
            whole.bin(rate, FIRST, border, &mut bins);
            let length = (PER_MEAN * block).next_power_of_two().max(STRETCH_MIN);
            let count = (SHORT_MAX / length).clamp(1, words.len() / length);
            let stride = words.len() / count;
            let stretches = (0..count).map(|at| words[at * stride..at * stride + length].to_vec());
            let short = Periodogram::of(stretches)?;
            let first = round_to_count((border * length as f64).ceil()).max(FIRST);
            short.bin(1.0, first, 0.5, &mut bins);
        }
        (bins.len() >= BINS_MIN).then_some(Self { bins })
    }

    /// Largest density of a bin.
    pub(crate) fn largest(&self) -> f64 {
        self.bins.iter().map(|bin| bin.density).fold(0.0, f64::max)
    }

    /// Whether the highest frequencies have so little that the rest may have been smoothed.
    pub(crate) fn may_fall_off(&self) -> bool {
        let largest = self.largest();
        let high = self.bins.iter().filter(|bin| bin.frequency > 0.25);
        let (sum, count) = high.fold((0.0, 0.0), |(sum, count), bin| {
            (sum + bin.density * bin.count, count + bin.count)
        });
        count > 0.0 && sum / count < FALL_MAX * largest
    }
}

/// Mean periodogram of stretches of one length.
struct Periodogram {
    /// One-sided density over the rate of its values, from zero on.
    density: Vec<f64>,
    length: usize,
    stretches: usize,
}

impl Periodogram {
    fn of(stretches: impl Iterator<Item = Vec<f64>>) -> Option<Self> {
        let mut planner = RealFftPlanner::<f64>::new();
        let mut found: Option<Self> = None;
        for mut values in stretches {
            remove_line(&mut values);
            let length = values.len();
            let transform = planner.plan_fft_forward(length);
            let mut power = 0.0;
            for (index, value) in values.iter_mut().enumerate() {
                let weight = 0.5 - 0.5 * (TAU * (index as f64 + 0.5) / length as f64).cos();
                power += weight * weight;
                *value = if value.is_nan() { 0.0 } else { *value * weight };
            }
            let mut output = transform.make_output_vec();
            transform.process(&mut values, &mut output).ok()?;
            let sums = found.get_or_insert_with(|| Self {
                density: vec![0.0; output.len()],
                length,
                stretches: 0,
            });
            sums.stretches += 1;
            for (sum, bin) in sums.density.iter_mut().zip(&output) {
                *sum += 2.0 * bin.norm_sqr() / power;
            }
        }
        found
    }

    /// Enters the bins from an ordinate on up to a frequency; `rate` is that of the values over the words'.
    fn bin(&self, rate: f64, first: usize, up_to: f64, bins: &mut Vec<Bin>) {
        let step = rate / self.length as f64;
        let last = round_to_count((up_to / step).floor()).min(self.density.len() - 1);
        let mut start = first;
        while start < last {
            let end = round_to_count(start as f64 * RATIO).clamp(start + 1, last);
            let count = end - start;
            let sum: f64 = self.density[start..end].iter().sum();
            let frequency = step * (0.5 * (start + end) as f64 - 0.5);
            // Means of white words lose what lies beside the pass band of a mean.
            let turn = PI * frequency / rate;
            let gain = if rate < 1.0 {
                (turn.sin() / turn).powi(2)
            } else {
                1.0
            };
            let density = sum / (count * self.stretches) as f64 / rate / gain;
            bins.push(Bin {
                frequency,
                ends: [step * (start as f64 - 0.5), step * (end as f64 - 0.5)],
                density: density.max(f64::MIN_POSITIVE),
                count: HANN_INDEPENDENT * (count * self.stretches) as f64,
            });
            start = end;
        }
    }
}
