//! Compares the runs of a suite: tables of published figures and of sensitivities, with what a
//! publication leaves open, and filters side by side.
//!
//! Invariant: sees scenarios and measured metrics, never a record; judges and puts together, does not
//! measure.

mod beside;
mod change_per_unit;
mod layout;
mod table;

pub use beside::{Beside, BesideFilter, BesideRun};
pub(crate) use layout::{ComparedRun, Layout, contradictions};
pub(crate) use table::file_stem;
pub use table::{
    Assumed, Cause, ChangePerUnit, ColumnChange, ComparedCell, ComparedColumn, ComparedRow,
    ComparedTable, Comparison, DrawnFigure,
};
