//! The RTL folder: sources, testbench, vectors and a script that runs from anywhere.

use std::path::{Path, PathBuf};

use super::axis::{self, StreamPorts};
use super::params::unit_latencies;
use super::top::{TOP_SAMPLES, top_samples, top_verilog};
use super::vectors::{ExportSettings, write_text, write_vectors};
use crate::fpga::error::FpgaError;
use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::Pair;
use crate::vocabulary::{Device, UnitSource};

/// Files of every pipeline.
const SHARED: [(&str, &str); 10] = [
    ("README.txt", include_str!("rtl/README.txt")),
    ("fp_wait.v", include_str!("rtl/fp_wait.v")),
    ("sp_ram.v", include_str!("rtl/sp_ram.v")),
    ("den_check.v", include_str!("rtl/den_check.v")),
    ("front_end.v", include_str!("rtl/front_end.v")),
    ("top_bench.v", include_str!("rtl/top_bench.v")),
    ("tb_common.vh", include_str!("rtl/tb_common.vh")),
    ("tb_defaults.vh", include_str!("rtl/tb_defaults.vh")),
    ("run.sh", include_str!("rtl/run.sh")),
    ("test_cocotb.py", include_str!("rtl/test_cocotb.py")),
];

/// Units that the simulator computes, and those that synthesise.
const BEHAVIOURAL: (&str, &str) = ("fp_sim.v", include_str!("rtl/fp_sim.v"));
const SYNTHESIZABLE: (&str, &str) = ("fp_units.v", include_str!("rtl/fp_units.v"));

/// Script of the synthesis, its places still open.
const SYNTHESIS: &str = include_str!("rtl/synth.sh");

/// What an export of RTL may have or leave out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RtlParts {
    /// Floating-point units.
    pub units: UnitSource,
    /// Family of devices for which a script synthesises the top level; its units have to synthesise.
    pub device: Option<Device>,
}

impl RtlParts {
    /// Units computed by the simulator, no script of a synthesis.
    pub const PLAIN: Self = Self {
        units: UnitSource::Behavioural,
        device: None,
    };
}

/// Writes vectors, RTL, testbench, run script and cocotb test, and with the surroundings of the core
/// the top level for a board; returns the files.
///
/// `sh DIR/run.sh` runs the testbench under Icarus Verilog, with `SIM=verilator` under Verilator;
/// both end non-zero at the first difference. `README.txt` in the folder states the rest.
///
/// # Errors
/// As [`write_vectors`].
pub fn write_rtl<F: Fp>(
    dir: &Path,
    settings: &ExportSettings<F>,
    pairs: &[Pair<F>],
) -> Result<Vec<PathBuf>, FpgaError> {
    write_rtl_parts(dir, settings, pairs, RtlParts::PLAIN)
}

/// [`write_rtl`] with a choice of the units, and with a script for synthesis where a device is named
/// and the top level is there.
///
/// # Errors
/// As [`write_vectors`].
pub fn write_rtl_parts<F: Fp>(
    dir: &Path,
    settings: &ExportSettings<F>,
    pairs: &[Pair<F>],
    parts: RtlParts,
) -> Result<Vec<PathBuf>, FpgaError> {
    let mut files = write_vectors(dir, settings, pairs)?;
    let own = settings.pipeline.as_pipeline().kind().sources;
    let units = match parts.units {
        UnitSource::Behavioural => BEHAVIOURAL,
        UnitSource::Synthesizable => SYNTHESIZABLE,
    };
    for (name, text) in SHARED.into_iter().chain([units]).chain(own) {
        files.push(write_text(dir, name, text)?);
    }
    if let Some(top) = &settings.top {
        let kind = settings.pipeline.as_pipeline().kind();
        let name = format!("{}_top.v", kind.name);
        let text = top_verilog(settings, &top.surroundings);
        files.push(write_text(dir, &name, &text)?);
        let ports = StreamPorts {
            kind: kind.name,
            bits: [top.surroundings.sample_bits::<F>(), F::WIDTH],
            latencies: unit_latencies(settings.pipeline.as_pipeline().units())
                .map(|(_, clocks)| clocks),
        };
        files.push(write_text(dir, &ports.file(), &ports.verilog())?);
        for (name, text) in axis::SOURCES {
            files.push(write_text(dir, name, text)?);
        }
        if let Some(text) = top_samples(top) {
            files.push(write_text(dir, TOP_SAMPLES, &text)?);
        }
        if let Some(device) = parts.device {
            let name = kind.name;
            let sources = format!(
                "front_end.v {name}_core.v {name}_ctrl.v sp_ram.v fp_wait.v {}",
                units.0
            );
            let text = synthesis(name, device, &sources);
            files.push(write_text(dir, "synth.sh", &text)?);
        }
    }
    Ok(files)
}

/// Script of the synthesis of a kind's top level for a device.
<<<<<<< HEAD
///
/// * `sources`: files of the RTL beside that of the top level.
pub(super) fn synthesis(kind: &str, device: Device, sources: &str) -> String {
    let sources = format!("{kind}_top.v {sources}");
=======
fn synthesis(text: &str, kind: &str, device: Device, units: &str) -> String {
    let sources = format!(
        "{kind}_top.v front_end.v {kind}_core.v {kind}_ctrl.v den_check.v sp_ram.v fp_wait.v {units}"
    );
>>>>>>> proof
    let ports = format!("{kind}_axis.v axi_stream.v");
    SYNTHESIS
        .replace("@DEVICE@", device.word())
        .replace("@KIND@", kind)
        .replace("@PORTS@", &ports)
        .replace("@SOURCES@", &sources)
}

#[cfg(test)]
mod tests {
    use super::SHARED;
    use crate::fpga::kinds::KINDS;

    #[test]
    fn the_readme_states_files_macro_and_state_codes_of_every_kind() {
        let (_, readme) = SHARED[0];
        let words = readme.split_whitespace().collect::<Vec<_>>().join(" ");
        for kind in KINDS {
            for (name, _) in kind.sources {
                assert!(words.contains(name), "{name}");
            }
            let macro_name = format!("VEC_{}", kind.name.to_uppercase());
            assert!(words.contains(&macro_name), "{macro_name}");
            for (code, state) in kind.states.iter().enumerate() {
                assert!(words.contains(&format!("{code} {state}")), "{code} {state}");
            }
        }
    }

    #[test]
    fn every_kind_has_the_verilog_that_its_name_tells() {
        for kind in KINDS {
            let name = kind.name;
            let wanted = [
                format!("{name}_ctrl.v"),
                format!("{name}_core.v"),
                format!("tb_{name}.v"),
            ];
            assert_eq!(kind.sources.map(|(file, _)| file.to_owned()), wanted);
            for (file, text) in kind.sources {
                let module = format!("module {}", file.trim_end_matches(".v"));
                assert!(text.contains(&module), "{file}: {module}");
            }
            // The scripts of the export take the first parameter for the tap count.
            let (_, core) = kind.sources[1];
            let first = core.find("parameter").expect("parameters");
            let line = core[first..].lines().next().expect("a line");
            assert!(
                line.contains(&format!(" {} ", kind.tap_parameter)),
                "{name}: {line}"
            );
            assert!(line.contains("// taps"), "{name}: {line}");
        }
    }
}
