//! Pooling: independent repeats of a run, and conditions under which a metric was measured.

pub(super) mod aggregate;
pub(super) mod allan;
pub(super) mod curves;
pub(super) mod pooling;
pub(super) mod repeatability;
pub(super) mod sensitivity;
