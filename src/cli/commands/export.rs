//! `fogbench export`: golden vectors, waveforms and RTL of a hardware pipeline.

use std::io;
use std::path::{Path, PathBuf};

use crate::cli::commands::log::unreadable;
use crate::cli::options::hardware::ExportOptions;
use crate::cli::terminal::complaint;
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::cli::terminal::place::Place;
use crate::experiment::{input_digest, plan_suite, scenario_stimulus};
use crate::filters::FilterConfig;
use crate::filters::hardware::{
    PipelineSettings, Stimulus, export_pipeline_of, has_hardware, kind_names,
};
use crate::fpga::FpgaError;
use crate::recording::read_stimulus;
use crate::report::input_digest_toml;
use crate::vocabulary::ExportForm;
use crate::wording::{counted, is_misspelling};

/// Name of the file that says which samples the words of an export are of.
const INPUT_DIGEST: &str = "input_digest.toml";

/// Writes the folder and says what stands in it.
pub(in crate::cli) fn export(options: &ExportOptions) -> io::Result<Exit> {
    let (settings, stimulus) = match prepare(options) {
        Ok(prepared) => prepared,
        Err(exit) => return Ok(exit),
    };
    let place = Place::new(Some(&options.folder), "export", options.force);
    let inputs = options.stimulus.iter().chain(&options.scenario);
    if let Err(exit) = place.check(&inputs.map(PathBuf::as_path).collect::<Vec<_>>()) {
        return Ok(exit);
    }
    let form = options.what;
    let trace_samples = options.trace_samples;
    let samples = match form {
        ExportForm::Waveform => stimulus.words.len().min(trace_samples),
        _ => stimulus.words.len(),
    };
    let mut exported = Ok(Vec::new());
    let digest = input_digest_toml(&input_digest(&stimulus.words));
    let filled = place.fill(|folder| {
        let staged = folder.stage()?;
        let parts = options.parts();
        exported = export_pipeline_of(
            staged.path(),
            form,
            &settings,
            stimulus,
            trace_samples,
            parts,
        );
        let Ok(files) = &mut exported else {
            return Ok(());
        };
        for file in files.iter_mut() {
            if let Ok(name) = file.strip_prefix(staged.path()) {
                *file = options.folder.join(name);
            }
        }
        // A waveform holds no words to replay.
        if form != ExportForm::Waveform {
            staged.write(INPUT_DIGEST, digest.as_bytes())?;
            files.push(options.folder.join(INPUT_DIGEST));
        }
        staged.seal_plainly()?;
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
            output::talk(&counted(samples, "sample"));
            if form == ExportForm::Rtl {
                tell_scripts(options);
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

/// Says how an export of RTL is simulated and synthesised.
fn tell_scripts(options: &ExportOptions) {
    let script = options.folder.join("run.sh");
    output::talk(&format!("simulate with: sh {}", script.display()));
    if options.synth.is_some() {
        let script = options.folder.join("synth.sh");
        output::talk(&format!("synthesise with: sh {}", script.display()));
    }
}

/// Pipeline and stimulus, both checked before anything is written.
fn prepare(options: &ExportOptions) -> Result<(PipelineSettings, Stimulus), Exit> {
    let mut settings = options.filter.settings();
    let stimulus = match (&options.stimulus, &options.scenario) {
        (Some(path), _) => Stimulus {
            words: read_stimulus(path, options.column.as_deref(), options.samples)
                .map_err(|error| unreadable(&error))?,
            codes: None,
        },
        (None, Some(path)) => {
            let (found, stimulus) = from_scenario(path, options)?;
            settings = found.unwrap_or(settings);
            stimulus
        }
        (None, None) => return Err(refused("give --scenario or --stimulus".to_owned())),
    };
    if !settings.has_hardware() {
        let complaint = "update_order = \"gain-first\" has no hardware to export: use \"schedule\"";
        return Err(refused(complaint.to_owned()));
    }
    settings
        .timing()
        .map_err(|error| refused(error.to_string()))?;
    settings
        .check_units(options.parts().latencies)
        .map_err(|error| refused(error.to_string()))?;
    Ok((settings, stimulus))
}

fn refused(complaint: String) -> Exit {
    complaint::print(&[complaint]);
    Exit::Usage
}

fn from_scenario(
    path: &Path,
    options: &ExportOptions,
) -> Result<(Option<PipelineSettings>, Stimulus), Exit> {
    let plans = plan_suite(&[path.to_path_buf()], &options.set).map_err(|errors| {
        complaint::print(&errors);
        Exit::Usage
    })?;
    let [plan] = plans.as_slice() else {
        return Err(refused(format!(
            "{}: holds {}: expected one",
            path.display(),
            counted(plans.len(), "run")
        )));
    };
    let settings = match &options.name {
        None => None,
        Some(name) => {
            let filters = &plan.resolved().scenario.filters;
            let filter = filters.iter().find(|filter| filter.name == *name);
            let settings = filter.and_then(|filter| filter.kind.settings().hardware());
            Some(settings.ok_or_else(|| refused(no_hardware(path, name, filters)))?)
        }
    };
    if plan.resolved().scenario.compensation.is_some() {
        return Err(refused(format!(
            "{}: its filters are given compensated words, and an export the words of the gyro: put \
             the words of a run's samples/<axis>_compensated.npy in by --stimulus",
            path.display()
        )));
    }
    let stimulus =
        scenario_stimulus(plan, options.samples).map_err(|error| refused(error.to_string()))?;
    Ok((settings, stimulus))
}

/// Why a filter of a scenario has no hardware to export, and how to get it.
fn no_hardware(path: &Path, name: &str, filters: &[FilterConfig]) -> String {
    let lack = format!(
        "{}: there is no filter `{name}` with pipeline = \"fpga\"",
        path.display()
    );
    let listed = |last: &str| {
        let kinds: Vec<&str> = kind_names().collect();
        match kinds.split_last() {
            Some((end, [])) => (*end).to_owned(),
            Some((end, kinds)) => format!("{} {last} {end}", kinds.join(", ")),
            None => String::new(),
        }
    };
    let kind = |filter: &FilterConfig| Some(filter.kind.name()).filter(|kind| has_hardware(kind));
    if let Some(filter) = filters.iter().find(|filter| filter.name == name) {
        return match kind(filter) {
            Some(kind) => {
                format!("{lack}: write pipeline = \"fpga\" into its table [filter.{kind}]")
            }
            None => {
                let kinds = listed("and");
                format!("{lack}: its kind has no hardware, only {kinds} have")
            }
        };
    }
    let names = filters.iter().filter(|filter| kind(filter).is_some());
    let names: Vec<&str> = names.map(|filter| filter.name.as_str()).collect();
    let mut alike = names.iter().filter(|known| is_misspelling(name, known));
    match (alike.next(), names.is_empty()) {
        (Some(known), _) => format!("{lack}: did you mean `{known}`?"),
        (None, false) => format!("{lack}: expected one of {}", names.join(", ")),
        (None, true) => format!("{lack}: the scenario has no {} filter", listed("or")),
    }
}
