//! How far a suite is: progress on stderr, results on stdout in the order of the plan.

use std::io::{self, IsTerminal};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use indicatif::{ProgressBar, ProgressStyle};

use super::account::Account;
use super::against::Compared;
use super::clock::SuiteClock;
use super::server_files::ServerFiles;
use crate::cli::options::arguments::RunOptions;
use crate::cli::options::format::Format;
use crate::cli::terminal::exit::{Exit, io_failure};
use crate::cli::terminal::output;
use crate::cli::terminal::place;
use crate::cli::terminal::signals::Interrupt;
use crate::experiment::{self, Observer, Plan, SuiteError, SuiteOutcome, thread_count};
use crate::program::Programs;
use crate::report::{RunOutcome, RunReport, RunStatus};
use crate::store::ProgramLog;
use crate::wording::{counted, printable};

/// Progress on stderr, results on stdout in the order of the plan.
pub(super) struct Progress<'a> {
    bar: ProgressBar,
    clock: SuiteClock,
    options: &'a RunOptions,
    server: ServerFiles<'a>,
    interrupt: &'a Interrupt,
    pending: Mutex<Pending>,
    /// Whether a run has failed.
    has_failed: AtomicBool,
    /// The right to start programs, if the user gave it.
    programs: Option<Programs>,
    /// What they say.
    program_log: ProgramLog,
}

/// Texts that wait for their turn.
struct Pending {
    account: Account,
    failure: Option<io::Error>,
}

impl<'a> Progress<'a> {
    pub(super) fn new(
        plans: &[Plan],
        options: &'a RunOptions,
        server: ServerFiles<'a>,
        interrupt: &'a Interrupt,
    ) -> Self {
        let total_s: f64 = plans.iter().map(Plan::simulated_s).sum();
        let bar = if io::stderr().is_terminal() && !options.account.quiet {
            ProgressBar::new(whole(total_s))
        } else {
            ProgressBar::hidden()
        };
        let style = "{spinner} {bar:40} {percent:>3} % of {len} s of gyro time, {eta} to go";
        if let Ok(style) = ProgressStyle::with_template(style) {
            bar.set_style(style);
        }
        let pending = Pending {
            account: Account::new(plans, options),
            failure: None,
        };
        let folders = plans.iter().map(|plan| plan.resolved().folder());
        Self {
            bar,
            clock: SuiteClock::start(folders.collect(), total_s),
            options,
            server,
            interrupt,
            pending: Mutex::new(pending),
            has_failed: AtomicBool::new(false),
            programs: None,
            program_log: ProgramLog::of(&options.output),
        }
    }

    /// With the right to start programs, where there is one.
    pub(super) fn starting(self, programs: Option<Programs>) -> Self {
        Self { programs, ..self }
    }

    /// Says how the suite ended and gives its exit code.
    pub(super) fn conclude(&self, result: &Result<SuiteOutcome, SuiteError>) -> Exit {
        let was_interrupted = self.interrupt.exit().is_some();
        let exit = match result {
            Ok(suite) => {
                // First of all, as the reader of the data may have stalled.
                if was_interrupted {
                    self.talk(&interrupted(suite));
                }
                let printed = self.print_rest(suite);
                self.talk_of(suite);
                let unprinted = printed.err().map(io_failure);
                let compared = self.beside_bar(|| Compared::print(suite, self.options));
                let times = self.clock.times();
                let comparison = &compared.markdown;
                let served = self.beside_bar(|| self.server.write(suite, &times, comparison));
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
        let asked = thread_count(usize::from(self.options.account.jobs));
        if suite.threads < asked {
            self.talk(&format!(
                "warning: the system gave {} of {asked} threads",
                suite.threads
            ));
        }
        if !self.options.account.quiet {
            let runs = counted(suite.runs.len(), "run");
            self.talk(&format!("{runs} in {}", self.clock.total()));
            self.talk(&format!("results in {}", self.options.output.display()));
        }
    }

    /// Takes in what has ended and prints every text whose turn has come.
    fn take_in(&self, index: usize, enter: impl FnOnce(&mut Account)) {
        self.clock.ended(index);
        let mut pending = self.pending();
        enter(&mut pending.account);
        let text = pending.account.ready(|runs| self.seconds(runs));
        self.print(&mut pending, &text);
        drop(pending);
        self.beat();
    }

    /// How long some runs took, for the end of their line on a terminal: elsewhere the same runs give the
    /// same bytes.
    fn seconds(&self, runs: Range<usize>) -> String {
        let duration = self.clock.duration(runs);
        let duration = duration.filter(|_| io::stdout().is_terminal());
        duration.map_or_else(String::new, |time| format!("{:.1} s", time.as_secs_f64()))
    }

    /// Says now and then how far the suite is, where no bar does.
    fn beat(&self) {
        if self.options.account.quiet || !self.bar.is_hidden() {
            return;
        }
        if let Some(line) = self.clock.beat() {
            output::talk(&line);
        }
    }

    /// Prints what still waits for a run that has not ended, then the end of the suite.
    fn print_rest(&self, suite: &SuiteOutcome) -> io::Result<()> {
        let mut pending = self.pending();
        let mut text = pending.account.rest();
        let annotations = self.server.annotations(suite);
        if self.options.account.format == Format::Text {
            text.push_str(&annotations);
        } else {
            annotations.lines().for_each(|line| self.talk(line));
        }
        text.push_str(&pending.account.closing(suite));
        self.print(&mut pending, &text);
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
        self.clock.advanced(simulated_s);
        self.beat();
    }

    fn should_stop(&self) -> bool {
        self.interrupt.exit().is_some()
    }

    fn may_start(&self) -> bool {
        !self.is_cut_short()
    }

    fn programs(&self) -> Option<&Programs> {
        self.programs.as_ref()
    }

    fn program_said(&self, run: &str, channel: &str, line: &str) {
        let line = format!("{run} {channel}: {}", printable(line));
        self.program_log.said(&line);
        self.talk(&line);
    }

    fn program_took(&self, run: &str, channel: &str, us_per_word: f64) {
        self.program_log.took(run, channel, us_per_word);
    }
}

impl Observer for Progress<'_> {
    fn started(&self, index: usize) {
        self.clock.started(index);
    }

    fn finished(&self, index: usize, report: &RunReport) {
        if report.status() != RunStatus::Pass {
            self.has_failed.store(true, Ordering::Relaxed);
        }
        self.take_in(index, |account| account.finished(index, report));
    }

    fn failed(&self, index: usize, outcome: &RunOutcome) {
        self.has_failed.store(true, Ordering::Relaxed);
        let reason = outcome.error.as_deref().unwrap_or_default();
        self.talk(&format!("error: {}: {reason}", outcome.folder));
        self.take_in(index, |account| account.failed(index, outcome));
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
