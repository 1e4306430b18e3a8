//! One filter channel: the filter that makes the words, and a twin that measures its DC gain.
//!
//! Two DC gains are measured beside the words. *Replayed*: the time mean of the sum of the weights
//! that made each output, which is the response to a small added rate with the weight sequence of
//! the unperturbed run. *Adapted*: a twin filter runs on the same words plus a small rate from the
//! first sample on and is free to adapt; its mean output differs by that rate times the gain.

use crate::experiment::run::{RateTwins, RecordLength};
use crate::filters::hardware::{
    FixedSummary, HardwareFilter, HealthSummary, PipelineSettings, PipelineTiming,
};
use crate::filters::{Divergence, Filter, FilterKind, Output};
use crate::metrics::{BlackBox, ChannelFailure, RateGain};
use crate::signal::{FilterShape, Section, WeightRule};
use crate::vocabulary::NumberFormat;

/// Rate added to the twin's input, deg/h: small against Earth rate, large against rounding.
pub(super) const ADDED_RATE_DEG_PER_H: f64 = 0.1;

/// Blocks of the record whose mean weights are kept.
pub(super) const WEIGHT_BLOCKS: usize = 10;

/// Filter channel state during a run.
pub(super) struct ChannelFilter {
    name: String,
    kind: FilterKind,
    settings: Option<PipelineSettings>,
    shape: FilterShape,
    filter: Arithmetic,
    twin: Option<Arithmetic>,
    rate_twins: Option<RateTwins>,
    output_deg_per_h: Vec<f64>,
    /// Of fixed-point words: what the same filter makes of them in binary64.
    binary64: Binary64Words,
    warm_up_samples: usize,
    measured_samples: usize,
    failure: Option<Divergence>,
    restarts: Option<Restarts>,
    weight_sum_total: f64,
    /// Sums of every weight over consecutive blocks of the record, and the samples of each.
    weight_totals: [Vec<f64>; WEIGHT_BLOCKS],
    weight_counts: [u32; WEIGHT_BLOCKS],
    /// Sums of the twin's output minus the filter's over the same blocks.
    twin_differences: [f64; WEIGHT_BLOCKS],
    twin_counts: [u32; WEIGHT_BLOCKS],
    twin_difference_total: f64,
    measured: u64,
}

/// Reset schedule of a filter.
pub(super) struct Restarts {
    /// Indices of the samples at which it starts afresh, warm-up included, the next one last.
    samples: Vec<usize>,
    kind: FilterKind,
    sample_period_s: f64,
}

impl Restarts {
    /// The schedule of the filter of a kind.
    ///
    /// * `samples`: indices of the samples at which it starts afresh, warm-up included, ascending.
    pub(super) fn new(mut samples: Vec<usize>, kind: &FilterKind, sample_period_s: f64) -> Self {
        samples.reverse();
        Self {
            samples,
            kind: kind.clone(),
            sample_period_s,
        }
    }

    /// Constructor of a fresh filter, if sample `index` is one of those.
    fn at(&mut self, index: usize) -> Option<impl Fn() -> Arithmetic> {
        self.samples.pop_if(|next| *next == index)?;
        // Nothing of what follows is left out of the health of a matrix.
        let length = RecordLength {
            warm_up: 0,
            measured: 0,
        };
        Some(move || Arithmetic::new(&self.kind, length, self.sample_period_s))
    }
}

/// Filter channel results.
pub(super) struct FinishedFilter {
    /// Channel name.
    pub(super) name: String,
    /// What runs it again; none of words that were made elsewhere.
    pub(super) kind: Option<FilterKind>,
    /// Input samples that the filter weighs, and the rule of its weights.
    pub(super) shape: FilterShape,
    /// Whether it started afresh within the record.
    pub(super) restarts: bool,
    /// The words, or why there are none.
    pub(super) words: Result<FilterWords, ChannelFailure>,
    /// The hardware, if it is one.
    pub(super) pipeline: Option<FinishedPipeline>,
}

/// Hardware pipeline results.
pub(super) struct FinishedPipeline {
    /// Its constants.
    pub(super) settings: PipelineSettings,
    /// Its clocks, counted.
    pub(super) timing: PipelineTiming,
    /// Its matrix, if it has one.
    pub(super) health: Option<HealthSummary>,
    /// What is said of a matrix that forgetting has wound up.
    pub(super) wind_up: Option<String>,
    /// What became of its words, if they are fixed point.
    pub(super) fixed: Option<FixedSummary>,
}

/// Output words of a filter in binary64, and the sums of the weights that made them.
#[derive(Clone, Debug, Default)]
pub(super) struct Binary64Words {
    /// Output words, deg/h, warm-up included.
    pub(super) output_deg_per_h: Vec<f64>,
    /// Sum over the measured record.
    weight_sum_total: f64,
    measured: u32,
}

impl Binary64Words {
    /// Time mean of the sum of the weights over the measured record.
    pub(super) fn dc_gain(&self) -> Option<f64> {
        (self.measured > 0).then(|| self.weight_sum_total / f64::from(self.measured))
    }

    fn push(&mut self, output: Output, is_measured: bool) {
        self.output_deg_per_h.push(output.value_deg_per_h);
        if is_measured {
            self.weight_sum_total += output.weight_sum;
            self.measured += 1;
        }
    }
}

/// Output words of a filter that did not fail, and its gains.
pub(super) struct FilterWords {
    /// Output words, deg/h, warm-up included.
    pub(super) output_deg_per_h: Vec<f64>,
    /// Time mean of the sum of the weights over the measured record.
    pub(super) dc_gain: Option<f64>,
    /// The same with the filter free to adapt to the added rate; none if the twin failed.
    pub(super) dc_gain_adapted: Option<f64>,
    /// The same over consecutive blocks of the record.
    pub(super) block_dc_gains_adapted: Vec<f64>,
    /// The same for rates of other sizes; empty unless asked for.
    pub(super) rate_gains: Vec<RateGain>,
    /// Time mean of every weight over the measured record, as left by each sample; none for an
    /// infinite impulse response.
    pub(super) mean_weights: Option<Vec<f64>>,
    /// The same over consecutive blocks of the record; empty where the weights are given.
    pub(super) block_weights: Vec<Vec<f64>>,
    /// What twins tell of words that only their maker can make again; none of a filter of the bench.
    pub(super) black_box: Option<BlackBox>,
    /// Of fixed-point words: those of the same filter in binary64.
    pub(super) binary64: Option<Binary64Words>,
}

impl FilterWords {
    /// Words of a filter that shows nothing else.
    pub(super) fn alone(output_deg_per_h: Vec<f64>) -> Self {
        Self {
            output_deg_per_h,
            dc_gain: None,
            dc_gain_adapted: None,
            block_dc_gains_adapted: Vec::new(),
            rate_gains: Vec::new(),
            mean_weights: None,
            block_weights: Vec::new(),
            black_box: None,
            binary64: None,
        }
    }
}

/// Arithmetic that makes the words.
pub(super) enum Arithmetic {
    Textbook(Box<dyn Filter>),
    Hardware(Box<dyn HardwareFilter>),
}

impl Arithmetic {
    pub(super) fn new(kind: &FilterKind, length: RecordLength, sample_period_s: f64) -> Self {
        if let Some(settings) = kind.settings().hardware() {
            let filter = settings.filter(length.warm_up as u64);
            return Self::Hardware(filter.expect(CHECKED));
        }
        let filter = kind.settings().build(sample_period_s);
        Self::Textbook(filter.expect("words from outside have no channel filter"))
    }

    /// The same where only the scatter of the outputs is asked for: hardware of binary64 words differs from
    /// the textbook by rounding, and takes several times as long.
    pub(super) fn but_for_rounding(
        kind: &FilterKind,
        length: RecordLength,
        sample_period_s: f64,
    ) -> Self {
        let is_binary64 = |settings: &PipelineSettings| match settings {
            PipelineSettings::Float(settings) => settings.format == NumberFormat::Binary64,
            PipelineSettings::Fixed(_) => false,
        };
        let settings = kind.settings();
        let hardware = settings.hardware().filter(is_binary64);
        let textbook = hardware.and_then(|_| settings.build(sample_period_s));
        textbook.map_or_else(|| Self::new(kind, length, sample_period_s), Self::Textbook)
    }

    pub(super) fn as_filter(&self) -> &dyn Filter {
        match self {
            Self::Textbook(filter) => filter.as_ref(),
            Self::Hardware(filter) => filter.as_ref(),
        }
    }

    pub(super) fn step_all(
        &mut self,
        words_deg_per_h: &[f64],
        outputs: &mut Vec<Output>,
    ) -> Result<(), Divergence> {
        match self {
            Self::Textbook(filter) => filter.step_all(words_deg_per_h, outputs),
            Self::Hardware(filter) => filter.step_all(words_deg_per_h, outputs),
        }
    }

    #[inline]
    pub(super) fn step(&mut self, word_deg_per_h: f64) -> Result<Output, Divergence> {
        match self {
            Self::Textbook(filter) => filter.step(word_deg_per_h),
            Self::Hardware(filter) => filter.step(word_deg_per_h),
        }
    }
}

/// Why a pipeline's constants cannot be wrong here.
const CHECKED: &str = "the plan has refused what the pipeline refuses";

impl ChannelFilter {
    /// The channel `name` of a filter, with room for a record of this length; with `rate_gain` the
    /// gain for rates of every size is measured beside it.
    ///
    /// # Panics
    /// If the hardware refuses its constants, which the plan has checked.
    pub(super) fn new(
        name: String,
        kind: &FilterKind,
        length: RecordLength,
        sample_period_s: f64,
        rate_gain: bool,
    ) -> Self {
        let arithmetic = || Arithmetic::new(kind, length, sample_period_s);
        let filter = arithmetic();
        let shape = filter.as_filter().shape();
        let adapts = matches!(shape.rule, WeightRule::Adaptive { .. });
        Self {
            name,
            kind: kind.clone(),
            settings: kind.settings().hardware(),
            shape,
            weight_totals: std::array::from_fn(|_| vec![0.0; filter.as_filter().weights().len()]),
            weight_counts: [0; WEIGHT_BLOCKS],
            twin_differences: [0.0; WEIGHT_BLOCKS],
            twin_counts: [0; WEIGHT_BLOCKS],
            measured_samples: length.measured.max(1),
            filter,
            twin: adapts.then(arithmetic),
            rate_twins: rate_gain.then(|| RateTwins::new(length, arithmetic)),
            output_deg_per_h: Vec::with_capacity(length.total()),
            binary64: Binary64Words::default(),
            warm_up_samples: length.warm_up,
            failure: None,
            restarts: None,
            weight_sum_total: 0.0,
            twin_difference_total: 0.0,
            measured: 0,
        }
    }

    /// The channel with a filter that starts afresh at some samples.
    pub(super) fn restarting(self, restarts: Option<Restarts>) -> Self {
        Self { restarts, ..self }
    }

    /// Filters the next words of the record.
    pub(super) fn process(&mut self, words_deg_per_h: &[f64]) {
        let adapts = matches!(self.shape.rule, WeightRule::Adaptive { .. });
        if !adapts && self.rate_twins.is_none() && self.restarts.is_none() {
            return self.process_alone(words_deg_per_h);
        }
        for &word in words_deg_per_h {
            if self.failure.is_some() {
                return;
            }
            if let Err(divergence) = self.step(word) {
                self.fail(divergence);
            }
        }
    }

    /// Ends the channel: its words are of no use.
    fn fail(&mut self, divergence: Divergence) {
        self.failure = Some(divergence);
        self.output_deg_per_h = Vec::new();
    }

    /// The same for a filter with nothing beside it, in one go.
    fn process_alone(&mut self, words_deg_per_h: &[f64]) {
        if self.failure.is_some() {
            return;
        }
        let mut outputs = Vec::with_capacity(words_deg_per_h.len());
        if let Err(divergence) = self.filter.step_all(words_deg_per_h, &mut outputs) {
            return self.fail(divergence);
        }
        for output in outputs {
            if self.output_deg_per_h.len() >= self.warm_up_samples {
                self.weight_sum_total += output.weight_sum;
                self.measured += 1;
            }
            self.output_deg_per_h.push(output.value_deg_per_h);
        }
    }

    #[inline]
    fn step(&mut self, word_deg_per_h: f64) -> Result<(), Divergence> {
        let is_measured = self.output_deg_per_h.len() >= self.warm_up_samples;
        let index = self.output_deg_per_h.len();
        if let Some(afresh) = self
            .restarts
            .as_mut()
            .and_then(|restarts| restarts.at(index))
        {
            self.filter = afresh();
            self.twin = self.twin.as_ref().map(|_| afresh());
        }
        let output = self.filter.step(word_deg_per_h)?;
        self.output_deg_per_h.push(output.value_deg_per_h);
        if let Arithmetic::Hardware(filter) = &self.filter
            && let Some(output) = filter.twin()
        {
            self.binary64.push(output, is_measured);
        }
        let twin = self.twin.as_mut();
        match twin.map(|twin| twin.step(word_deg_per_h + ADDED_RATE_DEG_PER_H)) {
            Some(Ok(twin)) if is_measured => {
                let difference = twin.value_deg_per_h - output.value_deg_per_h;
                let block = self.block(index - self.warm_up_samples);
                self.twin_difference_total += difference;
                self.twin_differences[block] += difference;
                self.twin_counts[block] += 1;
            }
            Some(Err(_)) => self.twin = None,
            _ => {}
        }
        if let Some(twins) = &mut self.rate_twins {
            twins.step(word_deg_per_h, output.value_deg_per_h);
        }
        if is_measured {
            self.weight_sum_total += output.weight_sum;
            if let WeightRule::Adaptive { .. } = self.shape.rule {
                let block = self.block(index - self.warm_up_samples);
                let weights = self.filter.as_filter().weights();
                for (total, weight) in self.weight_totals[block].iter_mut().zip(weights) {
                    *total += weight;
                }
                self.weight_counts[block] += 1;
            }
            self.measured += 1;
        }
        Ok(())
    }

    /// Block of a sample, counted from the first measured one.
    fn block(&self, measured: usize) -> usize {
        (measured * WEIGHT_BLOCKS / self.measured_samples).min(WEIGHT_BLOCKS - 1)
    }

    /// Ends the run.
    pub(super) fn finish(mut self) -> FinishedFilter {
        let pipeline = self.finish_pipeline();
        #[expect(
            clippy::cast_precision_loss,
            reason = "sample counts are far below 2^53"
        )]
        let measured = self.measured as f64;
        let mean = |total: f64| (self.measured > 0).then(|| total / measured);
        let words = match self.failure {
            Some(divergence) => Err(diverged(&divergence)),
            None => Ok(FilterWords {
                // Given weights have the gain that they settle on; their sum starts from nothing.
                dc_gain: given_gain(&self.shape.rule).or_else(|| mean(self.weight_sum_total)),
                rate_gains: self
                    .rate_twins
                    .as_ref()
                    .map_or_else(Vec::new, RateTwins::finish),
                mean_weights: match &self.shape.rule {
                    WeightRule::Adaptive { .. } => (0..self.weight_totals[0].len())
                        .map(|tap| mean(self.weight_totals.iter().map(|block| block[tap]).sum()))
                        .collect(),
                    WeightRule::Fixed(weights) => Some(weights.clone()),
                    WeightRule::Sections(_) | WeightRule::Hidden(_) => None,
                },
                block_weights: match &self.shape.rule {
                    WeightRule::Adaptive { .. } => self.block_weights(),
                    _ => Vec::new(),
                },
                dc_gain_adapted: given_gain(&self.shape.rule).or_else(|| {
                    self.twin.as_ref().and_then(|_| {
                        mean(self.twin_difference_total).map(|gain| gain / ADDED_RATE_DEG_PER_H)
                    })
                }),
                block_dc_gains_adapted: self.block_dc_gains_adapted(),
                binary64: (self.binary64.output_deg_per_h.len() == self.output_deg_per_h.len())
                    .then_some(self.binary64)
                    .filter(|words| !words.output_deg_per_h.is_empty()),
                output_deg_per_h: self.output_deg_per_h,
                black_box: None,
            }),
        };
        FinishedFilter {
            name: self.name,
            kind: Some(self.kind),
            shape: self.shape,
            restarts: self.restarts.is_some(),
            words,
            pipeline,
        }
    }

    /// Time mean of every weight over each block that has samples.
    fn block_weights(&self) -> Vec<Vec<f64>> {
        let blocks = self.weight_totals.iter().zip(self.weight_counts);
        blocks
            .filter(|(_, count)| *count > 0)
            .map(|(totals, count)| {
                totals
                    .iter()
                    .map(|total| total / f64::from(count))
                    .collect()
            })
            .collect()
    }

    /// Gain of the twin over each block that has samples.
    fn block_dc_gains_adapted(&self) -> Vec<f64> {
        let blocks = self.twin_differences.iter().zip(self.twin_counts);
        blocks
            .filter(|(_, count)| *count > 0)
            .map(|(difference, count)| difference / (f64::from(count) * ADDED_RATE_DEG_PER_H))
            .collect()
    }

    fn finish_pipeline(&mut self) -> Option<FinishedPipeline> {
        let (Arithmetic::Hardware(filter), Some(settings)) = (&mut self.filter, self.settings)
        else {
            return None;
        };
        Some(FinishedPipeline {
            settings,
            timing: settings.timing().expect(CHECKED),
            health: filter.health(),
            wind_up: filter.wind_up().map(|warning| warning.to_string()),
            fixed: filter.fixed(),
        })
    }
}

/// Kind of the failure of a filter that diverged.
pub(super) const DIVERGED: &str = "diverged";

fn diverged(divergence: &Divergence) -> ChannelFailure {
    ChannelFailure {
        kind: DIVERGED.to_owned(),
        sample: divergence.sample,
        message: divergence.to_string(),
    }
}

/// Gain of given weights for a rate that never changes; none of weights that adapt.
pub(super) fn given_gain(rule: &WeightRule) -> Option<f64> {
    let of_section = |section: &Section| {
        let [a1, a2] = section.denominator;
        section.numerator.iter().sum::<f64>() / (1.0 + a1 + a2)
    };
    match rule {
        WeightRule::Fixed(weights) => Some(weights.iter().sum()),
        WeightRule::Sections(sections) => Some(sections.iter().map(of_section).product()),
        WeightRule::Adaptive { .. } | WeightRule::Hidden(_) => None,
    }
}
