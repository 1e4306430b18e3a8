//! Waveforms of a window of clocks: VCD and FST with the same signals.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use fst_writer::{
    FstBodyWriter, FstFileType, FstInfo, FstScopeType, FstSignalId, FstSignalType, FstVarDirection,
    FstVarType,
};
use vcd::{IdCode, TimescaleUnit, VarType};

use super::params::half_period_ps;
use super::signals::{Kind, Sheet, Value};
use super::vectors::{ExportSettings, simulate, write_text};
use crate::fpga::error::FpgaError;
use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::Pair;
use crate::fpga::trace::{ClockRecord, Window};

/// Characters of a state name in the FST, which has no strings: an ASCII vector of this length.
const NAME_CHARACTERS: usize = 11;

/// A waveform file being written.
trait Sink {
    fn time(&mut self, time_ps: u64) -> io::Result<()>;
    fn clock_line(&mut self, high: bool) -> io::Result<()>;
    fn change(&mut self, index: usize, kind: Kind, value: Value) -> io::Result<()>;
}

struct VcdSink<W: Write> {
    writer: vcd::Writer<W>,
    clock: IdCode,
    signals: Vec<IdCode>,
}

impl<W: Write> VcdSink<W> {
    fn new(out: W, top: &str, sheet: &Sheet) -> io::Result<Self> {
        let mut writer = vcd::Writer::new(out);
        writer.timescale(1, TimescaleUnit::PS)?;
        writer.add_module(top)?;
        let clock = writer.add_wire(1, "clk")?;
        let mut signals = Vec::new();
        let mut open = "";
        for signal in &sheet.signals {
            if signal.scope != open {
                if !open.is_empty() {
                    writer.upscope()?;
                }
                writer.add_module(signal.scope)?;
                open = signal.scope;
            }
            signals.push(match signal.kind {
                Kind::Bits(width) => writer.add_wire(width, signal.name)?,
                Kind::Real => writer.add_var(VarType::Real, 64, signal.name, None)?,
                Kind::Text => writer.add_var(VarType::String, 1, signal.name, None)?,
            });
        }
        writer.upscope()?;
        writer.upscope()?;
        writer.enddefinitions()?;
        Ok(Self {
            writer,
            clock,
            signals,
        })
    }
}

impl<W: Write> Sink for VcdSink<W> {
    fn time(&mut self, time_ps: u64) -> io::Result<()> {
        self.writer.timestamp(time_ps)
    }

    fn clock_line(&mut self, high: bool) -> io::Result<()> {
        self.writer.change_scalar(self.clock, high)
    }

    fn change(&mut self, index: usize, kind: Kind, value: Value) -> io::Result<()> {
        let id = self.signals[index];
        match (value, kind) {
            (Value::Bits(bits), Kind::Bits(1)) => self.writer.change_scalar(id, bits != 0),
            (Value::Bits(bits), Kind::Bits(width)) => {
                let digits = (0..width)
                    .rev()
                    .map(|k| vcd::Value::from(bits >> k & 1 != 0));
                self.writer.change_vector(id, digits)
            }
            (Value::Real(bits), _) => self.writer.change_real(id, f64::from_bits(bits)),
            (Value::Text(text), _) => self.writer.change_string(id, text),
            (Value::Bits(_), Kind::Real | Kind::Text) => {
                unreachable!("vectors are declared as vectors")
            }
        }
    }
}

struct FstSink<W: Write + io::Seek> {
    writer: FstBodyWriter<W>,
    clock: FstSignalId,
    signals: Vec<FstSignalId>,
}

impl FstSink<BufWriter<File>> {
    fn new(path: &Path, top: &str, sheet: &Sheet) -> fst_writer::Result<Self> {
        let info = FstInfo {
            start_time: 0,
            timescale_exponent: -12,
            version: String::new(),
            date: String::new(),
            file_type: FstFileType::Verilog,
        };
        let mut writer = fst_writer::open_fst(path, &info)?;
        writer.scope(top, "", FstScopeType::Module)?;
        let wire = (FstVarType::Wire, FstVarDirection::Implicit);
        let clock = writer.var("clk", FstSignalType::bit_vec(1), wire.0, wire.1, None)?;
        let mut signals = Vec::new();
        let mut open = "";
        for signal in &sheet.signals {
            if signal.scope != open {
                if !open.is_empty() {
                    writer.up_scope()?;
                }
                writer.scope(signal.scope, "", FstScopeType::Module)?;
                open = signal.scope;
            }
            let (form, var) = match signal.kind {
                Kind::Bits(width) => (FstSignalType::bit_vec(width), FstVarType::Wire),
                Kind::Real => (FstSignalType::real(), FstVarType::Real),
                Kind::Text => (
                    FstSignalType::bit_vec(8 * u32::try_from(NAME_CHARACTERS).unwrap_or(0)),
                    FstVarType::Wire,
                ),
            };
            signals.push(writer.var(signal.name, form, var, wire.1, None)?);
        }
        writer.up_scope()?;
        writer.up_scope()?;
        Ok(Self {
            writer: writer.finish()?,
            clock,
            signals,
        })
    }
}

impl<W: Write + io::Seek> Sink for FstSink<W> {
    fn time(&mut self, time_ps: u64) -> io::Result<()> {
        self.writer.time_change(time_ps).map_err(io::Error::other)
    }

    fn clock_line(&mut self, high: bool) -> io::Result<()> {
        let digit = if high { b"1" } else { b"0" };
        self.writer
            .signal_change(self.clock, digit)
            .map_err(io::Error::other)
    }

    fn change(&mut self, index: usize, kind: Kind, value: Value) -> io::Result<()> {
        let digit = |is_one: bool| if is_one { b'1' } else { b'0' };
        let bytes: Vec<u8> = match (value, kind) {
            (Value::Bits(bits), Kind::Bits(width)) => (0..width)
                .rev()
                .map(|k| digit(bits >> k & 1 != 0))
                .collect(),
            (Value::Real(bits), _) => f64::from_bits(bits).to_le_bytes().to_vec(),
            (Value::Text(text), _) => format!("{text:>NAME_CHARACTERS$}")
                .bytes()
                .flat_map(|byte| (0..8).rev().map(move |k| digit(byte >> k & 1 != 0)))
                .collect(),
            (Value::Bits(_), Kind::Real | Kind::Text) => {
                unreachable!("vectors are declared as vectors")
            }
        };
        self.writer
            .signal_change(self.signals[index], &bytes)
            .map_err(io::Error::other)
    }
}

/// Writes `wave.vcd`, `wave.fst` and the state names' translate file; returns the files.
///
/// Time in ps: a clock's values appear with the rising edge that begins it. A VCD takes about
/// 0.1 MB per RLS sample at four taps, so choose a window rather than a whole run.
///
/// # Errors
/// [`FpgaError::Write`] if a file cannot be written, [`FpgaError::OutOfRange`] for the clock.
pub fn write_waveform<F: Fp>(
    dir: &Path,
    settings: &ExportSettings<F>,
    pairs: &[Pair<F>],
    window: Window,
) -> Result<Vec<PathBuf>, FpgaError> {
    crate::fpga::check::check_clock(settings.clock_mhz)?;
    fs::create_dir_all(dir).map_err(|cause| FpgaError::write(dir, cause))?;
    let mut records = Vec::new();
    simulate(&settings.pipeline, pairs, window, &mut |record| {
        records.push(*record);
    });
    let Some(first) = records.first() else {
        return Err(FpgaError::CountOutOfRange {
            name: "first clock of the waveform window",
            value: window.first_clock,
            range: "a clock of the run, and at least one clock long",
        });
    };
    let layout = Sheet::of(first);
    let kind = settings.pipeline.as_pipeline().kind();
    let (top, filter) = (kind.name, translate_file(kind.states));
    let half_period_ps = half_period_ps(settings.clock_mhz);

    let vcd_path = dir.join("wave.vcd");
    let failed = |cause| FpgaError::write(&vcd_path, cause);
    let out = BufWriter::new(File::create(&vcd_path).map_err(failed)?);
    let mut sink = VcdSink::new(out, top, &layout).map_err(failed)?;
    dump(&mut sink, &records, half_period_ps).map_err(failed)?;
    sink.writer.flush().map_err(failed)?;

    let fst_path = dir.join("wave.fst");
    let failed = |cause: fst_writer::FstWriteError| FpgaError::write(&fst_path, cause);
    let mut sink = FstSink::new(&fst_path, top, &layout).map_err(failed)?;
    dump(&mut sink, &records, half_period_ps)
        .map_err(|cause| FpgaError::write(&fst_path, cause))?;
    sink.writer.finish().map_err(failed)?;

    let names = write_text(dir, "states.gtkwfilter", &filter)?;
    Ok(vec![vcd_path, fst_path, names])
}

fn dump<F: Fp>(
    sink: &mut impl Sink,
    records: &[ClockRecord<F>],
    half_period_ps: u64,
) -> io::Result<()> {
    let mut shown: Vec<Option<Value>> = Vec::new();
    for record in records {
        let sheet = Sheet::of(record);
        shown.resize(sheet.values.len(), None);
        let start = 2 * half_period_ps * record.clock;
        sink.time(start)?;
        sink.clock_line(true)?;
        for (index, (signal, value)) in sheet.signals.iter().zip(sheet.values).enumerate() {
            if shown[index] != Some(value) {
                sink.change(index, signal.kind, value)?;
                shown[index] = Some(value);
            }
        }
        sink.time(start + half_period_ps)?;
        sink.clock_line(false)?;
    }
    Ok(())
}

/// State codes and names in the form GTKWave's translate filter reads.
fn translate_file(names: &[&str]) -> String {
    names
        .iter()
        .enumerate()
        .map(|(code, name)| format!("{code:x} {name}\n"))
        .collect()
}
