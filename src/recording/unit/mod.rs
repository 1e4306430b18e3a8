//! Units of the numbers: how they are spelled, and rates from them.

pub(super) mod convert;
pub(super) mod kinds;
pub(super) mod spelling;
