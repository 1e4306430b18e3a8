//! The verdict on a filter: what the intervals of its metrics say it does to signal and noise.

use super::estimate::table::ChannelMetrics;
use super::estimate::value::Estimate;
use super::key::metric::MetricKey;
use super::motion::steps::SETTLED_GAIN;
use super::motion::swing::{AMPLITUDE_RATIO, DELAY_VS_RAW};
use super::noise::level::NOISE_GAIN;
use super::steps::staircase::SCALE_FACTOR_ERROR;
use super::trial::black_box::{
    MEMORY_1_PERCENT, SINE_FREQUENCY, SINE_GAIN, STEP_GAINS, TWIN_MEAN_RATIO,
};
use super::trial::dc_gain::{ANGLE_RANDOM_WALK_OVER_DC_GAIN, DC_GAIN};
use super::trial::noise_delay::NOISE_GAIN_OVER_BOUND;
use super::trial::predicted::DELAY_AT_DC;
use super::trial::readaptation::READAPTATION_TIME;
use super::trial::weight_noise::{ALLAN_RATIO_INSIDE_MEMORY, WEIGHT_NOISE_RATIO};
use crate::units::MICRO;

/// Distance of a gain from 1 that counts as none.
const GAIN_TOLERANCE: f64 = 0.01;

/// Distance of a ratio of noise from 1 that counts as none.
const NOISE_TOLERANCE: f64 = 0.05;

/// Where the interval of a ratio lies against 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AgainstOne {
    /// All of it below.
    Below,
    /// All of it within the tolerance.
    Equal,
    /// All of it above.
    Above,
    /// It reaches over 1 and beyond the tolerance.
    Undecided,
}

/// A ratio and where it lies.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Finding {
    /// The ratio.
    pub estimate: Estimate,
    /// Where its interval lies.
    pub against_one: AgainstOne,
}

impl Finding {
    /// Judges the interval of a ratio of noise.
    #[must_use]
    pub fn of_noise(estimate: Estimate) -> Self {
        Self::new(estimate, NOISE_TOLERANCE)
    }

    /// Judges the interval of a ratio; within `tolerance` of 1 comes before below and above.
    #[must_use]
    pub fn new(estimate: Estimate, tolerance: f64) -> Self {
        let Estimate { low, high, .. } = estimate;
        let against_one = if low >= 1.0 - tolerance && high <= 1.0 + tolerance {
            AgainstOne::Equal
        } else if high < 1.0 {
            AgainstOne::Below
        } else if low > 1.0 {
            AgainstOne::Above
        } else {
            AgainstOne::Undecided
        };
        Self {
            estimate,
            against_one,
        }
    }
}

/// What a filter does to fast noise, and by what means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Deed {
    /// It reduces noise no more than it reduces the signal.
    Attenuates,
    /// It reduces the signal, and noise more than that.
    AttenuatesAndSmooths,
    /// It reduces noise and keeps the signal.
    Smooths,
    /// It reduces noise; whether the signal too, the intervals leave open.
    Reduces,
    /// It leaves noise as it is.
    Passes,
    /// It raises noise.
    Raises,
    /// The interval of the noise gain leaves it open.
    Undecided,
    /// The record gives no noise gain.
    NotJudged,
}

/// The verdict on one filter.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FilterVerdict {
    /// What it does to fast noise.
    pub deed: Deed,
    /// Gain for a small added constant rate.
    pub dc_gain: Option<Finding>,
    /// Gain for the motion itself: of a swing its amplitude, of steps the last rate.
    pub motion_gain: Option<Finding>,
    /// Noise power over raw's.
    pub fast_noise: Option<Finding>,
    /// The same once the scale factor is restored: over the square of the gain.
    pub fast_noise_restored: Option<Finding>,
    /// Allan deviation over raw's once the scale factor is restored.
    pub slow_noise: Option<Finding>,
    /// Averaging time of that Allan deviation, s.
    pub slow_noise_averaging_time_s: Option<f64>,
    /// The same at 1 s, where the filter reaches into it.
    pub inside_memory: Option<Finding>,
    /// Angle random walk once the scale factor is restored, deg/sqrt(h).
    pub walk_restored_deg_per_sqrt_h: Option<Estimate>,
    /// Delay behind raw: of the motion, or at DC where there is none, ms.
    pub delay_ms: Option<Estimate>,
    /// Noise power over the least that as many fixed weights with unit DC gain have at this delay.
    pub over_bound: Option<Finding>,
    /// Time from the start of a motion within the record until the gain is back, s.
    pub readaptation_s: Option<Estimate>,
}

impl FilterVerdict {
    /// The gain that counts: that of the motion where there is one, else that at DC.
    #[must_use]
    pub fn level(&self) -> Option<Finding> {
        self.motion_gain.or(self.dc_gain)
    }
}

/// Judges a channel; `None` for one that is no filter, or that failed.
#[must_use]
pub fn filter_verdict(channel: &ChannelMetrics) -> Option<FilterVerdict> {
    let metric = |key: &MetricKey| channel.get(key);
    let estimate = |key: &MetricKey| metric(key).map(|metric| metric.estimate);
    let gain = |key: &MetricKey| estimate(key).map(|gain| Finding::new(gain, GAIN_TOLERANCE));
    let noise = |ratio: Estimate| Finding::new(ratio, NOISE_TOLERANCE);
    // A gain that twins found least is no better for what the filter learns of a lasting rate.
    // Of raw the amplitude ratio is that to the truth; only filters have a gain at DC.
    let dc_gain = gain(&DC_GAIN);
    let dc_gain = least_gain(channel).map_or(dc_gain, Some);
    let noise_gain = estimate(&NOISE_GAIN);
    if channel.error.is_some() || (dc_gain.is_none() && noise_gain.is_none()) {
        return None;
    }
    // A slope over many rates says more than the gain at the last of them, which may be rest.
    let slope = estimate(&SCALE_FACTOR_ERROR);
    let slope = slope.map(|error| Finding::new(one_plus_ppm(error), GAIN_TOLERANCE));
    let motion_gain = gain(&AMPLITUDE_RATIO).or(slope);
    let motion_gain = motion_gain.or_else(|| gain(&SETTLED_GAIN));
    let level = motion_gain.or(dc_gain);
    let restored = level
        .zip(noise_gain)
        .and_then(|(level, noise)| over_square(noise, level.estimate))
        .map(noise);
    let fast_noise = noise_gain.map(noise);
    Some(FilterVerdict {
        deed: deed(level, fast_noise, restored),
        dc_gain,
        motion_gain,
        fast_noise,
        fast_noise_restored: restored,
        slow_noise: estimate(&WEIGHT_NOISE_RATIO).map(noise),
        slow_noise_averaging_time_s: metric(&WEIGHT_NOISE_RATIO)
            .and_then(|metric| metric.fields.get("averaging_time_s").copied()),
        inside_memory: estimate(&ALLAN_RATIO_INSIDE_MEMORY).map(noise),
        walk_restored_deg_per_sqrt_h: estimate(&ANGLE_RANDOM_WALK_OVER_DC_GAIN),
        delay_ms: estimate(&DELAY_VS_RAW).or_else(|| estimate(&DELAY_AT_DC)),
        over_bound: estimate(&NOISE_GAIN_OVER_BOUND).map(noise),
        readaptation_s: estimate(&READAPTATION_TIME),
    })
}

/// Times the memory that a period must hold for the gain of a sine to be one at DC.
const PERIOD_PER_MEMORY_MIN: f64 = 30.0;

/// The least of the gains that tell of DC, where twins have run: mean over mean where the mean is sure, a
/// small step, a slow sine.
fn least_gain(channel: &ChannelMetrics) -> Option<Finding> {
    let known = |key: &MetricKey| channel.get(key).map(|metric| metric.estimate);
    let memory_s = known(&MEMORY_1_PERCENT).map(|memory| memory.value);
    let sine = channel.get(&SINE_GAIN).filter(|sine| {
        let frequency_hz = sine.fields.get(SINE_FREQUENCY);
        let period_s = frequency_hz.map(|frequency_hz| 1.0 / frequency_hz);
        let least_s = memory_s.map(|memory_s| PERIOD_PER_MEMORY_MIN * memory_s);
        period_s >= least_s && least_s.is_some()
    });
    let steps = STEP_GAINS.iter().filter_map(|(key, _)| known(key));
    let twins: Vec<Estimate> = steps.chain(sine.map(|sine| sine.estimate)).collect();
    if twins.is_empty() {
        return None;
    }
    let all = twins.into_iter().chain(known(&TWIN_MEAN_RATIO));
    let all = all.chain(known(&DC_GAIN));
    let least = all.min_by(|one, other| one.high.total_cmp(&other.high));
    least.map(|least| Finding::new(least, GAIN_TOLERANCE))
}

/// What the gain and the two noise ratios mean together.
fn deed(level: Option<Finding>, fast: Option<Finding>, restored: Option<Finding>) -> Deed {
    let Some(fast) = fast else {
        return Deed::NotJudged;
    };
    match fast.against_one {
        AgainstOne::Above => Deed::Raises,
        AgainstOne::Equal => Deed::Passes,
        AgainstOne::Undecided => Deed::Undecided,
        AgainstOne::Below => match level.map(|level| level.against_one) {
            Some(AgainstOne::Equal | AgainstOne::Above) => Deed::Smooths,
            Some(AgainstOne::Undecided) | None => Deed::Reduces,
            Some(AgainstOne::Below) => match restored.map(|ratio| ratio.against_one) {
                Some(AgainstOne::Below) => Deed::AttenuatesAndSmooths,
                _ => Deed::Attenuates,
            },
        },
    }
}

/// A power over the square of a gain; `None` where the gain may be zero.
///
/// The relative half widths add in quadrature: the ends of both intervals at once would be far less
/// probable than either. What power and gain of one record have in common makes it smaller still.
fn over_square(power: Estimate, gain: Estimate) -> Option<Estimate> {
    let ratio = power.value / (gain.value * gain.value);
    let of_gain = |end: f64| (gain.value / end).powi(2) - 1.0;
    let below = (1.0 - power.low / power.value).hypot(of_gain(gain.high));
    let above = (power.high / power.value - 1.0).hypot(of_gain(gain.low));
    (gain.low > 0.0 && power.value > 0.0).then(|| {
        let low = (ratio * (1.0 - below)).max(0.0);
        Estimate::with_interval(ratio, low, ratio * (1.0 + above))
    })
}

/// The gain that an error of the scale factor stands for.
fn one_plus_ppm(error_ppm: Estimate) -> Estimate {
    let gain = |ppm: f64| 1.0 + MICRO * ppm;
    Estimate::with_interval(
        gain(error_ppm.value),
        gain(error_ppm.low),
        gain(error_ppm.high),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::estimate::table::ChannelFailure;
    use crate::metrics::estimate::value::Metric;

    fn channel(entries: &[(&str, f64, f64)]) -> ChannelMetrics {
        let metrics = entries.iter().map(|(name, low, high)| {
            let estimate = Estimate::with_interval(0.5 * (low + high), *low, *high);
            ((*name).to_owned(), Metric::new(estimate, "1"))
        });
        ChannelMetrics {
            metrics: metrics.collect(),
            ..ChannelMetrics::default()
        }
    }

    #[test]
    fn the_intervals_of_gain_and_noise_decide_the_deed() {
        // DC gain, noise power gain, what they mean.
        let table = [
            ((0.49, 0.49), (0.235, 0.245), Deed::Attenuates),
            ((0.49, 0.49), (0.10, 0.12), Deed::AttenuatesAndSmooths),
            // Restored, the interval reaches over 1: smoothing is not shown.
            ((0.49, 0.49), (0.20, 0.26), Deed::Attenuates),
            ((1.0, 1.0), (0.24, 0.26), Deed::Smooths),
            ((0.995, 1.004), (0.24, 0.26), Deed::Smooths),
            ((1.02, 1.03), (0.24, 0.26), Deed::Smooths),
            ((0.90, 1.05), (0.24, 0.26), Deed::Reduces),
            ((0.49, 0.49), (0.96, 1.04), Deed::Passes),
            ((1.0, 1.0), (1.25, 1.35), Deed::Raises),
            ((0.49, 0.49), (0.90, 1.02), Deed::Undecided),
        ];
        for (gain, noise, expected) in table {
            let entries = [
                ("dc_gain", gain.0, gain.1),
                ("noise_gain", noise.0, noise.1),
            ];
            let verdict = filter_verdict(&channel(&entries)).unwrap();
            assert_eq!(verdict.deed, expected, "{gain:?} {noise:?}");
        }
        let only_gain = filter_verdict(&channel(&[("dc_gain", 1.0, 1.0)])).unwrap();
        assert_eq!(only_gain.deed, Deed::NotJudged);
        let only_noise = filter_verdict(&channel(&[("noise_gain", 0.2, 0.3)])).unwrap();
        assert_eq!(only_noise.deed, Deed::Reduces);
    }

    #[test]
    fn an_interval_stands_below_at_or_above_one_or_open() {
        let table = [
            ((0.5, 0.9), AgainstOne::Below),
            ((0.96, 0.99), AgainstOne::Equal),
            ((0.90, 0.99), AgainstOne::Below),
            ((0.96, 1.04), AgainstOne::Equal),
            ((1.01, 1.2), AgainstOne::Above),
            ((0.9, 1.1), AgainstOne::Undecided),
        ];
        for ((low, high), expected) in table {
            let finding = Finding::new(Estimate::with_interval(1.0, low, high), 0.05);
            assert_eq!(finding.against_one, expected, "{low} {high}");
        }
    }

    #[test]
    fn in_a_swing_the_gain_for_the_swing_and_its_delay_count() {
        let verdict = filter_verdict(&channel(&[
            ("dc_gain", 0.6, 0.6),
            ("amplitude_ratio", 0.9999, 1.0001),
            ("noise_gain", 0.5, 0.6),
            ("delay_vs_raw_ms", 0.33, 0.35),
            ("delay_at_dc_ms", 0.6, 0.6),
            ("noise_gain_over_bound", 1.4, 2.0),
        ]))
        .unwrap();
        assert_eq!(verdict.deed, Deed::Smooths);
        assert!((verdict.delay_ms.unwrap().value - 0.34).abs() < 1e-12);
        let over = verdict.over_bound.unwrap();
        assert_eq!(over.against_one, AgainstOne::Above);
        assert!((over.estimate.low - 1.4).abs() < 1e-12);
        let restored = verdict.fast_noise_restored.unwrap().estimate;
        let width = (0.05_f64 / 0.55).hypot(2e-4);
        assert!((restored.high / restored.value - 1.0 - width).abs() < 1e-6);
    }

    #[test]
    fn the_least_gain_of_twins_counts_at_dc() {
        let entries = [
            ("dc_gain", 1.0, 1.0),
            ("noise_gain", 0.23, 0.25),
            ("step_gain_1s", 0.5, 0.5),
            ("step_gain_10s", 0.7, 0.7),
            ("twin_mean_ratio", 0.9, 0.9),
            // What is learned of a lasting rate does not count.
            ("lasting_rate_gain", 0.4, 0.4),
        ];
        let verdict = filter_verdict(&channel(&entries)).unwrap();
        let gain = verdict.dc_gain.unwrap();
        assert!((gain.estimate.value - 0.5).abs() < 1e-12);
        assert_eq!(verdict.deed, Deed::Attenuates);
        // A sine within thirty memories says nothing of DC, and a mean that may be 1 is no less.
        let mut entries = channel(&[
            ("dc_gain", 1.0, 1.0),
            ("step_gain_1s", 1.0, 1.0),
            ("sine_gain", 0.3, 0.3),
            ("memory_1_percent_s", 0.1, 0.1),
            ("twin_mean_ratio", 0.98, 1.01),
        ]);
        let sine = entries.metrics.get_mut("sine_gain").unwrap();
        sine.fields.insert(SINE_FREQUENCY, 1.0);
        let verdict = filter_verdict(&entries).unwrap();
        assert_eq!(verdict.dc_gain.unwrap().against_one, AgainstOne::Equal);
        entries
            .metrics
            .extend(channel(&[("twin_mean_ratio", 0.2, 0.3)]).metrics);
        let verdict = filter_verdict(&entries).unwrap();
        assert_eq!(verdict.dc_gain.unwrap().against_one, AgainstOne::Below);
    }

    #[test]
    fn raw_and_failed_channels_have_no_verdict() {
        assert_eq!(
            filter_verdict(&channel(&[("amplitude_ratio", 1.0, 1.0)])),
            None
        );
        let mut failed = channel(&[("dc_gain", 1.0, 1.0)]);
        failed.error = Some(ChannelFailure {
            kind: "diverged".to_owned(),
            sample: 1,
            message: String::new(),
        });
        assert_eq!(filter_verdict(&failed), None);
    }

    #[test]
    fn a_gain_that_may_be_zero_restores_nothing() {
        let entries = [("dc_gain", 0.0, 0.0), ("noise_gain", 0.1, 0.2)];
        let verdict = filter_verdict(&channel(&entries)).unwrap();
        assert_eq!(verdict.fast_noise_restored, None);
        assert_eq!(verdict.deed, Deed::Attenuates);
    }
}
