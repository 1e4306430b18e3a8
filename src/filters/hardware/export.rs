//! Exports of hardware pipelines with a stimulus.

use std::path::{Path, PathBuf};

use super::fixed::FixedSettings;
use super::pipeline::PipelineSettings;
use super::settings::{FloatSettings, with_word};
use crate::fpga::FpgaError;
use crate::fpga::export::{
    ExportSettings, FixedExport, IntegerCodes, RtlParts, TopLevel, stimulus_pairs,
    write_fixed_rtl_for, write_fixed_vectors, write_rtl_parts, write_vectors, write_waveform,
};
use crate::fpga::float_unit::Fp;
use crate::fpga::timing::Units;
use crate::vocabulary::{DesiredSignal, ExportForm};

/// A sample stream in front of the front end.
#[derive(Clone, Debug, PartialEq)]
pub struct Stimulus {
    /// Samples, in the unit of the pipeline's constants.
    pub words: Vec<f64>,
    /// The gyro's integer codes behind them, if they have any.
    pub codes: Option<IntegerCodes>,
}

/// What an export's hardware is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HardwareParts {
    /// Latencies of the units.
    pub latencies: Units,
    /// What an export of RTL may have or leave out.
    pub rtl: RtlParts,
}

impl HardwareParts {
    /// Units of one clock, computed by the simulator.
    pub const PLAIN: Self = Self {
        latencies: Units::ONE_CLOCK,
        rtl: RtlParts::PLAIN,
    };
}

/// [`export_pipeline_of`] the plain parts.
///
/// # Errors
/// Constants or stimulus that the pipeline refuses, and files that cannot be written.
pub fn export_pipeline(
    folder: &Path,
    form: ExportForm,
    settings: &PipelineSettings,
    stimulus: Stimulus,
    trace_samples: usize,
) -> Result<Vec<PathBuf>, FpgaError> {
    let parts = HardwareParts::PLAIN;
    export_pipeline_of(folder, form, settings, stimulus, trace_samples, parts)
}

/// Writes the folder; returns its files. The update is in the schedule's order, the hardware's.
///
/// # Errors
/// Constants, latencies or stimulus that the pipeline refuses, and files that cannot be written.
pub fn export_pipeline_of(
    folder: &Path,
    form: ExportForm,
    settings: &PipelineSettings,
    stimulus: Stimulus,
    trace_samples: usize,
    parts: HardwareParts,
) -> Result<Vec<PathBuf>, FpgaError> {
    settings.check_units(parts.latencies)?;
    match settings {
        PipelineSettings::Float(settings) => with_word!(settings.format, F => {
            export::<F>(folder, form, settings, stimulus, trace_samples, parts)
        }),
        PipelineSettings::Fixed(settings) => {
            export_fixed(folder, form, settings, &stimulus, trace_samples, parts)
        }
    }
}

fn export<F: Fp>(
    folder: &Path,
    form: ExportForm,
    settings: &FloatSettings,
    mut stimulus: Stimulus,
    trace_samples: usize,
    parts: HardwareParts,
) -> Result<Vec<PathBuf>, FpgaError> {
    // Codes whose words are not theirs, as those of means: the board takes words.
    let codes = stimulus.codes.as_ref();
    let codes = codes.filter(|codes| codes.give(&stimulus.words));
    let scale = codes.map(|codes| codes.scale.clone());
    if let Some(codes) = codes {
        stimulus.words = codes.words().collect();
    }
    let pairs = stimulus_pairs(&stimulus.words, &mut settings.front_end::<F>())?;
    let pipeline = settings.core.config_with::<F>(parts.latencies)?;
    let top = TopLevel {
        surroundings: settings.surroundings(&pipeline, scale),
        samples: stimulus.words.iter().copied().map(F::from_f64).collect(),
    };
    let export = ExportSettings {
        pipeline,
        top: Some(top),
        clock_mhz: settings.clock_mhz,
        front_end: front_end_words(settings),
        trace_samples: trace_samples.min(pairs.len()),
        codes: stimulus.codes,
    };
    match form {
        ExportForm::Vectors => write_vectors(folder, &export, &pairs),
        ExportForm::Rtl => write_rtl_parts(folder, &export, &pairs, parts.rtl),
        ExportForm::Waveform => {
            let window = export.window(export.trace_samples);
            write_waveform(folder, &export, &pairs, window)
        }
    }
}

fn export_fixed(
    folder: &Path,
    form: ExportForm,
    settings: &FixedSettings,
    stimulus: &Stimulus,
    trace_samples: usize,
    parts: HardwareParts,
) -> Result<Vec<PathBuf>, FpgaError> {
    let mut numbered = stimulus.words.iter().enumerate();
    if let Some((index, value)) = numbered.find(|(_, word)| !word.is_finite()) {
        return Err(FpgaError::NonFiniteStimulus {
            index,
            value: *value,
            format: "fixed point",
        });
    }
    let config = settings.config()?.with_units(parts.latencies)?;
    let format = config.as_pipeline().tap_formats().desired;
    let full_scale = settings.full_scale_deg_per_h;
    let words = stimulus.words.iter();
    let export = FixedExport {
        config,
        desired: settings.twin.desired,
        input_lag_samples: settings.twin.input_lag_samples,
        output_register: settings.twin.output_register,
        samples: words
            .map(|word| format.of(word / full_scale).code)
            .collect(),
        full_scale: format!("{full_scale} deg/h"),
        clock_mhz: settings.twin.clock_mhz,
        trace_samples,
    };
    match form {
        ExportForm::Vectors => write_fixed_vectors(folder, &export),
        ExportForm::Rtl => write_fixed_rtl_for(folder, &export, parts.rtl.device),
        ExportForm::Waveform => Err(FpgaError::FixedWaveform),
    }
}

fn front_end_words(settings: &FloatSettings) -> String {
    let desired = match settings.desired {
        DesiredSignal::Current => "the newest sample",
        DesiredSignal::TwoSampleMean => "the mean of the two newest samples",
    };
    format!(
        "x: the sample {} samples ago; d: {desired}",
        settings.input_lag_samples
    )
}
