//! Delay of a swing by correlation: a cross-check of the sine fit.

use super::fit::{CYCLES_MIN, SwingClock};
use crate::metrics::estimate::interval;
use crate::metrics::estimate::interval::round_to_count;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::value::Estimate;

/// Most blocks of the window, for the jackknife.
const BLOCKS_MAX: usize = 20;

/// The correlation's window, its blocks and the two series about their means.
struct Window<'a> {
    reference: &'a [f64],
    values: &'a [f64],
    reference_mean: f64,
    values_mean: f64,
    /// Largest lag, samples; the window begins as many samples inside the record.
    margin: usize,
    /// Where every block begins, and the last one ends: samples, not whole ones.
    borders: Vec<f64>,
}

/// Sum over a part of the time axis on which sample k stands for `k - 1/2 ... k + 1/2`: those that a
/// border cuts count in part, so that whole cycles stay whole.
fn sum_between(ends: &[f64], value: impl Fn(usize) -> f64) -> f64 {
    let [start, end] = [ends[0], ends[1]].map(|end| (end, round_to_count((end + 0.5).floor())));
    let inside: f64 = (start.1 + 1..end.1).map(&value).sum();
    let first = (start.1 as f64 + 0.5 - start.0) * value(start.1);
    let last = (end.0 - end.1 as f64 + 0.5) * value(end.1);
    first + inside + last
}

impl Window<'_> {
    /// `sum x[k] y[k + lag]` over a block, for the lag `shift - margin`.
    fn block_product(&self, ends: &[f64], shift: usize) -> f64 {
        sum_between(ends, |index| {
            let later = self.values[index + shift - self.margin] - self.values_mean;
            (self.reference[index] - self.reference_mean) * later
        })
    }

    fn products(&self, shift: usize) -> Vec<f64> {
        let blocks = self.borders.windows(2);
        blocks.map(|ends| self.block_product(ends, shift)).collect()
    }

    /// The shift of the largest product, by ever smaller steps.
    ///
    /// The correlation of a swing is a cosine of the lag, with one peak within half a cycle, so that
    /// no peak can hide between coarse steps.
    fn best_shift(&self) -> usize {
        let product = |shift: usize| self.products(shift).iter().sum::<f64>();
        let last = 2 * self.margin;
        let mut step = (self.margin / 8).max(1);
        let mut tried: Vec<usize> = (0..=last).step_by(step).collect();
        loop {
            let best = tried
                .iter()
                .map(|&shift| (shift, product(shift)))
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
/// a second of 5 Hz. Here a sample that the border of W or of a block cuts counts in part; what is
/// left goes with the square of the sample period. The peak is that of the
/// parabola through the three largest sums; on a pure sine it errs by `(w d)^2 / 3 - (w T)^2 / 12` of
/// the part d of a sample. The interval is jackknifed over blocks of whole cycles.
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
    let count = cycles.min(BLOCKS_MAX);
    let border =
        |block: usize| (margin + 1) as f64 + (cycles * block / count) as f64 * samples_per_cycle;
    let borders: Vec<f64> = (0..=count).map(border).collect();
    let whole = [borders[0], borders[count]];
    let mean_of =
        |values: &[f64]| sum_between(&whole, |index| values[index]) / (whole[1] - whole[0]);
    let window = Window {
        reference,
        values,
        reference_mean: mean_of(reference),
        values_mean: mean_of(values),
        margin,
        borders,
    };
    let best = window.best_shift();
    if best == 0 || best == 2 * margin {
        return Err("the correlation has no peak within a quarter of a cycle".into());
    }
    let products = [best - 1, best, best + 1].map(|shift| window.products(shift));
    let [before, at, after] = &products;
    let sum = |products: &[f64]| products.iter().sum::<f64>();
    let totals = [sum(before), sum(at), sum(after)];
    let delay_s = |sums: [f64; 3]| {
        let part = 0.5 * (sums[0] - sums[2]) / (sums[0] - 2.0 * sums[1] + sums[2]);
        (best as f64 - margin as f64 + part) * clock.sample_period_s
    };
    let left_out: Vec<f64> = (0..count)
        .map(|block| {
            delay_s([
                totals[0] - before[block],
                totals[1] - at[block],
                totals[2] - after[block],
            ])
        })
        .collect();
    Ok(interval::jackknife(delay_s(totals), &left_out))
}
