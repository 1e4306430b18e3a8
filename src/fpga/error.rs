//! What can be wrong with a pipeline's settings or with the files written for it.

use std::path::PathBuf;

/// Error of the pipeline models and their exports.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FpgaError {
    /// The tap count does not fit the memories' address ranges.
    #[error("tap count {value} is out of range: expected 1 to 64")]
    TapCount {
        /// Refused value.
        value: usize,
    },
    /// A numeric setting lies outside its range, or leaves it when rounded to the word format.
    #[error("{name} = {} is out of range: expected {range} in {format}", shown(*value))]
    OutOfRange {
        /// Setting.
        name: &'static str,
        /// Refused value.
        value: f64,
        /// Allowed range, in words.
        range: &'static str,
        /// Word format in which the range is checked.
        format: &'static str,
    },
    /// A count of clocks, ports or samples lies outside its range.
    #[error("{name} = {value} is out of range: expected {range}")]
    CountOutOfRange {
        /// Setting.
        name: &'static str,
        /// Refused value.
        value: u64,
        /// Allowed range, in words.
        range: &'static str,
    },
    /// A constant lies beyond the largest word of its fixed-point format.
    #[error(
        "{name} = {} does not fit {signal}: Q{integer_bits}.{fraction_bits} ({} bits) holds less than {}",
        shown(*value), integer_bits + fraction_bits, shown(*limit)
    )]
    DoesNotFit {
        /// Constant.
        name: &'static str,
        /// Refused value.
        value: f64,
        /// Signal whose words would hold it.
        signal: &'static str,
        /// Integer bits of its format, the sign included.
        integer_bits: u32,
        /// Fraction bits of its format.
        fraction_bits: u32,
        /// First value beyond the format.
        limit: f64,
    },
    /// A stimulus holds a value that is not a finite number in the word format.
    #[error("stimulus sample {index} is {value:e}: expected a number that is finite in {format}")]
    NonFiniteStimulus {
        /// Index of the sample.
        index: usize,
        /// Refused value.
        value: f64,
        /// Word format of the pipeline.
        format: &'static str,
    },
    /// There is no export of this form.
    #[error("there is no waveform of fixed-point words: export rtl and run it with +VCD=wave.vcd")]
    FixedWaveform,
    /// The units of these fixed-point words take a clock each.
    #[error(
        "units of several clocks are there for rls alone in fixed point: leave the latencies out; run.sh takes DIV_LATENCY"
    )]
    FixedUnits,
    /// Two sequences that belong together differ in length.
    #[error("{name} holds {got} values: expected {want}, one per sample")]
    Length {
        /// Sequence.
        name: &'static str,
        /// Its length.
        got: usize,
        /// The length it must have.
        want: usize,
    },
    /// The waveform or the vectors could not be written.
    #[error("cannot write {path}: {message}")]
    Write {
        /// File.
        path: PathBuf,
        /// Cause.
        message: String,
    },
}

/// A number as messages show it: exact, a tiny or huge one with its power of ten.
fn shown(value: f64) -> String {
    let exact = format!("{value:?}");
    exact
        .strip_suffix(".0")
        .map_or(exact.clone(), str::to_owned)
}

impl FpgaError {
    /// Wraps the cause of a failed write with the file it happened to.
    pub(crate) fn write(path: &std::path::Path, cause: impl std::fmt::Display) -> Self {
        Self::Write {
            path: path.to_path_buf(),
            message: cause.to_string(),
        }
    }
}
