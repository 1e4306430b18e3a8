//! The folder of a fixed-point pipeline: vectors, and RTL with its testbenches.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use super::axis::{self, StreamPorts};
use super::fixed_params::{fixed_json, fixed_macros};
use super::fixed_top::fixed_top_verilog;
use super::params::unit_latencies;
use super::rtl::synthesis;
use super::top::TOP_SAMPLES;
use super::vectors::write_text;
use crate::fpga::error::FpgaError;
use crate::fpga::fixed::{
    CodePair, FixedClock, FixedClocked, FixedConfig, FixedFrontEnd, FixedKind, PortAccess,
    SignalName,
};
use crate::vocabulary::{DesiredSignal, Device, OutputRegister};

/// Testbench of every fixed-point core, which goes under the name of its kind.
const BENCH: &str = include_str!("rtl/tb_fixed.v");

/// Description of the folder; words in braces stand for what the kind says.
const README: &str = include_str!("rtl/README_fixed.txt");

/// Files of the RTL of every kind beside those of the export itself.
const SOURCES: [(&str, &str); 7] = [
    ("fx.v", include_str!("rtl/fx.v")),
    ("fp_wait.v", include_str!("rtl/fp_wait.v")),
    ("sp_ram.v", include_str!("rtl/sp_ram.v")),
    ("fx_front_end.v", include_str!("rtl/fx_front_end.v")),
    ("top_bench.v", include_str!("rtl/top_bench.v")),
    ("tb_defaults.vh", include_str!("rtl/tb_defaults.vh")),
    ("run.sh", include_str!("rtl/run.sh")),
];

/// What to export of a fixed-point pipeline and how to describe it.
#[derive(Clone, Debug, PartialEq)]
pub struct FixedExport {
    /// The core.
    pub config: FixedConfig,
    /// What d reproduces.
    pub desired: DesiredSignal,
    /// Samples by which x is older than the newest.
    pub input_lag_samples: usize,
    /// When the result appears.
    pub output_register: OutputRegister,
    /// Samples, codes of d.
    pub samples: Vec<i64>,
    /// What the value 1 stands for, in words; for the description alone.
    pub full_scale: String,
    /// Clock frequency in MHz; only described.
    pub clock_mhz: f64,
    /// Samples whose every clock goes into `trace.csv`.
    pub trace_samples: usize,
}

impl FixedExport {
    /// The first samples at which a word was beyond the ends of its signal, front end included, and at
    /// which a denominator or a diagonal element of R was not above zero.
    pub(super) fn first_faults(&self) -> [Option<usize>; 2] {
        let pipeline = self.config.as_pipeline();
        let formats = pipeline.tap_formats();
        let mut front_end = FixedFrontEnd::new(formats, self.desired, self.input_lag_samples);
        let mut engine = pipeline.engine();
        let mut overflow_at = None;
        for (index, sample) in self.samples.iter().enumerate() {
            engine.process(front_end.pair(*sample));
            let core = engine.health().overflows;
            let beyond = SignalName::ALL.iter().any(|name| core.of(*name) > 0);
            if overflow_at.is_none() && (beyond || front_end.overflows() != [0; 2]) {
                overflow_at = Some(index);
            }
        }
        let indefinite_at = engine.health().indefinite_at;
        [
            overflow_at,
            indefinite_at.and_then(|sample| usize::try_from(sample).ok()),
        ]
    }

    /// For each sample 1 where the core stored a word that was beyond the ends of its signal.
    fn overflows_of_core(&self) -> Vec<i64> {
        let mut engine = self.config.as_pipeline().engine();
        let mut before = engine.health().overflows;
        let mut flags = Vec::new();
        for pair in self.pairs() {
            engine.process(pair);
            let counted = engine.health().overflows;
            let rises = |name: &SignalName| counted.of(*name) > before.of(*name);
            flags.push(i64::from(SignalName::ALL.iter().any(rises)));
            before = counted;
        }
        flags
    }

    /// The pairs behind the front end.
    #[must_use]
    pub fn pairs(&self) -> Vec<CodePair> {
        let pipeline = self.config.as_pipeline();
        let formats = pipeline.tap_formats();
        let mut front_end = FixedFrontEnd::new(formats, self.desired, self.input_lag_samples);
        let samples = self.samples.iter();
        samples.map(|sample| front_end.pair(*sample)).collect()
    }
}

/// Simulates the samples back to back from reset and writes vectors and parameters; returns the files.
///
/// # Errors
/// [`FpgaError::CountOutOfRange`] without samples, [`FpgaError::OutOfRange`] for the clock,
/// [`FpgaError::Write`] if a file cannot be written.
pub fn write_fixed_vectors(dir: &Path, export: &FixedExport) -> Result<Vec<PathBuf>, FpgaError> {
    if export.samples.is_empty() {
        return Err(FpgaError::CountOutOfRange {
            name: "number of samples to export",
            value: 0,
            range: "at least 1",
        });
    }
    crate::fpga::check::check_clock(export.clock_mhz)?;
    fs::create_dir_all(dir).map_err(|cause| FpgaError::write(dir, cause))?;
    let pairs = export.pairs();
    let declared = export.config.as_pipeline();
    let mut pipeline = declared.clocked();
    let before = hex_lines(&pipeline.memories().concat());
    let (outputs, trace, rows) = simulate(pipeline.as_mut(), &pairs, export.trace_samples);
    let words: Vec<i64> = pairs
        .iter()
        .flat_map(|pair| [pair.input, pair.desired])
        .collect();
    let texts = [
        ("in.hex", hex_lines(&words)),
        (TOP_SAMPLES, hex_lines(&export.samples)),
        ("y.hex", hex_lines(&outputs)),
        ("overflow.hex", hex_lines(&export.overflows_of_core())),
        ("ram_init.hex", before),
        ("ram_final.hex", hex_lines(&pipeline.memories().concat())),
        ("trace.csv", trace),
        ("params.json", fixed_json(export, rows)),
        ("params.vh", fixed_macros(export, rows)),
    ];
    let mut files = Vec::new();
    for (name, text) in texts {
        files.push(write_text(dir, name, &text)?);
    }
    Ok(files)
}

/// Writes the vectors, and RTL with the constants, testbenches and a script that runs from anywhere;
/// returns the files.
///
/// # Errors
/// As [`write_fixed_vectors`].
pub fn write_fixed_rtl(dir: &Path, export: &FixedExport) -> Result<Vec<PathBuf>, FpgaError> {
    write_fixed_rtl_for(dir, export, None)
}

/// [`write_fixed_rtl`] with a script for synthesis where a device is named.
///
/// # Errors
/// As [`write_fixed_vectors`].
pub fn write_fixed_rtl_for(
    dir: &Path,
    export: &FixedExport,
    device: Option<Device>,
) -> Result<Vec<PathBuf>, FpgaError> {
    let mut files = write_fixed_vectors(dir, export)?;
    let kind = export.config.as_pipeline().kind();
    for (name, text) in SOURCES.iter().chain(&axis::SOURCES).chain(kind.sources) {
        files.push(write_text(dir, name, text)?);
    }
    let formats = export.config.as_pipeline().tap_formats();
    let ports = StreamPorts {
        kind: kind.name,
        bits: [formats.desired.width(), formats.output.width()],
        latencies: unit_latencies(export.config.as_pipeline().units()).map(|(_, clocks)| clocks),
    };
    if let Some(device) = device {
        let own = kind.sources.iter().map(|(name, _)| *name);
        let files_of_top = own.chain(["fx_front_end.v", "fx.v", "sp_ram.v", "fp_wait.v"]);
        let sources: Vec<&str> = files_of_top.collect();
        let text = synthesis(kind.name, device, &sources.join(" "));
        files.push(write_text(dir, "synth.sh", &text)?);
    }
    for (name, text) in [
        (ports.file(), ports.verilog()),
        ("README.txt".to_owned(), readme(kind)),
        (format!("tb_{}.v", kind.name), BENCH.to_owned()),
        (format!("{}_top.v", kind.name), fixed_top_verilog(export)),
    ] {
        files.push(write_text(dir, &name, &text)?);
    }
    Ok(files)
}

/// The description of the folder of a kind.
fn readme(kind: &FixedKind) -> String {
    let own: Vec<&str> = kind.sources.iter().map(|(name, _)| *name).collect();
    let mut codes = String::from(" ");
    for (code, state) in kind.states.iter().enumerate() {
        let entry = format!(" {code} {state}");
        let line = codes.lines().last().unwrap_or_default();
        if line.len() + entry.len() > 100 {
            codes.push_str("\n ");
        }
        codes.push_str(&entry);
    }
    README
        .replace("{kind}", kind.name)
        .replace("{sources}", &own.join(" "))
        .replace("{memories}", kind.memories)
        .replace("{states}", &codes)
}

/// Runs the pairs back to back; outputs, the trace of the first `traced` samples and the number of its rows.
/// A step of several clocks is a row, that of its last clock.
fn simulate(
    pipeline: &mut dyn FixedClocked,
    pairs: &[CodePair],
    traced: usize,
) -> (Vec<i64>, String, usize) {
    let (mut outputs, mut trace, mut rows) = (Vec::new(), String::new(), 0);
    let mut next = 0;
    while next < pairs.len() || !pipeline.is_idle() {
        let was_idle = pipeline.is_idle();
        let clock = pipeline.tick(pairs.get(next).copied());
        next += usize::from(clock.accepted);
        outputs.extend(clock.output);
        if !was_idle && !clock.waits && next <= traced {
            write_row(&mut trace, &clock);
            rows += 1;
        }
    }
    (outputs, trace, rows)
}

fn hex_lines(words: &[i64]) -> String {
    words.iter().map(|word| format!("{word:016x}\n")).collect()
}

fn write_row(trace: &mut String, clock: &FixedClock) {
    let r = &clock.registers;
    let port = |access: PortAccess| {
        let word = access.write.unwrap_or(0);
        format!(
            "{},{},{word:016x}",
            access.address,
            u8::from(access.write.is_some())
        )
    };
    // Writing to a string cannot fail.
    let _ = writeln!(
        trace,
        "{},{},{},{:032x},{:032x},{:016x},{:016x},{:016x},{:016x},{:016x},{},{:016x},{:016x}",
        r.state,
        port(clock.rama),
        port(clock.ramb),
        r.product,
        r.accumulator,
        r.read_latch,
        r.denominator,
        r.desired,
        r.error,
        r.output,
        r.head,
        r.gain,
        r.intermediate
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fpga::fixed::FIXED_KINDS;

    #[test]
    fn the_readme_of_every_fixed_point_kind_states_files_and_state_codes() {
        for kind in FIXED_KINDS {
            let readme = readme(kind);
            let words = readme.split_whitespace().collect::<Vec<_>>().join(" ");
            for (name, _) in SOURCES.iter().chain(&axis::SOURCES).chain(kind.sources) {
                assert!(words.contains(name), "{name}");
            }
            for (code, state) in kind.states.iter().enumerate() {
                assert!(words.contains(&format!("{code} {state}")), "{code} {state}");
            }
            assert!(!words.contains('{'), "{readme}");
        }
    }
}
