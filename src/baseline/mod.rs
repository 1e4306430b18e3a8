//! Results compared with earlier ones, figure by figure, and the file that keeps earlier ones.
//!
//! Invariant: judges records of two sides; reads no folder, runs nothing, prints nothing. What is compared
//! comes from the same conditions: everything of the scenario but the seed.
//!
//! A difference is judged by the best that both sides offer ([`Basis`]): figures that no noise moves by
//! tolerance; repeats of the same seed pair by pair; figures of a run whose noise is the same by their own
//! interval; else two intervals as independent. One call makes many such tests, and is to raise a false
//! alarm in at most one of twenty: the p-values are corrected together (Holm).

mod difference;
mod error;
mod file;
mod holm;
mod judge;
mod record;
mod update;

pub use error::BaselineError;
pub use file::{is_baseline_toml, read_baseline, to_toml};
pub use holm::{FAMILY_ERROR, HEADLINE_WEIGHT, OTHER_WEIGHT};
pub use judge::{Basis, Comparison, Judged, Outcome, Row, compare};
pub use record::{Entry, Id, Interval, Lack, Limits, Point, Side, point_of};
pub use update::updated;
