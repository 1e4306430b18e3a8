//! The time of samples: stamps without loss, counters that begin again, equal spacing.

pub(super) mod column;
pub(super) mod stamp;
pub(super) mod timing;
pub(super) mod unit;
