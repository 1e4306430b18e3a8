//! The few figures of steps that weights on their way move, of a record or of a run like it.
//!
//! Least squares that forgets nothing learns more from a step than from all words before: stretches of its
//! record do not show how these figures scatter from seed to seed, runs of it on other noise do.

use super::mean::{MEAN, MEAN_ERROR};
use super::tracking::TRACKING_ERROR_RMS;
use crate::metrics::estimate::influence::Spread;
use crate::metrics::estimate::interval;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::MetricKey;
use crate::metrics::noise::level::NOISE_GAIN;
use crate::metrics::noise::truth_response::without_motion;
use crate::metrics::record::{FilterFacts, Motion, Record, SAMPLES_MIN};
use crate::metrics::steps::scale_factor::ScaleFactorFigures;
use crate::metrics::steps::settling::tail_start;
use crate::metrics::steps::staircase::{
    SCALE_FACTOR_ASYMMETRY, SCALE_FACTOR_ERROR, SCALE_FACTOR_NONLINEARITY,
    SCALE_FACTOR_NONLINEARITY_OF_READING, scale_factor_figures, scale_factor_figures_by_drift,
};
use crate::metrics::theory::learning::{Learning, NOT_FROM_ONE_RECORD};
use crate::metrics::trial::dc_gain::DC_GAIN;
use crate::units::ratio_to_ppm;

/// A metric, and its value in a run; none where the run does not give it.
type Figure = (&'static MetricKey, fn(&StepFigures) -> Option<f64>);

/// What runs on other noise give the intervals of.
const FIGURES: [Figure; 9] = [
    (&MEAN, |of| Some(of.mean_deg_per_h)),
    // The true rate is that of the record.
    (&MEAN_ERROR, |of| Some(of.mean_deg_per_h)),
    (&TRACKING_ERROR_RMS, |of| {
        Some(of.tracking_error_rms_deg_per_h)
    }),
    (&DC_GAIN, |of| Some(of.dc_gain)),
    (&NOISE_GAIN, |of| of.noise_gain),
    (&SCALE_FACTOR_ERROR, |of| {
        Some(ratio_to_ppm(of.scale_factor?.factor))
    }),
    (&SCALE_FACTOR_NONLINEARITY, |of| {
        Some(ratio_to_ppm(of.scale_factor?.nonlinearity))
    }),
    (&SCALE_FACTOR_NONLINEARITY_OF_READING, |of| {
        Some(ratio_to_ppm(of.scale_factor?.nonlinearity_of_reading))
    }),
    (&SCALE_FACTOR_ASYMMETRY, |of| {
        Some(ratio_to_ppm(of.scale_factor?.asymmetry?))
    }),
];

/// Figures of a filter over steps, without intervals: as [`measure`](fn@super::super::measure::measure)
/// finds them, and nothing else.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepFigures {
    mean_deg_per_h: f64,
    tracking_error_rms_deg_per_h: f64,
    dc_gain: f64,
    /// None where too few samples have settled.
    noise_gain: Option<f64>,
    /// None where the dwells give no line.
    scale_factor: Option<ScaleFactorFigures>,
}

impl StepFigures {
    /// Those of a record of steps; none of another motion, and where the true rate is not known.
    ///
    /// * `filter`: what is known of the filter in the record that the runs are like.
    /// * `dc_gain`: that of the filter in this record.
    #[must_use]
    pub fn of(
        record: &Record,
        motion: &Motion,
        filter: Option<&FilterFacts>,
        dc_gain: f64,
    ) -> Option<Self> {
        let Motion::Steps {
            staircase,
            last_step_index,
            ..
        } = motion
        else {
            return None;
        };
        let (channel, truth) = (record.channel_deg_per_h, record.truth()?.words());
        let errors = channel
            .iter()
            .zip(truth.iter())
            .map(|(rate, truth)| rate - truth);
        let square = errors.map(|error| error * error).sum::<f64>() / channel.len() as f64;
        Some(Self {
            mean_deg_per_h: interval::mean(channel),
            tracking_error_rms_deg_per_h: square.sqrt(),
            dc_gain,
            noise_gain: settled_noise_gain(record, *last_step_index, filter),
            scale_factor: scale_factor_figures(record, staircase),
        })
    }

    /// Their standard deviations over seeds by slow noise, of which neither a record nor runs on its noise
    /// show much: that of a filter with this gain for a rate that is there from the first word on, and of
    /// its weights, which a rate that all words share moves.
    #[must_use]
    pub fn by_slow_noise(record: &Record, motion: &Motion, facts: &FilterFacts) -> Option<Self> {
        let Motion::Steps { staircase, .. } = motion else {
            return None;
        };
        let by_weights = facts.learning.as_ref().and_then(Learning::gain_by_drift);
        Some(Self {
            mean_deg_per_h: facts.dc_gain_adapted? * record.drift_variance().sqrt(),
            tracking_error_rms_deg_per_h: 0.0,
            dc_gain: by_weights.unwrap_or(0.0),
            noise_gain: None,
            scale_factor: scale_factor_figures_by_drift(record, staircase),
        })
    }
}

/// Variance of the channel over that of raw where the last step has settled, each about its mean.
fn settled_noise_gain(
    record: &Record,
    last_step_index: usize,
    filter: Option<&FilterFacts>,
) -> Option<f64> {
    let samples = record.channel_deg_per_h.len();
    let start = tail_start(samples, last_step_index.min(samples));
    if samples - start < SAMPLES_MIN {
        return None;
    }
    let still = without_motion(record, start, filter);
    let (own, raw) = still.as_ref().map_or_else(
        || {
            (
                &record.channel_deg_per_h[start..],
                &record.raw_deg_per_h[start..],
            )
        },
        |(own, raw)| (own.as_slice(), raw.as_slice()),
    );
    let gain = interval::sample_variance(own) / interval::sample_variance(raw);
    gain.is_finite().then_some(gain)
}

impl ChannelMetrics {
    /// Gives the figures of a record of steps the intervals that they have in runs on other noise, by
    /// Student's t, and by slow noise; without runs they have none.
    ///
    /// What some run lacks, and what is the same in all of them, stays as it is.
    pub(crate) fn scatter_over_runs(
        &mut self,
        runs: Option<&[StepFigures]>,
        by_slow_noise: Option<StepFigures>,
    ) {
        for (key, figure) in FIGURES {
            let Some(metric) = self.get_mut(key) else {
                continue;
            };
            let value = metric.estimate.value;
            let Some(runs) = runs else {
                metric.estimate = Estimate::without_interval(value, NOT_FROM_ONE_RECORD);
                continue;
            };
            let values: Option<Vec<f64>> = runs.iter().map(figure).collect();
            let variance = values.map_or(0.0, |values| interval::sample_variance(&values));
            if variance > 0.0 {
                let freedom = runs.len() as f64 - 1.0;
                let slow = by_slow_noise.as_ref().and_then(figure).unwrap_or(0.0);
                let slow = Spread::known(slow * slow);
                metric.estimate = Spread { variance, freedom }.plus(slow).about(value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::allan::variants::AllanOptions;
    use crate::metrics::measure::measure;
    use crate::metrics::record::{Dwell, FilterFacts, Settings, Staircase};
    use crate::random::Streams;
    use crate::signal::Rates;
    use crate::signal::{FilterShape, WeightRule};

    const DWELL: usize = 500;
    const RATES: [f64; 5] = [10.0, 200.0, 400.0, -300.0, 100.0];

    fn motion() -> Motion {
        let dwell = |(at, rate): (usize, &f64)| Dwell {
            samples: at * DWELL + 100..(at + 1) * DWELL,
            rate_deg_per_h: *rate,
        };
        Motion::Steps {
            last_step_index: 4 * DWELL,
            step_deg_per_h: RATES[4] - RATES[3],
            staircase: Staircase {
                dwells: RATES.iter().enumerate().map(dwell).collect(),
                settle_s: 0.1,
                rest_deg_per_h: 10.0,
                ..Staircase::default()
            },
        }
    }

    /// A mean of three samples times 0.9.
    fn facts() -> FilterFacts {
        FilterFacts {
            shape: FilterShape {
                taps: Some(3),
                newest_age_samples: 0,
                register_samples: 0,
                rule: WeightRule::Fixed(vec![0.3; 3]),
            },
            dc_gain: Some(0.9),
            dc_gain_adapted: Some(0.9),
            mean_weights: Some(vec![0.3; 3]),
            block_weights: Vec::new(),
            block_dc_gains_adapted: Vec::new(),
            learning: None,
            weights_of_other_runs: Vec::new(),
            two_runs: None,
            added_rate_deg_per_h: 0.1,
            rate_gains: Vec::new(),
            latency_s: 0.0,
        }
    }

    /// What is measured of a record, and its figures.
    fn measured() -> (ChannelMetrics, StepFigures) {
        let mut stream = Streams::new(5, 0).stream("white");
        let truth: Vec<f64> = RATES.iter().flat_map(|rate| [*rate; DWELL]).collect();
        let raw: Vec<f64> = truth.iter().map(|rate| rate + stream.normal()).collect();
        let taps = |at: usize| raw[at.saturating_sub(2)..=at].iter().sum::<f64>();
        let channel: Vec<f64> = (0..raw.len()).map(|at| 0.3 * taps(at)).collect();
        let record = Record {
            channel_deg_per_h: &channel,
            raw_deg_per_h: &raw,
            truth_deg_per_h: Rates::Words(&truth),
            response_deg_per_h: &[],
            encoder_rad: None,
            sample_period_s: 1e-3,
            first_stamp_s: 1e-3,
            drift: None,
        };
        let settings = Settings {
            motion: motion(),
            bias_averaging_time_s: 1.0,
            fit_tau_min_s: 0.01,
            allan: AllanOptions::default(),
            bridges: Vec::new(),
        };
        let metrics = measure(&record, &settings, Some(&facts()));
        let figures = StepFigures::of(&record, &settings.motion, Some(&facts()), 0.9);
        (metrics, figures.unwrap())
    }

    #[test]
    fn figures_of_a_record_are_the_values_that_are_measured_of_it() {
        let (metrics, figures) = measured();
        let mean = interval::mean(&RATES);
        for (key, figure) in FIGURES {
            let Some(own) = figure(&figures) else {
                assert!(metrics.get(key).is_none(), "{}", key.name);
                continue;
            };
            // What is the same in all runs is left out.
            let shift = if key == &MEAN_ERROR {
                mean
            } else if key == &SCALE_FACTOR_ERROR {
                ratio_to_ppm(1.0)
            } else {
                0.0
            };
            let value = metrics.get(key).unwrap().estimate.value + shift;
            assert!(
                (own - value).abs() <= 1e-9 * value.abs(),
                "{}: {own} {value}",
                key.name
            );
        }
    }

    #[test]
    fn runs_give_the_interval_that_their_scatter_and_slow_noise_say() {
        let (mut metrics, figures) = measured();
        let of = |mean: f64| StepFigures {
            mean_deg_per_h: mean,
            ..figures
        };
        let gain = metrics.get(&DC_GAIN).unwrap().estimate;
        let runs = [1.0, 2.0, 4.0, 8.0].map(of);
        metrics.scatter_over_runs(Some(&runs), Some(of(0.0)));
        let mean = metrics.get(&MEAN).unwrap().estimate;
        // Student's t of three degrees of freedom, 3.1824, times their deviation.
        let half_width = 3.1824 * interval::sample_variance(&[1.0, 2.0, 4.0, 8.0]).sqrt();
        assert!((mean.high - mean.value - half_width).abs() < 1e-3);
        // What is the same in all runs stays as it is.
        assert_eq!(metrics.get(&DC_GAIN).unwrap().estimate, gain);
        metrics.scatter_over_runs(Some(&runs), Some(of(10.0)));
        let wider = metrics.get(&MEAN).unwrap().estimate;
        assert!(wider.high - wider.value > 1.96 * 10.0);
        metrics.scatter_over_runs(None, None);
        assert!(!metrics.get(&MEAN).unwrap().estimate.has_interval());
    }
}
