//! The list of a suite that may have more runs than fit in memory as plans, and the plans of a few of them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use super::estimate::Estimate;
use super::list::{Lister, RunList};
use crate::experiment::plan::{Gather, Plan, survey};
use crate::scenario::ScenarioError;

/// Which scenarios of a suite are listed, and what is kept of their plans.
#[derive(Clone, Copy)]
pub struct Wanted<'a> {
    /// Whether a scenario of this name is listed.
    pub is_listed: &'a dyn Fn(&str) -> bool,
    /// Whether the plan of the run in this folder is kept.
    pub is_kept: &'a dyn Fn(&str) -> bool,
    /// Whether the seconds are estimated that all of it will take.
    pub is_estimated: bool,
}

/// A suite as a list.
#[derive(Debug)]
pub struct Listing {
    /// What there is to run.
    pub list: RunList,
    /// Kept plans by folder.
    pub plans: BTreeMap<String, Plan>,
    /// What is worth saying, each once.
    pub remarks: Vec<String>,
    /// CPU seconds of one core; 0 where they are not asked for.
    pub estimated_s: f64,
    /// Whether there are scenarios that are not listed.
    pub has_others: bool,
}

/// Reads and checks everything under `paths` as `plan_suite` does, and lists it.
///
/// # Errors
/// As `plan_suite`.
pub fn list_suite(
    paths: &[PathBuf],
    sets: &[String],
    wanted: Wanted,
) -> Result<Listing, Vec<ScenarioError>> {
    let collector = survey(paths, sets, &|| Collector {
        wanted,
        lister: Lister::default(),
        plans: BTreeMap::new(),
        remarks: Vec::new(),
        said: BTreeSet::new(),
        estimate: Estimate::default(),
        has_others: false,
    })?;
    let Collector {
        lister,
        plans,
        mut remarks,
        estimate,
        has_others,
        ..
    } = collector;
    remarks.sort_by(|(one, _), (other, _)| one.cmp(other));
    Ok(Listing {
        list: lister.in_order_of_folders(),
        plans,
        remarks: remarks.into_iter().map(|(_, remark)| remark).collect(),
        estimated_s: estimate.seconds(),
        has_others,
    })
}

/// What a listing gathers.
struct Collector<'a> {
    wanted: Wanted<'a>,
    lister: Lister,
    plans: BTreeMap<String, Plan>,
    /// Behind the folder that each is said of.
    remarks: Vec<(String, String)>,
    said: BTreeSet<String>,
    estimate: Estimate,
    has_others: bool,
}

impl Gather for Collector<'_> {
    fn take(&mut self, plan: Plan) {
        let resolved = plan.resolved();
        if !(self.wanted.is_listed)(&resolved.scenario.name) {
            self.has_others = true;
            return;
        }
        self.lister.enter(&plan);
        let folder = resolved.folder();
        for remark in &resolved.remarks {
            if !self.said.contains(remark) {
                self.said.insert(remark.clone());
                self.remarks.push((folder.clone(), remark.clone()));
            }
        }
        if self.wanted.is_estimated {
            self.estimate.add(&plan);
        }
        if (self.wanted.is_kept)(&folder) {
            self.plans.insert(folder, plan);
        }
    }
}
