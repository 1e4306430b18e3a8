//! The numbered list of what there is to run: each run whole, or some repeats of one that has many.
//!
//! The list depends on the scenarios alone, not on the number of shards: what is run together is pooled in
//! the same order however it was dealt out.

use std::ops::Range;

use crate::experiment::build::VERSION;
use crate::experiment::campaign;
use crate::experiment::plan::Plan;
use crate::scenario::Resolved;

/// Most parts that the repeats of a run are split into.
const PARTS_MAX: u32 = 1000;

/// One thing to run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Unit {
    /// Index of its run.
    pub(super) run: usize,
    /// Repeats; none of a run that is done in one piece.
    pub(super) repeats: Option<Range<u32>>,
}

/// The runs of some plans, in their order, and what there is to run of them.
#[derive(Clone, Debug)]
pub struct RunList {
    /// Digest of each resolved run, its seed, inputs and this version.
    pub(super) ids: Vec<String>,
    /// Folder of each run.
    pub(super) folders: Vec<String>,
    pub(super) units: Vec<Unit>,
}

impl RunList {
    /// The list of some plans.
    #[must_use]
    pub fn of(plans: &[Plan]) -> Self {
        let mut list = Self {
            ids: Vec::with_capacity(plans.len()),
            folders: Vec::with_capacity(plans.len()),
            units: Vec::new(),
        };
        for (run, plan) in plans.iter().enumerate() {
            let resolved = plan.resolved();
            list.ids.push(id(resolved));
            list.folders.push(resolved.folder());
            list.units
                .extend(parts(plan).map(|repeats| Unit { run, repeats }));
        }
        list
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
        self.ids.len()
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
            let (id, folder) = (&self.ids[unit.run], &self.folders[unit.run]);
            format!("{}\t{id}\t{folder}\t{repeats}\n", index + 1)
        })
    }

    /// Indices of what shard `index` (from 1) of `count` runs.
    pub(super) fn dealt(&self, index: u32, count: u32) -> impl Iterator<Item = usize> + use<> {
        let (first, step) = (index as usize - 1, count as usize);
        (first..self.units.len()).step_by(step)
    }
}

/// Digest of all that makes a run: version, every resolved value, the files it was read from, its place in a
/// sweep. Two builds of one version give the same.
fn id(resolved: &Resolved) -> String {
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
    hasher.finalize().to_hex().to_string()
}

/// The parts of a run: none where it is done in one piece.
fn parts(plan: &Plan) -> impl Iterator<Item = Option<Range<u32>>> + use<> {
    let scenario = &plan.resolved().scenario;
    let repeats = scenario.repeats;
    // A campaign ranks its sheets, and whoever applies one has to run it first: both stay in one piece.
    let is_split =
        repeats > 1 && plan.compensation().is_none() && campaign::campaign(scenario).is_none();
    let length = repeats.div_ceil(PARTS_MAX).max(1);
    let starts = (0..repeats).step_by(length as usize);
    let ranges = starts.map(move |start| Some(start..repeats.min(start + length)));
    let whole = (!is_split).then_some(None);
    whole
        .into_iter()
        .chain(ranges.take(if is_split { usize::MAX } else { 0 }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_is_dealt_to_one_shard() {
        let unit = |run| Unit { run, repeats: None };
        let list = RunList {
            ids: Vec::new(),
            folders: Vec::new(),
            units: (0..23).map(unit).collect(),
        };
        for count in [1, 2, 7, 23, 40] {
            let dealt = (1..=count).flat_map(|index| list.dealt(index, count));
            let mut dealt: Vec<usize> = dealt.collect();
            dealt.sort_unstable();
            assert_eq!(dealt, (0..23).collect::<Vec<_>>(), "{count}");
        }
    }
}
