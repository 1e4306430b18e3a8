//! The folder of a fixed-point pipeline: sources, testbench and vectors.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use super::vectors::write_text;
use crate::fpga::error::FpgaError;
use crate::fpga::fixed::{
    CodePair, FixedClock, FixedRlsConfig, FixedRlsPipeline, FixedRlsState, Format, Overflow,
    Rounding, fixed_rls_clocks_per_sample, fixed_rls_latency_clocks,
};

const SOURCES: [(&str, &str); 4] = [
    ("rls_fixed_core.v", include_str!("rtl/rls_fixed_core.v")),
    ("fx.v", include_str!("rtl/fx.v")),
    ("sp_ram.v", include_str!("rtl/sp_ram.v")),
    ("tb_rls_fixed.v", include_str!("rtl/tb_rls_fixed.v")),
];

/// Letter of each signal in the names of the core's parameters.
const LETTERS: [char; 8] = ['X', 'D', 'T', 'N', 'K', 'R', 'W', 'Y'];

/// Simulates the pair after pair, back to back from reset, and writes RTL, testbench and vectors;
/// returns the files.
///
/// The testbench is run in the folder: `iverilog -g2012 -s tb_rls_fixed -o tb *.v && vvp -n tb`.
///
/// * `trace_samples`: samples whose every clock goes into `trace.csv`.
///
/// # Errors
/// [`FpgaError::CountOutOfRange`] without pairs, [`FpgaError::Write`] if a file cannot be written.
pub fn write_fixed_rtl(
    dir: &Path,
    config: &FixedRlsConfig,
    pairs: &[CodePair],
    trace_samples: usize,
) -> Result<Vec<PathBuf>, FpgaError> {
    if pairs.is_empty() {
        return Err(FpgaError::CountOutOfRange {
            name: "number of samples to export",
            value: 0,
            range: "at least 1",
        });
    }
    fs::create_dir_all(dir).map_err(|cause| FpgaError::write(dir, cause))?;
    let mut pipeline = FixedRlsPipeline::new(*config);
    let memories =
        |pipeline: &FixedRlsPipeline| hex_lines(&[pipeline.rama(), pipeline.ramb()].concat());
    let before = memories(&pipeline);
    let period = fixed_rls_clocks_per_sample(config.tap_count());
    let traced = trace_samples.min(pairs.len()) * period;
    let (mut outputs, mut trace, mut rows) = (Vec::new(), String::new(), 0);
    let mut next = 0;
    while next < pairs.len() || pipeline.registers().state != FixedRlsState::Idle {
        let clock = pipeline.tick(pairs.get(next).copied());
        next += usize::from(clock.accepted);
        outputs.extend(clock.output);
        if clock.registers.state != FixedRlsState::Idle && rows < traced {
            trace.push_str(&trace_row(&clock));
            rows += 1;
        }
    }
    let words = pairs.iter().flat_map(|pair| [pair.input, pair.desired]);
    let texts = [
        ("in.hex", hex_lines(&words.collect::<Vec<_>>())),
        ("y.hex", hex_lines(&outputs)),
        ("ram_init.hex", before),
        ("ram_final.hex", memories(&pipeline)),
        ("trace.csv", trace),
        ("fixed.vh", parameters(config, pairs.len(), rows)),
    ];
    let mut files = Vec::new();
    let texts = texts.iter().map(|(name, text)| (*name, text.as_str()));
    for (name, text) in texts.chain(SOURCES) {
        files.push(write_text(dir, name, text)?);
    }
    Ok(files)
}

fn hex_lines(words: &[i64]) -> String {
    words.iter().map(|word| format!("{word:016x}\n")).collect()
}

fn trace_row(clock: &FixedClock) -> String {
    let r = &clock.registers;
    let port = |access: crate::fpga::fixed::PortAccess| {
        let word = access.write.unwrap_or(0);
        format!(
            "{},{},{word:016x}",
            access.address,
            u8::from(access.write.is_some())
        )
    };
    format!(
        "{},{},{},{:032x},{:032x},{:016x},{:016x},{:016x},{:016x},{:016x},{}\n",
        r.state as u8,
        port(clock.rama),
        port(clock.ramb),
        r.product,
        r.accumulator,
        r.read_latch,
        r.denominator,
        r.desired,
        r.error,
        r.output,
        r.head
    )
}

/// Verilog macros of the testbench; the core's parameters all in one.
fn parameters(config: &FixedRlsConfig, samples: usize, rows: usize) -> String {
    let formats = config.formats().named();
    let widths = formats.iter().map(|(_, format)| format.width());
    let widest = widths.max().unwrap_or(0);
    let mut core = format!(".P({}), .MW({widest})", config.tap_count());
    for ((_, format), letter) in formats.iter().zip(LETTERS) {
        let _ = write!(core, "{}", format_parameters(*format, letter));
    }
    let (factor, factor_bits) = config.inverse_alpha().unwrap_or((0, 0));
    let _ = write!(
        core,
        ", .ALPHA(128'sh{:032x}), .SCALES({}), .IALPHA(64'sh{factor:016x}), .NI({factor_bits}), \
         .DELTA(64'sh{:016x})",
        config.alpha(),
        u8::from(factor != 0),
        config.delta()
    );
    let mut text = "// Parameters of this export.\n".to_owned();
    let mut define = |name: &str, value: &str| {
        let _ = writeln!(text, "`define FIXED_{name} {value}");
    };
    let p = config.tap_count();
    define("P", &p.to_string());
    define("MW", &widest.to_string());
    for ((_, format), letter) in formats.iter().zip(LETTERS) {
        define(&format!("W{letter}"), &format.width().to_string());
    }
    define("SAMPLES", &samples.to_string());
    define("ROWS", &rows.to_string());
    define("PERIOD", &fixed_rls_clocks_per_sample(p).to_string());
    define("LATENCY", &fixed_rls_latency_clocks(p).to_string());
    define("PARAMETERS", &core);
    text
}

fn format_parameters(format: Format, letter: char) -> String {
    let mut text = format!(
        ", .W{letter}({}), .N{letter}({})",
        format.width(),
        format.fraction_bits
    );
    // Nothing is rounded into the input's words.
    if letter != 'X' && letter != 'D' {
        let rounding = match format.rounding {
            Rounding::Truncate => 0,
            Rounding::HalfUp => 1,
            Rounding::NearestEven => 2,
        };
        let saturates = u8::from(format.overflow == Overflow::Saturate);
        let _ = write!(text, ", .R{letter}({rounding}), .S{letter}({saturates})");
    }
    text
}
