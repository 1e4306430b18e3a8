//! Arrays of NumPy: their heading, and the columns that they hold.

pub(super) mod array;
pub(super) mod heading;
