//! Delay of a swing by correlation: a cross-check of the sine fit.

use super::fit::{CYCLES_MIN, SwingClock, fit_sine};
use crate::metrics::estimate::influence::Spread;
use crate::metrics::estimate::interval::round_to_count;
use crate::metrics::estimate::paired::{MeanScatter, covariance_at_lags};
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::value::Estimate;

/// The correlation's window and the two series about their means.
struct Window<'a> {
    reference: &'a [f64],
    values: &'a [f64],
    reference_mean: f64,
    values_mean: f64,
    /// Largest lag, samples; the window begins as many samples inside the record.
    margin: usize,
    /// Where the window begins and ends: samples, not whole ones.
    ends: [f64; 2],
}

/// Sum over a part of the time axis on which sample k stands for `k - 1/2 ... k + 1/2`: those that a
/// border cuts count in part, so that whole cycles stay whole.
fn sum_between(ends: [f64; 2], value: impl Fn(usize) -> f64) -> f64 {
    let [start, end] = ends.map(|end| (end, round_to_count((end + 0.5).floor())));
    let inside: f64 = (start.1 + 1..end.1).map(&value).sum();
    let first = (start.1 as f64 + 0.5 - start.0) * value(start.1);
    let last = (end.0 - end.1 as f64 + 0.5) * value(end.1);
    first + inside + last
}

impl Window<'_> {
    /// `sum x[k] y[k + lag]` over the window, for the lag `shift - margin`.
    fn product(&self, shift: usize) -> f64 {
        sum_between(self.ends, |index| {
            let later = self.values[index + shift - self.margin] - self.values_mean;
            (self.reference[index] - self.reference_mean) * later
        })
    }

    /// Spread that noise gives the difference of the products one lag above and below a shift.
    ///
    /// `sum x[k] (n[k + l + 1] - n[k + l - 1])` is `sum n[j] (x[j - l - 1] - x[j - l + 1])`, a sine of
    /// small amplitude, and two samples at either end that x weighs in full. Blocks would count
    /// those ends once for each block.
    fn difference_spread(&self, noise: &[f64], shift: usize) -> Spread {
        let [first, last] = self.ends.map(|end| round_to_count((end + 0.5).floor()));
        let reference = |index: usize| self.reference[index] - self.reference_mean;
        let inner: Vec<f64> = (first + 1..last)
            .map(|index| {
                let slope = reference(index - 1) - reference(index + 1);
                noise[index + shift - self.margin] * slope
            })
            .collect();
        let count = inner.len() as f64;
        let inner = MeanScatter::of(&inner[..], 1)
            .density_over(inner.len())
            .scaled(count);
        let correlation = covariance_at_lags(noise, 1);
        let ends: f64 = [(first, first + 1), (last - 1, last)]
            .map(|(one, other)| {
                let (one, other) = (reference(one), reference(other));
                correlation[0] * (one * one + other * other) + 2.0 * correlation[1] * one * other
            })
            .iter()
            .sum();
        inner.plus(Spread::known(ends))
    }

    /// The shift of the largest product, by ever smaller steps.
    ///
    /// The correlation of a swing is a cosine of the lag, with one peak within half a cycle, so that
    /// no peak can hide between coarse steps.
    fn best_shift(&self) -> usize {
        let last = 2 * self.margin;
        let mut step = (self.margin / 8).max(1);
        let mut tried: Vec<usize> = (0..=last).step_by(step).collect();
        loop {
            let best = tried
                .iter()
                .map(|&shift| (shift, self.product(shift)))
                .reduce(|best, next| if next.1 > best.1 { next } else { best })
                .map_or(self.margin, |(shift, _)| shift);
            if step == 1 {
                return best;
            }
            step = step.div_ceil(2);
            tried = [best.saturating_sub(step), best, (best + step).min(last)].to_vec();
            if step == 1 {
                // The last steps were halved with rounding: look once more on both sides.
                tried = (best.saturating_sub(3)..=(best + 3).min(last)).collect();
            }
        }
    }
}

/// Delay of a swing behind a reference by the peak of their correlation, s.
///
/// `R(l) = sum_(k in W) x[k] y[k + l]` with means removed. The window W holds the same whole cycles
/// for every lag and lies a quarter of a cycle, the largest lag, inside the record. The usual sum
/// over whatever overlaps, with fewer terms the larger the lag, is a triangle times a cosine, or has
/// a part of twice the frequency at its ends: its peak is off by some `1 / (w^2 T)`, which is 1 ms for
/// a second of 5 Hz. Here a sample that the border of W cuts counts in part; what is
/// left goes with the square of the sample period. The peak is that of the
/// parabola through the three largest sums; on a pure sine it errs by `(w d)^2 / 3 - (w T)^2 / 12` of
/// the part d of a sample. The interval is that of the noise about the sine.
///
/// The noise of the two must be independent: what they share correlates at lags of its own.
///
/// # Errors
/// The reason, in words, if W holds no three whole cycles or the delay exceeds a quarter of a cycle.
///
/// # Source
/// Derived. Known answer K24.
pub fn correlation_delay_s(
    reference: &[f64],
    values: &[f64],
    clock: &SwingClock,
) -> Result<Estimate, Unavailable> {
    let samples_per_cycle = 1.0 / (clock.frequency_hz * clock.sample_period_s);
    let margin = round_to_count((samples_per_cycle / 4.0).ceil());
    let samples = reference.len().min(values.len());
    let cycles = clock.whole_cycles(samples.saturating_sub(2 * margin + 3));
    if cycles < CYCLES_MIN {
        return Err(format!(
            "{cycles} whole cycles lie a quarter of a cycle inside the record; a correlation needs \
             {CYCLES_MIN}"
        )
        .into());
    }
    let start = (margin + 1) as f64;
    let ends = [start, start + cycles as f64 * samples_per_cycle];
    let mean_of = |values: &[f64]| sum_between(ends, |index| values[index]) / (ends[1] - ends[0]);
    let window = Window {
        reference,
        values,
        reference_mean: mean_of(reference),
        values_mean: mean_of(values),
        margin,
        ends,
    };
    let best = window.best_shift();
    if best == 0 || best == 2 * margin {
        return Err("the correlation has no peak within a quarter of a cycle".into());
    }
    let [before, at, after] = [best - 1, best, best + 1].map(|shift| window.product(shift));
    let curvature = before - 2.0 * at + after;
    let part = 0.5 * (before - after) / curvature;
    let delay_s = (best as f64 - margin as f64 + part) * clock.sample_period_s;
    let noise = residuals(values, clock)?;
    let spread = window.difference_spread(&noise, best);
    let per_product = 0.5 * clock.sample_period_s / curvature;
    Ok(spread.scaled(per_product).about(delay_s))
}

/// Values minus the sine and the offset fitted to them.
fn residuals(values: &[f64], clock: &SwingClock) -> Result<Vec<f64>, Unavailable> {
    let sine = fit_sine(values, clock).ok_or("the samples do not determine a sine")?;
    let fitted =
        |index| sine.offset + sine.amplitude * (clock.phase_rad(index) + sine.phase_rad).cos();
    Ok(values
        .iter()
        .enumerate()
        .map(|(index, value)| value - fitted(index))
        .collect())
}
