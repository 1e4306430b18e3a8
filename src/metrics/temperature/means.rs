//! Means of a record beside its temperature, and how fast that changes.
//!
//! A thermometer is read in steps and its rate is a difference of readings: the rate of a mean is the
//! slope of a parabola through its neighbours, as many of them as it takes to lift the slopes out of the
//! noise of the readings.

use std::ops::Range;

use crate::metrics::estimate::interval::{mean, round_to_count, sample_variance};
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::sine::fit::{SwingClock, fit_sine};
use crate::units::k_per_s_to_k_per_min;
use crate::wording::{counted, plain};

/// Most means of a record: more of them would show nothing of the temperature, which is slow.
const MEANS_MAX: usize = 480;

/// Fewest means of which coefficients are told.
const MEANS_MIN: usize = 40;

/// Cycles of a swing that a mean holds, a multiple of them.
const CYCLES: f64 = 10.0;

/// Least change of the temperature that coefficients are told from, K.
const CHANGE_MIN_K: f64 = 1.0;

/// Neighbours on either side that a slope is taken over, the fewest that do.
const REACHES: [usize; 7] = [2, 4, 8, 16, 32, 64, 128];

/// Largest part of the variance of the slopes that may be noise, where some reach gives as little.
const NOISE_PART: f64 = 0.01;

/// A record with the temperature at its words.
#[derive(Clone, Copy, Debug)]
pub struct WarmRecord<'a> {
    /// Words, deg/h; NaN where one is missing.
    pub words_deg_per_h: &'a [f64],
    /// True rate at them, deg/h; empty where nobody knows it.
    pub truth_deg_per_h: &'a [f64],
    /// Temperature at them, deg C; NaN where it is missing.
    pub temperature_c: &'a [f64],
    /// Sample period, s.
    pub sample_period_s: f64,
    /// Stamp of the first word, s.
    pub first_stamp_s: f64,
    /// Frequency of the swing, Hz; none at rest or at constant rates.
    pub swing_hz: Option<f64>,
}

/// Means of a record in the order of time, of equally long parts; no number where one is missing.
#[derive(Clone, Debug)]
pub(crate) struct WarmMeans {
    /// Time that each holds, s.
    pub(crate) length_s: f64,
    /// Middle of each, s.
    pub(crate) time_s: Vec<f64>,
    /// Temperature, deg C.
    pub(crate) temperature_c: Vec<f64>,
    /// Its rate, K/min; no number at either end.
    pub(crate) rate_k_per_min: Vec<f64>,
    /// Word minus true rate, or the word where that is not known, deg/h.
    pub(crate) error_deg_per_h: Vec<f64>,
    /// True rate, deg/h; empty where it is not known.
    pub(crate) truth_deg_per_h: Vec<f64>,
    /// Amplitude of a swing over the true one, or over that of the record, minus 1; else empty.
    pub(crate) gain_error: Vec<f64>,
    /// Standard deviation of the noise of a rate, K/min.
    pub(crate) rate_noise_k_per_min: f64,
}

impl WarmMeans {
    /// The means of a record.
    ///
    /// # Errors
    /// A record too short, or without a change of the temperature.
    pub(crate) fn of(record: &WarmRecord) -> Result<Self, Unavailable> {
        let parts = parts(record);
        check_count(record, parts.len())?;
        let mut means = Self::over(record, &parts);
        if let Some(frequency_hz) = record.swing_hz {
            means.gain_error = gains(record, &parts, frequency_hz);
        }
        means.check_change()?;
        Ok(means)
    }

    /// The means of a record however short it is, and whether its temperature changes or not; nothing where
    /// none is known.
    pub(crate) fn of_any(record: &WarmRecord) -> Option<Self> {
        let means = Self::over(record, &parts(record));
        let is_known = means.temperature_c.iter().any(|it| it.is_finite());
        is_known.then_some(means)
    }

    /// The means over parts of a record, with the rates of the temperature.
    fn over(record: &WarmRecord, parts: &[Range<usize>]) -> Self {
        let length_s = parts.first().map_or(0, Range::len) as f64 * record.sample_period_s;
        let mut means = Self {
            length_s,
            time_s: Vec::new(),
            temperature_c: Vec::new(),
            rate_k_per_min: Vec::new(),
            error_deg_per_h: Vec::new(),
            truth_deg_per_h: Vec::new(),
            gain_error: Vec::new(),
            rate_noise_k_per_min: 0.0,
        };
        for part in parts {
            means.take(record, part.clone());
        }
        let (slopes, noise) = slopes(&means.temperature_c);
        let spacing_s = match means.time_s[..] {
            [first_s, next_s, ..] => next_s - first_s,
            _ => length_s,
        };
        let per_min = k_per_s_to_k_per_min(1.0 / spacing_s);
        means.rate_k_per_min = slopes.iter().map(|slope| slope * per_min).collect();
        means.rate_noise_k_per_min = noise * per_min;
        means
    }

    /// Lowest and highest temperature, deg C.
    pub(crate) fn range_c(&self) -> (f64, f64) {
        let present = self.temperature_c.iter().copied();
        let present = present.filter(|it| !it.is_nan());
        present.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), it| {
            (low.min(it), high.max(it))
        })
    }

    /// Takes the mean over some words, of those that are there with their temperature.
    fn take(&mut self, record: &WarmRecord, part: Range<usize>) {
        let (mut sums, mut count) = ([0.0; 3], 0.0);
        for index in part.clone() {
            let (word, warmth) = (record.words_deg_per_h[index], record.temperature_c[index]);
            let truth = record.truth_deg_per_h.get(index).copied();
            if word.is_nan() || warmth.is_nan() {
                continue;
            }
            for (sum, value) in sums.iter_mut().zip([word, warmth, truth.unwrap_or(0.0)]) {
                *sum += value;
            }
            count += 1.0;
        }
        // More than half are there, or the mean is missing.
        let is_there = 2.0 * count > part.len() as f64;
        let [word, warmth, truth] = sums.map(|sum| if is_there { sum / count } else { f64::NAN });
        let middle = part.start as f64 + 0.5 * (part.len() as f64 - 1.0);
        self.time_s
            .push(record.first_stamp_s + middle * record.sample_period_s);
        self.temperature_c.push(warmth);
        self.error_deg_per_h.push(word - truth);
        if !record.truth_deg_per_h.is_empty() {
            self.truth_deg_per_h.push(truth);
        }
    }

    /// Refuses a temperature that hardly changes.
    fn check_change(&self) -> Result<(), Unavailable> {
        let present = self.temperature_c.iter().copied();
        let present: Vec<f64> = present.filter(|it| !it.is_nan()).collect();
        if present.len() < MEANS_MIN {
            return Err(too_few(present.len()));
        }
        let (low, high) = self.range_c();
        if high - low >= CHANGE_MIN_K {
            return Ok(());
        }
        Err(format!(
            "the temperature hardly changes, from {low:.2} to {high:.2} C: coefficients of it need a change \
             of {} K",
            plain(CHANGE_MIN_K)
        )
        .into())
    }

    /// Whether the rate of the temperature lets its effect be told beside what else is fitted.
    ///
    /// * `own_k_per_min`: standard deviation of the rate that nothing else explains.
    pub(crate) fn tells_rate(&self, own_k_per_min: f64) -> bool {
        self.rate_noise_k_per_min.powi(2) <= RATE_NOISE_MAX * own_k_per_min.powi(2)
    }
}

/// Largest part that noise may have in the variance of the rate: its coefficient comes out smaller by it.
const RATE_NOISE_MAX: f64 = 0.1;

fn too_few(count: usize) -> Unavailable {
    format!("temperature coefficients need {MEANS_MIN} means of the record, and it has {count}")
        .into()
}

/// The parts of a record that its means are taken over, whole cycles of a swing.
fn parts(record: &WarmRecord) -> Vec<Range<usize>> {
    let samples = record.words_deg_per_h.len() as f64;
    let together = record.swing_hz.map_or(1.0, |frequency_hz| {
        CYCLES / (frequency_hz * record.sample_period_s)
    });
    let length = together * (samples / (MEANS_MAX as f64 * together)).ceil();
    let at = |part: usize| round_to_count(part as f64 * length);
    (0..=MEANS_MAX)
        .map(|part| at(part)..at(part + 1))
        .take_while(|part| part.end <= record.words_deg_per_h.len())
        .collect()
}

/// Refuses a record of too few parts.
fn check_count(record: &WarmRecord, parts: usize) -> Result<(), Unavailable> {
    if parts >= MEANS_MIN {
        return Ok(());
    }
    let reason = too_few(parts);
    Err(match record.swing_hz {
        None => reason,
        Some(_) => format!(
            "{reason} of {} each",
            counted(round_to_count(CYCLES), "cycle")
        )
        .into(),
    })
}

/// Amplitudes of a swing, over the true ones where they are known, else over their mean, minus 1.
fn gains(record: &WarmRecord, parts: &[Range<usize>], frequency_hz: f64) -> Vec<f64> {
    let amplitude = |values: &[f64], part: &Range<usize>| {
        let clock = SwingClock {
            frequency_hz,
            sample_period_s: record.sample_period_s,
            first_stamp_s: record.first_stamp_s + part.start as f64 * record.sample_period_s,
        };
        let own = values.get(part.clone())?;
        fit_sine(own, &clock).map(|fit| fit.amplitude)
    };
    let shown: Vec<f64> = parts
        .iter()
        .map(|part| amplitude(record.words_deg_per_h, part).unwrap_or(f64::NAN))
        .collect();
    if record.truth_deg_per_h.is_empty() {
        let present: Vec<f64> = shown.iter().copied().filter(|it| !it.is_nan()).collect();
        let mean = mean(&present);
        return shown.iter().map(|own| own / mean - 1.0).collect();
    }
    let truths = parts
        .iter()
        .map(|part| amplitude(record.truth_deg_per_h, part).unwrap_or(f64::NAN));
    shown
        .iter()
        .zip(truths)
        .map(|(own, truth)| own / truth - 1.0)
        .collect()
}

/// Slopes of equally spaced values, per step, and the standard deviation of their noise: over the fewest
/// neighbours of which noise is a hundredth, or over those of which it is least.
fn slopes(values: &[f64]) -> (Vec<f64>, f64) {
    let most = values.len() / 8;
    let mut best: Option<(f64, Vec<f64>, f64)> = None;
    for reach in REACHES.into_iter().filter(|reach| *reach <= most) {
        let (slopes, noise) = slopes_over(values, reach);
        let present: Vec<f64> = slopes.iter().copied().filter(|it| !it.is_nan()).collect();
        let part = noise * noise / sample_variance(&present);
        if !part.is_finite() {
            continue;
        }
        if best.as_ref().is_none_or(|(least, ..)| part < *least) {
            best = Some((part, slopes, noise));
        }
        if part < NOISE_PART {
            break;
        }
    }
    best.map_or_else(
        || (vec![f64::NAN; values.len()], f64::INFINITY),
        |(_, slopes, noise)| (slopes, noise),
    )
}

/// Slopes of the parabolas through each value and `reach` neighbours on either side, and the standard
/// deviation that their residuals give to one.
///
/// On such a window the slope of the parabola is that of the line: `sum k y / sum k^2`.
fn slopes_over(values: &[f64], reach: usize) -> (Vec<f64>, f64) {
    let steps: Vec<f64> = (0..=2 * reach).map(|at| at as f64 - reach as f64).collect();
    let squares: f64 = steps.iter().map(|k| k * k).sum();
    let mean_square = squares / steps.len() as f64;
    let bend = |k: f64| k * k - mean_square;
    let bends: f64 = steps.iter().map(|k| bend(*k).powi(2)).sum();
    let (mut left, mut windows) = (0.0, 0.0);
    let mut slopes = vec![f64::NAN; values.len()];
    for (first, window) in values.windows(steps.len()).enumerate() {
        let centre = mean(window);
        if centre.is_nan() {
            continue;
        }
        let (mut slope, mut curve, mut square) = (0.0, 0.0, 0.0);
        for (k, value) in steps.iter().zip(window) {
            let own = value - centre;
            slope += k * own;
            curve += bend(*k) * own;
            square += own * own;
        }
        slopes[first + reach] = slope / squares;
        left += (square - slope * slope / squares - curve * curve / bends).max(0.0);
        windows += 1.0;
    }
    let freedom = steps.len() as f64 - 3.0;
    let variance = left / (windows * freedom);
    (slopes, (variance / squares).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_of_a_parabola_are_its_derivative_and_noise_widens_the_reach() {
        let parabola: Vec<f64> = (0..100).map(|at| 0.01 * f64::from(at * at)).collect();
        let (found, noise) = slopes(&parabola);
        for (at, slope) in found.iter().enumerate().take(98).skip(2) {
            let want = 0.02 * at as f64;
            assert!((slope - want).abs() < 1e-9, "{at}: {slope}");
        }
        assert!(found[1].is_nan() && noise < 1e-6, "{noise}");
        // Readings in steps of 0.5 hide a slope of 0.02 from five neighbours.
        let stepped: Vec<f64> = (0..400)
            .map(|at| (2.0 * (0.01 * f64::from(at)).sin() * 4.0).round() / 2.0)
            .collect();
        let (found, _) = slopes(&stepped);
        let missing = found.iter().take_while(|slope| slope.is_nan()).count();
        assert!(missing >= 8, "{missing}");
        let at = 200;
        let want = 0.04 * (0.01 * at as f64).cos();
        assert!((found[at] - want).abs() < 0.015, "{} {want}", found[at]);
    }
}
