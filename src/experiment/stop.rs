//! Stopping a run before its end.

use super::suite::Observer;
use crate::gyro::GyroError;

/// Why a run has no result.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(super) enum Unfinished {
    /// The observer wants the suite to stop.
    #[error("stopped before its end")]
    Stopped,
    /// It cannot be run to its end; the text says why.
    #[error("{0}")]
    Failed(String),
}

impl From<GyroError> for Unfinished {
    fn from(error: GyroError) -> Self {
        Self::Failed(error.to_string())
    }
}

/// The gate between two blocks or stages of a run.
///
/// # Errors
/// [`Unfinished::Stopped`] once the observer wants the suite to stop.
pub(super) fn unless_stopped(observer: &dyn Observer) -> Result<(), Unfinished> {
    if observer.should_stop() {
        Err(Unfinished::Stopped)
    } else {
        Ok(())
    }
}
