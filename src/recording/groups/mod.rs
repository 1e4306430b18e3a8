//! Group means of a turntable calibration.

pub(super) mod heading;
pub(super) mod read;
