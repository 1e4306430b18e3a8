//! `fogbench merge`: one output folder of the parts that `run --shard` ran, judged as `run` judges.

use std::io;

use crate::cli::commands::run::{self, without_gates};
use crate::cli::commands::select;
use crate::cli::commands::shards::plan::select_options;
use crate::cli::commands::shards::status::refused;
use crate::cli::options::arguments::{RunOptions, SelectOptions};
use crate::cli::options::shard::{MergeOptions, ShardOptions};
use crate::cli::terminal::exit::Exit;
use crate::cli::terminal::output;
use crate::cli::terminal::signals::Interrupt;
use crate::experiment::{Gathered, RunList, merge_shards, ranges_text};

/// Gathers, checks, merges, prints and judges; starts no program.
pub(in crate::cli) fn merge(options: &MergeOptions, interrupt: &Interrupt) -> io::Result<Exit> {
    let gathered = match Gathered::of(&options.folders) {
        Ok(gathered) => gathered,
        Err(error) => return Ok(refused(error)),
    };
    let missing = gathered.missing();
    if !missing.is_empty() {
        let text = format!(
            "{} of {} shards are missing: {}",
            missing.len(),
            gathered.head().count,
            ranges_text(&missing)
        );
        if !options.partial {
            output::talk(&format!(
                "error: {text}: run them, as with --array={}, or merge what there is with --partial",
                ranges_text(&missing)
            ));
            return Ok(Exit::Usage);
        }
        output::talk(&format!(
            "warning: partial: {text}; their runs count as not run"
        ));
    }
    let as_run = as_run(options, select_options(&gathered.head().selected));
    let plans = match select::plans(&as_run.select) {
        Ok(plans) => plans,
        Err(exit) => return Ok(exit),
    };
    let list = RunList::of(&plans);
    if let Err(error) = gathered.check(&list) {
        return Ok(refused(error));
    }
    if options.account.require_gates && without_gates(&plans) {
        return Ok(Exit::GateFailed);
    }
    run::conclude_by(&plans, &as_run, interrupt, None, |suite, observer| {
        merge_shards(&plans, &list, gathered, suite, observer)
    })
}

/// The options of a `run` that ends as the merge is to end.
fn as_run(options: &MergeOptions, select: SelectOptions) -> RunOptions {
    RunOptions {
        select,
        output: options.output.clone(),
        force: options.force,
        resume: None,
        allow_programs: false,
        fail_fast: false,
        shard: ShardOptions::default(),
        account: options.account.clone(),
    }
}
