//! `fogbench calibrate`: twelve parameters from a file of groups or from a simulated campaign.

use std::io;

use crate::cli::options::calibrate::CalibrateOptions;
use crate::cli::terminal::complaint;
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::cli::terminal::place::Place;
use crate::experiment::{CalibrateError, CalibrationTrial, calibrate_campaign, calibrate_groups};
use crate::recording::LogError;
use crate::report::{calibrate_json, calibrate_text};

/// Prints the calibration; with a folder, writes `calibration.toml` and `groups.csv` into it.
pub(in crate::cli) fn calibrate(options: &CalibrateOptions) -> io::Result<Exit> {
    let place = Place::new(options.output.as_deref(), "calibration", options.force);
    if let Err(exit) = place.check(&[&options.path]) {
        return Ok(exit);
    }
    let found = if options.is_scenario() {
        of_scenario(options)
    } else {
        of_groups(options)
    };
    let found = match found {
        Ok(found) => found,
        Err(exit) => return Ok(exit),
    };
    if let Err(exit) = place.fill(|folder| found.write(folder)) {
        return Ok(exit);
    }
    let report = found.report();
    output::data(&options.format.of(
        || calibrate_text(&report, output::width(), output::colour()),
        || calibrate_json(&report),
    )?)?;
    if let Some(folder) = &options.output {
        output::talk(&format!("results in {}", folder.display()));
    }
    Ok(Exit::Success)
}

fn of_groups(options: &CalibrateOptions) -> Result<CalibrationTrial, Exit> {
    if !options.set.is_empty() {
        return Err(misused(
            "--set changes keys of a scenario: a groups file has none",
        ));
    }
    calibrate_groups(&options.path, &options.groups_settings()).map_err(|errors| {
        let is_unreadable =
            |error: &CalibrateError| matches!(error, CalibrateError::File(LogError::Read { .. }));
        complaint::print(&errors);
        if errors.iter().any(is_unreadable) {
            Exit::Io
        } else {
            Exit::Usage
        }
    })
}

fn of_scenario(options: &CalibrateOptions) -> Result<CalibrationTrial, Exit> {
    if options.latitude_deg.is_some() {
        return Err(misused(
            "--latitude-deg belongs to a groups file: a scenario has turntable.site.latitude_deg",
        ));
    }
    calibrate_campaign(&options.path, &options.scenario_sets(), &()).map_err(|errors| {
        complaint::print(&errors);
        Exit::Usage
    })
}

fn misused(message: &str) -> Exit {
    complaint::print(&[message.to_owned()]);
    Exit::Usage
}
