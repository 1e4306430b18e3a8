//! Figures of a problem that logs bring, in place of printed ones.

use super::measurand::Measurand;
use crate::inference::{LoggedConfig, PrintedConfig};
use crate::metrics::{ChannelMetrics, Estimate, IntervalKind, NORMAL_QUANTILE};
use crate::report::RestoredRun;
use crate::scenario::{Problem, ScenarioError};

/// Adds the figures of the logs to those that are printed.
///
/// # Errors
/// Every complaint about a log, with its place in the problem.
pub(super) fn with_logs(mut problem: Problem) -> Result<Problem, Vec<ScenarioError>> {
    let mut errors = Vec::new();
    let mut figures = Vec::new();
    for (index, log) in problem.config.logs.iter().enumerate() {
        match figures_of(&problem, index, log) {
            Ok(own) => figures.extend(own),
            Err(error) => errors.push(error),
        }
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    problem.logged_from = problem.config.published.len();
    problem.config.published.extend(figures);
    Ok(problem)
}

/// Figures of one log.
fn figures_of(
    problem: &Problem,
    index: usize,
    log: &LoggedConfig,
) -> Result<Vec<PrintedConfig>, ScenarioError> {
    let at = format!("log[{index}].file");
    let text = problem.read_beside(&at, &log.file)?;
    let channels = RestoredRun::of_summary(&text).map(|restored| restored.channels);
    let channels = channels.ok_or_else(|| {
        let message = format!(
            "{at}: {} is no summary of a log: expected what `fogbench analyze --format json` prints",
            log.file
        );
        problem.complaint(&at, message)
    })?;
    let of = |name: &str| -> Option<ChannelMetrics> {
        let found = channels.iter().find(|(known, _)| known == name);
        found.map(|(_, channel)| channel.clone())
    };
    let mut figures = Vec::new();
    for (place, written) in log.metrics.iter().enumerate() {
        let at = format!("log[{index}].metrics[{place}]");
        let complaint = |what: &str| {
            let message = format!("{at} = \"{written}\": {what}");
            problem.complaint(&at, message)
        };
        let names = Measurand::names(written, of).map_err(|error| complaint(&error.to_string()))?;
        let before = figures.len();
        for name in names {
            let (channel, measurand) =
                Measurand::of(&name).map_err(|error| complaint(&error.to_string()))?;
            let found = of(&channel).and_then(|own| measurand.read(&own));
            figures.extend(found.map(|estimate| PrintedConfig {
                record: log.record.clone(),
                metric: name,
                value: estimate.value,
                unit: measurand.unit().to_owned(),
                rounding: None,
                standard_uncertainty: standard_error(&estimate),
                source: log.file.clone(),
            }));
        }
        if figures.len() == before {
            let known: Vec<&str> = channels.iter().map(|own| own.0.as_str()).collect();
            let lack = format!(
                "{} does not have it; its channels are {}",
                log.file,
                known.join(", ")
            );
            return Err(complaint(&lack));
        }
    }
    Ok(figures)
}

/// Standard error of an estimate; none of one without an interval, of which theory knows the scatter.
fn standard_error(estimate: &Estimate) -> Option<f64> {
    let has_interval = !matches!(
        estimate.interval,
        IntervalKind::Exact | IntervalKind::Absent(_)
    );
    let error = 0.5 * (estimate.high - estimate.low) / NORMAL_QUANTILE;
    (has_interval && error > 0.0).then_some(error)
}
