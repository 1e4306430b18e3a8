//! Sines in a record: fits of one frequency, of a free one and of many, and the delay by correlation.

pub(super) mod correlation;
pub(super) mod fit;
pub(super) mod free_frequency;
pub(super) mod tones;
