//! List of all metrics, the names they may be asked by, and which records support them.

pub mod columns;
mod list;
pub(super) mod names;
pub(super) mod support;

pub use list::*;
