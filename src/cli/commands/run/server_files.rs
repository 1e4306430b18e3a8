//! What a build server gets of a suite: files beside the output folder, and annotations.

use std::fs;
use std::path::Path;

use crate::cli::options::arguments::RunOptions;
use crate::cli::options::build_server::Annotations;
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::{output, place};
use crate::experiment::{Plan, SuiteOutcome};
use crate::report::{
    BencherMetrics, RestoredRun, SUITE_SUMMARY, SuiteTimes, github_annotations, is_bencher_metrics,
    is_junit_xml, is_suite_markdown, junit_xml, suite_markdown,
};
use crate::store::SingleFile;

/// What is asked for.
pub(super) struct ServerFiles<'a> {
    options: &'a RunOptions,
    /// Scenario file of each run.
    scenario_files: Vec<String>,
}

impl<'a> ServerFiles<'a> {
    /// Finds every file to be one that may be written.
    ///
    /// A refusal is printed before its exit code is returned.
    pub(super) fn check(options: &'a RunOptions, plans: &[Plan]) -> Result<Self, Exit> {
        let scenario_files: Vec<String> = plans
            .iter()
            .map(|plan| plan.resolved().shown_file())
            .collect();
        let read = scenario_files.iter().map(Path::new);
        let read: Vec<&Path> = read
            .chain(options.account.against.baseline.as_deref())
            .collect();
        let files: Vec<SingleFile> = files(options).map(|(_, file)| file).collect();
        let below = place::real(&options.output);
        for (index, file) in files.iter().enumerate() {
            place::check_unread(file.path, &read)?;
            let path = place::real(file.path);
            if path.starts_with(&below) {
                output::talk(&format!(
                    "error: {} lies in the output folder, where nothing depends on the time or place of \
                     a run: nothing was run; choose a file outside of {}",
                    file.path.display(),
                    options.output.display()
                ));
                return Err(Exit::Usage);
            }
            if files[..index]
                .iter()
                .any(|other| place::real(other.path) == path)
            {
                output::talk(&format!(
                    "error: {} is asked for twice: nothing was run",
                    file.path.display()
                ));
                return Err(Exit::Usage);
            }
            file.check().map_err(|error| place::refused(&error))?;
            let folder = path.parent().unwrap_or(&path);
            if !folder.is_dir() {
                output::talk(&format!(
                    "error: there is no folder {} for {}: nothing was run",
                    folder.display(),
                    file.path.display()
                ));
                return Err(Exit::Io);
            }
        }
        Ok(Self {
            options,
            scenario_files,
        })
    }

    /// Writes the files; success, or how the program ends for want of one.
    ///
    /// * `comparison`: Markdown of a comparison with a baseline, empty without one.
    pub(super) fn write(&self, suite: &SuiteOutcome, times: &SuiteTimes, comparison: &str) -> Exit {
        let mut exit = Exit::Success;
        for (kind, file) in files(self.options) {
            let text = match kind {
                Kind::Junit => junit_xml(&suite.runs, suite.against.judged(), Some(times)),
                Kind::Markdown => {
                    let failed = suite.against.judged().map_or(0, |it| it.failed().count());
                    suite_markdown(&suite.runs, failed, comparison)
                }
                Kind::Bencher => bencher_text(&self.options.output, suite),
            };
            if let Err(error) = file.write(&text) {
                exit = exit.worst(place::refused(&error));
            }
        }
        exit
    }

    /// What a build server reads of a suite among its output; empty if nothing is asked for.
    pub(super) fn annotations(&self, suite: &SuiteOutcome) -> String {
        match self.options.account.server.annotations {
            None => String::new(),
            Some(Annotations::Github) => {
                let judged = suite.against.judged();
                github_annotations((&suite.runs, judged), &self.scenario_files, from_here)
            }
        }
    }
}

/// What a file holds.
#[derive(Clone, Copy)]
enum Kind {
    Junit,
    Markdown,
    Bencher,
}

impl Kind {
    /// Whether a text of this kind is one that fogbench wrote; an empty file holds nothing of anybody's, and
    /// a build server makes that of a job's page beforehand.
    fn is_ours(self) -> fn(&str) -> bool {
        match self {
            Self::Junit => |text| text.is_empty() || is_junit_xml(text),
            Self::Markdown => |text| text.is_empty() || is_suite_markdown(text),
            Self::Bencher => |text| text.is_empty() || is_bencher_metrics(text),
        }
    }
}

/// The files that are asked for.
fn files(options: &RunOptions) -> impl Iterator<Item = (Kind, SingleFile<'_>)> {
    let server = &options.account.server;
    let asked = [
        (Kind::Junit, &server.junit),
        (Kind::Markdown, &server.summary_markdown),
        (Kind::Bencher, &server.bmf),
    ];
    asked.into_iter().filter_map(|(kind, path)| {
        let file = SingleFile {
            path: path.as_deref()?,
            is_ours: Some(kind.is_ours()),
            force: options.force,
        };
        Some((kind, file))
    })
}

/// Metrics of every run of which the output folder holds the result of this suite.
fn bencher_text(folder: &Path, suite: &SuiteOutcome) -> String {
    let mut metrics = BencherMetrics::default();
    for run in suite.runs.iter().filter(|run| run.is_finished()) {
        let summary = folder.join(&run.folder).join(SUITE_SUMMARY.name);
        let text = fs::read_to_string(summary).ok();
        if let Some(restored) = text.and_then(|text| RestoredRun::of_summary(&text)) {
            metrics.add(&run.folder, &restored.channels);
        }
    }
    metrics.text()
}

/// A path from the working directory, `/` between its parts; as it is where it leads out of it.
fn from_here(path: &str) -> String {
    let here = std::env::current_dir().and_then(fs::canonicalize);
    let file = fs::canonicalize(path);
    let inside = here.ok().zip(file.ok());
    let inside = inside.and_then(|(here, file)| Some(file.strip_prefix(here).ok()?.to_owned()));
    let Some(inside) = inside else {
        return path.to_owned();
    };
    let parts = inside.components();
    let parts = parts.map(|part| part.as_os_str().to_string_lossy().into_owned());
    parts.collect::<Vec<_>>().join("/")
}
