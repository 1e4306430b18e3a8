//! Checks of a whole suite that keep of each run only what is worth saying about it.

use std::path::PathBuf;

use super::checked::Plan;
use super::suite::{compared, plan_suite, visit_plans};
use crate::scenario::{ScenarioError, in_order, read_suite};

/// What is worth saying about one run that has passed every check.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Sound {
    /// Folder of the run below the output folder.
    pub folder: String,
    /// The scenario's own file as messages show it.
    pub file: String,
    /// Name of the scenario.
    pub name: String,
    /// What a calibration campaign can determine, in a sentence.
    pub calibration: Option<String>,
    /// What is allowed but worth saying.
    pub warnings: Vec<String>,
    /// What is worth saying about the file, but no part of the results.
    pub remarks: Vec<String>,
}

impl From<&Plan> for Sound {
    fn from(plan: &Plan) -> Self {
        Self {
            folder: plan.resolved().folder(),
            file: plan.resolved().shown_file(),
            name: plan.resolved().scenario.name.clone(),
            calibration: plan.calibration().map(str::to_owned),
            warnings: plan.warnings().to_vec(),
            remarks: plan.resolved().remarks.clone(),
        }
    }
}

/// What is kept of the plans of a suite that is not held in memory.
pub(crate) trait Gather {
    /// Takes one more plan; they come in the order of the files.
    fn take(&mut self, plan: Plan);
}

impl Gather for Vec<Sound> {
    fn take(&mut self, plan: Plan) {
        self.push(Sound::from(&plan));
    }
}

/// Checks everything under `paths` as [`plan_suite`] does, without holding the plans in memory.
///
/// # Errors
/// As [`plan_suite`].
pub fn check_suite(paths: &[PathBuf], sets: &[String]) -> Result<Vec<Sound>, Vec<ScenarioError>> {
    let mut sound: Vec<Sound> = survey(paths, sets, &Vec::new)?;
    sound.sort_by(|one, other| one.folder.cmp(&other.folder));
    Ok(sound)
}

/// What `gather` keeps of everything under `paths`, checked as [`plan_suite`] does. Plans of a suite with
/// tables are held in memory meanwhile: these are checked against all of them.
///
/// # Errors
/// As [`plan_suite`].
pub(crate) fn survey<G: Gather>(
    paths: &[PathBuf],
    sets: &[String],
    gather: &dyn Fn() -> G,
) -> Result<G, Vec<ScenarioError>> {
    let mut gathered = gather();
    let mut kept = Vec::new();
    let (mut has_tables, mut is_streamed) = (false, false);
    let errors = visit_plans(&|take| read_suite(paths, sets, take), &mut |plan| {
        let scenario = &plan.resolved().scenario;
        has_tables |= !scenario.comparisons.is_empty() || !scenario.comparison_rows.is_empty();
        if has_tables {
            kept.push(plan);
        } else {
            is_streamed = true;
            gathered.take(plan);
        }
    });
    if has_tables {
        let plans = if is_streamed {
            plan_suite(paths, sets)?
        } else {
            compared(kept, errors)?
        };
        let mut all = gather();
        plans.into_iter().for_each(|plan| all.take(plan));
        return Ok(all);
    }
    if errors.is_empty() {
        Ok(gathered)
    } else {
        Err(in_order(errors))
    }
}
