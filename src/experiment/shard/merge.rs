//! One output folder from the files of shards, as one unsharded suite would have written it.

use std::panic::{AssertUnwindSafe, catch_unwind};

use rayon::prelude::*;

use super::gather::Gathered;
use super::list::RunList;
use super::result::{FirstRepeat, UnitResult};
use crate::comparison::Layout;
use crate::experiment::plan::Plan;
use crate::experiment::run::{RecordLength, RepeatPool, notes, theory, verdicts};
use crate::experiment::suite::{
    Ledger, Observer, Resume, Suite, SuiteError, SuiteOptions, SuiteOutcome, SuiteOutput, conduct,
    enter_failure, enter_files, enter_report, enter_unwritten, failed, layout, panic_text, pool,
    report_of_plan, thread_count,
};
use crate::gyro::temperature_record;
use crate::report::RunReport;
use crate::signal::{Rates, RunSignals};
use crate::store::StoreError;

/// Writes what `run_suite` writes of some plans, from the results that shards of their list hold, and starts
/// nothing. A run of which a shard is missing counts as not run.
///
/// # Errors
/// As `run_suite`.
pub fn merge_shards(
    plans: &[Plan],
    list: &RunList,
    mut gathered: Gathered,
    options: &SuiteOptions,
    observer: &dyn Observer,
) -> Result<SuiteOutcome, SuiteError> {
    let layout = &layout(plans);
    let pool =
        pool(thread_count(options.threads)).map_err(|source| SuiteError::Threads { source })?;
    gathered.release(&options.output);
    let output = &SuiteOutput::open(plans, layout, options)?;
    for caution in output.cautions() {
        observer.caution(caution);
    }
    let ledger = &Ledger::new(plans.len());
    let suite = &Suite {
        output,
        resume: Resume::Never,
        earlier: options.earlier.as_ref(),
        ledger,
    };
    let merger = &Merger {
        plans,
        layout,
        suite,
        observer,
        gathered: &gathered,
        parts: parts(list, &gathered),
    };
    let work = || {
        let runs = (0..plans.len()).into_par_iter().with_max_len(1);
        runs.for_each(|run| merger.merge(run));
    };
    conduct((plans, layout), suite, &pool, observer, work)
}

/// Where the result of a part of a run stands: index of the file, first byte and length; none where its shard
/// is missing.
type Part = Option<(usize, (u64, usize))>;

/// The parts of each run, in the order of the list.
fn parts(list: &RunList, gathered: &Gathered) -> Vec<Vec<Part>> {
    let mut of_units: Vec<Part> = vec![None; list.len()];
    for (file, shard) in gathered.files.iter().enumerate() {
        for (head, at) in &shard.entries {
            of_units[head.unit] = Some((file, *at));
        }
    }
    let mut of_runs: Vec<Vec<Part>> = vec![Vec::new(); list.runs()];
    for (unit, part) in list.units.iter().zip(of_units) {
        of_runs[unit.run()].push(part);
    }
    of_runs
}

/// What the threads of a merge share.
struct Merger<'a> {
    plans: &'a [Plan],
    layout: &'a Layout<'a>,
    suite: &'a Suite<'a>,
    observer: &'a dyn Observer,
    gathered: &'a Gathered,
    parts: Vec<Vec<Part>>,
}

impl Merger<'_> {
    /// Enters a run; one of which a part is missing is left out.
    fn merge(&self, run: usize) {
        let parts: Option<Vec<_>> = self.parts[run].iter().copied().collect();
        let Some(parts) = parts.filter(|_| !self.observer.should_stop()) else {
            return;
        };
        let plan = &self.plans[run];
        let entered = catch_unwind(AssertUnwindSafe(|| self.enter(run, &parts)));
        let entered = entered.unwrap_or_else(|panic| {
            self.suite.ledger.note_broken();
            Ok(Some(panic_text(&*panic)))
        });
        match entered {
            Ok(None) => {}
            Ok(Some(reason)) => {
                let outcome = failed(plan, reason.clone());
                enter_failure((plan, run), &outcome, &reason, self.suite, self.observer);
            }
            Err(error) => enter_unwritten((plan, run), &error, self.suite, self.observer),
        }
    }

    /// Enters a run with a result; says why it has none, if it has none.
    fn enter(
        &self,
        run: usize,
        parts: &[(usize, (u64, usize))],
    ) -> Result<Option<String>, StoreError> {
        let plan = &self.plans[run];
        let (mut repeats, mut first) = (RepeatPool::default(), None);
        for (file, at) in parts {
            let entry = match self.gathered.files[*file].entry(*at) {
                Ok(entry) => entry,
                Err(damaged) => return Ok(Some(damaged.to_string())),
            };
            match entry.result {
                UnitResult::Failed(reason) => return Ok(Some(reason)),
                UnitResult::Files(files) => {
                    let (layout, suite) = (self.layout, self.suite);
                    let outcome = enter_files((plan, run), &files, layout, suite, self.observer)?;
                    return Ok(outcome.and_then(|outcome| outcome.error));
                }
                UnitResult::Repeats(part) => {
                    part.repeats.into_iter().for_each(|it| repeats.add(it));
                    first = first.or(part.first);
                }
            }
        }
        let Some(first) = first else {
            return Ok(Some("its shards do not hold the first repeat".to_owned()));
        };
        self.enter_repeats(run, repeats, &first)
    }

    /// Writes what comes of pooled repeats; says why nothing does.
    fn enter_repeats(
        &self,
        run: usize,
        repeats: RepeatPool,
        first: &FirstRepeat,
    ) -> Result<Option<String>, StoreError> {
        let plan = &self.plans[run];
        let Some((faults, channels)) = repeats.pooled() else {
            return Ok(Some("its shards hold no repeat".to_owned()));
        };
        let theory = match theory(&plan.resolved().scenario) {
            Ok(theory) => theory,
            Err(error) => return Ok(Some(error.to_string())),
        };
        let report = RunReport {
            theory: &theory,
            channels: &channels,
            verdicts: &verdicts(plan, &channels),
            notes: &notes(plan, faults, &first.notes),
            ..report_of_plan(plan)
        };
        let signals = signals(plan, first);
        let (layout, suite) = (self.layout, self.suite);
        self.observer.advanced(plan.simulated_s());
        enter_report((plan, run), &report, &signals, layout, suite, self.observer).map(|_| None)
    }
}

/// The samples of the first repeat, as a report shows them.
fn signals<'a>(plan: &'a Plan, first: &'a FirstRepeat) -> Vec<RunSignals<'a>> {
    let scenario = &plan.resolved().scenario;
    let sample_period_s = plan.sample_period_s();
    let end_s = scenario.warm_up_s + scenario.duration_s;
    let gyros = first.gyros.iter().zip(scenario.axis_prefixes());
    let signals = gyros.map(|(gyro, prefix)| {
        let channels = gyro.channels.iter();
        RunSignals {
            sample_period_s,
            first_measured: RecordLength::new(scenario, sample_period_s).warm_up,
            prefix,
            truth_deg_per_h: Rates::Words(&gyro.truth_deg_per_h),
            encoder_rad: first.encoder_rad.as_deref(),
            // Of samples that are written, which those of several repeats are not.
            input_digest: None,
            channels: channels
                .map(|(name, words)| (name.as_str(), words.as_slice()))
                .collect(),
            temperature: temperature_record(&scenario.gyro, scenario.warm_up_s, end_s),
        }
    });
    signals.collect()
}
