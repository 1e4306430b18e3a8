//! Overshoot and rise time of the last step of a record.

use super::settling::{Settling, tail_start};
use crate::metrics::estimate::influence::Spread;
use crate::metrics::estimate::magnitude::{Peak, ensemble_mean};
use crate::metrics::estimate::paired::{covariance_at_lags, mean_spread};
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
.lower_is_better()
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
.lower_is_better()
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
    /// value is then 0. The interval is that of the mean over records of a value which is 0 in some of
    /// them: it has the excess that this record may hide in its noise, and what is then seen of it.
    #[must_use]
    pub fn overshoot(&self) -> Estimate {
        let peak = (self.index..self.rate_deg_per_h.len())
            .map(|index| self.response(index) - 1.0)
            .fold(0.0, f64::max);
        let after = self.rate_deg_per_h.len() - self.index;
        let noise = self.noise();
        let counts_from = self.settling.noise_reach_deg_per_h / self.height_deg_per_h.abs();
        if noise <= 0.0 {
            return Estimate::exact(peak);
        }
        let law = Peak {
            samples: after,
            counts_from: counts_from / noise,
        };
        ensemble_mean(&law, peak / noise).scaled(noise)
    }

    /// Time from 10 % to 90 % of the step, s, linear between samples.
    ///
    /// The interval is that of the noise of the samples between which the two crossings lie, with
    /// their correlation, and of the rate settled at; the error of the straight line between two
    /// samples is the same in every record.
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
        let (Some(start), Some(end)) = (self.crossing(RISE.0), self.crossing(RISE.1)) else {
            return Err("no sample precedes the step".into());
        };
        let value = (end.at() - start.at()) * self.sample_period_s;
        let deviation = self.rise_deviation(&start, &end) * self.sample_period_s;
        let rise = Spread::known(deviation * deviation).about(value);
        Ok(rise.clamped(0.0, f64::INFINITY))
    }

    /// Standard deviation of the time between two crossings by the noise, samples.
    fn rise_deviation(&self, start: &Crossing, end: &Crossing) -> f64 {
        let slopes: Vec<(usize, f64)> = end
            .slopes()
            .into_iter()
            .chain(start.slopes().map(|(index, slope)| (index, -slope)))
            .collect();
        let lags = end.before + 1 - start.before;
        let tail = &self.rate_deg_per_h[tail_start(self.rate_deg_per_h.len(), self.index)..];
        let noise = covariance_at_lags(tail, lags.min(tail.len() / LAGS_PER_TAIL));
        let covariance = |lag: usize| noise.get(lag).copied().unwrap_or(0.0);
        let variance: f64 = slopes
            .iter()
            .flat_map(|(i, a)| {
                slopes
                    .iter()
                    .map(move |(j, b)| a * b * covariance(i.abs_diff(*j)))
            })
            .sum();
        // The rate settled at moves all responses alike.
        let common: f64 = slopes.iter().map(|(_, slope)| slope).sum();
        let settled = mean_spread(tail, 1).variance * common * common;
        (variance.max(0.0) + settled).sqrt() / self.height_deg_per_h.abs()
    }

    /// Where the response first reaches a level.
    fn crossing(&self, level: f64) -> Option<Crossing> {
        let after =
            (self.index..self.rate_deg_per_h.len()).find(|&index| self.response(index) >= level)?;
        let before = after.checked_sub(1)?;
        let (low, high) = (self.response(before), self.response(after));
        Some(Crossing {
            before,
            part: ((level - low) / (high - low)).clamp(0.0, 1.0),
            rise: high - low,
        })
    }
}

/// Samples of the settled rate for each lag of its autocovariance.
const LAGS_PER_TAIL: usize = 8;

/// Where a response crosses a level.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    /// The sample before.
    before: usize,
    /// Part of the way to the next one.
    part: f64,
    /// Response of the next one over that of this.
    rise: f64,
}

impl Crossing {
    /// Time of the crossing, samples.
    fn at(&self) -> f64 {
        self.before as f64 + self.part
    }

    /// Derivatives of that time by the responses of the two samples.
    fn slopes(&self) -> [(usize, f64); 2] {
        [
            (self.before, -(1.0 - self.part) / self.rise),
            (self.before + 1, -self.part / self.rise),
        ]
    }
}

/// Enters overshoot and rise time.
///
/// `given` takes the interval from estimates that a single record does not give.
pub(crate) fn put_step_shape(
    step: &Step,
    given: impl Fn(Estimate) -> Estimate,
    metrics: &mut ChannelMetrics,
) {
    if !step.has_height() {
        for key in [&OVERSHOOT, &RISE_TIME] {
            metrics.miss(key, NO_HEIGHT);
        }
        return;
    }
    let percent = step.overshoot().scaled(100.0);
    metrics.put(&OVERSHOOT, given(percent));
    match step.rise_time_s() {
        Ok(rise) => {
            metrics.put(&RISE_TIME, given(rise));
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
                    settling_time_s: Estimate::exact(0.1),
                    band_deg_per_h: 50.0,
                    final_deg_per_h: 100.0,
                    noise_std_deg_per_h: 10.0,
                    noise_reach_deg_per_h: 40.0,
                },
                sample_period_s: 0.1,
            };
            let mut metrics = ChannelMetrics::default();
            put_step_shape(&step, |estimate| estimate, &mut metrics);
            for key in [&OVERSHOOT, &RISE_TIME] {
                assert_eq!(metrics.why_unavailable(key), Some(NO_HEIGHT));
            }
        }
    }
}
