//! The numbered list of what there is to run: each run whole, or some repeats of one that has many.
//!
//! The list depends on the scenarios alone, not on the number of shards: what is run together is pooled in
//! the same order however it was dealt out.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::experiment::build::VERSION;
use crate::experiment::campaign;
use crate::experiment::plan::Plan;
use crate::scenario::{Resolved, run_folder};

/// Most parts that the repeats of a run are split into.
const PARTS_MAX: u32 = 1000;

/// One thing to run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Unit {
    /// Index of its run.
    run: u32,
    /// Repeats; none of a run that is done in one piece.
    pub(super) repeats: Option<Range<u32>>,
}

impl Unit {
    /// Index of its run.
    pub(super) fn run(&self) -> usize {
        self.run as usize
    }
}

/// One run of a list: small, as there may be a million.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Listed {
    /// Digest of the resolved run, its seed, inputs and this version.
    id: [u8; 32],
    /// Index of the name of its scenario.
    scenario: u32,
    /// Its point of a sweep.
    point: Option<u32>,
    /// Repeats, and whether they are parted.
    repeats: u32,
    is_parted: bool,
}

/// The runs of a suite in the order of their folders, and what there is to run of them.
#[derive(Clone, Debug, Default)]
pub struct RunList {
    scenarios: Vec<String>,
    runs: Vec<Listed>,
    pub(super) units: Vec<Unit>,
}

impl RunList {
    /// The list of some plans, in their order.
    #[must_use]
    pub fn of(plans: &[Plan]) -> Self {
        let mut lister = Lister::default();
        plans.iter().for_each(|plan| lister.enter(plan));
        lister.in_their_order()
    }

    /// Number of things to run.
    #[must_use]
    pub fn len(&self) -> usize {
        self.units.len()
    }

    /// Whether there is nothing to run.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.units.is_empty()
    }

    /// Number of runs.
    #[must_use]
    pub fn runs(&self) -> usize {
        self.runs.len()
    }

    /// Folder of a run.
    pub(super) fn folder(&self, run: usize) -> String {
        let Listed {
            scenario, point, ..
        } = self.runs[run];
        let name = &self.scenarios[scenario as usize];
        run_folder(name, point.map(|point| point as usize))
    }

    /// Digest of the whole list.
    #[must_use]
    pub fn digest(&self) -> String {
        let mut hasher = blake3::Hasher::new();
        for line in self.lines() {
            hasher.update(line.as_bytes());
        }
        hasher.finalize().to_hex().to_string()
    }

    /// The list as lines: number from 1, digest of the run, folder, repeats.
    pub fn lines(&self) -> impl Iterator<Item = String> {
        self.units.iter().enumerate().map(|(index, unit)| {
            let repeats = unit.repeats.as_ref();
            let repeats = repeats.map_or_else(
                || "all".to_owned(),
                |range| format!("{}-{}", range.start + 1, range.end),
            );
            let id = blake3::Hash::from_bytes(self.runs[unit.run()].id).to_hex();
            let folder = self.folder(unit.run());
            format!("{}\t{id}\t{folder}\t{repeats}\n", index + 1)
        })
    }

    /// Indices of what shard `index` (from 1) of `count` runs.
    pub(super) fn dealt(&self, index: u32, count: u32) -> impl Iterator<Item = usize> + use<> {
        dealt(0..self.units.len(), index, count)
    }
}

/// What shard `index` (from 1) of `count` gets of what there is to run.
pub(super) fn dealt<T>(
    all: impl Iterator<Item = T>,
    index: u32,
    count: u32,
) -> impl Iterator<Item = T> {
    all.skip(index as usize - 1).step_by(count as usize)
}

/// Runs that are entered one after the other, to become a list.
#[derive(Default)]
pub(super) struct Lister {
    known: BTreeMap<String, u32>,
    runs: Vec<Listed>,
}

impl Lister {
    /// Enters a run.
    pub(super) fn enter(&mut self, plan: &Plan) {
        let resolved = plan.resolved();
        let name = &resolved.scenario.name;
        let scenario = match self.known.get(name) {
            Some(index) => *index,
            None => {
                let index = narrow(self.known.len());
                self.known.insert(name.clone(), index);
                index
            }
        };
        self.runs.push(Listed {
            id: id(resolved),
            scenario,
            point: resolved.sweep.as_ref().map(|point| narrow(point.index)),
            repeats: resolved.scenario.repeats,
            is_parted: is_parted(plan),
        });
    }

    /// The list in the order of the folders.
    pub(super) fn in_order_of_folders(mut self) -> RunList {
        // The name of a scenario that is swept is the folder of its points.
        let mut folders: Vec<(String, u32)> = Vec::with_capacity(self.known.len());
        let mut is_swept = vec![false; self.known.len()];
        for run in &self.runs {
            is_swept[run.scenario as usize] |= run.point.is_some();
        }
        for (name, index) in &self.known {
            let end = if is_swept[*index as usize] { "/" } else { "" };
            folders.push((format!("{name}{end}"), *index));
        }
        folders.sort();
        let mut rank = vec![0_usize; folders.len()];
        for (place, (_, index)) in folders.iter().enumerate() {
            rank[*index as usize] = place;
        }
        self.runs
            .sort_by_key(|run| (rank[run.scenario as usize], run.point));
        self.in_their_order()
    }

    fn in_their_order(self) -> RunList {
        let mut scenarios = vec![String::new(); self.known.len()];
        for (name, index) in self.known {
            scenarios[index as usize] = name;
        }
        let count = self.runs.iter().map(|run| parts(run).count()).sum();
        let mut units = Vec::with_capacity(count);
        for (run, listed) in self.runs.iter().enumerate() {
            let run = narrow(run);
            units.extend(parts(listed).map(|repeats| Unit { run, repeats }));
        }
        RunList {
            scenarios,
            runs: self.runs,
            units,
        }
    }
}

/// A number of runs or points, of which no suite has more than 32 bits hold.
fn narrow(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

/// Digest of all that makes a run: version, every resolved value, the files it was read from, its place in a
/// sweep. Two builds of one version give the same.
fn id(resolved: &Resolved) -> [u8; 32] {
    let mut hasher = blake3::Hasher::new();
    let mut enter = |text: &str| {
        hasher.update(&(text.len() as u64).to_le_bytes());
        hasher.update(text.as_bytes());
    };
    enter(VERSION);
    enter(&resolved.file);
    enter(&resolved.digest);
    for input in &resolved.inputs {
        enter(&input.file);
        enter(&input.digest);
    }
    if let Some(point) = &resolved.sweep {
        enter(&format!("{} of {}", point.index, point.count));
        for (key, value) in &point.assignments {
            enter(key);
            enter(value);
        }
    }
    *hasher.finalize().as_bytes()
}

/// Whether the repeats of a run are parted. A campaign ranks its sheets, and whoever applies one has to run it
/// first: both stay in one piece.
fn is_parted(plan: &Plan) -> bool {
    let scenario = &plan.resolved().scenario;
    scenario.repeats > 1 && plan.compensation().is_none() && campaign::campaign(scenario).is_none()
}

/// The parts of a run: none where it is done in one piece.
fn parts(run: &Listed) -> impl Iterator<Item = Option<Range<u32>>> + use<> {
    let repeats = run.repeats;
    let length = repeats.div_ceil(PARTS_MAX).max(1);
    let starts = (0..repeats).step_by(length as usize);
    let ranges = starts.map(move |start| Some(start..repeats.min(start + length)));
    let whole = (!run.is_parted).then_some(None);
    whole
        .into_iter()
        .chain(ranges.take(if run.is_parted { usize::MAX } else { 0 }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_is_dealt_to_one_shard() {
        let unit = |run| Unit { run, repeats: None };
        let list = RunList {
            units: (0..23).map(unit).collect(),
            ..RunList::default()
        };
        for count in [1, 2, 7, 23, 40] {
            let dealt = (1..=count).flat_map(|index| list.dealt(index, count));
            let mut dealt: Vec<usize> = dealt.collect();
            dealt.sort_unstable();
            assert_eq!(dealt, (0..23).collect::<Vec<_>>(), "{count}");
        }
    }

    #[test]
    fn runs_stand_in_the_order_of_their_folders_as_texts() {
        let names = ["b", "a-b", "a", "a.c", "ab", "a_", "A"];
        let mut lister = Lister::default();
        for (index, name) in names.iter().enumerate() {
            lister.known.insert((*name).to_owned(), narrow(index));
            let is_swept = index % 2 == 0;
            for point in (0..3).rev().take(if is_swept { 3 } else { 1 }) {
                lister.runs.push(Listed {
                    id: [0; 32],
                    scenario: narrow(index),
                    point: is_swept.then_some(point * 450),
                    repeats: 1,
                    is_parted: false,
                });
            }
        }
        let list = lister.in_order_of_folders();
        let folders: Vec<String> = (0..list.runs()).map(|run| list.folder(run)).collect();
        let mut sorted = folders.clone();
        sorted.sort();
        assert_eq!(folders, sorted);
        assert_eq!(folders.len(), 15);
    }
}
