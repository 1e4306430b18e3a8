//! `fogbench run`: runs scenarios, prints tables as they become ready, ends with the verdict.

use std::collections::BTreeMap;
use std::io::{self, IsTerminal};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use indicatif::{ProgressBar, ProgressStyle};

use crate::cli::commands::against::Against;
use crate::cli::commands::select;
use crate::cli::commands::server_files::ServerFiles;
use crate::cli::options::arguments::{ResumeFrom, RunOptions};
use crate::cli::options::format::Format;
use crate::cli::terminal::exit::{Exit, io_failure};
use crate::cli::terminal::output;
use crate::cli::terminal::place;
use crate::cli::terminal::signals::Interrupt;
use crate::experiment::{
    self, Observer, Plan, Resume, SuiteError, SuiteOptions, SuiteOutcome, run_suite, thread_count,
};
use crate::report::{self, RunOutcome, RunReport, RunStatus};
use crate::scenario::bounded;
use crate::wording::counted;

/// Plans, runs, prints and judges.
pub(in crate::cli) fn run(options: &RunOptions, interrupt: &Interrupt) -> io::Result<Exit> {
    let plans = match select::plans(&options.select) {
        Ok(plans) => plans,
        Err(exit) => return Ok(exit),
    };
    if options.require_gates
        && plans
            .iter()
            .all(|plan| plan.resolved().scenario.gates.is_empty())
    {
        output::talk("error: --require-gates: no selected scenario has a gate; nothing was run");
        return Ok(Exit::GateFailed);
    }
    let suite = SuiteOptions {
        threads: usize::from(options.jobs),
        force: options.force,
        resume: resume(options.resume),
        ..SuiteOptions::new(options.output.clone())
    };
    let beside = Against::read(options, &plans)
        .and_then(|against| Ok((against, ServerFiles::check(options, &plans)?)));
    let (against, server) = match beside {
        Ok(beside) => beside,
        Err(exit) => return Ok(exit),
    };
    let progress = Progress::new(&plans, options, (against, server), interrupt);
    if let Some(text) = senseless_threads(options) {
        output::talk(&format!(
            "warning: RAYON_NUM_THREADS = `{}` is no number of threads: one per core",
            bounded(&text)
        ));
    }
    interrupt.defer();
    let result = run_suite(&plans, &suite, &progress);
    Ok(progress.conclude(&result))
}

/// What the variable for the number of threads says in vain; none if it is not asked, or a number.
fn senseless_threads(options: &RunOptions) -> Option<String> {
    let text = std::env::var("RAYON_NUM_THREADS").ok()?;
    let is_idle = options.jobs > 0 || text.is_empty() || text.parse::<usize>().is_ok();
    (!is_idle).then_some(text)
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
///
/// * `is_cut_short`: whether runs were left out because another one had failed.
fn exit_of(suite: &SuiteOutcome, is_cut_short: bool) -> Exit {
    if suite.broken {
        return Exit::Internal;
    }
    if suite.unwritten || !suite.failures.is_empty() {
        return Exit::Io;
    }
    let counts = |run: &&RunOutcome| !(is_cut_short && run.is_not_run);
    match suite
        .runs
        .iter()
        .filter(counts)
        .map(RunOutcome::status)
        .max()
    {
        None | Some(RunStatus::Pass) => Exit::Success,
        Some(RunStatus::GateFailed) => Exit::GateFailed,
        Some(RunStatus::ChannelFailed | RunStatus::NotRun | RunStatus::RunFailed) => {
            Exit::RunFailed
        }
    }
}

/// What to do after a signal.
fn interrupted(suite: &SuiteOutcome) -> String {
    let runs = suite.runs.iter();
    let finished = runs.filter(|run| !run.is_not_run).count();
    format!(
        "interrupted: {finished} of {} runs finished; the same command with --resume goes on",
        suite.runs.len()
    )
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
struct Progress<'a> {
    bar: ProgressBar,
    options: &'a RunOptions,
    against: Against<'a>,
    server: ServerFiles<'a>,
    interrupt: &'a Interrupt,
    pending: Mutex<Pending>,
    /// Whether a run has failed.
    has_failed: AtomicBool,
}

/// Texts that wait for their turn.
struct Pending {
    next: usize,
    texts: BTreeMap<usize, String>,
    failure: Option<io::Error>,
}

impl<'a> Progress<'a> {
    fn new(
        plans: &[Plan],
        options: &'a RunOptions,
        (against, server): (Against<'a>, ServerFiles<'a>),
        interrupt: &'a Interrupt,
    ) -> Self {
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
            options,
            against,
            server,
            interrupt,
            pending: Mutex::new(pending),
            has_failed: AtomicBool::new(false),
        }
    }

    /// Says how the suite ended and gives its exit code.
    fn conclude(&self, result: &Result<SuiteOutcome, SuiteError>) -> Exit {
        let was_interrupted = self.interrupt.exit().is_some();
        let exit = match result {
            Ok(suite) => {
                // First of all, as the reader of the data may have stalled.
                if was_interrupted {
                    self.talk(&interrupted(suite));
                }
                let printed = self.print_rest(&closing(suite, self.options.format));
                self.talk_of(suite);
                let unprinted = printed.err().map(io_failure);
                let compared = self.beside_bar(|| self.against.compare(suite));
                let served = self.beside_bar(|| self.server.write(suite, &compared.markdown));
                let exit = exit_of(suite, self.is_cut_short());
                let exit = exit.worst(compared.exit).worst(served);
                exit.worst(unprinted.unwrap_or(Exit::Success))
            }
            Err(error) => {
                self.talk(&format!("error: {error}"));
                match error {
                    SuiteError::Store(error) => place::exit_of(error),
                    SuiteError::Unwritten { .. } | SuiteError::Threads { .. } => Exit::Io,
                }
            }
        };
        self.bar.finish_and_clear();
        let signal = self.interrupt.exit();
        exit.worst(signal.unwrap_or(Exit::Success))
    }

    /// Whether a run has failed and no other is to start.
    fn is_cut_short(&self) -> bool {
        self.options.fail_fast && self.has_failed.load(Ordering::Relaxed)
    }

    fn talk_of(&self, suite: &SuiteOutcome) {
        let left = suite.runs.iter().filter(|run| run.is_not_run).count();
        if self.is_cut_short() && left > 0 {
            self.talk(&format!(
                "--fail-fast: {left} of {} not started after the first failure",
                counted(suite.runs.len(), "run")
            ));
        }
        for failure in &suite.failures {
            self.talk(&format!("error: {failure}"));
        }
        let asked = thread_count(usize::from(self.options.jobs));
        if suite.threads < asked {
            self.talk(&format!(
                "warning: the system gave {} of {asked} threads",
                suite.threads
            ));
        }
        self.talk(&format!("results in {}", self.options.output.display()));
    }

    fn text(&self, run: &RunReport) -> String {
        match self.options.format {
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
        let mut pending = self.pending();
        pending.texts.insert(index, text);
        let mut ready = String::new();
        let mut next = pending.next;
        while let Some(text) = pending.texts.remove(&next) {
            ready.push_str(&text);
            next += 1;
        }
        pending.next = next;
        self.print(&mut pending, &ready);
    }

    /// Prints the texts that still wait for a run that has not ended, then `closing`.
    fn print_rest(&self, closing: &str) -> io::Result<()> {
        let mut pending = self.pending();
        let mut rest: String = std::mem::take(&mut pending.texts).into_values().collect();
        rest.push_str(closing);
        self.print(&mut pending, &rest);
        pending.failure.take().map_or(Ok(()), Err)
    }

    /// Prints, unless that has failed before.
    fn print(&self, pending: &mut Pending, text: &str) {
        if pending.failure.is_none() && !text.is_empty() {
            pending.failure = self.beside_bar(|| output::data(text)).err();
        }
    }

    fn talk(&self, line: &str) {
        self.beside_bar(|| output::talk(line));
    }

    /// Takes the bar off the terminal while `print` prints. One that is not drawn is left alone: it
    /// is locked meanwhile, and a reader that has stalled would hold up whoever moves it on.
    fn beside_bar<T>(&self, print: impl FnOnce() -> T) -> T {
        if self.bar.is_hidden() {
            print()
        } else {
            self.bar.suspend(print)
        }
    }

    fn pending(&self) -> MutexGuard<'_, Pending> {
        self.pending.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl experiment::Progress for Progress<'_> {
    fn advanced(&self, simulated_s: f64) {
        self.bar.inc(whole(simulated_s));
    }

    fn should_stop(&self) -> bool {
        self.interrupt.exit().is_some()
    }

    fn may_start(&self) -> bool {
        !self.is_cut_short()
    }
}

impl Observer for Progress<'_> {
    fn started(&self, index: usize) {
        self.server.started(index);
    }

    fn finished(&self, index: usize, report: &RunReport) {
        self.server.ended(index);
        let status = || RunOutcome::from_report(report, "").status();
        if self.options.fail_fast && status() != RunStatus::Pass {
            self.has_failed.store(true, Ordering::Relaxed);
        }
        self.print_in_turn(index, self.text(report));
    }

    fn failed(&self, index: usize, outcome: &RunOutcome) {
        self.server.ended(index);
        self.has_failed.store(true, Ordering::Relaxed);
        let reason = outcome.error.as_deref().unwrap_or_default();
        self.talk(&format!("error: {}: {reason}", outcome.folder));
        self.print_in_turn(index, String::new());
    }

    /// Ends the program: what is still being computed is not waited for.
    fn abandoned(&self, result: &Result<SuiteOutcome, SuiteError>) {
        let exit = self.conclude(result);
        std::process::exit(i32::from(exit.number()));
    }

    fn taken_over(&self, index: usize, report: &RunReport) {
        let scenario = &report.scenario.name;
        let point = report.sweep.as_ref();
        let point = point.map_or_else(String::new, |(index, _)| format!("/{index:04}"));
        self.talk(&format!("{scenario}{point}: taken over"));
        self.finished(index, report);
    }

    fn caution(&self, message: &str) {
        self.talk(&format!("warning: {message}"));
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
