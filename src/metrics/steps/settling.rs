//! Settling after a step of rate.

use statrs::distribution::{ContinuousCDF, Normal};

use crate::metrics::estimate::interval;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::{Applies, Headline, MetricKey, Needs, Table};
use crate::wording::counted;

/// Settling time.
pub static SETTLING_TIME: MetricKey = MetricKey::new(
    "settling_time_s",
    "s",
    Applies::Steps,
    "time after the last step until the rate stays within max(1 % of the step, 5 sigma)",
)
.lower_is_better()
.synonyms(&["settle_time", "settling"])
.heading("settling time")
.needs(Needs::Step)
.of_turned_axis()
.tables(&[Table::Steps])
.headlines(&[Headline::Steps]);

/// Half width of the band as a part of the step.
const BAND_PER_STEP: f64 = 0.01;

/// Half width of the band, at least, in standard deviations of the noise.
const BAND_NOISE_DEVIATIONS: f64 = 5.0;

/// Probability that noise alone leaves the band once in the record.
const FALSE_EXIT_PROBABILITY: f64 = 0.01;

/// Fewest samples after the last step of which settling is told.
pub(crate) const STEP_SAMPLES_MIN: usize = 16;

/// What a step record shows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Settling {
    /// From the step to the stamp of the first sample after which the rate stays in the band, s. The
    /// interval is that of the noise at the edge of the band, and a sample more on either side, as
    /// the time is a whole number of them.
    pub settling_time_s: Estimate,
    /// Half width of the band, deg/h.
    pub band_deg_per_h: f64,
    /// Rate settled at: mean of the last quarter, deg/h.
    pub final_deg_per_h: f64,
    /// Standard deviation of the last quarter about its own straight line, deg/h.
    pub noise_std_deg_per_h: f64,
    /// Distance from there that the noise of the samples after the step reaches with a probability
    /// of 1 % or less, deg/h.
    pub noise_reach_deg_per_h: f64,
}

/// First sample of the last quarter after the step, where the rate counts as settled.
#[must_use]
pub(crate) fn tail_start(samples: usize, step_index: usize) -> usize {
    step_index + (samples.saturating_sub(step_index)) * 3 / 4
}

/// Settling time after the last step of a record.
///
/// The rate settles at the mean of the last quarter of the samples after the step. It has settled
/// from the first sample after which it never leaves a band of the larger of 1 % of the step and
/// 5 standard deviations of the noise in that quarter (more in records of more than some 17 000
/// samples after the step: the band is then such that noise alone leaves it with a probability of
/// 1 %). A change of gain shows in the mean error, not here.
///
/// * `rate_deg_per_h`: record, deg/h.
/// * `step_index`: first sample of the new rate; its stamp is one sample period after the step.
///
/// # Errors
/// The reason, in words, if fewer than 16 samples follow the step or the rate leaves the band in the
/// last quarter.
pub fn settling(
    rate_deg_per_h: &[f64],
    step_index: usize,
    step_deg_per_h: f64,
    sample_period_s: f64,
) -> Result<Settling, Unavailable> {
    let samples = rate_deg_per_h.len();
    if samples < step_index + STEP_SAMPLES_MIN {
        return Err(format!(
            "{} after the last step; settling needs {STEP_SAMPLES_MIN}",
            counted(samples.saturating_sub(step_index), "sample")
        )
        .into());
    }
    let start = tail_start(samples, step_index);
    let tail = &rate_deg_per_h[start..];
    let target = interval::mean(tail);
    let noise = deviation_about_line(tail);
    let noise_reach = noise * noise_deviations(samples - step_index);
    let band = (BAND_PER_STEP * step_deg_per_h.abs()).max(noise_reach);
    let settled_within = |band: f64| {
        let outside = rate_deg_per_h[step_index..]
            .iter()
            .rposition(|rate| (rate - target).abs() > band);
        outside.map_or(0, |last| last + 1)
    };
    let settled = settled_within(band);
    if step_index + settled > start {
        return Err("the rate has not settled before the last quarter of the record".into());
    }
    Ok(Settling {
        settling_time_s: {
            let reach = interval::NORMAL_QUANTILE * noise;
            let entered = |band: f64| {
                let inside = |rate: &f64| (rate - target).abs() <= band;
                rate_deg_per_h[step_index..]
                    .iter()
                    .position(inside)
                    .unwrap_or(settled)
            };
            let ends = [
                entered(band + reach).min(settled),
                (entered(band - reach) + 2).max(settled + 2),
            ];
            let [value, low, high] =
                [settled + 1, ends[0], ends[1]].map(|samples| samples as f64 * sample_period_s);
            Estimate::with_interval(value, low, high)
        },
        band_deg_per_h: band,
        final_deg_per_h: target,
        noise_std_deg_per_h: noise,
        noise_reach_deg_per_h: noise_reach,
    })
}

/// Standard deviation about the straight line through the values.
///
/// A rate that still creeps must not pass for noise and widen its own band.
fn deviation_about_line(values: &[f64]) -> f64 {
    let middle = (values.len() as f64 - 1.0) / 2.0;
    let mean = interval::mean(values);
    let (mut squares, mut cross, mut spread) = (0.0, 0.0, 0.0);
    for (index, value) in values.iter().enumerate() {
        let from_middle = index as f64 - middle;
        let deviation = value - mean;
        squares += deviation * deviation;
        cross += from_middle * deviation;
        spread += from_middle * from_middle;
    }
    let residual = (squares - cross * cross / spread.max(f64::MIN_POSITIVE)).max(0.0);
    (residual / (values.len().max(3) - 2) as f64).sqrt()
}

/// Half width of the band in standard deviations for a number of samples.
fn noise_deviations(samples: usize) -> f64 {
    let tail = FALSE_EXIT_PROBABILITY / (2.0 * samples as f64);
    let quantile = Normal::standard().inverse_cdf(1.0 - tail);
    quantile.max(BAND_NOISE_DEVIATIONS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exponential_settles_to_one_percent_after_4_6_time_constants() {
        let time_constant = 50.0;
        let rates: Vec<f64> = (0..4000_i32)
            .map(|k| {
                let since = f64::from(k) - 99.0;
                if since <= 0.0 {
                    0.0
                } else {
                    36.0 * (1.0 - (-since / time_constant).exp())
                }
            })
            .collect();
        let settled = settling(&rates, 100, 36.0, 0.001).unwrap();
        let expected = 0.001 * (time_constant * 100.0_f64.ln()).ceil();
        assert!(
            (settled.settling_time_s.value - expected).abs() < 1e-12,
            "{settled:?}"
        );
    }

    #[test]
    fn a_record_that_never_settles_is_refused() {
        let rates: Vec<f64> = (0..400_i32).map(f64::from).collect();
        assert!(settling(&rates, 10, 1.0, 0.1).is_err());
        assert!(settling(&rates, 395, 1.0, 0.1).is_err());
    }
}
