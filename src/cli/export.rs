//! `fogbench export`: golden vectors, waveforms and RTL of a hardware pipeline.

use std::io;
use std::path::Path;

use super::exit::Exit;
use super::hardware_arguments::{ExportKind, ExportOptions};
use super::log::unreadable;
use super::{output, place};
use crate::experiment::{
    ExportForm, PipelineSettings, Stimulus, export_pipeline, plan_suite, scenario_stimulus,
};
use crate::fpga::FpgaError;
use crate::recording::read_stimulus;

/// Writes the folder and says what stands in it.
pub(super) fn export(options: &ExportOptions) -> io::Result<Exit> {
    let (settings, stimulus) = match prepare(options) {
        Ok(prepared) => prepared,
        Err(exit) => return Ok(exit),
    };
    if let Err(exit) = place::check(Some(&options.folder), options.force) {
        return Ok(exit);
    }
    let form = match options.what {
        ExportKind::Vectors => ExportForm::Vectors,
        ExportKind::Waveform => ExportForm::Waveform,
        ExportKind::Rtl => ExportForm::Rtl,
    };
    let trace_samples = options.trace_samples;
    let samples = match form {
        ExportForm::Waveform => stimulus.words.len().min(trace_samples),
        _ => stimulus.words.len(),
    };
    let mut exported = Ok(Vec::new());
    let filled = place::fill(&options.folder, options.force, |folder| {
        let staged = folder.stage()?;
        exported = export_pipeline(staged.path(), form, &settings, stimulus, trace_samples);
        let Ok(files) = &mut exported else {
            return Ok(());
        };
        for file in files {
            if let Ok(name) = file.strip_prefix(staged.path()) {
                *file = options.folder.join(name);
            }
        }
        staged.seal_plainly("export")?;
        staged.put_files_in_place()
    });
    if let Err(exit) = filled {
        return Ok(exit);
    }
    match exported {
        Ok(files) => {
            let names: String = files
                .iter()
                .map(|file| format!("{}\n", file.display()))
                .collect();
            output::data(&names)?;
            output::talk(&format!("{samples} samples"));
            if form == ExportForm::Rtl {
                let script = options.folder.join("run.sh");
                output::talk(&format!("simulate with: sh {}", script.display()));
            }
            Ok(Exit::Success)
        }
        Err(error) => {
            output::talk(&format!("error: {error}"));
            Ok(match error {
                FpgaError::Write { .. } => Exit::Io,
                _ => Exit::Usage,
            })
        }
    }
}

/// Pipeline and stimulus, both checked before anything is written.
fn prepare(options: &ExportOptions) -> Result<(PipelineSettings, Stimulus), Exit> {
    let one = |complaint: String| refused(&[complaint]);
    let mut settings = options.filter.settings();
    let stimulus = match (&options.stimulus, &options.scenario) {
        (Some(path), _) => Stimulus {
            words: read_stimulus(path, options.column.as_deref(), options.samples)
                .map_err(|error| unreadable(&error))?,
            codes: None,
        },
        (None, Some(path)) => {
            let (found, stimulus) =
                from_scenario(path, options).map_err(|complaints| refused(&complaints))?;
            settings = found.unwrap_or(settings);
            stimulus
        }
        (None, None) => return Err(one("give --scenario or --stimulus".to_owned())),
    };
    if !settings.core.has_hardware() {
        let complaint = "update_order = \"gain-first\" has no hardware to export: use \"schedule\"";
        return Err(one(complaint.to_owned()));
    }
    settings.timing().map_err(|error| one(error.to_string()))?;
    Ok((settings, stimulus))
}

fn refused(complaints: &[String]) -> Exit {
    output::complain(complaints);
    Exit::Usage
}

fn from_scenario(
    path: &Path,
    options: &ExportOptions,
) -> Result<(Option<PipelineSettings>, Stimulus), Vec<String>> {
    let plans = plan_suite(&[path.to_path_buf()], &[])
        .map_err(|errors| errors.iter().map(ToString::to_string).collect::<Vec<_>>())?;
    let [plan] = plans.as_slice() else {
        return Err(vec![format!(
            "{}: holds {} runs: expected one",
            path.display(),
            plans.len()
        )]);
    };
    let settings = match &options.name {
        None => None,
        Some(name) => {
            let filters = &plan.resolved().scenario.filters;
            let filter = filters.iter().find(|filter| filter.name == *name);
            let settings = filter.and_then(|filter| PipelineSettings::of(&filter.kind));
            Some(settings.ok_or_else(|| {
                vec![format!(
                    "{}: there is no filter `{name}` with pipeline = \"fpga\"",
                    path.display()
                )]
            })?)
        }
    };
    if plan.resolved().scenario.compensation.is_some() {
        return Err(vec![format!(
            "{}: its filters are given compensated words, and an export the words of the gyro: put \
             the words of a run's samples/<axis>_compensated.npy in by --stimulus",
            path.display()
        )]);
    }
    let stimulus =
        scenario_stimulus(plan, options.samples).map_err(|error| vec![error.to_string()])?;
    Ok((settings, stimulus))
}
