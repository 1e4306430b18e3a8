//! What is wrong with data that do not fit the stated motion.

use std::fmt;

use super::observations::GroupObservation;

/// Largest scale-factor error that is taken for one; beyond it the data are refused.
pub const SCALE_ERROR_MAX: f64 = 0.1;

/// Something wrong with the groups, in words through [`fmt::Display`].
#[derive(Clone, Debug, PartialEq)]
pub struct Finding;

impl fmt::Display for Finding {
    fn fmt(&self, _out: &mut fmt::Formatter<'_>) -> fmt::Result {
        Ok(())
    }
}

/// Looks for the usual mistakes.
#[must_use]
pub fn diagnose(_groups: &[GroupObservation]) -> Vec<Finding> {
    Vec::new()
}
