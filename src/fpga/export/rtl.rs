//! The RTL folder: sources, testbench, vectors and a script that runs from anywhere.

use std::path::{Path, PathBuf};

use super::vectors::{ExportSettings, PipelineConfig, write_text, write_vectors};
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

const RLS: [(&str, &str); 3] = [
    ("rls_ctrl.v", include_str!("rtl/rls_ctrl.v")),
    ("rls_core.v", include_str!("rtl/rls_core.v")),
    ("tb_rls.v", include_str!("rtl/tb_rls.v")),
];

const LMS: [(&str, &str); 3] = [
    ("lms_ctrl.v", include_str!("rtl/lms_ctrl.v")),
    ("lms_core.v", include_str!("rtl/lms_core.v")),
    ("tb_lms.v", include_str!("rtl/tb_lms.v")),
];

const SIGN_LMS: [(&str, &str); 3] = [
    ("sign_lms_ctrl.v", include_str!("rtl/sign_lms_ctrl.v")),
    ("sign_lms_core.v", include_str!("rtl/sign_lms_core.v")),
    ("tb_sign_lms.v", include_str!("rtl/tb_sign_lms.v")),
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
    let own = match settings.pipeline {
        PipelineConfig::Rls(_) => RLS,
        PipelineConfig::Lms(_) => LMS,
        PipelineConfig::SignLms(_) => SIGN_LMS,
    };
    for (name, text) in SHARED.into_iter().chain(own) {
        files.push(write_text(dir, name, text)?);
    }
    Ok(files)
}
