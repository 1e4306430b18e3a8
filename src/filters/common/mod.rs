//! What filters of several kinds share: front end, weights, output register, watch for divergence.

mod complaints;
mod core_filter;
mod divergence;
mod filter;
mod fixed;
mod front_end;
pub(in crate::filters) mod sections;

pub use complaints::{Complaint, Complaints};
pub(super) use core_filter::dot;
pub use core_filter::{Core, CoreFilter};
pub(in crate::filters) use divergence::Life;
pub use divergence::{Divergence, DivergenceKind, Fault, Watch};
pub use filter::{Filter, Output};
pub use fixed::{FixedCore, FixedFilter};
pub use front_end::{FrontEndConfig, Register, adaptive_rule, least_squares_rule};
pub use sections::{RecursiveFilter, SectionsCore};
