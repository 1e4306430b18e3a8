//! Arrays of NumPy: their heading, the columns that they hold, archives of them.

pub(super) mod archive;
pub(super) mod array;
mod gather;
pub(super) mod heading;
pub(super) mod number;
