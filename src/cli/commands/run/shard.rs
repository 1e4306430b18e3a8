//! `fogbench run --shard`: one part of a suite, into a file of its own; `merge` judges.

use std::io;
use std::path::Path;

use super::{programs, warn_of_threads};
use crate::cli::commands::select;
use crate::cli::commands::shards::plan::{select_options, selected};
use crate::cli::options::arguments::RunOptions;
use crate::cli::terminal::exit::{Exit, io_failure};
use crate::cli::terminal::signals::Interrupt;
use crate::cli::terminal::{output, place};
use crate::experiment::{
    self, Listing, PlanFile, ShardError, ShardHead, ShardObserver, ShardOptions, ShardOutcome,
    run_shard,
};
use crate::program::Programs;
use crate::store::ProgramLog;
use crate::wording::printable;

/// Runs the part that is asked for, or goes on with it.
pub(super) fn run(options: &RunOptions, interrupt: &Interrupt) -> io::Result<Exit> {
    // Preemption may come at any moment, and nothing is lost by it.
    interrupt.defer_shard();
    let (Listing { plans, list, .. }, head) = match asked(options) {
        Ok(asked) => asked,
        Err(exit) => return Ok(exit),
    };
    let programs = match programs(plans.values(), options) {
        Ok(programs) => programs,
        Err(exit) => return Ok(exit),
    };
    warn_of_threads(options);
    let watch = Watch {
        options,
        interrupt,
        programs,
        program_log: ProgramLog::of(&options.output),
        name: format!("shard {} of {}", head.index, head.count),
    };
    let shard = ShardOptions {
        output: options.output.clone(),
        threads: usize::from(options.account.jobs),
        force: options.force,
    };
    Ok(match run_shard(&plans, &list, &head, &shard, &watch) {
        Ok(outcome) => watch.conclude(&outcome),
        Err(error) => {
            output::talk(&format!("error: {error}"));
            let exit = match &error {
                ShardError::Store(error) => place::exit_of(error),
                _ => Exit::Io,
            };
            exit.worst(interrupt.exit().unwrap_or(exit))
        }
    })
}

/// What is asked for: the list of what there is to run with the plans of the part, and which part it is. Without
/// a plan file all plans are kept, as it is not known before the end which run goes to which part.
///
/// A refusal is printed before its exit code is returned.
fn asked(options: &RunOptions) -> Result<(Listing, ShardHead), Exit> {
    let file = options.shard.plan.as_deref().map(plan_file).transpose()?;
    let planned = file.as_ref().map(|file| file.shards);
    let numbers = options
        .shard
        .numbers(planned, &|name| std::env::var(name).ok());
    let numbers = numbers.map_err(|error| {
        output::talk(&format!("error: {error}; nothing was run"));
        Exit::Usage
    })?;
    let selected = match &file {
        Some(file) => file.selected.clone(),
        None => selected(&options.select),
    };
    let own = file.as_ref().map(|file| file.folders_of(numbers.0));
    let is_kept = |folder: &str| own.as_ref().is_none_or(|own| own.contains(folder));
    let listing = select::listing(&select_options(&selected), &is_kept, false)?;
    if let (Some(file), Some(path)) = (&file, &options.shard.plan)
        && let Err(error) = file.check(&listing.list)
    {
        output::talk(&format!(
            "error: {}: {error}; nothing was run",
            path.display()
        ));
        return Err(Exit::Usage);
    }
    let head = ShardHead::new(&listing.list, numbers, selected);
    Ok((listing, head))
}

fn plan_file(path: &Path) -> Result<PlanFile, Exit> {
    let text = std::fs::read_to_string(path).map_err(|error| {
        io_failure(io::Error::new(
            error.kind(),
            format!("{}: {error}; nothing was run", path.display()),
        ))
    })?;
    PlanFile::read(text).map_err(|error| {
        output::talk(&format!(
            "error: {}: {error}; nothing was run",
            path.display()
        ));
        Exit::Usage
    })
}

/// Tells of a shard on stderr.
struct Watch<'a> {
    options: &'a RunOptions,
    interrupt: &'a Interrupt,
    programs: Option<Programs>,
    program_log: ProgramLog,
    name: String,
}

impl Watch<'_> {
    /// Says how the shard ended and gives its exit code.
    fn conclude(&self, outcome: &ShardOutcome) -> Exit {
        let ShardOutcome {
            done,
            units,
            taken_over,
            ..
        } = outcome;
        let name = &self.name;
        for failure in &outcome.failures {
            output::talk(&format!("error: {failure}"));
        }
        let before = match taken_over {
            0 => String::new(),
            _ => format!(", {taken_over} of them before"),
        };
        if !outcome.is_complete() {
            output::talk(&format!(
                "{name}: {done} of {units} done{before}; the same command goes on"
            ));
            let exit = if outcome.broken {
                Exit::Internal
            } else if !outcome.failures.is_empty() {
                Exit::Io
            } else {
                // Stopped, as nothing else leaves something undone.
                Exit::Continues
            };
            return exit.worst(self.interrupt.exit().unwrap_or(exit));
        }
        if !self.options.account.quiet {
            output::talk(&format!(
                "{name}: {done} of {units} done{before}, in {}",
                outcome.place.display()
            ));
        }
        if outcome.has_failed {
            output::talk(&format!(
                "{name}: a run or a channel failed; `merge` says which"
            ));
            Exit::RunFailed
        } else {
            Exit::Success
        }
    }
}

impl experiment::Progress for Watch<'_> {
    fn should_stop(&self) -> bool {
        self.interrupt.exit().is_some()
    }

    fn programs(&self) -> Option<&Programs> {
        self.programs.as_ref()
    }

    fn program_said(&self, run: &str, channel: &str, line: &str) {
        let line = format!("{run} {channel}: {}", printable(line));
        self.program_log.said(&line);
        output::talk(&line);
    }

    fn program_took(&self, run: &str, channel: &str, us_per_word: f64) {
        self.program_log.took(run, channel, us_per_word);
    }
}

impl ShardObserver for Watch<'_> {
    fn unit_done(&self, folder: &str, done: usize, units: usize) {
        if !self.options.account.quiet {
            output::talk(&format!("{}: {done} of {units} done: {folder}", self.name));
        }
    }

    fn caution(&self, message: &str) {
        output::talk(&format!("warning: {message}"));
    }

    /// Ends the program: what is still being computed is not waited for.
    fn abandoned(&self, outcome: &ShardOutcome) {
        std::process::exit(i32::from(self.conclude(outcome).number()));
    }
}
