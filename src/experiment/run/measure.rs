//! Measuring the records of one repeat: which words are compared with which.

use std::sync::OnceLock;

use rayon::prelude::*;

use super::allan_settings::allan_options;
use super::assembly_motion::drop_lacking;
use super::motion::motion;
use super::other_noise::{figures_of_other_runs, runs_that_differ, two_runs};
use super::progress::{Progress, Unfinished, unless_stopped};
use super::records::{RecordLength, stamp_s};
use super::simulate::{GyroRecord, Simulation};
use crate::experiment::black_box::{self, BuiltIn, TwinInput};
use crate::experiment::campaign;
use crate::experiment::channel_filter::{ADDED_RATE_DEG_PER_H, FilterWords, FinishedFilter};
use crate::experiment::outside;
use crate::experiment::pipeline_metrics;
use crate::experiment::plan::Plan;
use crate::gyro::{self, slow_drift};
use crate::metrics::catalogue::DIVERGED_AT;
use crate::metrics::{
    BlackBox, ChannelFailure, ChannelMetrics, Estimate, FilterFacts, Learning, Motion, Record,
    Settings, StepFigures, known_motion, measure, put_beside_others, put_black_box,
};
use crate::scenario::BlackBoxTrial;
use crate::signal::{SlowDrift, WeightRule};

/// Channels of one repeat with their metrics.
pub(crate) type Channels = Vec<(String, ChannelMetrics)>;

/// Measures every channel of a repeat, in the order of the report; the listener can stop it between
/// two channels.
pub(crate) fn measure_repeat(
    plan: &Plan,
    simulation: &Simulation,
    length: RecordLength,
    progress: &dyn Progress,
) -> Result<Channels, Unfinished> {
    let scenario = &plan.resolved().scenario;
    let sample_period_s = plan.sample_period_s();
    let settings = &Settings {
        motion: motion(scenario, sample_period_s),
        bias_averaging_time_s: scenario.bias_averaging_time_s,
        fit_tau_min_s: plan.fit_tau_min_s(),
        allan: allan_options(scenario.allan),
        bridges: Vec::new(),
    };
    let simulated_s = scenario.warm_up_s + scenario.duration_s;
    let drift = slow_drift(
        &scenario.gyro.slow_noise,
        gyro::word_period_s(&scenario.gyro),
        simulated_s,
    );
    let gyros = simulation.gyros.iter();
    let cuts: Vec<Cut> = gyros
        .map(|record| Cut {
            record,
            encoder_rad: simulation.encoder_rad.as_deref(),
            length,
            sample_period_s,
            settings,
            drift: Some(drift.clone()),
            motion: OnceLock::new(),
            black_box: scenario.trial.black_box,
        })
        .collect();
    let measured = |name: String, measure: &dyn Fn() -> ChannelMetrics| {
        unless_stopped(progress)?;
        Ok((name, measure()))
    };
    let (raw, filters): (Result<Channels, Unfinished>, Result<Channels, Unfinished>) = rayon::join(
        || {
            let named = cuts.par_iter().zip(scenario.raw_channels());
            let raw = named.map(|(cut, name)| measured(name, &|| cut.measure_raw()));
            let named = cuts.par_iter().zip(scenario.compensated_channels());
            raw.chain(named.map(|(cut, name)| measured(name, &|| cut.measure_compensated())))
                .collect()
        },
        || {
            let filters = simulation.filters.par_iter();
            let measure = |(gyro, filter): &(usize, FinishedFilter)| {
                measured(filter.name.clone(), &|| cuts[*gyro].measure_filter(filter))
            };
            filters.map(measure).collect()
        },
    );
    let mut channels: Channels = raw?.into_iter().chain(filters?).collect();
    for (name, metrics) in &mut channels {
        drop_lacking(scenario, name, metrics);
        campaign::drop_lacking(scenario, metrics);
    }
    Ok(channels)
}

/// The measured part of one gyro's record and how to measure it.
pub(crate) struct Cut<'a> {
    pub(crate) record: &'a GyroRecord,
    pub(crate) encoder_rad: Option<&'a [f64]>,
    pub(crate) length: RecordLength,
    pub(crate) sample_period_s: f64,
    pub(crate) settings: &'a Settings,
    /// How the slow noise of the gyro scatters over seeds, where that is known.
    pub(crate) drift: Option<SlowDrift>,
    /// What of the filters' input is no noise, worked out once for all that adapt; none at a rate that
    /// never changes.
    pub(crate) motion: OnceLock<Option<Vec<f64>>>,
    /// What twins are to show of every filter.
    pub(crate) black_box: Option<BlackBoxTrial>,
}

impl Cut<'_> {
    pub(crate) fn measure_raw(&self) -> ChannelMetrics {
        self.measure_unfiltered(&self.record.raw_deg_per_h)
    }

    pub(crate) fn measure_compensated(&self) -> ChannelMetrics {
        self.measure_unfiltered(self.record.filter_input_deg_per_h())
    }

    fn measure_unfiltered(&self, words: &[f64]) -> ChannelMetrics {
        match words.iter().position(|word| !word.is_finite()) {
            Some(sample) => {
                let failure = ChannelFailure {
                    kind: "not finite".to_owned(),
                    sample: sample as u64,
                    message: format!("the word of the gyro is {}", words[sample]),
                };
                failed(failure, self.sample_period_s)
            }
            None => self.measure(words, words, None),
        }
    }

    fn measure(
        &self,
        channel_deg_per_h: &[f64],
        input_deg_per_h: &[f64],
        filter: Option<&FilterFacts>,
    ) -> ChannelMetrics {
        let record = self.of(channel_deg_per_h, input_deg_per_h);
        measure(&record, self.settings, filter)
    }

    /// The measured part of a channel and of what it was made from.
    pub(crate) fn of<'b>(
        &'b self,
        channel_deg_per_h: &'b [f64],
        input_deg_per_h: &'b [f64],
    ) -> Record<'b> {
        let first = self.length.warm_up;
        Record {
            channel_deg_per_h: &channel_deg_per_h[first..],
            raw_deg_per_h: &input_deg_per_h[first..],
            // A recorded log has none.
            truth_deg_per_h: self.record.truth_deg_per_h.rates().from(first),
            response_deg_per_h: self.record.response_deg_per_h.as_deref().unwrap_or(&[]),
            encoder_rad: self.encoder_rad.map(|readings| &readings[first..]),
            sample_period_s: self.sample_period_s,
            first_stamp_s: stamp_s(first as u64, self.sample_period_s),
            drift: self.drift.as_ref(),
        }
    }

    /// What a filter has learned from its input; none where its motion is not known.
    fn learning(
        &self,
        filter: &FinishedFilter,
        input: &[f64],
        motion: Option<&[f64]>,
    ) -> Option<Learning> {
        let first = self.length.warm_up;
        if !Learning::is_of(&filter.shape, input.len() - first) {
            return None;
        }
        let is_at_rest = self.settings.motion == Motion::Steady;
        if self.record.truth_deg_per_h.is_empty() && !is_at_rest {
            return None;
        }
        Learning::of(&filter.shape, input, motion, first)
    }

    /// What of the filters' input is no noise; none at a rate that never changes.
    fn motion(&self) -> Option<&[f64]> {
        let of_record = || {
            let record = self.record;
            let truth = record.truth_deg_per_h.rates();
            let response = record.response_deg_per_h.as_deref();
            let of_words =
                || known_motion(record.filter_input_deg_per_h(), response, &truth.words());
            truth.changes().then(of_words)
        };
        self.motion.get_or_init(of_record).as_deref()
    }

    /// Mean weights of runs of a filter on other noise, if the blocks of its record do not show how they
    /// scatter; of one that follows a gradient.
    fn weights_of_other_runs(
        &self,
        filter: &FinishedFilter,
        words: (&[f64], &[f64]),
    ) -> Vec<Vec<f64>> {
        let follows_gradient = matches!(
            filter.shape.rule,
            WeightRule::Adaptive {
                forgetting_factor: None,
                ..
            }
        );
        let tries = || runs_that_differ(filter, words, self.length, self.sample_period_s);
        follows_gradient.then(tries).flatten().unwrap_or_default()
    }

    /// Whether steps move the weights of a filter that forgets nothing within a stretch of its learning.
    fn moves_weights_in_steps(&self, facts: &FilterFacts) -> bool {
        let learning = facts.learning.as_ref();
        matches!(self.settings.motion, Motion::Steps { .. })
            && learning.is_some_and(|learning| !learning.is_even())
    }

    /// Figures of steps in runs of a filter on other noise; none where one fails.
    fn figures_of_other_runs(
        &self,
        filter: &FinishedFilter,
        words: (&[f64], &[f64]),
        facts: &FilterFacts,
    ) -> Option<Vec<StepFigures>> {
        let motion = &self.settings.motion;
        let figures = |output: &[f64], input: &[f64], dc_gain: f64| {
            StepFigures::of(&self.of(output, input), motion, Some(facts), dc_gain)
        };
        figures_of_other_runs(filter, words, self.length, self.sample_period_s, figures)
    }

    /// How far the slow noise of the gyro moves figures of steps from seed to seed.
    fn by_slow_noise(&self, facts: &FilterFacts) -> Option<StepFigures> {
        let words = self.record.filter_input_deg_per_h();
        StepFigures::by_slow_noise(&self.of(words, words), &self.settings.motion, facts)
    }

    /// Variance over seeds of the slow noise in the mean of the record, (deg/h)^2.
    fn drift_variance(&self) -> f64 {
        let first = self.length.warm_up as u64;
        let start_s = stamp_s(first, self.sample_period_s) - self.sample_period_s;
        let end_s = stamp_s(first + self.length.measured as u64, self.sample_period_s)
            - self.sample_period_s;
        let drift = self.drift.as_ref();
        drift.map_or(0.0, |drift| drift.mean_variance([start_s, end_s]))
    }

    /// What twins tell of a filter, where that is asked for.
    fn black_box(
        &self,
        filter: &FinishedFilter,
        words: &FilterWords,
        input: &[f64],
    ) -> Option<BlackBox> {
        let Some(kind) = &filter.kind else {
            return words.black_box.clone();
        };
        let subject = BuiltIn {
            kind,
            register_samples: filter.shape.register_samples,
            sample_period_s: self.sample_period_s,
        };
        let input = TwinInput {
            words_deg_per_h: input,
            sample_period_s: self.sample_period_s,
        };
        // Nothing stops a filter of the bench.
        black_box::examine(&subject, &input, self.black_box).ok()?
    }

    pub(crate) fn measure_filter(&self, filter: &FinishedFilter) -> ChannelMetrics {
        let mut metrics = match &filter.words {
            Ok(words) => {
                let input = self.record.filter_input_deg_per_h();
                let adapts = matches!(filter.shape.rule, WeightRule::Adaptive { .. });
                let motion = adapts.then(|| self.motion()).flatten();
                let on_motion = motion.map(|motion| (input, motion));
                let facts = FilterFacts {
                    // What a filter learned before it started afresh is gone.
                    learning: (!filter.restarts)
                        .then(|| self.learning(filter, input, motion))
                        .flatten()
                        .map(|learning| learning.with_drift(self.drift_variance())),
                    weights_of_other_runs: on_motion
                        .map(|words| self.weights_of_other_runs(filter, words))
                        .unwrap_or_default(),
                    two_runs: on_motion.and_then(|words| {
                        two_runs(filter, words, self.length, self.sample_period_s)
                    }),
                    ..filter_facts(filter, words)
                };
                let mut metrics = self.measure(&words.output_deg_per_h, input, Some(&facts));
                if let Some(words) = on_motion.filter(|_| self.moves_weights_in_steps(&facts)) {
                    let runs = self.figures_of_other_runs(filter, words, &facts);
                    metrics.scatter_over_runs(runs.as_deref(), self.by_slow_noise(&facts));
                }
                if let Some(found) = self.black_box(filter, words, input) {
                    let is_fixed = !adapts && filter.shape.hidden_reason().is_none();
                    put_black_box(&found, is_fixed, &mut metrics);
                    put_beside_others(&facts, self.sample_period_s, &mut metrics);
                }
                metrics
            }
            Err(failure) => failed(failure.clone(), self.sample_period_s),
        };
        if let Some(pipeline) = &filter.pipeline {
            pipeline_metrics::enter(pipeline, self.sample_period_s, &mut metrics);
            if let Some(fixed) = &pipeline.fixed {
                let binary64 = self.measure_binary64(filter);
                let period_s = self.sample_period_s;
                pipeline_metrics::enter_fixed(fixed, binary64.as_ref(), period_s, &mut metrics);
            }
            metrics.keep_finite();
        }
        metrics
    }
}

impl Cut<'_> {
    /// What is measured of the same filter in binary64; none of other words than fixed-point ones, and
    /// of a filter that failed.
    fn measure_binary64(&self, filter: &FinishedFilter) -> Option<ChannelMetrics> {
        let words = filter.words.as_ref().ok()?;
        let twin = words.binary64.as_ref()?;
        let alone = FilterWords {
            dc_gain: twin.dc_gain(),
            ..FilterWords::alone(Vec::new())
        };
        let facts = filter_facts(filter, &alone);
        let input = self.record.filter_input_deg_per_h();
        Some(self.measure(&twin.output_deg_per_h, input, Some(&facts)))
    }
}

fn filter_facts(filter: &FinishedFilter, words: &FilterWords) -> FilterFacts {
    FilterFacts {
        shape: filter.shape.clone(),
        dc_gain: words.dc_gain,
        dc_gain_adapted: words.dc_gain_adapted,
        mean_weights: words.mean_weights.clone(),
        block_weights: words.block_weights.clone(),
        block_dc_gains_adapted: words.block_dc_gains_adapted.clone(),
        learning: None,
        weights_of_other_runs: Vec::new(),
        two_runs: None,
        added_rate_deg_per_h: ADDED_RATE_DEG_PER_H,
        rate_gains: words.rate_gains.clone(),
        latency_s: pipeline_metrics::latency_s(filter.pipeline.as_ref()),
    }
}

/// A channel that failed has no numbers of its record but the instant of its failure, if the words
/// brought it about.
fn failed(failure: ChannelFailure, sample_period_s: f64) -> ChannelMetrics {
    let mut channel = ChannelMetrics::default();
    if !outside::is_from_outside(&failure) {
        let at_s = stamp_s(failure.sample, sample_period_s);
        channel.put(&DIVERGED_AT, Estimate::exact(at_s));
    }
    channel.error = Some(failure);
    channel
}
