//! Reasons why a metric or a curve is missing.

use std::borrow::Cow;

use crate::wording::plain;

/// Why a record does not show a metric or a curve, in words for people.
///
/// A reason is said in finite numbers: where one could be none, it says what is the matter instead.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Unavailable(Cow<'static, str>);

impl Unavailable {
    /// The words.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl From<&'static str> for Unavailable {
    fn from(words: &'static str) -> Self {
        Self(Cow::Borrowed(words))
    }
}

impl From<String> for Unavailable {
    fn from(words: String) -> Self {
        Self(Cow::Owned(words))
    }
}

/// Why a record without its true rate lacks what is compared with it.
pub(crate) const NO_TRUTH: &str = "the true rate is not known: a recorded log brings none";

pub(crate) fn too_short(metric: &str, needed_s: f64, duration_s: f64) -> Unavailable {
    Unavailable::from(format!(
        "`{metric}` needs a record of at least {} s; this one has {} s",
        plain(needed_s),
        plain(duration_s)
    ))
}
