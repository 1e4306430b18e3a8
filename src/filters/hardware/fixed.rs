//! A fixed-point pipeline on the bench: its constants, its timing and the filter they stand for.

use super::filter::HardwareFilter;
use super::monitor::{HealthSummary, Monitor};
use super::settings::FloatSettings;
use super::timing::PipelineTiming;
use crate::filters::common::{
    Complaints, Divergence, DivergenceKind, Fault, Filter, Life, Output, Register, Watch,
};
use crate::fpga::FpgaError;
use crate::fpga::engine::InverseCorrelation;
use crate::fpga::fixed::{
    FixedFrontEnd, FixedRlsConfig, FixedRlsEngine, FixedRlsSettings, Stored, fixed_board_usage,
    fixed_rls_usage,
};
use crate::fpga::health::{Warning, wind_up_warning};
use crate::fpga::kinds::CoreSettings;
use crate::fpga::rls::{RlsCore, RlsSettings};
use crate::signal::FilterShape;
use crate::vocabulary::{
    DesiredSignal, Division, NumberFormat, OutputRegister, UpdateOrder, UpdateSign,
};

/// A fixed-point pipeline with its front end, before any check.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedSettings {
    /// The filter, its constants in the full scale.
    pub core: FixedRlsSettings,
    /// Word that the value 1 stands for, deg/h.
    pub full_scale_deg_per_h: f64,
    /// What the filter is asked to reproduce.
    pub desired: DesiredSignal,
    /// Samples by which the regressors lag the newest sample.
    pub input_lag_samples: usize,
    /// When the result appears.
    pub output_register: OutputRegister,
    /// Clock, MHz.
    pub clock_mhz: f64,
}

impl FixedSettings {
    /// The constants in their words.
    ///
    /// # Errors
    /// What the pipeline refuses.
    pub fn config(&self) -> Result<FixedRlsConfig, FpgaError> {
        FixedRlsConfig::new(self.core)
    }

    /// The hold registers in front of the core.
    pub(super) fn front_end(&self) -> FixedFrontEnd {
        FixedFrontEnd::new(self.core.formats, self.desired, self.input_lag_samples)
    }

    /// The word of d for a sample.
    pub(super) fn stored(&self, word_deg_per_h: f64) -> Stored {
        let format = self.core.formats.desired;
        format.of(word_deg_per_h / self.full_scale_deg_per_h)
    }

    /// The same filter in binary64.
    fn twin(&self) -> FloatSettings {
        let full_scale = self.full_scale_deg_per_h;
        let delta = self.core.initial_inverse_correlation / full_scale / full_scale;
        FloatSettings {
            core: CoreSettings::Rls(RlsCore {
                settings: RlsSettings {
                    tap_count: self.core.tap_count,
                    forgetting_factor: self.core.forgetting_factor,
                    initial_inverse_correlation: delta,
                    division: Division::Reciprocal,
                    update_sign: UpdateSign::Corrected,
                },
                order: UpdateOrder::Schedule,
            }),
            desired: self.desired,
            input_lag_samples: self.input_lag_samples,
            output_register: self.output_register,
            format: NumberFormat::Binary64,
            clock_mhz: self.clock_mhz,
        }
    }

    pub(super) fn timing(&self) -> Result<PipelineTiming, FpgaError> {
        let config = self.config()?;
        let (usage, board) = (fixed_rls_usage(config), fixed_board_usage(config));
        Ok(PipelineTiming::of(usage, board, self.clock_mhz))
    }

    /// Blames the key that a refused constant comes from.
    pub(super) fn complain(&self, error: &FpgaError, complaints: &mut Complaints) {
        let full_scale = self.full_scale_deg_per_h;
        let per_square = |value: f64| value / full_scale / full_scale;
        let delta = self.core.initial_inverse_correlation;
        let advice = match error {
            FpgaError::DoesNotFit { value, limit, .. } if value.to_bits() == delta.to_bits() => {
                format!(
                    "less than {:.4e} (deg/h)^-2, or more integer bits in fixed.r",
                    per_square(*limit)
                )
            }
            FpgaError::OutOfRange { value, .. } if value.to_bits() == delta.to_bits() => {
                let step = self.core.formats.inverse.value(1);
                format!(
                    "{:.4e} (deg/h)^-2 or more, or more bits in fixed.r",
                    per_square(step)
                )
            }
            _ => return complaints.table(&error.to_string()),
        };
        let message = format!(
            "= {:.4e} (deg/h)^-2, at a full scale of {full_scale} deg/h: {error}; use {advice}",
            per_square(delta)
        );
        complaints.key("initial_inverse_correlation", &message);
    }

    pub(super) fn filter(
        &self,
        warm_up_samples: u64,
    ) -> Result<Box<dyn HardwareFilter>, FpgaError> {
        let engine = FixedRlsEngine::new(self.config()?);
        Ok(Box::new(FixedPipelineFilter {
            settings: *self,
            front_end: self.front_end(),
            weights: vec![0.0; self.core.tap_count],
            engine,
            register: Register::new(self.output_register),
            watch: Watch::new(),
            monitor: Monitor::new(self.core.tap_count, warm_up_samples),
            twin: Twin::new(self.twin().filter(0)?, warm_up_samples),
            desired_overflows: 0,
            life: Life::default(),
        }))
    }

    fn shape(&self) -> FilterShape {
        self.twin().shape()
    }
}

/// What became of the words of a fixed-point filter.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FixedSummary {
    /// Words beyond the ends of each signal, in the order of the formats.
    pub overflows: [u64; 8],
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
    settings: FixedSettings,
    front_end: FixedFrontEnd,
    engine: FixedRlsEngine,
    weights: Vec<f64>,
    register: Register,
    watch: Watch,
    monitor: Monitor,
    twin: Twin,
    desired_overflows: u64,
    life: Life,
}

impl FixedPipelineFilter {
    fn advance(&mut self, input: f64, sample: u64) -> Result<Output, Fault> {
        let formats = self.settings.core.formats;
        let full_scale = self.settings.full_scale_deg_per_h;
        let weight_sum = self.weights.iter().sum();
        let stored = self.settings.stored(input);
        self.desired_overflows += u64::from(stored.overflowed);
        let pair = self.front_end.pair(stored.code);
        let code = self.engine.process(pair);
        for (held, word) in self.weights.iter_mut().zip(self.engine.weights()) {
            *held = formats.weight.value(*word);
        }
        let result = Output {
            value_deg_per_h: formats.output.value(code) * full_scale,
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
        let format = self.settings.core.formats.inverse;
        let codes = self.engine.inverse_correlation();
        let matrix: Vec<f64> = codes.iter().map(|code| format.value(*code)).collect();
        let inverse = InverseCorrelation {
            matrix: &matrix,
            tap_count: self.settings.core.tap_count,
            delta: self.settings.core.initial_inverse_correlation,
            alpha: self.settings.core.forgetting_factor,
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
        self.settings.shape()
    }
}

impl HardwareFilter for FixedPipelineFilter {
    fn health(&mut self) -> Option<HealthSummary> {
        self.look(self.life.newest_sample());
        self.monitor.worst()
    }

    fn wind_up(&self) -> Option<Warning> {
        wind_up_warning(self.monitor.latest()?, self.settings.core.forgetting_factor)
    }

    fn fixed(&self) -> Option<FixedSummary> {
        let health = self.engine.health();
        let [input, mean] = self.front_end.overflows();
        Some(FixedSummary {
            overflows: [
                input,
                mean + self.desired_overflows,
                health.intermediate_overflows,
                health.denominator_overflows,
                health.gain_overflows,
                health.inverse_overflows,
                health.weight_overflows,
                health.output_overflows,
            ],
            indefinite_at: health.indefinite_at,
            error_over_signal: self.twin.error_over_signal(),
        })
    }

    fn twin(&self) -> Option<Output> {
        self.twin.newest
    }
}
