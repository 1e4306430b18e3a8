//! Pictures of a sweep: a headline metric over what is swept.
//!
//! One key that differs is the axis, and every channel a line. Of several keys one is the axis; each
//! channel then has a panel, with a line for each setting of the others, or with a cell for each point
//! where they are many.

mod cells;
mod keys;
mod lines;
mod names;
mod pictures;
mod sheet;

pub(in crate::report) use pictures::{SweepPicture, pictures};
