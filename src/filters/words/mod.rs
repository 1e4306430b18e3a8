//! Words of the hardware: floating point, or a fixed-point format for each signal.
//!
//! Each kind of filter has a table of its own, whose signals stand in one list; what is done with the words
//! is done with [`FixedWords`], whatever the kind.

mod lms;
mod rls;
mod sign_lms;
mod signals;

pub use lms::LmsWords;
pub use rls::RlsWords;
pub use sign_lms::SignLmsWords;
pub(super) use signals::refuse_as_printed;
pub use signals::{FixedWords, HardwareWords, SignalWord};
