//! The RTL folder: sources, testbench, vectors and a script that runs from anywhere.

use std::path::{Path, PathBuf};

use super::vectors::{ExportSettings, write_text, write_vectors};
use crate::fpga::error::FpgaError;
use crate::fpga::float_unit::Fp;
use crate::fpga::front_end::Pair;

/// Files of every pipeline.
const SHARED: [(&str, &str); 7] = [
    ("README.txt", include_str!("rtl/README.txt")),
    ("fp_sim.v", include_str!("rtl/fp_sim.v")),
    ("sp_ram.v", include_str!("rtl/sp_ram.v")),
    ("tb_common.vh", include_str!("rtl/tb_common.vh")),
    ("tb_defaults.vh", include_str!("rtl/tb_defaults.vh")),
    ("run.sh", include_str!("rtl/run.sh")),
    ("test_cocotb.py", include_str!("rtl/test_cocotb.py")),
];

/// Writes vectors, RTL, testbench, run script and cocotb test; returns the files.
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
    let mut files = write_vectors(dir, settings, pairs)?;
    let own = settings.pipeline.as_pipeline().kind().sources;
    for (name, text) in SHARED.into_iter().chain(own) {
        files.push(write_text(dir, name, text)?);
    }
    Ok(files)
}
