//! All complaints about a scenario as one error.

use std::fmt;

use crate::scenario::message::error::ScenarioError;

/// Every complaint about a scenario, in the order of its files and lines; never empty.
///
/// Prints one complaint per line, each with its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScenarioErrors(Vec<ScenarioError>);

impl ScenarioErrors {
    /// The complaints.
    #[must_use]
    pub fn complaints(&self) -> &[ScenarioError] {
        &self.0
    }
}

impl From<Vec<ScenarioError>> for ScenarioErrors {
    fn from(complaints: Vec<ScenarioError>) -> Self {
        Self(complaints)
    }
}

impl fmt::Display for ScenarioErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, complaint) in self.0.iter().enumerate() {
            if index > 0 {
                f.write_str("\n")?;
            }
            complaint.fmt(f)?;
        }
        Ok(())
    }
}

impl std::error::Error for ScenarioErrors {}
