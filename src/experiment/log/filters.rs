//! The filters of a scenario, to be put behind a recorded log.

use std::path::Path;

use crate::experiment::line_enhancer;
use crate::experiment::pipeline_check;
use crate::experiment::pipeline_settings::PipelineSettings;
use crate::experiment::textbook::cutoff_complaint;
use crate::filters::covariance_digits_warning;
use crate::scenario::{FilterConfig, FilterKind, Resolved, ScenarioError, load_base_or_scenario};
use crate::vocabulary::Pipeline;

/// The filters of one scenario or base, checked against the sample rate of a log.
#[derive(Clone, Debug)]
pub struct LogFilters {
    resolved: Resolved,
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
    let runs = load_base_or_scenario(path, sets)?;
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
    let complaints: Vec<ScenarioError> = filters
        .iter()
        .enumerate()
        .filter_map(|(index, filter)| {
            let hardware = || {
                let settings = PipelineSettings::of(&filter.kind)?;
                let path = format!("filter[{index}].{}", pipeline_check::kind(&settings));
                pipeline_check::check(&settings, &path, sample_rate_hz).err()
            };
            let (key, message) =
                cutoff_complaint(index, &filter.kind, sample_rate_hz).or_else(hardware)?;
            Some(ScenarioError::at(first.locate(&key), message))
        })
        .collect();
    if complaints.is_empty() {
        Ok(LogFilters {
            resolved: first.clone(),
        })
    } else {
        Err(complaints)
    }
}

impl LogFilters {
    /// The filters in the order of the file.
    pub(crate) fn configs(&self) -> &[FilterConfig] {
        &self.resolved.scenario.filters
    }

    /// Name and digest of the scenario they are from.
    pub(crate) fn source(&self) -> (String, String) {
        (self.resolved.file.clone(), self.resolved.digest.clone())
    }

    /// Warns of filters that words of this size cost their digits, and says in which unit the constants
    /// of a line enhancer are meant.
    pub(crate) fn warnings(&self, words_deg_per_h: &[f64]) -> Vec<String> {
        let largest = words_deg_per_h
            .iter()
            .fold(0.0, |largest: f64, word| largest.max(word.abs()));
        let warnings = self.configs().iter().filter_map(|filter| {
            let warning = match (PipelineSettings::of(&filter.kind), &filter.kind) {
                (_, FilterKind::SignLms(config)) => {
                    return Some(line_enhancer::unit_note(&filter.name, config));
                }
                (Some(settings), _) => settings.digits_warning(largest)?.to_string(),
                (None, FilterKind::Rls(config)) if config.pipeline == Pipeline::Textbook => {
                    let delta = config.initial_inverse_correlation;
                    covariance_digits_warning(delta, config.taps as usize, largest)?
                }
                _ => return None,
            };
            Some(format!("filter `{}`: {warning}", filter.name))
        });
        warnings.collect()
    }
}
