//! How long a filter that has learned one motion takes to learn the next.
//!
//! Least squares with a forgetting factor of 1 weigh all they have seen alike: after a long time at
//! rest their weights are those for rest, and a motion that begins then is attenuated until it has
//! lasted long enough to count.

use crate::metrics::estimate::blocks::RATIO_BLOCKS;
use crate::metrics::estimate::interval;
use crate::metrics::estimate::interval::NORMAL_QUANTILE;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::{Applies, MetricKey, Needs, Table};
use crate::metrics::noise::autocovariance::LaggedProducts;
use crate::metrics::record::{FilterFacts, Record};
use crate::metrics::sine::fit::{SwingClock, fit_sine};
use crate::metrics::steps::settling::tail_start;
use crate::metrics::theory::memory::memory_samples;
use crate::metrics::theory::prediction::{lags_needed, predict, prediction_lack};
use crate::signal::{FilterShape, WeightRule};
use crate::wording::decimals;

/// Readaptation.
pub static READAPTATION_TIME: MetricKey = MetricKey::of_filters(
    "readaptation_time_s",
    "s",
    Applies::Onset,
    "time from the start of a motion until the gain stays within 1 % of what it teaches; of a filter that does not adapt its memory",
)
.lower_is_better()
.heading("readaptation")
.needs(Needs::SettledStep)
.tables(&[Table::Swing, Table::Steps]);

/// How the reason begins where the gain does not come back.
pub(crate) const NOT_WITHIN: &str = "not within the record";

/// Half width of the band as a part of the final gain.
const BAND: f64 = 0.01;

/// Largest scatter of the gain from window to window as a part of the final gain: the band is more
/// than three such deviations.
const SCATTER_MAX: f64 = 0.003;

/// Fewest windows of which a time is told.
const WINDOWS_MIN: usize = 8;

/// Samples of the shortest window after a step.
const STEP_UNIT_SAMPLES: usize = 16;

/// Part of the step within which a rate counts as the final one.
const FINAL_RATE: f64 = 1e-3;

/// Smallest final rate in standard errors of its mean, those of white noise.
const MEAN_PER_ERROR_MIN: f64 = 30.0;

/// In-phase and quadrature part of one series over one unit of time.
type Phasor = [f64; 2];

/// Channel and raw over consecutive units of time from the beginning of the motion on.
///
/// A unit is a whole cycle of a swing, with the two parts of the fitted sine, or 16 samples after a
/// step, with their sum.
#[derive(Clone, Debug)]
pub struct GainUnits {
    units: Vec<[Phasor; 2]>,
    unit_s: f64,
}

/// Time until a gain is back.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Readaptation {
    /// From the beginning of the motion, s. The interval spans the windows on both sides of the
    /// border found, and what the scatter of the gain leaves open.
    pub time_s: Estimate,
    /// Length of the windows over which the gain is taken, s.
    pub window_s: f64,
    /// Gain in the first window.
    pub first_gain: f64,
}

impl GainUnits {
    /// Cycle by cycle of a swing that begins with the record.
    #[must_use]
    pub fn of_swing(channel: &[f64], raw: &[f64], clock: &SwingClock) -> Self {
        let cycles = clock.whole_cycles(channel.len().min(raw.len()));
        let unit = |cycle: usize| {
            let (start, end) = (clock.samples_in(cycle), clock.samples_in(cycle + 1));
            let own = SwingClock {
                first_stamp_s: clock.first_stamp_s + start as f64 * clock.sample_period_s,
                ..*clock
            };
            let phasor = |values: &[f64]| -> Option<Phasor> {
                let fit = fit_sine(values.get(start..end.min(values.len()))?, &own)?;
                let (sine, cosine) = fit.phase_rad.sin_cos();
                Some([fit.amplitude * cosine, fit.amplitude * sine])
            };
            Some([phasor(channel)?, phasor(raw)?])
        };
        Self {
            units: (0..cycles).map_while(unit).collect(),
            unit_s: 1.0 / clock.frequency_hz,
        }
    }

    /// Sums over 16 samples each.
    #[must_use]
    pub fn of_step(channel: &[f64], raw: &[f64], sample_period_s: f64) -> Self {
        let sum = |values: &[f64]| [values.iter().sum(), 0.0];
        let chunks = channel
            .chunks_exact(STEP_UNIT_SAMPLES)
            .zip(raw.chunks_exact(STEP_UNIT_SAMPLES));
        Self {
            units: chunks.map(|(own, other)| [sum(own), sum(other)]).collect(),
            unit_s: STEP_UNIT_SAMPLES as f64 * sample_period_s,
        }
    }

    /// Gain over raw in windows of `count` units.
    fn gains(&self, count: usize) -> Vec<f64> {
        let size = |window: &[[Phasor; 2]], series: usize| {
            let part = |part: usize| -> f64 { window.iter().map(|unit| unit[series][part]).sum() };
            part(0).hypot(part(1))
        };
        self.units
            .chunks_exact(count)
            .map(|window| size(window, 0) / size(window, 1))
            .collect()
    }

    /// Time until the gain stays within 1 % of `final_gain`.
    ///
    /// The windows are the shortest, doubled from one unit on, over which the gain scatters by less
    /// than 0.3 % from one to the next in the second half of the record. Channel and raw have their
    /// noise at the frequency of the motion in common, so that it hardly moves their ratio.
    ///
    /// # Errors
    /// The reason, in words: the gain scatters too much, or it is not back by the end of the record.
    pub fn readaptation(&self, final_gain: f64) -> Result<Readaptation, Unavailable> {
        if self.units.len() < WINDOWS_MIN {
            return Err(format!(
                "the motion lasts for less than {WINDOWS_MIN} windows of {:.4} s",
                self.unit_s
            )
            .into());
        }
        if !final_gain.is_finite() {
            return Err("the gain that the new motion teaches is not a finite number".into());
        }
        let mut count = 1;
        let (gains, scatter) = loop {
            let gains = self.gains(count);
            let scatter = scatter(&gains);
            if gains.len() >= WINDOWS_MIN && scatter <= SCATTER_MAX * final_gain {
                break (gains, scatter);
            }
            count *= 2;
            if self.units.len() / count < WINDOWS_MIN {
                if scatter.is_nan() {
                    return Err("there are windows without a motion of raw's".into());
                }
                return Err(format!(
                    "the gain scatters by more than {} % over an eighth of the record",
                    100.0 * SCATTER_MAX
                )
                .into());
            }
        };
        let window_s = count as f64 * self.unit_s;
        let end_s = gains.len() as f64 * window_s;
        let back = |band: f64| {
            let outside = |gain: &f64| (gain - final_gain).abs() > band;
            gains.iter().rposition(outside).map_or(0, |last| last + 1)
        };
        let band = BAND * final_gain;
        let windows = back(band);
        // One window inside may be chance.
        if windows + 2 > gains.len() {
            return Err(format!(
                "{NOT_WITHIN} of {end_s:.4} s after the motion began: the gain is {} at its end, \
                 1 % about {} is asked for",
                decimals(gains[gains.len() - 1], 4),
                decimals(final_gain, 4)
            )
            .into());
        }
        let doubt = NORMAL_QUANTILE * scatter;
        let (early, late) = (back(band + doubt), back(band - doubt));
        Ok(Readaptation {
            time_s: Estimate::with_interval(
                windows as f64 * window_s,
                early.saturating_sub(1) as f64 * window_s,
                ((late + 1) as f64 * window_s).min(end_s),
            ),
            window_s,
            first_gain: gains[0],
        })
    }
}

/// Standard deviation of gains from their second differences in the second half, which a trend does
/// not widen: the variance of `a - 2b + c` is six times that of each.
fn scatter(gains: &[f64]) -> f64 {
    let half = &gains[gains.len() / 2..];
    let squares: Vec<f64> = half
        .windows(3)
        .map(|three| (three[0] - 2.0 * three[1] + three[2]).powi(2))
        .collect();
    if squares.is_empty() {
        return f64::INFINITY;
    }
    (interval::mean(&squares) / 6.0).sqrt()
}

/// Whether a filter learns at all; one that does not has [`put_memory`] for an answer.
pub(crate) fn adapts(shape: &FilterShape) -> bool {
    matches!(shape.rule, WeightRule::Adaptive { .. })
}

/// Enters the readaptation time of a filter that does not adapt: its memory, whatever the motion.
///
/// A motion that begins within a word shows whole in the next one, and the output holds nothing older
/// once that word has come to the oldest sample weighed: `newest age + memory` samples after the motion
/// began if it begins with a word, which is the interval's lower end, and one more at the latest.
pub(crate) fn put_memory(facts: &FilterFacts, sample_period_s: f64, metrics: &mut ChannelMetrics) {
    let memory = memory_samples(&facts.shape);
    let reach_s = (facts.shape.newest_age_samples + memory) as f64 * sample_period_s;
    let least_s = reach_s + facts.latency_s;
    let most_s = least_s + sample_period_s;
    let time_s = Estimate::with_interval(most_s, least_s, most_s);
    let fields = &mut metrics.put(&READAPTATION_TIME, time_s).fields;
    fields.insert("memory_samples", memory as f64);
}

/// Enters the readaptation time with what defines it, or the reason for its lack.
pub(crate) fn put(units: &GainUnits, final_gain: f64, metrics: &mut ChannelMetrics) {
    match units.readaptation(final_gain) {
        Ok(found) => {
            let fields = &mut metrics.put(&READAPTATION_TIME, found.time_s).fields;
            fields.insert("window_s", found.window_s);
            fields.insert("first_gain", found.first_gain);
            fields.insert("final_gain", final_gain);
        }
        Err(reason) => metrics.miss(&READAPTATION_TIME, reason),
    }
}

/// Readaptation after a change of rate from sample `start` on, whose last quarter is the new rate.
///
/// The gain asked for is the sum of the weights that the new rate alone would teach: the Wiener
/// weights for its square plus the autocovariance of raw's noise.
pub(crate) fn measure_after_step(
    record: &Record,
    start: usize,
    facts: &FilterFacts,
    metrics: &mut ChannelMetrics,
) {
    if !adapts(&facts.shape) {
        return;
    }
    let tail = &record.raw_deg_per_h[tail_start(record.raw_deg_per_h.len(), start)..];
    let mean = interval::mean(tail);
    let lags = lags_needed(&facts.shape);
    let noise = LaggedProducts::new(tail, mean, lags, RATIO_BLOCKS).autocovariance();
    if mean.abs() <= MEAN_PER_ERROR_MIN * (noise[0] / tail.len().max(1) as f64).sqrt() {
        let reason = "the final rate is too small against the noise to predict what it teaches";
        return metrics.miss(&READAPTATION_TIME, reason);
    }
    let second_moment: Vec<f64> = noise.iter().map(|value| value + mean * mean).collect();
    let Some(prediction) = predict(&facts.shape, &second_moment) else {
        return metrics.miss(&READAPTATION_TIME, prediction_lack(&facts.shape));
    };
    let units = GainUnits::of_step(
        &record.channel_deg_per_h[start..],
        &record.raw_deg_per_h[start..],
        record.sample_period_s,
    );
    put(&units, prediction.dc_gain(), metrics);
}

/// First sample of a motion that ends in a constant rate: where the truth leaves its first value
/// by more than a thousandth of the change; `None` if the last quarter after it still changes.
pub(crate) fn onset(truth_deg_per_h: &[f64]) -> Option<usize> {
    let (first, last) = (truth_deg_per_h.first()?, truth_deg_per_h.last()?);
    let change = (last - first).abs();
    let scale = first.abs().max(last.abs());
    if change <= 1e-9 * scale {
        return None;
    }
    let start = truth_deg_per_h
        .iter()
        .position(|rate| (rate - first).abs() > FINAL_RATE * change)?;
    let settled = truth_deg_per_h[tail_start(truth_deg_per_h.len(), start)..]
        .iter()
        .all(|rate| (rate - last).abs() <= FINAL_RATE * change);
    settled.then_some(start)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Units whose gain approaches 0.98 from 0.5 with a time constant in units.
    fn creeping(units: i32, time_constant: f64) -> GainUnits {
        let gain = |unit: i32| 0.98 - 0.48 * (-(f64::from(unit) + 0.5) / time_constant).exp();
        GainUnits {
            units: (0..units)
                .map(|unit| [[gain(unit), 0.0], [0.6, 0.8]])
                .collect(),
            unit_s: 0.2,
        }
    }

    #[test]
    fn an_exponential_approach_is_within_one_percent_after_3_9_time_constants() {
        let found = creeping(400, 20.0).readaptation(0.98).unwrap();
        // 0.48 exp(-t / tau) = 0.0098.
        let expected_s = 0.2 * 20.0 * (0.48_f64 / 0.0098).ln();
        assert!(found.time_s.low <= expected_s && expected_s <= found.time_s.high);
        assert!((found.time_s.value - expected_s).abs() <= 0.2, "{found:?}");
        assert!((found.first_gain - 0.51).abs() < 0.01);
    }

    #[test]
    fn what_does_not_come_back_is_bounded_by_the_record() {
        let reason = creeping(100, 200.0).readaptation(0.98).unwrap_err();
        assert!(
            reason
                .as_str()
                .starts_with("not within the record of 20.0000 s"),
            "{reason}"
        );
        let at_once = creeping(100, 1e-3).readaptation(0.98).unwrap();
        assert!(at_once.time_s.value <= 0.0 && at_once.time_s.high <= 0.21);
    }

    #[test]
    fn the_onset_is_where_the_truth_leaves_its_first_value() {
        let mut truth = vec![8.0; 100];
        truth.extend((1..=20).map(|k| 8.0 + f64::from(k)));
        truth.extend(vec![28.0; 80]);
        assert_eq!(onset(&truth), Some(100));
        assert_eq!(onset(&truth[..120]), None);
        assert_eq!(onset(&[8.0; 50]), None);
    }
}
