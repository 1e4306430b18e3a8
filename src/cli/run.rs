//! `fogbench run`: runs scenarios, prints tables as they become ready, ends with the verdict.

use std::collections::BTreeMap;
use std::io::{self, IsTerminal};
use std::sync::Mutex;

use indicatif::{ProgressBar, ProgressStyle};

use super::arguments::{Format, ResumeFrom, RunOptions};
use super::exit::Exit;
use super::{output, place, select};
use crate::experiment::{
    Observer, Plan, Resume, SuiteError, SuiteOptions, SuiteOutcome, run_suite,
};
use crate::report::{self, RunOutcome, RunReport, RunStatus};

/// Plans, runs, prints and judges.
pub(super) fn run(options: &RunOptions) -> io::Result<Exit> {
    let plans = match select::plans(&options.select) {
        Ok(plans) => plans,
        Err(exit) => return Ok(exit),
    };
    let progress = Progress::new(&plans, options.format);
    let suite = SuiteOptions {
        threads: usize::from(options.jobs),
        force: options.force,
        resume: resume(options.resume),
        ..SuiteOptions::new(options.output.clone())
    };
    let result = run_suite(&plans, &suite, &progress);
    progress.bar.finish_and_clear();
    let outcome = match result {
        Ok(outcome) => outcome,
        Err(error) => {
            output::talk(&format!("error: {error}"));
            return Ok(match error {
                SuiteError::Store(error) => place::exit_of(&error),
                SuiteError::Threads { .. } => Exit::Internal,
            });
        }
    };
    progress.printed()?;
    output::data(&closing(&outcome, options.format))?;
    output::talk(&format!("results in {}", options.output.display()));
    Ok(exit_of(&outcome))
}

/// Whose results the suite takes over.
fn resume(from: Option<ResumeFrom>) -> Resume {
    match from {
        None => Resume::Never,
        Some(ResumeFrom::SameBuild) => Resume::SameBuild,
        Some(ResumeFrom::AnyBuild) => Resume::AnyBuild,
    }
}

/// The verdict of the whole suite: the worst of its runs.
fn exit_of(suite: &SuiteOutcome) -> Exit {
    if suite.broken {
        return Exit::Internal;
    }
    match suite.runs.iter().map(RunOutcome::status).max() {
        None | Some(RunStatus::Pass) => Exit::Success,
        Some(RunStatus::GateFailed) => Exit::GateFailed,
        Some(RunStatus::ChannelFailed | RunStatus::RunFailed) => Exit::RunFailed,
    }
}

fn closing(suite: &SuiteOutcome, format: Format) -> String {
    let (runs, across) = (&suite.runs, &suite.comparison);
    match format {
        Format::Text => {
            let (width, colour) = (output::width(), output::colour());
            let suite = report::suite_text(runs, width, colour);
            suite + &report::comparison_text(across, width, colour)
        }
        Format::Json => {
            report::suite_summary_json(env!("CARGO_PKG_VERSION"), runs, across, &suite.stale)
        }
        // Every run has been printed on its own line.
        Format::Jsonl => String::new(),
    }
}

/// Progress on stderr, results on stdout in the order of the plan.
struct Progress {
    bar: ProgressBar,
    format: Format,
    pending: Mutex<Pending>,
}

/// Texts that wait for their turn.
struct Pending {
    next: usize,
    texts: BTreeMap<usize, String>,
    failure: Option<io::Error>,
}

impl Progress {
    fn new(plans: &[Plan], format: Format) -> Self {
        let total_s: f64 = plans.iter().map(Plan::simulated_s).sum();
        let bar = if io::stderr().is_terminal() {
            ProgressBar::new(whole(total_s))
        } else {
            ProgressBar::hidden()
        };
        let style = "{spinner} {bar:40} {percent:>3} % of {len} s of gyro time, {eta} to go";
        if let Ok(style) = ProgressStyle::with_template(style) {
            bar.set_style(style);
        }
        let pending = Pending {
            next: 0,
            texts: BTreeMap::new(),
            failure: None,
        };
        Self {
            bar,
            format,
            pending: Mutex::new(pending),
        }
    }

    fn text(&self, run: &RunReport) -> String {
        match self.format {
            Format::Text => {
                let table = report::table_text(run, output::width(), output::colour());
                format!("{table}\n")
            }
            Format::Json => String::new(),
            Format::Jsonl => {
                let document = report::run_summary_json(run);
                format!(
                    "{}\n",
                    document.lines().map(str::trim_start).collect::<String>()
                )
            }
        }
    }

    /// Prints every text whose predecessors have all been printed.
    fn print_in_turn(&self, index: usize, text: String) {
        let mut pending = self
            .pending
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        pending.texts.insert(index, text);
        let mut ready = String::new();
        let mut next = pending.next;
        while let Some(text) = pending.texts.remove(&next) {
            ready.push_str(&text);
            next += 1;
        }
        pending.next = next;
        if pending.failure.is_none() && !ready.is_empty() {
            let result = self.bar.suspend(|| output::data(&ready));
            pending.failure = result.err();
        }
    }

    /// The first failure to print, if any.
    fn printed(&self) -> io::Result<()> {
        let mut pending = self
            .pending
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        pending.failure.take().map_or(Ok(()), Err)
    }
}

impl Observer for Progress {
    fn advanced(&self, simulated_s: f64) {
        self.bar.inc(whole(simulated_s));
    }

    fn finished(&self, index: usize, report: &RunReport) {
        self.print_in_turn(index, self.text(report));
    }

    fn failed(&self, index: usize, outcome: &RunOutcome) {
        let reason = outcome.error.as_deref().unwrap_or_default();
        self.bar
            .suspend(|| output::talk(&format!("error: {}: {reason}", outcome.folder)));
        self.print_in_turn(index, String::new());
    }

    fn taken_over(&self, index: usize, report: &RunReport) {
        let scenario = &report.scenario.name;
        let point = report.sweep.as_ref();
        let point = point.map_or_else(String::new, |(index, _)| format!("/{index:04}"));
        self.bar
            .suspend(|| output::talk(&format!("{scenario}{point}: taken over")));
        self.finished(index, report);
    }

    fn caution(&self, message: &str) {
        self.bar
            .suspend(|| output::talk(&format!("warning: {message}")));
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a time in whole seconds for the progress bar, positive and far below 2^53"
)]
fn whole(seconds: f64) -> u64 {
    seconds.round() as u64
}
