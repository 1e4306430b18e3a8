//! Counts of a campaign, and the faults it found.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use super::case::Fault;

/// What a campaign has seen so far.
#[derive(Default)]
pub(crate) struct Tally {
    counts: BTreeMap<String, u64>,
    keys: BTreeSet<String>,
    faults: BTreeMap<String, Vec<Found>>,
}

/// A fault and how to see it again.
struct Found {
    seed: u64,
    message: String,
    file: Option<PathBuf>,
}

/// Most faults of one key that are told one by one.
const TOLD_MAX: usize = 3;

impl Tally {
    pub(crate) fn count(&mut self, what: impl Into<String>) {
        *self.counts.entry(what.into()).or_default() += 1;
    }

    pub(crate) fn get(&self, what: &str) -> u64 {
        self.counts.get(what).copied().unwrap_or_default()
    }

    /// Notes that a key stood in a scenario that ran.
    pub(crate) fn key(&mut self, schema_path: &str) {
        if !self.keys.contains(schema_path) {
            self.keys.insert(schema_path.to_owned());
        }
    }

    /// Whether a key stood in a scenario that ran.
    pub(crate) fn has_key(&self, schema_path: &str) -> bool {
        self.keys.contains(schema_path)
    }

    /// Whether a fault of this key is new.
    pub(crate) fn is_new(&self, fault: &Fault) -> bool {
        !self.faults.contains_key(&fault.key)
    }

    /// Notes a fault; the file of the first ones is kept.
    pub(crate) fn fault(&mut self, campaign: &str, seed: u64, fault: &Fault, text: &str) {
        let found = self.faults.entry(fault.key.clone()).or_default();
        let file = (found.len() < TOLD_MAX).then(|| {
            let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("campaign");
            fs::create_dir_all(&folder).expect("a folder for failing cases");
            let file = folder.join(format!("{campaign}-{seed}.toml"));
            fs::write(&file, text).expect("a file for a failing case");
            file
        });
        found.push(Found {
            seed,
            message: fault.message.clone(),
            file,
        });
    }

    pub(crate) fn is_clean(&self) -> bool {
        self.faults.is_empty()
    }

    /// Every count, and every fault with its seeds.
    pub(crate) fn report(&self) -> String {
        let mut text = String::new();
        for (what, count) in &self.counts {
            let _ = writeln!(text, "{count:>9}  {what}");
        }
        for (key, found) in &self.faults {
            let _ = writeln!(text, "{:>9}  FAULT {key}", found.len());
            for found in found.iter().take(TOLD_MAX) {
                let file = found.file.as_ref().map(|file| file.display().to_string());
                let _ = writeln!(
                    text,
                    "           FOGBENCH_CASE={} {}: {}",
                    found.seed,
                    file.unwrap_or_default(),
                    found.message
                );
            }
        }
        text
    }
}
