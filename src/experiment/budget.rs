//! The noise budget of the gyro in a file, without a run.

use std::path::Path;

use crate::gyro;
use crate::scenario::AssumedValue;
use crate::scenario::{Purpose, ScenarioError, load_base_or_scenario};
use crate::signal::BudgetSheet;

/// The noise budget of one gyro, and whose it is.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct GyroBudget {
    /// The bare name of the file, so that what is written does not depend on where one stands.
    pub file: String,
    /// The budget.
    pub sheet: BudgetSheet,
    /// What nobody set, and it rests on.
    pub assumed: Vec<AssumedValue>,
}

/// Reads the gyro of a scenario or base file, `--set` overrides applied, and works out its budget.
///
/// A sweep is one gyro if none of its points changes it.
///
/// # Errors
/// Every complaint about the file; a gyro that cannot be built; a sweep over gyros.
pub fn gyro_budget(path: &Path, sets: &[String]) -> Result<GyroBudget, Vec<ScenarioError>> {
    let runs = load_base_or_scenario(path, sets, Purpose::Run)?;
    let Some((first, others)) = runs.split_first() else {
        return Err(Vec::new());
    };
    let config = &first.scenario.gyro;
    if others.iter().any(|run| run.scenario.gyro != *config) {
        let message = format!(
            "{} points of the sweep have different gyros: expected one; leave the matrix out and \
             give the values with --set",
            runs.len()
        );
        return Err(vec![ScenarioError::at(first.locate("name"), message)]);
    }
    let sheet = gyro::budget_sheet(config).map_err(|error| {
        let key = error.key();
        vec![ScenarioError::at(
            first.locate(key),
            format!("{key}: {error}"),
        )]
    })?;
    Ok(GyroBudget {
        file: first.file.clone(),
        sheet,
        assumed: first.assumed_of_budget(),
    })
}
