//! Plans: scenarios that have passed the checks that need physics or metrics.

mod checked;
mod checker;
mod filters;
mod metrics;
mod published;
mod record_length;
mod suite;
mod survey;

pub use checked::Plan;
pub(crate) use suite::gather_plans;
pub use suite::plan_suite;
#[cfg(feature = "report")]
pub(crate) use survey::{Gather, survey};
pub use survey::{Sound, check_suite};
