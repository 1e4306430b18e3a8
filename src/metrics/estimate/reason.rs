//! Reasons why a metric is missing that several computations give.

use crate::wording::plain;

/// Why a record without its true rate lacks what is compared with it.
pub(crate) const NO_TRUTH: &str = "the true rate is not known: a recorded log brings none";

pub(crate) fn too_short(metric: &str, needed_s: f64, duration_s: f64) -> String {
    format!(
        "`{metric}` needs a record of at least {} s; this one has {} s",
        plain(needed_s),
        plain(duration_s)
    )
}
