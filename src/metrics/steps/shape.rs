//! Overshoot and rise time of the last step of a record.

use super::settling::Settling;
use crate::metrics::estimate::interval::NORMAL_QUANTILE;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::{Applies, MetricKey, Needs, Table};
use crate::wording::decimals;

/// Rise time.
pub static RISE_TIME: MetricKey = MetricKey::new(
    "rise_time_s",
    "s",
    Applies::Steps,
    "time from 10 % to 90 % of the last step, linear between samples",
)
.synonyms(&["rise_time"])
.heading("rise time")
.needs(Needs::Step)
.of_turned_axis()
.tables(&[Table::Steps]);

/// Overshoot.
pub static OVERSHOOT: MetricKey = MetricKey::new(
    "overshoot_percent",
    "%",
    Applies::Steps,
    "largest excess over the settled rate after the last step, of the step; 0 within the noise",
)
.heading("overshoot")
.needs(Needs::Step)
.of_turned_axis()
.tables(&[Table::Steps]);

/// Parts of the step between which the rise is timed.
const RISE: (f64, f64) = (0.1, 0.9);

/// Noise beyond which a crossing of these parts says nothing, as a part of the step.
const NOISE_MAX: f64 = 0.025;

/// Reason of a step without a height.
const NO_HEIGHT: &str = "the last step has no height";

/// A step with what the rate settles at.
#[derive(Clone, Copy, Debug)]
pub struct Step<'a> {
    /// Record, deg/h.
    pub rate_deg_per_h: &'a [f64],
    /// First sample of the new rate.
    pub index: usize,
    /// Height, deg/h.
    pub height_deg_per_h: f64,
    /// How it settled.
    pub settling: Settling,
    /// Sample period, s.
    pub sample_period_s: f64,
}

impl Step<'_> {
    /// Response of sample `index`: 0 before the step, 1 where it has settled.
    fn response(&self, index: usize) -> f64 {
        let from_final = self.rate_deg_per_h[index] - self.settling.final_deg_per_h;
        1.0 + from_final / self.height_deg_per_h
    }

    /// Whether there is a height to divide by; next to nothing is none.
    fn has_height(&self) -> bool {
        let settling = &self.settling;
        let largest = settling
            .noise_reach_deg_per_h
            .max(settling.final_deg_per_h.abs());
        (100.0 * largest / self.height_deg_per_h).is_finite()
    }

    /// Standard deviation of the noise as a part of the step.
    fn noise(&self) -> f64 {
        self.settling.noise_std_deg_per_h / self.height_deg_per_h.abs()
    }

    /// Largest excess over the final rate as a part of the step.
    ///
    /// An excess that the noise of the record reaches with a probability of 1 % or more is none: the
    /// value is then 0, and the interval reaches up to that level.
    #[must_use]
    pub fn overshoot(&self) -> Estimate {
        let peak = (self.index..self.rate_deg_per_h.len())
            .map(|index| self.response(index) - 1.0)
            .fold(0.0, f64::max);
        let reached_by_noise = self.settling.noise_reach_deg_per_h / self.height_deg_per_h.abs();
        if peak <= reached_by_noise {
            return Estimate::with_interval(0.0, 0.0, reached_by_noise);
        }
        let half_width = NORMAL_QUANTILE * self.noise();
        Estimate::with_interval(peak, (peak - half_width).max(0.0), peak + half_width)
    }

    /// Time from 10 % to 90 % of the step, s, linear between samples.
    ///
    /// The interval is that of the noise, widened by a sample period: each crossing is known to lie
    /// between two samples.
    ///
    /// # Errors
    /// The reason, in words, where the step has no height, the noise is large or no sample precedes the step.
    pub fn rise_time_s(&self) -> Result<Estimate, Unavailable> {
        if !self.has_height() {
            return Err(NO_HEIGHT.into());
        }
        let noise = self.noise();
        if noise > NOISE_MAX {
            return Err(format!(
                "the noise is {} % of the step: allowed up to {:.1} %",
                decimals(100.0 * noise, 1),
                100.0 * NOISE_MAX
            )
            .into());
        }
        let shift = NORMAL_QUANTILE * noise;
        let rise = |shift: f64| {
            let (start, end) = (
                self.crossing(RISE.0 + shift)?,
                self.crossing(RISE.1 - shift)?,
            );
            Some((end - start) * self.sample_period_s)
        };
        let found = (rise(0.0), rise(shift), rise(-shift));
        let (Some(value), Some(short), Some(long)) = found else {
            return Err("no sample precedes the step".into());
        };
        let period_s = self.sample_period_s;
        let low = (short.min(value) - period_s).max(0.0);
        Ok(Estimate::with_interval(
            value,
            low,
            long.max(value) + period_s,
        ))
    }

    /// Where the response first reaches a level, samples.
    fn crossing(&self, level: f64) -> Option<f64> {
        let after =
            (self.index..self.rate_deg_per_h.len()).find(|&index| self.response(index) >= level)?;
        let before = after.checked_sub(1)?;
        let (low, high) = (self.response(before), self.response(after));
        Some(before as f64 + ((level - low) / (high - low)).clamp(0.0, 1.0))
    }
}

/// Enters overshoot and rise time.
pub(crate) fn put_step_shape(step: &Step, metrics: &mut ChannelMetrics) {
    if !step.has_height() {
        for key in [&OVERSHOOT, &RISE_TIME] {
            metrics.miss(key, NO_HEIGHT);
        }
        return;
    }
    let percent = step.overshoot().scaled(100.0);
    metrics.put(&OVERSHOOT, percent);
    match step.rise_time_s() {
        Ok(rise) => {
            metrics.put(&RISE_TIME, rise);
        }
        Err(reason) => metrics.miss(&RISE_TIME, reason),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_of_next_to_nothing_has_no_height_and_no_noise_in_percent_of_it() {
        for height_deg_per_h in [0.0, 1e-307] {
            let step = Step {
                rate_deg_per_h: &[100.0; 32],
                index: 16,
                height_deg_per_h,
                settling: Settling {
                    settling_time_s: 0.1,
                    band_deg_per_h: 50.0,
                    final_deg_per_h: 100.0,
                    noise_std_deg_per_h: 10.0,
                    noise_reach_deg_per_h: 40.0,
                },
                sample_period_s: 0.1,
            };
            let mut metrics = ChannelMetrics::default();
            put_step_shape(&step, &mut metrics);
            for key in [&OVERSHOOT, &RISE_TIME] {
                assert_eq!(metrics.why_unavailable(key), Some(NO_HEIGHT));
            }
        }
    }
}
