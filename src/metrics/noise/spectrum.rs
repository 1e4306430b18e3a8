//! Power spectral density of a rate record.

use std::f64::consts::PI;
use std::sync::Arc;

use realfft::num_complex::Complex;
use realfft::{RealFftPlanner, RealToComplex};

use crate::metrics::estimate::interval;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::key::curve::{Column, CurveKey, CurvePool};

/// Frequency.
pub static FREQUENCY: Column = Column::new("frequency_hz", "Hz", "middle of the bin");

/// One-sided density.
pub static DENSITY: Column = Column::new(
    "psd_deg2_per_h2_per_hz",
    "(deg/h)^2/Hz",
    "one-sided power spectral density: its integral over positive frequencies is the variance",
);

/// Two-sided density.
pub static TWO_SIDED_DENSITY: Column = Column::new(
    "two_sided_psd_deg2_per_h2_per_hz",
    "(deg/h)^2/Hz",
    "half of it, at either sign of the frequency; of white noise the square of N",
);

/// Power spectral density.
pub static PSD: CurveKey = CurveKey::new(
    "psd",
    &[&FREQUENCY, &DENSITY, &TWO_SIDED_DENSITY],
    "power spectral density of the rate by Welch's method, in bins of equal logarithmic width",
)
.csv("psd.csv")
.picture("spectrum.svg")
.pooled(CurvePool::Power);

/// Longest segment, samples: 2^18 at 4 kHz reaches down to 15 mHz.
const SEGMENT_MAX: usize = 1 << 18;

/// Shortest segment, samples.
const SEGMENT_MIN: usize = 4;

/// Segments, at least, that a spectrum is averaged over (before overlap).
const SEGMENTS_MIN: usize = 8;

/// A one-sided power spectral density.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Spectrum {
    /// Frequencies, Hz, rising, zero left out.
    pub frequency_hz: Vec<f64>,
    /// One-sided density, (deg/h)^2/Hz: its integral over positive frequencies is the variance.
    pub density_deg2_per_h2_per_hz: Vec<f64>,
}

/// Segment length that suits a record: a power of two, an eighth of the record at most.
#[must_use]
pub fn segment_samples(record_samples: usize) -> usize {
    let largest = (record_samples / SEGMENTS_MIN).clamp(1, SEGMENT_MAX);
    1 << largest.ilog2()
}

/// Welch's estimate of the one-sided power spectral density of a rate, (deg/h)^2/Hz.
///
/// Segments of `segment_samples` (even) overlap by half, are freed of the record's mean and weighted
/// with the periodic Hann window; `S1(f) = 2 T sum |X|^2 / (K sum w^2)`, not doubled at half the
/// sampling rate. One-sided: white noise of angle random walk N has `S1 = 2 N^2`, where the
/// coefficients of IEEE Std 952 refer to the two-sided density `N^2`.
///
/// A segment with a missing sample (NaN) is left out. A record shorter than one segment, or a segment shorter than four samples, gives an empty
/// spectrum.
///
/// # Panics
/// Never: the transform's buffers are made by its own plan.
///
/// # Source
/// Welch, IEEE Trans. Audio Electroacoust. 15 (1967) 70.
#[must_use]
pub fn welch(rate_deg_per_h: &[f64], sample_period_s: f64, segment_samples: usize) -> Spectrum {
    let length = segment_samples;
    if length < SEGMENT_MIN || rate_deg_per_h.len() < length {
        return Spectrum::empty();
    }
    let mean = interval::mean_of_present(rate_deg_per_h);
    let mut welch = Welch::new(length, mean);
    let step = length / 2;
    for segment in 0..(rate_deg_per_h.len() - length) / step + 1 {
        welch.add(&rate_deg_per_h[segment * step..segment * step + length]);
    }
    welch.spectrum(sample_period_s, mean)
}

impl Spectrum {
    fn empty() -> Self {
        Self {
            frequency_hz: Vec::new(),
            density_deg2_per_h2_per_hz: Vec::new(),
        }
    }
}

/// The powers of segments while they come in.
pub(crate) struct Welch {
    centre: f64,
    window: Vec<f64>,
    transform: Arc<dyn RealToComplex<f64>>,
    input: Vec<f64>,
    output: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
    power: Vec<f64>,
    /// Sum of the real parts of the first bin, which holds what the centre misses of the mean.
    first: f64,
    segments: u32,
}

impl Welch {
    /// Of segments of `length` samples, at least four, about a rate near the mean.
    pub(crate) fn new(length: usize, centre: f64) -> Self {
        let transform = RealFftPlanner::<f64>::new().plan_fft_forward(length);
        let output = transform.make_output_vec();
        Self {
            centre,
            window: (0..length)
                .map(|k| 0.5 - 0.5 * (2.0 * PI * k as f64 / length as f64).cos())
                .collect(),
            input: transform.make_input_vec(),
            power: vec![0.0; output.len()],
            scratch: transform.make_scratch_vec(),
            output,
            transform,
            first: 0.0,
            segments: 0,
        }
    }

    /// Samples of a segment.
    pub(crate) fn length(&self) -> usize {
        self.window.len()
    }

    /// Adds a segment; one with a missing sample (NaN) is left out.
    pub(crate) fn add(&mut self, values: &[f64]) {
        if values.iter().any(|value| value.is_nan()) {
            return;
        }
        self.segments += 1;
        for ((slot, value), weight) in self.input.iter_mut().zip(values).zip(&self.window) {
            *slot = (value - self.centre) * weight;
        }
        self.transform
            .process_with_scratch(&mut self.input, &mut self.output, &mut self.scratch)
            .expect("buffers were made by this very plan");
        for (sum, bin) in self.power.iter_mut().zip(&self.output) {
            *sum += bin.norm_sqr();
        }
        self.first += self.output[1].re;
    }

    /// The density of what was added about its mean.
    pub(crate) fn spectrum(&self, sample_period_s: f64, mean: f64) -> Spectrum {
        let mut spectrum = Spectrum::empty();
        if self.segments == 0 {
            return spectrum;
        }
        let length = self.length();
        let segments = f64::from(self.segments);
        // The window turns a constant into the bins 0 and 1, there `-length/4` of it.
        let left = (mean - self.centre) * length as f64 / 4.0;
        let mut power = self.power.clone();
        power[1] += 2.0 * left * self.first + segments * left * left;
        let window_power: f64 = self.window.iter().map(|weight| weight * weight).sum();
        let scale = 2.0 * sample_period_s / (segments * window_power);
        let resolution_hz = 1.0 / (length as f64 * sample_period_s);
        for (bin, sum) in power.iter().enumerate().skip(1) {
            let sides = if 2 * bin == length { 0.5 } else { 1.0 };
            spectrum.frequency_hz.push(bin as f64 * resolution_hz);
            spectrum
                .density_deg2_per_h2_per_hz
                .push(sum * scale * sides);
        }
        spectrum
    }
}

/// The spectrum of a record while it comes in.
pub(crate) struct WelchStream {
    welch: Option<Welch>,
    /// Samples of the segments to come.
    waiting: Vec<f64>,
}

impl WelchStream {
    /// Of segments of `length` samples about a rate near the mean; nothing of fewer than four.
    pub(crate) fn new(length: usize, centre: f64) -> Self {
        Self {
            welch: (length >= SEGMENT_MIN).then(|| Welch::new(length, centre)),
            waiting: Vec::new(),
        }
    }

    /// Takes the next samples.
    pub(crate) fn extend(&mut self, values: &[f64]) {
        let Some(welch) = &mut self.welch else {
            return;
        };
        self.waiting.extend_from_slice(values);
        let (length, mut first) = (welch.length(), 0);
        while self.waiting.len() - first >= length {
            welch.add(&self.waiting[first..first + length]);
            first += length / 2;
        }
        self.waiting.drain(..first);
    }

    /// The density of all segments about the mean of the record.
    pub(crate) fn spectrum(&self, sample_period_s: f64, mean: f64) -> Spectrum {
        let welch = self.welch.as_ref();
        welch.map_or_else(Spectrum::empty, |welch| {
            welch.spectrum(sample_period_s, mean)
        })
    }
}

/// Averages a spectrum in bins of equal ratio, `points_max` at most; low bins stay single.
#[must_use]
pub fn log_binned(spectrum: &Spectrum, points_max: usize) -> Spectrum {
    let count = spectrum.frequency_hz.len();
    let mut binned = Spectrum::empty();
    if count == 0 {
        return binned;
    }
    let ratio = (count as f64)
        .powf(1.0 / points_max.max(1) as f64)
        .max(1.0 + 1e-12);
    let mut start = 0;
    while start < count {
        let reach = interval::round_to_count((start + 1) as f64 * ratio);
        let end = reach.clamp(start + 1, count);
        binned
            .frequency_hz
            .push(interval::mean(&spectrum.frequency_hz[start..end]));
        binned.density_deg2_per_h2_per_hz.push(interval::mean(
            &spectrum.density_deg2_per_h2_per_hz[start..end],
        ));
        start = end;
    }
    binned
}

/// Enters the spectrum.
pub(crate) fn put_spectrum(spectrum: Spectrum, metrics: &mut ChannelMetrics) {
    // Half the one-sided density at either sign of the frequency: N^2 of white noise.
    let halves = spectrum.density_deg2_per_h2_per_hz.iter();
    let halves = halves.map(|density| density / 2.0).collect();
    let columns = [
        (&TWO_SIDED_DENSITY, halves),
        (&FREQUENCY, spectrum.frequency_hz),
        (&DENSITY, spectrum.density_deg2_per_h2_per_hz),
    ];
    metrics.put_curve(&PSD, columns);
}
