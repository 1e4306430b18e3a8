//! Measuring one channel under each kind of motion.

pub(super) mod multi_sine;
pub(super) mod steady;
pub(super) mod swing;
