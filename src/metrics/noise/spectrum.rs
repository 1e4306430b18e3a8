//! Power spectral density of a rate record.

use std::f64::consts::PI;

use realfft::RealFftPlanner;

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
    let mut spectrum = Spectrum {
        frequency_hz: Vec::new(),
        density_deg2_per_h2_per_hz: Vec::new(),
    };
    if length < 4 || rate_deg_per_h.len() < length {
        return spectrum;
    }
    let mean = interval::mean_of_present(rate_deg_per_h);
    let window: Vec<f64> = (0..length)
        .map(|k| 0.5 - 0.5 * (2.0 * PI * k as f64 / length as f64).cos())
        .collect();
    let window_power: f64 = window.iter().map(|weight| weight * weight).sum();
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(length);
    let mut input = transform.make_input_vec();
    let mut output = transform.make_output_vec();
    let mut scratch = transform.make_scratch_vec();
    let mut power = vec![0.0; output.len()];
    let step = length / 2;
    let all = (rate_deg_per_h.len() - length) / step + 1;
    let mut segments = 0;
    for segment in 0..all {
        let values = &rate_deg_per_h[segment * step..segment * step + length];
        if values.iter().any(|value| value.is_nan()) {
            continue;
        }
        segments += 1;
        for ((slot, value), weight) in input.iter_mut().zip(values).zip(&window) {
            *slot = (value - mean) * weight;
        }
        transform
            .process_with_scratch(&mut input, &mut output, &mut scratch)
            .expect("buffers were made by this very plan");
        for (sum, bin) in power.iter_mut().zip(&output) {
            *sum += bin.norm_sqr();
        }
    }
    if segments == 0 {
        return spectrum;
    }
    let scale = 2.0 * sample_period_s / (f64::from(segments) * window_power);
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

/// Averages a spectrum in bins of equal ratio, `points_max` at most; low bins stay single.
#[must_use]
pub fn log_binned(spectrum: &Spectrum, points_max: usize) -> Spectrum {
    let count = spectrum.frequency_hz.len();
    let mut binned = Spectrum {
        frequency_hz: Vec::new(),
        density_deg2_per_h2_per_hz: Vec::new(),
    };
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
