//! Measuring one channel under each kind of motion.

pub(super) mod mean;
pub(super) mod multi_sine;
pub(super) mod steady;
pub(super) mod step_figures;
pub(super) mod steps;
pub(super) mod swing;
mod swing_response;
pub(super) mod tracking;
