//! A calibration as text, JSON, parameters and table of groups.

pub(super) mod calibrate;
pub(super) mod documents;
pub(super) mod temperature;
pub(super) mod text;
