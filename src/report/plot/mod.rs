//! Pictures.
use crate::report::RunReport;
use crate::signal::RunSignals;
/// Largest size of a picture, bytes.
pub const SVG_BYTES_MAX: usize = 500_000;
/// Pictures of a run.
#[must_use]
pub fn plots(_report: &RunReport, _signals: &RunSignals) -> Vec<(String, String)> {
    Vec::new()
}
