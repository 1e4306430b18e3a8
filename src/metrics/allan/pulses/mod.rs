//! Words that count pulses of angle: what their quantisation does to the Allan variance, and how the
//! noise below it is found.

pub(crate) mod answer;
pub(crate) mod entry;
pub(super) mod passage;
pub(crate) mod recognition;
pub(crate) mod sawtooth;
pub(super) mod step;
