//! The files of one run.

use super::output::SuiteOutput;
use crate::experiment::plan::Plan;
use crate::experiment::run::{RecordLength, Simulation, stamp_s};
use crate::gyro::temperature_record;
use crate::report::{self, CalibrationProvenance, Pictures, RunReport};
use crate::scenario::SamplesFormat;
use crate::signal::{CalibrationSheet, RunSignals};
use crate::store::{Staged, StoreError};
use crate::units::rad_to_arcsec;

/// Picture of a calibration.
const CALIBRATION_SVG: &str = "calibration.svg";

/// The pictures of one run, and what to say of those that are left out.
pub(crate) fn draw(plan: &Plan, report: &RunReport, simulation: &Simulation) -> Pictures {
    let mut pictures = Pictures::default();
    let names = Names::of(report);
    for signals in &signals(plan, simulation, &names) {
        pictures.extend(report::plots(report, signals));
    }
    if let Some(sheet) = report.calibration {
        let svg = report::calibration_svg(&report.scenario.name, sheet);
        pictures.add_svg(CALIBRATION_SVG.to_owned(), svg);
    }
    pictures
}

/// Writes everything of one run beside its place, to be swapped in whole.
pub(crate) fn write_folder<'a>(
    plan: &Plan,
    report: &RunReport,
    simulation: &Simulation,
    pictures: &Pictures,
    output: &'a SuiteOutput,
) -> Result<Staged<'a>, StoreError> {
    let folder = output.stage()?;
    folder.write("summary.json", report::run_summary_json(report).as_bytes())?;
    if let Some(csv) = report::allan_csv(report) {
        folder.write("allan.csv", csv.as_bytes())?;
    }
    if let Some(csv) = report::runs_csv(report) {
        folder.write("runs.csv", csv.as_bytes())?;
    }
    if let Some(csv) = report::autocovariance_csv(report) {
        folder.write("autocovariance.csv", csv.as_bytes())?;
    }
    if let Some(csv) = report::psd_csv(report) {
        folder.write("psd.csv", csv.as_bytes())?;
    }
    if let Some(csv) = report::scale_factor_csv(report) {
        folder.write("scale-factor.csv", csv.as_bytes())?;
    }
    if let Some(sheet) = report.calibration {
        write_calibration(&folder, report, sheet)?;
    }
    for (name, svg) in &pictures.drawn {
        folder.write(name, svg.as_bytes())?;
    }
    if report.scenario.output.samples == SamplesFormat::Npy {
        let names = Names::of(report);
        write_samples(&folder, &signals(plan, simulation, &names))?;
    }
    Ok(folder)
}

/// The groups of a campaign and the parameters to apply.
fn write_calibration(
    folder: &Staged,
    report: &RunReport,
    sheet: &CalibrationSheet,
) -> Result<(), StoreError> {
    let provenance = CalibrationProvenance {
        tool_version: report.tool_version,
        file: report.file,
        digest: report.digest,
    };
    let toml = report::calibration_toml(sheet, &provenance);
    folder.write("calibration.toml", toml.as_bytes())?;
    folder.write("groups.csv", report::groups_csv(&sheet.groups).as_bytes())
}

/// Names of the channels of the gyros.
struct Names {
    raw: Vec<String>,
    compensated: Vec<String>,
}

impl Names {
    fn of(report: &RunReport) -> Self {
        Self {
            raw: report.scenario.raw_channels(),
            compensated: report.scenario.compensated_channels(),
        }
    }
}

/// The samples of each gyro.
fn signals<'a>(plan: &Plan, simulation: &'a Simulation, names: &'a Names) -> Vec<RunSignals<'a>> {
    let scenario = &plan.resolved().scenario;
    let sample_period_s = plan.sample_period_s();
    let first_measured = RecordLength::new(scenario, sample_period_s).warm_up;
    let end_s = scenario.warm_up_s + scenario.duration_s;
    let gyros = simulation.gyros.iter().enumerate();
    let named = gyros.zip(scenario.axis_prefixes().iter().zip(&names.raw));
    let signals = named.map(|((gyro, record), (prefix, raw_name))| {
        let raw = (raw_name.as_str(), record.raw_deg_per_h.as_slice());
        let compensated = record.compensated_deg_per_h.as_deref();
        let name = names.compensated.get(gyro).map(String::as_str);
        let compensated = name.zip(compensated);
        let filters = simulation.filters.iter().filter_map(|(of, filter)| {
            let words = filter.words.as_ref().ok().filter(|_| *of == gyro)?;
            Some((filter.name.as_str(), words.output_deg_per_h.as_slice()))
        });
        RunSignals {
            sample_period_s,
            first_measured,
            prefix,
            truth_deg_per_h: &record.truth_deg_per_h,
            encoder_rad: simulation.encoder_rad.as_deref(),
            channels: std::iter::once(raw)
                .chain(compensated)
                .chain(filters)
                .collect(),
            temperature: temperature_record(&scenario.gyro, scenario.warm_up_s, end_s),
        }
    });
    signals.collect()
}

fn write_samples(folder: &Staged, gyros: &[RunSignals]) -> Result<(), StoreError> {
    for signals in gyros {
        for (name, words) in &signals.channels {
            folder.write_npy(&format!("samples/{name}.npy"), words)?;
        }
        let truth = format!("samples/{}truth.npy", signals.prefix);
        folder.write_npy(&truth, signals.truth_deg_per_h)?;
    }
    let Some(first) = gyros.first() else {
        return Ok(());
    };
    if let Some(readings) = first.encoder_rad {
        let angles: Vec<f64> = readings.iter().copied().map(rad_to_arcsec).collect();
        folder.write_npy("samples/encoder_arcsec.npy", &angles)?;
    }
    let samples = first.truth_deg_per_h.len() as u64;
    let time_s: Vec<f64> = (0..samples)
        .map(|index| stamp_s(index, first.sample_period_s))
        .collect();
    folder.write_npy("samples/time_s.npy", &time_s)
}
