//! Whether the fitted terms describe the curve, and which terms the curve asks for.

pub(super) mod choice;
pub(super) mod draws;
pub(in crate::metrics) mod goodness;
pub(super) mod scatter;
