//! Vector instructions that the processor at hand has beyond those the program is built for.
//!
//! Invariant: wider vectors move no bit. The compiler neither reorders a sum nor fuses a product with an
//! addition; what is written in lanes is only done in more of them at once.

use fearless_simd::{Level, dispatch};

/// What `work` returns, compiled for the widest vectors of this processor as far as it is inlined.
///
/// Worth its few nanoseconds for loops over hundreds of values, written in lanes.
#[inline]
pub(crate) fn with_wide_vectors<R>(work: impl FnOnce() -> R) -> R {
    dispatch!(Level::new(), _simd => work())
}
