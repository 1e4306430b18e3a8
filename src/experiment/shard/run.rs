//! Running one shard into its own file.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::mpsc::channel;
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use super::codec::{Coded as _, decoded, encoded};
use super::file::{Damaged, MAGIC, ShardFile, ShardHead};
use super::list::{RunList, Unit};
use super::result::{Entry, EntryHead, FirstRepeat, Repeats, UnitResult};
use crate::experiment::plan::Plan;
use crate::experiment::run::{Progress, Unfinished, run_plan, run_range, verdicts};
use crate::experiment::suite::{files_of_result, panic_text, pool, thread_count, wait};
use crate::gate::expects_failure;

use crate::store::{ShardSlot, ShardWork, StoreError};

/// What the caller hears of a shard besides its progress; called from many threads.
pub trait ShardObserver: Progress {
    /// One more of the things to run is done.
    fn unit_done(&self, _folder: &str, _done: usize, _units: usize) {}
    /// Something about the shard is worth saying.
    fn caution(&self, _message: &str) {}
    /// Hears how a shard ended that was to stop while some of it is still in the middle of a long stage: the
    /// caller may end the program here.
    fn abandoned(&self, _outcome: &ShardOutcome) {}
}

impl ShardObserver for () {}

/// How a shard is run.
#[derive(Clone, Debug)]
pub struct ShardOptions {
    /// Folder that receives its file; made if absent.
    pub output: PathBuf,
    /// Threads, as [`thread_count`] takes them.
    pub threads: usize,
    /// Whether to replace a file that is the user's.
    pub force: bool,
}

/// How a shard ended.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ShardOutcome {
    /// Its file.
    pub place: PathBuf,
    /// What it is to run.
    pub units: usize,
    /// What of it is done.
    pub done: usize,
    /// What of that was done before.
    pub taken_over: usize,
    /// Whether a run, or a channel that no gate expects to, failed.
    pub has_failed: bool,
    /// Whether an invariant was broken, which is a defect of the program; what it concerns is not done.
    pub broken: bool,
    /// Why results could not be written.
    pub failures: Vec<String>,
}

impl ShardOutcome {
    /// Whether everything is done and stands in its place.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.done == self.units && self.failures.is_empty()
    }
}

/// Why a shard does not run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ShardError {
    /// The folder is in use or holds something of the user's, or a file could not be written.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A file of a shard is not as it was written.
    #[error(transparent)]
    Damaged(#[from] Damaged),
    /// The system gave not one thread.
    #[error("cannot start a thread: {0}")]
    Threads(std::io::Error),
}

/// A shard at work.
struct Work {
    file: ShardWork,
    /// Of each unit that is done, whether it failed.
    done: BTreeMap<usize, bool>,
    is_broken: bool,
    failures: Vec<String>,
}

/// Runs what `head` says of `list`, whose plans stand in `plans` by folder, continues what an earlier process of
/// the same shard left, and puts the file in its place once it holds everything.
///
/// # Errors
/// [`ShardError`], before anything runs, or if the finished file cannot be put in its place.
pub fn run_shard(
    plans: &BTreeMap<String, Plan>,
    list: &RunList,
    head: &ShardHead,
    options: &ShardOptions,
    observer: &dyn ShardObserver,
) -> Result<ShardOutcome, ShardError> {
    let slot = ShardSlot::take(&options.output, &head.file_name(), MAGIC, options.force)?;
    for caution in slot.cautions() {
        observer.caution(caution);
    }
    let units: Vec<usize> = list.dealt(head.index, head.count).collect();
    if let Some(outcome) = complete_before(&slot, list, head, observer)? {
        return Ok(outcome);
    }
    let work = begin(&slot, head)?;
    let before = work.done.len();
    let mut left: Vec<usize> = units.clone();
    left.retain(|unit| !work.done.contains_key(unit));
    let cost = |unit: &usize| plans[&list.folder(list.units[*unit].run())].cost();
    // Costs are never negative, so that their bits are ordered as they are.
    left.sort_by_cached_key(|unit| Reverse(cost(unit).to_bits()));
    let work = Mutex::new(work);
    let outcome = |work: &Work| ShardOutcome {
        place: slot.place().to_owned(),
        units: units.len(),
        done: work.done.len(),
        taken_over: before,
        has_failed: work.done.values().any(|failed| *failed),
        broken: work.is_broken,
        failures: work.failures.clone(),
    };
    let pool = pool(thread_count(options.threads)).map_err(ShardError::Threads)?;
    let (end_of_work, ends) = channel();
    let crew = Crew {
        plans,
        list,
        units: units.len(),
        work: &work,
    };
    pool.in_place_scope(|scope| {
        let (crew, left) = (&crew, &left);
        scope.spawn(move |_| {
            let left = left.par_iter().with_max_len(1);
            left.for_each(|unit| crew.run(*unit, observer));
            drop(end_of_work);
        });
        if !wait(&ends, observer) {
            let work = work.lock().unwrap_or_else(PoisonError::into_inner);
            observer.abandoned(&outcome(&work));
        }
    });
    let work = work.into_inner().unwrap_or_else(PoisonError::into_inner);
    let outcome = outcome(&work);
    if outcome.is_complete() {
        slot.finish(work.file, |digest| {
            head.record(outcome.units, outcome.has_failed, digest)
        })?;
    }
    Ok(outcome)
}

/// The outcome of a shard whose complete file stands in its place; its record is written where a kill came
/// between the two.
fn complete_before(
    slot: &ShardSlot,
    list: &RunList,
    head: &ShardHead,
    observer: &dyn ShardObserver,
) -> Result<Option<ShardOutcome>, ShardError> {
    let found = match ShardFile::read(slot.place()) {
        Ok(Some(found)) if found.head.is_of(head) && found.is_whole(list) => found,
        Ok(_) => return Ok(None),
        Err(damaged) => {
            observer.caution(&format!("{damaged}: it is run anew"));
            return Ok(None);
        }
    };
    if found.check_record().is_err() {
        let digest = crate::store::digest_of(slot.place()).map_err(|error| Damaged {
            path: slot.place().to_owned(),
            reason: error.to_string(),
        })?;
        let record = found
            .head
            .record(found.entries.len(), found.has_failed(), &digest);
        slot.write_record(&record)?;
    }
    Ok(Some(ShardOutcome {
        place: slot.place().to_owned(),
        units: found.entries.len(),
        done: found.entries.len(),
        taken_over: found.entries.len(),
        has_failed: found.has_failed(),
        ..ShardOutcome::default()
    }))
}

/// Takes up what an earlier process of the same shard left; what is of another plan or version goes.
fn begin(slot: &ShardSlot, head: &ShardHead) -> Result<Work, StoreError> {
    let mut has_head = false;
    let mut done = BTreeMap::new();
    let mut file = slot.begin(&mut |record| {
        if !has_head {
            has_head = decoded::<ShardHead>(record).is_some_and(|found| found.is_of(head));
            return has_head;
        }
        let mut from = record;
        let entry = EntryHead::take(&mut from);
        done.extend(entry.map(|entry| (entry.unit, entry.has_failed)));
        true
    })?;
    if !has_head {
        done.clear();
        let written = file.append(&encoded(head));
        written.map_err(|source| StoreError::Write {
            path: slot.place().to_owned(),
            source,
        })?;
    }
    Ok(Work {
        file,
        done,
        is_broken: false,
        failures: Vec::new(),
    })
}

/// What the threads of a shard share.
struct Crew<'a> {
    plans: &'a BTreeMap<String, Plan>,
    list: &'a RunList,
    units: usize,
    work: &'a Mutex<Work>,
}

impl Crew<'_> {
    /// Runs one thing and writes what comes of it.
    fn run(&self, index: usize, observer: &dyn ShardObserver) {
        let has_failures = || !self.lock().failures.is_empty();
        if observer.should_stop() || !observer.may_start() || has_failures() {
            return;
        }
        let unit = &self.list.units[index];
        let folder = self.list.folder(unit.run());
        let plan = &self.plans[&folder];
        let run = || run_unit(plan, unit, observer);
        let (result, has_failed) = match catch_unwind(AssertUnwindSafe(run)) {
            Ok(Ok(result)) => result,
            Ok(Err(Unfinished::Stopped)) => return,
            Ok(Err(Unfinished::Failed(reason))) => (UnitResult::Failed(reason), true),
            Err(panic) => {
                self.lock().is_broken = true;
                observer.caution(&format!("{folder}: {}", panic_text(&*panic)));
                return;
            }
        };
        let head = EntryHead {
            unit: index,
            has_failed,
        };
        let bytes = encoded(&Entry { head, result });
        let mut work = self.lock();
        match work.file.append(&bytes) {
            Ok(()) => drop(work.done.insert(index, has_failed)),
            Err(error) => {
                work.failures
                    .push(format!("cannot write a result: {error}"));
                return;
            }
        }
        let done = work.done.len();
        drop(work);
        observer.unit_done(&folder, done, self.units);
    }

    /// The work. Nothing that can panic runs while it is held.
    fn lock(&self) -> std::sync::MutexGuard<'_, Work> {
        self.work.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What comes of one thing, and whether it failed.
fn run_unit(
    plan: &Plan,
    unit: &Unit,
    progress: &dyn Progress,
) -> Result<(UnitResult, bool), Unfinished> {
    let Some(range) = unit.repeats.clone() else {
        let results = run_plan(plan, progress)?;
        let (files, has_failed) = files_of_result(plan, &results);
        return Ok((UnitResult::Files(files), has_failed));
    };
    let first = Mutex::new(None);
    let keep_first = |simulation: &_, notes| {
        let kept = FirstRepeat::of(plan, simulation, notes);
        *first.lock().unwrap_or_else(PoisonError::into_inner) = Some(kept);
    };
    let repeats = run_range(plan, range, &keep_first, progress)?;
    let has_failed = repeats.iter().any(|repeat| {
        let verdicts = verdicts(plan, &repeat.channels);
        let mut channels = repeat.channels.iter();
        channels.any(|(name, metrics)| metrics.error.is_some() && !expects_failure(&verdicts, name))
    });
    let first = first.into_inner().unwrap_or_else(PoisonError::into_inner);
    Ok((UnitResult::Repeats(Repeats { repeats, first }), has_failed))
}
