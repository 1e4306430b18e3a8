//! The ledger of a suite: which runs have ended, and the moment after which none is added.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::sync::{Mutex, MutexGuard, PoisonError, RwLock};
use std::time::{Duration, Instant};

use super::files::point_of;
use crate::experiment::plan::Plan;
use crate::experiment::run::Progress;
use crate::report::RunOutcome;
use crate::store::StoreError;

/// Time that runs have to reach their next block once the suite is to stop. The whole program must
/// end within 2 s of a signal: what is left is for the files of the suite.
const GRACE: Duration = Duration::from_millis(600);

/// Time between two looks at the listener.
const TICK: Duration = Duration::from_millis(20);

/// Outcomes of the runs that have ended.
///
/// A run swaps its folder in and is entered in one step ([`Ledger::commit`]), and the ledger closes
/// between such steps: whoever reads the closed ledger knows every folder that stands, and no folder
/// is being swapped while the program ends.
pub(crate) struct Ledger {
    entries: Mutex<Entries>,
    /// Held for reading while a folder is swapped in and entered, for writing to close.
    is_closed: RwLock<bool>,
    /// Set by the first run that cannot be written.
    is_unwritten: AtomicBool,
    is_broken: AtomicBool,
}

struct Entries {
    outcomes: Vec<Option<RunOutcome>>,
}

impl Ledger {
    /// The empty ledger of `runs` runs.
    pub(crate) fn new(runs: usize) -> Self {
        let entries = Entries {
            outcomes: vec![None; runs],
        };
        Self {
            entries: Mutex::new(entries),
            is_closed: RwLock::new(false),
            is_unwritten: AtomicBool::new(false),
            is_broken: AtomicBool::new(false),
        }
    }

    /// Swaps the folder of run `index` in by `swap` and enters `outcome`; false, and nothing is
    /// done, if the ledger is closed.
    ///
    /// # Errors
    /// What `swap` says; nothing is entered then.
    pub(crate) fn commit(
        &self,
        index: usize,
        outcome: &RunOutcome,
        swap: impl FnOnce() -> Result<(), StoreError>,
    ) -> Result<bool, StoreError> {
        let is_closed = self
            .is_closed
            .read()
            .unwrap_or_else(PoisonError::into_inner);
        if *is_closed {
            return Ok(false);
        }
        swap()?;
        self.entries().outcomes[index] = Some(outcome.clone());
        Ok(true)
    }

    /// Enters a run that has no folder to swap in; false, and nothing is done, if the ledger is closed.
    pub(crate) fn enter(&self, index: usize, outcome: &RunOutcome) -> bool {
        // Without a swap there is nothing to fail.
        self.commit(index, outcome, || Ok(())).unwrap_or(false)
    }

    /// Notes that what a run gave could not be written.
    pub(crate) fn note_unwritten(&self) {
        self.is_unwritten.store(true, Ordering::Relaxed);
    }

    /// Whether what a run gave could not be written.
    pub(crate) fn is_unwritten(&self) -> bool {
        self.is_unwritten.load(Ordering::Relaxed)
    }

    /// Notes that an invariant was broken.
    pub(crate) fn note_broken(&self) {
        self.is_broken.store(true, Ordering::Relaxed);
    }

    /// Whether an invariant was broken.
    pub(crate) fn is_broken(&self) -> bool {
        self.is_broken.load(Ordering::Relaxed)
    }

    /// Waits for the swaps under way and closes; then the outcome of every plan, those that have not
    /// ended as not run.
    pub(crate) fn close(&self, plans: &[Plan]) -> Vec<RunOutcome> {
        *self
            .is_closed
            .write()
            .unwrap_or_else(PoisonError::into_inner) = true;
        let mut entries = self.entries();
        let ended = std::mem::take(&mut entries.outcomes).into_iter();
        let all = ended.zip(plans).map(|(outcome, plan)| {
            outcome.unwrap_or_else(|| {
                let resolved = plan.resolved();
                let name = &resolved.scenario.name;
                RunOutcome::not_run(name, &resolved.folder(), &resolved.file).at(point_of(plan))
            })
        });
        all.collect()
    }

    /// The entries. Nothing that can panic runs while they are held, so that a poisoned lock still
    /// guards sound ones.
    fn entries(&self) -> MutexGuard<'_, Entries> {
        self.entries.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Waits for the end of all work, which drops the sender of `work`; false if some of it is still in
/// the middle of a stage [`GRACE`] after the listener wanted the suite to stop.
pub(crate) fn wait(work: &Receiver<()>, progress: &dyn Progress) -> bool {
    let mut asked: Option<Instant> = None;
    while matches!(work.recv_timeout(TICK), Err(RecvTimeoutError::Timeout)) {
        if progress.should_stop() && asked.get_or_insert_with(Instant::now).elapsed() >= GRACE {
            return false;
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use std::io;

    use super::*;

    fn full(path: &str) -> StoreError {
        StoreError::Write {
            path: path.into(),
            source: io::Error::other("full"),
        }
    }

    fn outcome(name: &str) -> RunOutcome {
        RunOutcome::not_run(name, name, "a.toml")
    }

    #[test]
    fn a_closed_ledger_swaps_nothing_in() {
        let ledger = Ledger::new(1);
        assert!(ledger.close(&[]).is_empty());
        let swapped = ledger.commit(0, &outcome("late"), || panic!("swapped after the end"));
        assert!(!swapped.expect("nothing was tried"));
    }

    #[test]
    fn a_failed_swap_is_not_entered() {
        let ledger = Ledger::new(2);
        let refused = || Err(full("b"));
        assert!(ledger.commit(1, &outcome("b"), refused).is_err());
        assert!(ledger.entries().outcomes.iter().all(Option::is_none));
    }

    #[test]
    fn a_panic_in_a_swap_leaves_the_ledger_in_order() {
        let ledger = Ledger::new(1);
        let broken = || ledger.commit(0, &outcome("a"), || panic!("planted fault"));
        let panic = std::panic::catch_unwind(std::panic::AssertUnwindSafe(broken));
        assert!(panic.is_err());
        ledger.enter(0, &outcome("a"));
        assert!(ledger.entries().outcomes[0].is_some());
    }
}
