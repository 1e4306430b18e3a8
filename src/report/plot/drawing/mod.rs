//! What pictures are drawn with: axes, panels, series, and the picture that takes them.
//!
//! plotters stands behind [`picture`] only.

pub(in crate::report::plot) mod axis;
pub(in crate::report::plot) mod labels;
pub(in crate::report::plot) mod panel;
pub(in crate::report) mod picture;
pub(in crate::report::plot) mod series;
pub(in crate::report::plot) mod theory;
pub(in crate::report::plot) mod thin;
