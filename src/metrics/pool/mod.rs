//! Pooling: independent repeats of a run, and conditions under which a metric was measured.

pub(super) mod aggregate;
pub(super) mod sensitivity;
