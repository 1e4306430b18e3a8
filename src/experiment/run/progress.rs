//! Watching a run, and stopping it before its end.

use crate::gyro::GyroError;
use crate::program::Programs;

/// What the caller hears of a run while it is computed; called from many threads.
pub trait Progress: Sync {
    /// `simulated_s` more seconds of gyro time are done.
    fn advanced(&self, _simulated_s: f64) {}
    /// Whether to stop. Asked between the blocks and stages of every run; what has ended by then
    /// stays, the rest is not run.
    fn should_stop(&self) -> bool {
        false
    }
    /// Whether another run of a suite may start; those that have started go on.
    fn may_start(&self) -> bool {
        true
    }
    /// The right to start programs of the user's; none: filters that are programs fail.
    fn programs(&self) -> Option<&Programs> {
        None
    }
    /// A program has written a line on its stderr.
    fn program_said(&self, _run: &str, _channel: &str, _line: &str) {}
    /// A program has answered every word of a record, in so much time a word. No result may hold it.
    fn program_took(&self, _run: &str, _channel: &str, _us_per_word: f64) {}
}

/// Nobody listens, nobody stops.
impl Progress for () {}

/// Why a run has no result.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Unfinished {
    /// The listener wants the run to stop.
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
/// [`Unfinished::Stopped`] once the listener wants the run to stop.
pub(crate) fn unless_stopped(progress: &dyn Progress) -> Result<(), Unfinished> {
    if progress.should_stop() {
        Err(Unfinished::Stopped)
    } else {
        Ok(())
    }
}
