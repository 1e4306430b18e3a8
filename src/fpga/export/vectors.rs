//! Golden vectors: stimulus, response, memory images, per-clock trace and parameters.

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use super::params::{params_json, params_vh};
use crate::fpga::board::{CodeScale, Surroundings};
use crate::fpga::error::FpgaError;
use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::{FrontEnd, Pair};
use crate::fpga::kinds::PipelineConfig;
use crate::fpga::trace::{CSV_HEADER, ClockRecord, Window, hex, write_csv_line};

/// The gyro's raw output words, from which the stimulus was made.
#[derive(Clone, Debug, PartialEq)]
pub struct IntegerCodes {
    /// One code per sample.
    pub codes: Vec<i32>,
    /// How a code becomes a word.
    pub scale: CodeScale,
}

impl IntegerCodes {
    /// Whether the words are those of the codes, bit for bit but for the sign of 0, which a code has not.
    #[must_use]
    pub fn give(&self, words: &[f64]) -> bool {
        let bits = |word: f64| (word + 0.0).to_bits();
        let mut pairs = self.words().zip(words);
        self.codes.len() == words.len() && pairs.all(|(mine, word)| bits(mine) == bits(*word))
    }

    /// The words of the codes.
    pub fn words(&self) -> impl Iterator<Item = f64> {
        self.codes.iter().map(|code| self.scale.word(*code))
    }
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
    /// The top level for a board; none: the core alone is exported.
    pub top: Option<TopLevel<F>>,
}

/// The top level of an export.
#[derive(Clone, Debug, PartialEq)]
pub struct TopLevel<F> {
    /// What stands around the core.
    pub surroundings: Surroundings,
    /// The samples behind the pairs, as words.
    pub samples: Vec<F>,
}

impl<F: Fp> ExportSettings<F> {
    /// The clocks of the first `samples` samples, the wake-up clock included.
    #[must_use]
    pub fn window(&self, samples: usize) -> Window {
        let clocks = match samples {
            0 => 0,
            _ => {
                let used = self.pipeline.as_pipeline().clocked().usage();
                1 + samples as u64 * used.clocks_per_sample
            }
        };
        Window {
            first_clock: 0,
            clock_count: clocks,
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
                    format: F::NAME,
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

/// Runs the pipeline over all pairs, from reset, back to back; the clocks of a window go to `sink`.
pub(super) fn simulate<F: Fp>(
    pipeline: &PipelineConfig<F>,
    pairs: &[Pair<F>],
    window: Window,
    sink: &mut dyn FnMut(&ClockRecord<F>),
) -> Simulation<F> {
    let mut clocked = pipeline.as_pipeline().clocked();
    let memories_before = clocked.memories();
    let outputs = clocked.record(pairs, window, sink);
    Simulation {
        outputs,
        memories_before,
        memories_after: clocked.memories(),
    }
}

/// Writes stimulus, response, memory images, trace and parameters; returns the files.
///
/// # Errors
/// [`FpgaError::CountOutOfRange`] without pairs, [`FpgaError::Length`] if the codes are not one
/// per pair, [`FpgaError::OutOfRange`] for the clock, [`FpgaError::Write`] if a file cannot be
/// written.
pub fn write_vectors<F: Fp>(
    dir: &Path,
    settings: &ExportSettings<F>,
    pairs: &[Pair<F>],
) -> Result<Vec<PathBuf>, FpgaError> {
    check_counts(settings, pairs.len())?;
    crate::fpga::check::check_clock(settings.clock_mhz)?;
    fs::create_dir_all(dir).map_err(|cause| FpgaError::write(dir, cause))?;
    let trace_path = dir.join("trace.csv");
    let (simulation, trace_rows) = write_trace(&trace_path, settings, pairs)?;

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
    let json = params_json(settings, pairs.len(), trace_rows);
    files.push(write_text(dir, "params.json", &json)?);
    let header = params_vh(settings, pairs.len(), trace_rows);
    files.push(write_text(dir, "params.vh", &header)?);
    Ok(files)
}

fn check_counts<F>(settings: &ExportSettings<F>, want: usize) -> Result<(), FpgaError> {
    if want == 0 {
        return Err(FpgaError::CountOutOfRange {
            name: "number of samples to export",
            value: 0,
            range: "at least 1",
        });
    }
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

/// Simulates while streaming the trace to its file; returns the clocks written that do not idle,
/// which are those a testbench compares.
fn write_trace<F: Fp>(
    path: &Path,
    settings: &ExportSettings<F>,
    pairs: &[Pair<F>],
) -> Result<(Simulation<F>, u64), FpgaError> {
    let failed = |cause: std::io::Error| FpgaError::write(path, cause);
    let mut out = BufWriter::new(File::create(path).map_err(failed)?);
    writeln!(out, "{CSV_HEADER}").map_err(failed)?;
    let mut rows = 0;
    let mut outcome = Ok(());
    let window = settings.window(settings.trace_samples);
    let simulation = simulate(&settings.pipeline, pairs, window, &mut |record| {
        rows += u64::from(record.registers.state != 0);
        if outcome.is_ok() {
            outcome = write_csv_line(&mut out, record);
        }
    });
    outcome.and_then(|()| out.flush()).map_err(failed)?;
    Ok((simulation, rows))
}
