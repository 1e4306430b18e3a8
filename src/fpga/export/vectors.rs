//! Golden vectors: stimulus, response, memory images, per-clock trace and parameters.

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::fpga::error::FpgaError;
use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::{FrontEnd, Pair, UpdateSign};
use crate::fpga::lms::{
    DesiredSource, LmsConfig, LmsPipeline, lms_clocks_per_sample, lms_latency_clocks,
};
use crate::fpga::probe::Probe;
use crate::fpga::rls::{
    Division, RlsConfig, RlsPipeline, rls_clocks_per_sample, rls_latency_clocks,
};
use crate::fpga::trace::{CSV_HEADER, Recorder, Window, hex, write_csv_line};

/// The pipeline to export.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PipelineConfig<F> {
    /// Recursive least squares.
    Rls(RlsConfig<F>),
    /// Least mean squares, normalised or not.
    Lms(LmsConfig<F>),
}

impl<F: Fp> PipelineConfig<F> {
    /// Clocks per back-to-back sample.
    #[must_use]
    pub fn clocks_per_sample(&self) -> usize {
        match self {
            Self::Rls(config) => rls_clocks_per_sample(config.tap_count()),
            Self::Lms(config) => lms_clocks_per_sample(config.tap_count(), config.is_normalised()),
        }
    }

    /// Clocks from accepting a sample until its result can be read.
    #[must_use]
    pub fn latency_clocks(&self) -> usize {
        match self {
            Self::Rls(config) => rls_latency_clocks(config.tap_count()),
            Self::Lms(config) => lms_latency_clocks(config.tap_count(), config.is_normalised()),
        }
    }
}

/// The gyro's raw output words, from which the stimulus was made.
#[derive(Clone, Debug, PartialEq)]
pub struct IntegerCodes {
    /// One code per sample.
    pub codes: Vec<i32>,
    /// Value of one code step, in `unit`.
    pub lsb: f64,
    /// Unit of the LSB, such as `deg/s`.
    pub unit: String,
}

/// What to export and how to describe it.
#[derive(Clone, Debug, PartialEq)]
pub struct ExportSettings<F> {
    /// The pipeline and its constants.
    pub pipeline: PipelineConfig<F>,
    /// Clock frequency in MHz, > 0; only described and used for the time axis of waveforms.
    pub clock_mhz: f64,
    /// What stands between the gyro word and the pair, in words.
    pub front_end: String,
    /// Samples whose every clock goes into `trace.csv`.
    pub trace_samples: usize,
    /// The gyro's integer codes, one per pair.
    pub codes: Option<IntegerCodes>,
}

impl<F: Fp> ExportSettings<F> {
    /// The clocks of the first `samples` samples, the wake-up clock included.
    pub(super) fn window(&self, samples: usize) -> Window {
        let clocks = match samples {
            0 => 0,
            _ => 1 + samples * self.pipeline.clocks_per_sample(),
        };
        Window {
            first_clock: 0,
            clock_count: clocks as u64,
        }
    }
}

/// The pairs of a sample stream behind its front end.
///
/// # Errors
/// [`FpgaError::NonFiniteStimulus`] naming the first sample that is not finite in the format.
pub fn stimulus_pairs<F: Fp>(
    samples: &[f64],
    front_end: &mut FrontEnd<F>,
) -> Result<Vec<Pair<F>>, FpgaError> {
    samples
        .iter()
        .enumerate()
        .map(|(index, value)| {
            let word = F::from_f64(*value);
            if word.is_finite() {
                Ok(front_end.pair(word))
            } else {
                Err(FpgaError::NonFiniteStimulus {
                    index,
                    value: *value,
                })
            }
        })
        .collect()
}

/// Result of a run from reset.
pub(super) struct Simulation<F> {
    pub(super) outputs: Vec<F>,
    pub(super) memories_before: Vec<F>,
    pub(super) memories_after: Vec<F>,
}

/// Runs the pipeline over all pairs, from reset, back to back.
pub(super) fn simulate<F: Fp, Q: Probe<F>>(
    pipeline: &PipelineConfig<F>,
    pairs: &[Pair<F>],
    probe: &mut Q,
) -> Simulation<F> {
    let mut outputs = Vec::with_capacity(pairs.len());
    match pipeline {
        PipelineConfig::Rls(config) => {
            let mut pipeline = RlsPipeline::new(*config);
            let memories_before = [pipeline.rama(), pipeline.ramb()].concat();
            pipeline.run_probed(pairs, &mut outputs, probe);
            Simulation {
                outputs,
                memories_before,
                memories_after: [pipeline.rama(), pipeline.ramb()].concat(),
            }
        }
        PipelineConfig::Lms(config) => {
            let mut pipeline = LmsPipeline::new(*config);
            let memories_before = [pipeline.rama(), pipeline.ramb()].concat();
            pipeline.run_probed(pairs, &mut outputs, probe);
            Simulation {
                outputs,
                memories_before,
                memories_after: [pipeline.rama(), pipeline.ramb()].concat(),
            }
        }
    }
}

/// Writes stimulus, response, memory images, trace and parameters; returns the files.
///
/// # Errors
/// [`FpgaError::Length`] if the codes are not one per pair, [`FpgaError::Write`] if a file
/// cannot be written.
pub fn write_vectors<F: Fp>(
    dir: &Path,
    settings: &ExportSettings<F>,
    pairs: &[Pair<F>],
) -> Result<Vec<PathBuf>, FpgaError> {
    check_codes(settings, pairs.len())?;
    crate::fpga::timing::check_clock(settings.clock_mhz)?;
    fs::create_dir_all(dir).map_err(|cause| FpgaError::write(dir, cause))?;
    let trace_path = dir.join("trace.csv");
    let (simulation, trace_clocks) = write_trace(&trace_path, settings, pairs)?;

    let stimulus: Vec<F> = pairs
        .iter()
        .flat_map(|pair| [pair.input, pair.desired])
        .collect();
    let mut files = vec![trace_path];
    for (name, words) in [
        ("in.hex", &stimulus),
        ("y.hex", &simulation.outputs),
        ("ram_init.hex", &simulation.memories_before),
        ("ram_final.hex", &simulation.memories_after),
    ] {
        let text: String = words.iter().map(|word| hex(*word) + "\n").collect();
        files.push(write_text(dir, name, &text)?);
    }
    if let Some(codes) = &settings.codes {
        let mut text = String::new();
        for code in &codes.codes {
            writeln!(text, "{code:08x}").expect("writing to a string cannot fail");
        }
        files.push(write_text(dir, "in_codes.hex", &text)?);
    }
    let json = params_json(settings, pairs.len(), trace_clocks);
    files.push(write_text(dir, "params.json", &json)?);
    let header = params_vh(settings, pairs.len(), trace_clocks);
    files.push(write_text(dir, "params.vh", &header)?);
    Ok(files)
}

fn check_codes<F>(settings: &ExportSettings<F>, want: usize) -> Result<(), FpgaError> {
    match &settings.codes {
        Some(codes) if codes.codes.len() != want => Err(FpgaError::Length {
            name: "integer codes",
            got: codes.codes.len(),
            want,
        }),
        _ => Ok(()),
    }
}

/// Writes one text file of the folder.
pub(super) fn write_text(dir: &Path, name: &str, text: &str) -> Result<PathBuf, FpgaError> {
    let path = dir.join(name);
    fs::write(&path, text).map_err(|cause| FpgaError::write(&path, cause))?;
    Ok(path)
}

/// Simulates while streaming the trace to its file; returns the clocks written.
fn write_trace<F: Fp>(
    path: &Path,
    settings: &ExportSettings<F>,
    pairs: &[Pair<F>],
) -> Result<(Simulation<F>, u64), FpgaError> {
    let failed = |cause: std::io::Error| FpgaError::write(path, cause);
    let mut out = BufWriter::new(File::create(path).map_err(failed)?);
    writeln!(out, "{CSV_HEADER}").map_err(failed)?;
    let mut clocks = 0;
    let mut outcome = Ok(());
    let window = settings.window(settings.trace_samples);
    let mut recorder = Recorder::new(window, |record: &_| {
        clocks += 1;
        if outcome.is_ok() {
            outcome = write_csv_line(&mut out, record);
        }
    });
    let simulation = simulate(&settings.pipeline, pairs, &mut recorder);
    recorder.finish();
    outcome.and_then(|()| out.flush()).map_err(failed)?;
    Ok((simulation, clocks))
}

/// Constants common to both parameter files: name and word.
fn constants<F: Fp>(pipeline: &PipelineConfig<F>) -> Vec<(&'static str, F)> {
    match pipeline {
        PipelineConfig::Rls(config) => vec![
            ("ONE", F::ONE),
            ("ALPHA", config.alpha()),
            ("IALPHA", config.inverse_alpha()),
            ("DELTA", config.delta()),
        ],
        PipelineConfig::Lms(config) => vec![
            ("ONE", F::ONE),
            ("HALF", F::from_f64(0.5)),
            ("MU", config.step_size()),
            ("EPS", config.regularisation().unwrap_or(F::ZERO)),
        ],
    }
}

/// Settings common to both parameter files: name and number.
fn choices<F: Fp>(pipeline: &PipelineConfig<F>) -> Vec<(&'static str, usize)> {
    let (mut choices, sign) = match pipeline {
        PipelineConfig::Rls(config) => {
            let element = usize::from(config.division() == Division::Element);
            let choices = vec![("P", config.tap_count()), ("ELEM", element)];
            (choices, config.update_sign())
        }
        PipelineConfig::Lms(config) => {
            let mean = usize::from(config.desired() == DesiredSource::MeanOfTwoNewest);
            let choices = vec![
                ("N", config.tap_count()),
                ("NORMALISED", usize::from(config.is_normalised())),
                ("MEAN", mean),
            ];
            (choices, config.update_sign())
        }
    };
    choices.push(("AS_PRINTED", usize::from(sign == UpdateSign::AsPrinted)));
    choices.push(("FTZ", usize::from(F::FLUSHES_SUBNORMALS)));
    choices
}

/// Verilog definitions for the testbench.
fn params_vh<F: Fp>(settings: &ExportSettings<F>, samples: usize, trace_clocks: u64) -> String {
    let mut text = String::from("// Parameters of this export.\n");
    let mut define = |name: &str, value: String| {
        writeln!(text, "`define FB_{name} {value}").expect("writing to a string cannot fail");
    };
    define("W", F::WIDTH.to_string());
    for (name, value) in choices(&settings.pipeline) {
        define(name, value.to_string());
    }
    for (name, word) in constants(&settings.pipeline) {
        define(name, format!("{}'h{}", F::WIDTH, hex(word)));
    }
    define("SAMPLES", samples.to_string());
    define("TRACE_CLOCKS", trace_clocks.to_string());
    text
}

/// Parameters for people and programs: numbers, their bits, and the choices behind the bits.
fn params_json<F: Fp>(settings: &ExportSettings<F>, samples: usize, trace_clocks: u64) -> String {
    let mut fields: Vec<(String, String)> = Vec::new();
    let quote = |text: &str| format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""));
    let mut add = |name: &str, value: String| fields.push((name.to_string(), value));
    let filter = match &settings.pipeline {
        PipelineConfig::Rls(_) => "rls",
        PipelineConfig::Lms(_) => "lms",
    };
    add("filter", quote(filter));
    add("format", quote(F::NAME));
    add(
        "rounding",
        quote("nearest, ties to even, every operation alone"),
    );
    add("fused_multiply_add", "false".to_string());
    add(
        "subnormals",
        quote(if F::FLUSHES_SUBNORMALS {
            "flushed"
        } else {
            "kept"
        }),
    );
    add("word_bits", F::WIDTH.to_string());
    for (name, value) in choices(&settings.pipeline) {
        add(&name.to_lowercase(), value.to_string());
    }
    if filter == "rls" {
        add("alpha_first", "true".to_string());
        add("update_order", quote("(t_i * t_j) first"));
        add("gain", quote("R L with the updated R"));
    }
    for (name, word) in constants(&settings.pipeline) {
        let name = name.to_lowercase();
        add(&name, format!("{:e}", word.to_f64()));
        add(&format!("{name}_bits"), quote(&hex(word)));
    }
    add("front_end", quote(&settings.front_end));
    add("clock_mhz", format!("{}", settings.clock_mhz));
    add(
        "clocks_per_sample",
        settings.pipeline.clocks_per_sample().to_string(),
    );
    add(
        "latency_clocks",
        settings.pipeline.latency_clocks().to_string(),
    );
    add("samples", samples.to_string());
    add("trace_clocks", trace_clocks.to_string());
    if let Some(codes) = &settings.codes {
        add("code_lsb", format!("{:e}", codes.lsb));
        add("code_unit", quote(&codes.unit));
    }
    let lines: Vec<String> = fields
        .iter()
        .map(|(name, value)| format!("  \"{name}\": {value}"))
        .collect();
    format!("{{\n{}\n}}\n", lines.join(",\n"))
}
