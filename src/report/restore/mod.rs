//! Results read back from `summary.json`.

pub(super) mod calibration;
pub(super) mod run;
pub(super) mod values;
