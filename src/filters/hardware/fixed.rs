//! A fixed-point pipeline on the bench: its constants, its timing and the filter they stand for.

use super::filter::HardwareFilter;
use super::fixed_core::{FixedConstant, constants_of, fixed_core};
use super::monitor::{HealthSummary, Monitor};
use super::settings::FloatSettings;
use super::timing::PipelineTiming;
use crate::filters::common::{
    Complaints, Divergence, DivergenceKind, Fault, Filter, Life, Output, Register, Watch,
};
use crate::filters::words::FixedWords;
use crate::fpga::FpgaError;
use crate::fpga::engine::InverseCorrelation;
use crate::fpga::fixed::{
    FixedConfig, FixedCoreSettings, FixedEngine, FixedFrontEnd, Format, SignalName, TapFormats,
    fixed_board_usage, fixed_usage,
};
use crate::fpga::health::{Warning, wind_up_warning};
use crate::signal::FilterShape;

/// A fixed-point pipeline with its front end, before any check.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedSettings {
    /// The filter, its constants in the full scale.
    pub core: FixedCoreSettings,
    /// Word that the value 1 stands for, deg/h.
    pub full_scale_deg_per_h: f64,
    /// The same filter in binary64; front end, register and clock are common to both.
    pub twin: FloatSettings,
}

impl FixedSettings {
    /// The filter of the books on fixed-point words.
    pub(super) fn of(float: FloatSettings, words: &FixedWords) -> Self {
        let (core, twin) = fixed_core(&float.core, words);
        Self {
            core,
            full_scale_deg_per_h: words.full_scale_deg_per_h,
            twin: FloatSettings {
                core: twin,
                ..float
            },
        }
    }

    /// The constants in their words.
    ///
    /// # Errors
    /// What the pipeline refuses.
    pub fn config(&self) -> Result<FixedConfig, FpgaError> {
        self.core.config()
    }

    /// Format of a signal; none of one that the pipeline does not have.
    pub(super) fn format_of(&self, name: SignalName) -> Option<Format> {
        let signals = self.core.signals();
        let found = signals.iter().find(|signal| signal.name == name);
        found.map(|signal| signal.format)
    }

    pub(super) fn timing(&self) -> Result<PipelineTiming, FpgaError> {
        let config = self.config()?;
        let pipeline = config.as_pipeline();
        let (usage, board) = (fixed_usage(pipeline), fixed_board_usage(pipeline));
        Ok(PipelineTiming::of(usage, board, self.twin.clock_mhz))
    }

    /// Blames the key that a refused constant comes from.
    pub(super) fn complain(&self, error: &FpgaError, complaints: &mut Complaints) {
        let (FpgaError::DoesNotFit { name, value, .. } | FpgaError::OutOfRange { name, value, .. }) =
            error
        else {
            return complaints.table(&error.to_string());
        };
        let mut constants = constants_of(&self.core).iter();
        let Some(constant) = constants.find(|constant| constant.name == *name) else {
            return complaints.table(&error.to_string());
        };
        let full_scale = self.full_scale_deg_per_h;
        let FixedConstant { unit, power, .. } = constant;
        let in_unit = |value: f64| format!("{:.4e}{unit}", value * full_scale.powi(*power));
        let table = format!("fixed.{}", constant.signal.name().to_lowercase());
        let advice = match error {
            FpgaError::DoesNotFit { limit, .. } => {
                format!(
                    "less than {}, or more integer bits in {table}",
                    in_unit(*limit)
                )
            }
            _ => {
                let format = self.format_of(constant.signal);
                let step = format.map_or(0.0, |format| format.value(1));
                format!("{} or more, or more bits in {table}", in_unit(step))
            }
        };
        let message = format!(
            "= {}, at a full scale of {full_scale} deg/h: {error}; use {advice}",
            in_unit(*value)
        );
        complaints.key(constant.key, &message);
    }

    pub(super) fn filter(
        &self,
        warm_up_samples: u64,
    ) -> Result<Box<dyn HardwareFilter>, FpgaError> {
        let config = self.config()?;
        let pipeline = config.as_pipeline();
        let formats = pipeline.tap_formats();
        let twin = &self.twin;
        let (desired, lag) = (twin.desired, twin.input_lag_samples);
        Ok(Box::new(FixedPipelineFilter {
            full_scale_deg_per_h: self.full_scale_deg_per_h,
            has_signal: SignalName::ALL.map(|name| self.format_of(name).is_some()),
            formats,
            front_end: FixedFrontEnd::new(formats, desired, lag),
            weights: vec![0.0; pipeline.tap_count()],
            engine: pipeline.engine(),
            register: Register::new(twin.output_register),
            watch: Watch::new(),
            monitor: Monitor::new(pipeline.tap_count(), warm_up_samples),
            twin: Twin::new(twin.filter(0)?, warm_up_samples),
            desired_overflows: 0,
            shape: twin.shape(),
            life: Life::default(),
        }))
    }
}

/// What became of the words of a fixed-point filter.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FixedSummary {
    /// Words beyond the ends of each signal, in the order of their names; none of one that is not there.
    pub overflows: [Option<u64>; SignalName::ALL.len()],
    /// First sample, warm-up included, with a denominator or a diagonal element of R at or below zero.
    pub indefinite_at: Option<u64>,
    /// Root of the mean square of the output's distance from the twin's, over that of the twin's output,
    /// over the record; none without a record.
    pub error_over_signal: Option<f64>,
}

/// Part of the full scale by which an output that counts as sound may differ from that of the twin.
const ERROR_MAX: f64 = 0.01;
/// Samples in which the first weights are found, whatever the words.
const ERROR_GRACE_SAMPLES: u64 = 64;

/// The same filter in binary64 on the same samples, and how far the words have come from it.
struct Twin {
    filter: Box<dyn HardwareFilter>,
    first_sample: u64,
    newest: Option<Output>,
    error_squares: f64,
    squares: f64,
}

impl Twin {
    fn new(filter: Box<dyn HardwareFilter>, warm_up_samples: u64) -> Self {
        Self {
            filter,
            first_sample: warm_up_samples,
            newest: None,
            error_squares: 0.0,
            squares: 0.0,
        }
    }

    /// Compares an output of the fixed-point filter with its own.
    fn compare(
        &mut self,
        input: f64,
        output: Output,
        sample: u64,
        full_scale: f64,
    ) -> Result<(), Fault> {
        self.newest = self.filter.step(input).ok();
        let Some(twin) = self.newest else {
            return Ok(());
        };
        let error = (output.value_deg_per_h - twin.value_deg_per_h).abs();
        if sample >= self.first_sample {
            self.error_squares += error * error;
            self.squares += twin.value_deg_per_h * twin.value_deg_per_h;
        }
        let limit = ERROR_MAX * full_scale;
        if sample < ERROR_GRACE_SAMPLES || error <= limit {
            return Ok(());
        }
        let message = format!(
            "the output is {:.1} deg/h, that of the same filter in binary64 {:.1} deg/h: further off \
             than {limit} deg/h, a hundredth of the full scale",
            output.value_deg_per_h, twin.value_deg_per_h
        );
        Err(Fault {
            kind: DivergenceKind::WordsTooShort,
            message,
        })
    }

    fn error_over_signal(&self) -> Option<f64> {
        (self.squares > 0.0).then(|| (self.error_squares / self.squares).sqrt())
    }
}

/// Fixed-point pipeline behind its front end.
struct FixedPipelineFilter {
    full_scale_deg_per_h: f64,
    /// Whether the pipeline has each signal, in the order of their names.
    has_signal: [bool; SignalName::ALL.len()],
    formats: TapFormats,
    front_end: FixedFrontEnd,
    engine: Box<dyn FixedEngine + Send>,
    weights: Vec<f64>,
    register: Register,
    watch: Watch,
    monitor: Monitor,
    twin: Twin,
    desired_overflows: u64,
    shape: FilterShape,
    life: Life,
}

impl FixedPipelineFilter {
    fn advance(&mut self, input: f64, sample: u64) -> Result<Output, Fault> {
        let full_scale = self.full_scale_deg_per_h;
        let weight_sum = self.weights.iter().sum();
        let stored = self.formats.desired.of(input / full_scale);
        self.desired_overflows += u64::from(stored.overflowed);
        let pair = self.front_end.pair(stored.code);
        let code = self.engine.process(pair);
        for (held, word) in self.weights.iter_mut().zip(self.engine.weights()) {
            *held = self.formats.weight.value(*word);
        }
        let result = Output {
            value_deg_per_h: self.formats.output.value(code) * full_scale,
            weight_sum,
        };
        let output = self.register.clock(result);
        self.watch.check_input(input)?;
        self.watch.check_output(result)?;
        self.twin.compare(input, output, sample, full_scale)?;
        if self.monitor.is_due(sample) {
            self.look(sample);
        }
        Ok(output)
    }

    /// Notes the state of the matrix. That it is no longer definite does not end a filter whose words
    /// have ends.
    fn look(&mut self, sample: u64) {
        let Some(inverse) = self.engine.inverse_correlation() else {
            return;
        };
        let codes = inverse.codes.iter();
        let matrix: Vec<f64> = codes.map(|code| inverse.format.value(*code)).collect();
        let inverse = InverseCorrelation {
            matrix: &matrix,
            tap_count: self.weights.len(),
            delta: inverse.delta,
            alpha: inverse.alpha,
        };
        drop(self.monitor.look(inverse, sample));
    }
}

impl Filter for FixedPipelineFilter {
    fn step(&mut self, input_deg_per_h: f64) -> Result<Output, Divergence> {
        let sample = self.life.next_sample();
        // Hardware goes on whatever its words were.
        let result = self.advance(input_deg_per_h, sample);
        self.life.judge(sample, result)
    }

    fn weights(&self) -> &[f64] {
        &self.weights
    }

    fn shape(&self) -> FilterShape {
        self.shape.clone()
    }
}

impl HardwareFilter for FixedPipelineFilter {
    fn health(&mut self) -> Option<HealthSummary> {
        self.look(self.life.newest_sample());
        self.monitor.worst()
    }

    fn wind_up(&self) -> Option<Warning> {
        let inverse = self.engine.inverse_correlation()?;
        wind_up_warning(self.monitor.latest()?, inverse.alpha)
    }

    fn fixed(&self) -> Option<FixedSummary> {
        let health = self.engine.health();
        let [input, mean] = self.front_end.overflows();
        Some(FixedSummary {
            overflows: SignalName::ALL.map(|name| {
                let count = match name {
                    SignalName::X => input,
                    SignalName::D => mean + self.desired_overflows,
                    of_core => health.overflows.of(of_core),
                };
                self.has_signal[name as usize].then_some(count)
            }),
            indefinite_at: health.indefinite_at,
            error_over_signal: self.twin.error_over_signal(),
        })
    }

    fn twin(&self) -> Option<Output> {
        self.twin.newest
    }
}
