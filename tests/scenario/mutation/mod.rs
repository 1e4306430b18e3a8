//! Logs, NPY files, groups and stimuli that nobody wrote: drawn, spelled in every way and mutated.
//!
//! Whatever comes out, a reader takes it or says in one short message what is wrong and in which file;
//! what it takes gives a report of finite numbers. In `cargo test` some hundreds of each are tried. At
//! length, one kind at a time:
//!
//! ```text
//! FOGBENCH_MUTANTS=100000 FOGBENCH_SEED=7 \
//!     cargo test --release --test integration mutation::logs -- --nocapture
//! ```
//!
//! ends when so many were accepted. A case that fails is named by its seed and drawn again alone by
//! `FOGBENCH_MUTANT=<seed>`, which keeps its files below the target folder.

mod groups;
mod logs;
mod npy;
mod stimuli;
mod values;

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use fogbench::store::{OutputFolder, StoreOptions};
use serde_json::Value;

use crate::support::seeded::{Draws, case_seed};

/// Longest time of a case; most take a millisecond.
const CASE_TIME_MAX: Duration = Duration::from_secs(10);
/// Failures after which a campaign ends.
const FAILURES_MAX: usize = 20;

/// What became of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Outcome {
    /// It was read and measured.
    Measured,
    /// It was read, and what was to be made of it refused.
    Read,
    /// It was not read.
    Refused,
}

/// A number from the environment.
fn setting(name: &str) -> Option<u64> {
    let text = std::env::var(name).ok()?;
    Some(
        text.parse()
            .unwrap_or_else(|_| panic!("{name} = {text}: expected a number")),
    )
}

/// Runs cases of a kind until `accepted` of them were read, or as many as the environment asks for.
#[track_caller]
fn campaign(kind: &str, accepted: u64, case: impl Fn(&mut Draws, &Path) -> Outcome) {
    if let Some(seed) = setting("FOGBENCH_MUTANT") {
        // Its files stay, to be looked at.
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{kind}-{seed}"));
        std::fs::create_dir_all(&folder).expect("writable");
        println!("{kind}: {}", folder.display());
        println!("{kind}: {:?}", case(&mut Draws::new(seed), &folder));
        return;
    }
    let folder = tempfile::tempdir().expect("a scratch folder");
    let wanted = setting("FOGBENCH_MUTANTS").unwrap_or(accepted);
    let campaign_seed = setting("FOGBENCH_SEED").unwrap_or(1);
    let watch = watch(kind);
    let mut counts: BTreeMap<Outcome, u64> = BTreeMap::new();
    let mut failures = Vec::new();
    let mut slowest = (Duration::ZERO, 0);
    let read = |counts: &BTreeMap<Outcome, u64>| {
        let read = counts
            .iter()
            .filter(|(outcome, _)| **outcome != Outcome::Refused);
        read.map(|(_, count)| count).sum::<u64>()
    };
    for index in 0.. {
        if read(&counts) >= wanted || failures.len() >= FAILURES_MAX {
            break;
        }
        assert!(
            index < 20 * wanted + 1000,
            "{kind}: too few are read: {counts:?}"
        );
        let seed = case_seed(campaign_seed, index);
        // The watch outlives the loop.
        let _ = watch.send(seed);
        let start = Instant::now();
        let run = || case(&mut Draws::new(seed), folder.path());
        match catch_unwind(AssertUnwindSafe(run)) {
            Ok(outcome) => *counts.entry(outcome).or_default() += 1,
            Err(panic) => failures.push(format!("seed {seed}: {}", words(&*panic))),
        }
        slowest = slowest.max((start.elapsed(), seed));
    }
    let of = |outcome| counts.get(&outcome).copied().unwrap_or_default();
    println!(
        "{kind}: seed {campaign_seed}: {} accepted ({} measured), {} refused, {} failed; slowest {:.1} \
         ms, seed {}",
        read(&counts),
        of(Outcome::Measured),
        of(Outcome::Refused),
        failures.len(),
        slowest.0.as_secs_f64() * 1e3,
        slowest.1,
    );
    assert!(
        failures.is_empty(),
        "{kind}: FOGBENCH_MUTANT=<seed> of\n{}",
        failures.join("\n")
    );
    assert!(
        of(Outcome::Refused) > 0 && of(Outcome::Measured) > 0,
        "{kind}: {counts:?}"
    );
}

/// What a panic said.
fn words(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().cloned();
    let text = text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()));
    text.unwrap_or_default()
}

/// Ends the test binary with the seed of a case that takes too long: a thread cannot be stopped.
fn watch(kind: &str) -> Sender<u64> {
    let (sender, receiver) = channel::<u64>();
    let kind = kind.to_owned();
    std::thread::spawn(move || {
        let mut case = 0;
        loop {
            match receiver.recv_timeout(CASE_TIME_MAX) {
                Ok(seed) => case = seed,
                Err(RecvTimeoutError::Disconnected) => return,
                Err(RecvTimeoutError::Timeout) => {
                    eprintln!("{kind}: seed {case} takes more than {CASE_TIME_MAX:?}");
                    std::process::abort();
                }
            }
        }
    });
    sender
}

/// The folder of a result, below that of the case.
fn result_folder(folder: &Path) -> OutputFolder {
    OutputFolder::of_result(&folder.join("out"), "log", StoreOptions::default())
        .expect("a free folder")
}

/// Asserts that a complaint is short, on one line and about the file.
#[track_caller]
fn assert_complaint(message: &str, file: &str) {
    assert!(message.contains(file), "the file is not named: {message}");
    assert!(message.len() < 2500, "{} bytes: {message}", message.len());
    let is_plain = !message.contains(|c: char| c.is_control());
    assert!(is_plain, "control characters: {message:?}");
}

/// Asserts that a document is JSON without a number that is none.
#[track_caller]
fn assert_document(json: &str) {
    let document: Value = serde_json::from_str(json).expect("JSON");
    fn walk(path: &str, value: &Value) {
        match value {
            Value::Number(number) => {
                assert!(
                    number.as_f64().is_some_and(f64::is_finite),
                    "{path}: {number}"
                );
            }
            Value::Array(items) => items.iter().for_each(|item| walk(path, item)),
            Value::Object(fields) => {
                for (key, value) in fields {
                    walk(&format!("{path}.{key}"), value);
                }
            }
            Value::Null | Value::Bool(_) | Value::String(_) => {}
        }
    }
    walk("", &document);
}
