//! A scenario read, changed and run by a program.

use std::path::Path;
use std::str::FromStr;

use crate::experiment::plan::{Plan, gather_plans};
use crate::experiment::run::{Run, RunError};
use crate::scenario::{ScenarioErrors, Setting, Unresolved};

/// A scenario that can be changed and run: the key to the whole bench.
///
/// ```
/// use fogbench::Scenario;
/// use fogbench::metrics::catalogue::DC_GAIN;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let run = Scenario::from_toml(
///     r#"
///     schema = 1
///     name = "at-rest"
///     duration_s = 2.0
///     filter = [{ name = "mean", moving_average = { taps = 4 } }]
///     "#,
/// )?
/// .set("filter[0].moving_average.taps", 8)?
/// .run()?;
///
/// let dc_gain = run["mean"].metric(&DC_GAIN)?;
/// assert!((dc_gain.value - 1.0).abs() < 1e-9);
/// assert_eq!(run.samples("mean")?.unit, "deg/h");
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
#[must_use]
pub struct Scenario {
    unresolved: Unresolved,
}

impl Scenario {
    /// Reads the text of a scenario file, or of the manifest of a run.
    ///
    /// Files that it names are relative to the working directory.
    ///
    /// # Errors
    /// Every complaint about the text and the bases it extends; values are checked when it runs.
    pub fn from_toml(text: &str) -> Result<Self, ScenarioErrors> {
        let unresolved = Unresolved::from_toml(text)?;
        Ok(Self { unresolved })
    }

    /// Reads a scenario file with its bases, or the manifest of a run.
    ///
    /// # Errors
    /// As [`Scenario::from_toml`].
    pub fn from_file(file: impl AsRef<Path>) -> Result<Self, ScenarioErrors> {
        let unresolved = Unresolved::from_file(file.as_ref())?;
        Ok(Self { unresolved })
    }

    /// Sets one key over what was read, as `--set` does on the command line: `filter[0].rls.taps`,
    /// or `filter.rls.taps` where there is one such filter.
    ///
    /// # Errors
    /// Complaints about the key; values are checked when the scenario runs.
    pub fn set(mut self, key: &str, value: impl Into<Setting>) -> Result<Self, ScenarioErrors> {
        self.unresolved.set(key, &value.into())?;
        Ok(self)
    }

    /// Checks every value and plans the runs: one, or one for each point of a sweep.
    ///
    /// # Errors
    /// Every complaint.
    pub fn points(&self) -> Result<Vec<Plan>, ScenarioErrors> {
        Ok(gather_plans(&|take| self.unresolved.resolve(take))?)
    }

    /// Checks every value and runs the scenario.
    ///
    /// # Errors
    /// [`RunError`]: complaints about values, a sweep of several points, or what hinders the run.
    pub fn run(&self) -> Result<Run, RunError> {
        let [plan] = <[Plan; 1]>::try_from(self.points()?)
            .map_err(|points| RunError::SeveralPoints(points.len()))?;
        plan.into_run(&())
    }
}

impl FromStr for Scenario {
    type Err = ScenarioErrors;

    fn from_str(text: &str) -> Result<Self, ScenarioErrors> {
        Self::from_toml(text)
    }
}
