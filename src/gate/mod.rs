//! Judges metrics against limits.
//!
//! Invariant: judges, does not compute. A metric that is missing, unavailable or not a number never
//! passes.

mod judge;
mod number;
mod verdict;

pub use judge::{judge, quotient};
pub(crate) use number::{estimate_text, limits_text, plain};
pub use verdict::{Verdict, VerdictKind};
