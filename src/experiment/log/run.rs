//! A scenario that measures a recorded log: the results of a run.

use super::filters::LogFilters;
use super::own_temperature::{compensate_temperature, load_own_temperature};
use super::trial::{LogInput, LogSettings, SETTLE_S, try_log};
use crate::experiment::plan::Plan;
use crate::experiment::run::{Faults, Progress, Results, Simulation, Unfinished, unless_stopped};
use crate::recording::{LogFormat, read_log};
use crate::scenario::{NamedFile, digest_of_log};

/// Reads the log of a plan again, puts it through the filters and measures.
///
/// # Errors
/// A log that is not the one that was planned with; whatever `try_log` refuses; a listener that stops it.
pub(crate) fn run_log(
    plan: &Plan,
    (file, format): (&NamedFile, &LogFormat),
    progress: &dyn Progress,
) -> Result<Results, Unfinished> {
    unless_stopped(progress)?;
    let resolved = plan.resolved();
    let scenario = &resolved.scenario;
    let name = scenario.log.as_ref().and_then(|log| log.file.clone());
    let name = name.unwrap_or_default();
    let mut log = read_log(&file.path, format).map_err(|error| {
        // Results hold no absolute path.
        let path = file.path.display().to_string();
        Unfinished::Failed(error.to_string().replace(&path, &name))
    })?;
    if plan
        .log()
        .is_none_or(|facts| facts.digest != digest_of_log(&log))
    {
        let message = format!("{name} has changed since it was read");
        return Err(Unfinished::Failed(message));
    }
    log.keep_first(plan.record_length().total());
    let settings = LogSettings {
        motion: format.motion.unwrap_or_default(),
        settle_s: format.settle_s.unwrap_or(SETTLE_S),
        warm_up_s: scenario.warm_up_s,
        bias_averaging_time_s: scenario.bias_averaging_time_s,
        fit_tau_min_s: format.fit_tau_min_s,
        allan: scenario.allan,
        temperature_reference_c: format.temperature_reference_c,
    };
    let filters = LogFilters::of(resolved, log.sample_rate_hz);
    let temperature = load_own_temperature(format).map_err(|errors| {
        let said: Vec<String> = errors.iter().map(ToString::to_string).collect();
        Unfinished::Failed(said.join("; "))
    })?;
    let input = match &temperature {
        Some(temperature) => LogInput::Compensated(compensate_temperature(log, temperature)),
        None => LogInput::Plain(log),
    };
    let trial = try_log(input, filters.as_ref(), &settings, progress);
    let trial = trial.map_err(|error| {
        let stopped = unless_stopped(progress).err();
        stopped.unwrap_or(Unfinished::Failed(error.message))
    })?;
    progress.advanced(plan.simulated_s());
    let mut notes = trial.notes;
    let said = plan.warnings().iter();
    let said: Vec<String> = said.filter(|it| !notes.contains(it)).cloned().collect();
    notes.extend(said);
    Ok(Results {
        simulation: Simulation {
            gyros: vec![trial.record],
            filters: trial
                .filters
                .into_iter()
                .map(|filter| (0, filter))
                .collect(),
            encoder_rad: None,
            faults: Faults::default(),
        },
        channels: trial.channels,
        verdicts: Vec::new(),
        notes,
        calibration: None,
        compensation: None,
        theory: Vec::new(),
    })
}
