//! Judges metrics against limits.
//!
//! Invariant: judges, does not compute. A metric that is missing, unavailable or not a number never
//! passes.

mod claim;
mod judge;
mod number;
mod verdict;

pub(crate) use crate::metrics::{estimate_text, plain, three_digits};
pub use claim::{ClaimKind, ClaimVerdict, judge_claim, simulated};
pub use judge::{expects_failure, judge, quotient};
pub(crate) use number::limits_text;
pub(crate) use verdict::count_accepted;
pub use verdict::{Verdict, VerdictKind};
