//! The filters of a scenario, to be put behind a recorded log.

use std::path::Path;

use crate::experiment::outside::{ProgramFiles, program_files};
use crate::filters::{ExpectedWords, FilterConfig};
use crate::scenario::{Purpose, Resolved, ScenarioError, load_base_or_scenario};

/// The filters of one scenario or base, checked against the sample rate of a log.
#[derive(Clone, Debug)]
pub struct LogFilters {
    resolved: Resolved,
    sample_rate_hz: f64,
}

/// Reads the filters of a scenario or base file, `--set` overrides applied.
///
/// A sweep is one set of filters if none of its points changes them.
///
/// # Errors
/// Every complaint about the file; no filter; a sweep over filters; a pipeline that cannot be built
/// or cannot keep up with `sample_rate_hz`; a low pass beyond half of it.
pub fn load_log_filters(
    path: &Path,
    sets: &[String],
    sample_rate_hz: f64,
) -> Result<LogFilters, Vec<ScenarioError>> {
    let runs = load_base_or_scenario(path, sets, Purpose::Filters)?;
    let Some((first, others)) = runs.split_first() else {
        return Err(Vec::new());
    };
    let filters = &first.scenario.filters;
    let refuse = |message: String| Err(vec![ScenarioError::at(first.locate("name"), message)]);
    if others.iter().any(|run| run.scenario.filters != *filters) {
        return refuse(format!(
            "{} points of the sweep have different filters: expected one set; leave the matrix \
             out and give the values with --set",
            runs.len()
        ));
    }
    if filters.is_empty() {
        return refuse("it has no [[filter]]: there is nothing to put the log through".to_owned());
    }
    let words = ExpectedWords {
        sample_rate_hz,
        peak_deg_per_h: 0.0,
        run: None,
    };
    let complaints = filters.iter().enumerate();
    let complaints: Vec<ScenarioError> = complaints
        .flat_map(|(index, filter)| filter.check_on(index, &words))
        .map(|complaint| ScenarioError::at(first.locate(&complaint.key), complaint.message))
        .collect();
    if complaints.is_empty() {
        Ok(LogFilters {
            resolved: first.clone(),
            sample_rate_hz,
        })
    } else {
        Err(complaints)
    }
}

impl LogFilters {
    /// Those of a scenario that measures a log and has passed every check; none where it has no filter.
    pub(super) fn of(resolved: &Resolved, sample_rate_hz: f64) -> Option<Self> {
        let has_filters = !resolved.scenario.filters.is_empty();
        has_filters.then(|| Self {
            resolved: resolved.clone(),
            sample_rate_hz,
        })
    }

    /// The filters in the order of the file.
    pub(crate) fn configs(&self) -> &[FilterConfig] {
        &self.resolved.scenario.filters
    }

    /// Their names in the order of the file.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.configs().iter().map(|config| config.name.as_str())
    }

    /// The programs that they would start.
    #[must_use]
    pub fn programs(&self) -> Vec<ProgramFiles> {
        program_files(&self.resolved)
    }

    /// The scenario they are from.
    pub(crate) fn resolved(&self) -> &Resolved {
        &self.resolved
    }

    /// Name and digest of the scenario they are from.
    pub(crate) fn source(&self) -> (String, String) {
        (self.resolved.file.clone(), self.resolved.digest.clone())
    }

    /// Warns of filters that words of this size cost their digits, and says in which unit the constants
    /// of a line enhancer are meant.
    pub(crate) fn warnings(&self, words_deg_per_h: &[f64]) -> Vec<String> {
        let peak_deg_per_h = words_deg_per_h
            .iter()
            .fold(0.0, |largest: f64, word| largest.max(word.abs()));
        let words = ExpectedWords {
            sample_rate_hz: self.sample_rate_hz,
            peak_deg_per_h,
            run: None,
        };
        let notes = self
            .configs()
            .iter()
            .flat_map(|filter| filter.notes(&words));
        let said = self.resolved.warnings.iter().cloned();
        said.chain(notes).collect()
    }
}
