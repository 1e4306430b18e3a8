//! Generated scenarios of values in range: every one that is accepted must run to a whole result.

use std::collections::BTreeMap;
use std::time::Instant;

use fogbench::experiment::Plan;
use fogbench::report::{RunOutcome, RunStatus};

use super::case::{Complaint, Fault, Ran, Refusal, Workshop, accept};
use super::draft::{Draft, Line};
use super::generator::Generator;
use super::invariants::{self, json, same};
use super::schema::{self, Child, Table};
use super::setting;
use super::tally::Tally;
use super::values::{quoted, toml};
use super::watchdog::Watchdog;
use crate::support::seeded::{Draws, case_seed};
use crate::support::{code, fogbench, stderr};

/// Seed of the small form.
const SEED: u64 = 20_221_105;
/// Scenarios that run in the small form.
const SMALL: u64 = 60;
/// Least share of the drawn scenarios that must run, in per cent.
const SHARE_MIN: u64 = 50;

#[test]
fn every_accepted_scenario_runs_to_a_whole_result() {
    invariants::watch_panics();
    let schema = schema::root();
    let watchdog = Watchdog::start();
    let mut tally = Tally::default();
    if let Ok(seed) = std::env::var("FOGBENCH_CASE") {
        let seed = seed.parse().expect("FOGBENCH_CASE is a seed");
        watchdog.feed(format!("FOGBENCH_CASE={seed}"));
        one(seed, &schema, &mut tally);
    } else {
        let campaign_seed = setting("FOGBENCH_SEED", SEED);
        let wanted = setting("FOGBENCH_SCENARIOS", SMALL);
        let mut index = 0;
        while tally.get("ran") < wanted {
            let seed = case_seed(campaign_seed, index);
            index += 1;
            watchdog.feed(format!("FOGBENCH_CASE={seed}"));
            one(seed, &schema, &mut tally);
            if index % 5000 == 0 {
                println!("after {index} cases:\n{}", tally.report());
            }
        }
        unseen(&schema, &mut tally);
    }
    println!("{}", tally.report());
    assert!(tally.is_clean(), "faults:\n{}", tally.report());
    let (ran, drawn) = (tally.get("ran"), tally.get("drawn"));
    assert!(ran * 100 >= drawn * SHARE_MIN, "{ran} of {drawn} ran");
}

/// Counts the keys that stood in no scenario that ran.
fn unseen(schema: &Table, tally: &mut Tally) {
    for path in schema::leaves(schema).keys() {
        if tally.has_key(path) {
            tally.count("keys that stood in a run");
        } else {
            tally.count(format!("key in no run: {path}"));
        }
    }
}

/// Draws, mends, runs and checks the case of a seed.
fn one(seed: u64, schema: &Table, tally: &mut Tally) {
    let started = Instant::now();
    let workshop = Workshop::new();
    let mut draws = Draws::new(seed);
    let (mut draft, setting) = Generator::new(&mut draws, schema).scenario();
    tally.count("drawn");
    let plans = match accept(&workshop, &mut draft, &mut draws, setting, schema) {
        Ok(plans) => plans,
        Err(Refusal::Refused(message)) => {
            if tally.get("refused") < 5 {
                println!("refused, FOGBENCH_CASE={seed}: {message}");
            }
            return tally.count("refused");
        }
        Err(Refusal::TooLong) => return tally.count("too long"),
        Err(Refusal::Broken(fault)) => {
            return tally.fault("scenario", seed, &fault, &draft.render().0);
        }
    };
    tally.count("ran");
    let kind = if draws.chance(PROGRAM) {
        Extra::Program
    } else {
        *draws.pick(&KINDS)
    };
    describe(&draft, &plans, schema, tally);
    match examine(&workshop, &draft, &plans, kind, &mut draws, tally) {
        Ok(()) => {}
        Err(fault) => {
            let shown = if tally.is_new(&fault) {
                shrink(&draft, &fault, kind)
            } else {
                draft.clone()
            };
            tally.fault("scenario", seed, &fault, &shown.render().0);
        }
    }
    if started.elapsed().as_secs() >= 5 {
        tally.count(format!(
            "slow: {} s, seed {seed}",
            started.elapsed().as_secs()
        ));
    }
}

/// What is done with a scenario beside running it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Extra {
    Nothing,
    /// The manifest of every run gives its folder again.
    Manifest,
    /// Two threads write what one writes.
    Threads,
    /// A second run into the same output leaves the same files.
    Again,
    /// Gates at both sides of a measured value.
    Gates,
    /// The program itself writes the same files and ends with the code of the verdict.
    Program,
}

/// Share of the cases that the program runs: a process takes as long as a case.
const PROGRAM: f64 = 0.02;

const KINDS: [Extra; 8] = [
    Extra::Nothing,
    Extra::Nothing,
    Extra::Nothing,
    Extra::Nothing,
    Extra::Manifest,
    Extra::Threads,
    Extra::Again,
    Extra::Gates,
];

fn examine(
    workshop: &Workshop,
    draft: &Draft,
    plans: &[Plan],
    kind: Extra,
    draws: &mut Draws,
    tally: &mut Tally,
) -> Result<(), Fault> {
    let ran = workshop.run(plans, "out", 1)?;
    for run in &ran.outcome.runs {
        tally.count(format!("status {}", run.status().as_str()));
    }
    tally.count(format!("kind {kind:?}"));
    match kind {
        Extra::Nothing => Ok(()),
        Extra::Manifest => manifests(workshop, &ran),
        Extra::Threads => {
            let two = workshop.run(plans, "two", 2)?;
            same("threads", &ran.output, &two.output)
        }
        Extra::Again => {
            workshop.run(plans, "again", 1)?;
            let again = workshop.run(plans, "again", 1)?;
            same("again", &ran.output, &again.output)
        }
        Extra::Gates => gates(workshop, draft, &ran, draws, tally),
        Extra::Program => program(workshop, &ran),
    }
}

/// Runs the program on the file; the same bytes, and the exit code of the worst run.
fn program(workshop: &Workshop, ran: &Ran) -> Result<(), Fault> {
    let output = fogbench(workshop.path(), &["run", "case.toml", "-o", "program"]);
    let worst = ran.outcome.runs.iter().map(RunOutcome::status).max();
    let expected = match worst {
        None | Some(RunStatus::Pass) => 0,
        Some(RunStatus::GateFailed) => 1,
        Some(RunStatus::ChannelFailed | RunStatus::RunFailed | RunStatus::NotRun) => 3,
    };
    if code(&output) != expected {
        let message = format!(
            "{}, expected {expected}: {}",
            code(&output),
            stderr(&output)
        );
        return Err(Fault::new("wrong exit code", message));
    }
    same("program", &ran.output, &workshop.path().join("program"))
}

/// Runs the manifest of every run; its folder must hold the same bytes.
fn manifests(workshop: &Workshop, ran: &Ran) -> Result<(), Fault> {
    for run in &ran.outcome.runs {
        let folder = ran.output.join(&run.folder);
        if run.status() == RunStatus::RunFailed {
            continue;
        }
        let plans = match workshop.plan_file(&folder.join("manifest.toml")) {
            Ok(plans) => plans,
            Err(Complaint::Broken(fault)) => return Err(fault),
            Err(Complaint::Errors(errors)) => {
                let message = errors[0].to_string();
                return Err(Fault::new("manifest refused", message));
            }
        };
        let repeated = workshop.run(&plans, "repeated", 1)?;
        same("manifest", &folder, &repeated.output.join(&run.folder))?;
    }
    Ok(())
}

/// A gate that a measured value must fail, or one that it must pass.
fn gates(
    workshop: &Workshop,
    draft: &Draft,
    ran: &Ran,
    draws: &mut Draws,
    tally: &mut Tally,
) -> Result<(), Fault> {
    let run = &ran.outcome.runs[0];
    if run.status() == RunStatus::RunFailed || ran.outcome.runs.len() > 1 {
        return Ok(());
    }
    let summary = json(&ran.output.join(&run.folder).join("summary.json"))?;
    let mut measured: Vec<(String, f64)> = Vec::new();
    for (channel, metrics) in summary["channels"].as_object().into_iter().flatten() {
        for (name, metric) in metrics.as_object().into_iter().flatten() {
            if let Some(value) = metric["value"].as_f64() {
                measured.push((format!("{channel}.{name}"), value));
            }
        }
    }
    if measured.is_empty() {
        return Ok(());
    }
    let (metric, value) = draws.pick(&measured).clone();
    let must_fail = draws.chance(0.5);
    // Far enough from it that no rounding on the way makes a difference.
    let margin = 1e-3 * (value.abs() + 1.0);
    let limit = if must_fail {
        value - margin
    } else {
        value + margin
    };
    let mut gated = draft.clone();
    let index = gated.names("gate").len() + 1000;
    let keys = [
        ("metric", quoted(&metric)),
        ("max", toml(limit)),
        ("decide", quoted("value")),
    ];
    for (key, value) in keys {
        gated.lines.push(Line {
            schema_path: format!("gate[].{key}"),
            element: Some(("gate".to_owned(), index)),
            key: key.to_owned(),
            value,
            part: "gate".to_owned(),
            stem: None,
            is_needed: true,
            blamed: 0,
        });
    }
    let Ok(plans) = workshop.plan(&gated) else {
        tally.count("gate refused");
        return Ok(());
    };
    let judged = workshop.run(&plans, "gated", 1)?;
    let verdicts = &judged.outcome.runs[0].verdicts;
    let accepted = verdicts.last().map(|verdict| verdict.accepted);
    tally.count(format!("gate accepted: {accepted:?}"));
    if accepted == Some(!must_fail) {
        Ok(())
    } else {
        let message = format!(
            "{metric} = {value:?}, max = {limit:?}: {:?}",
            verdicts.last()
        );
        Err(Fault::new("wrong verdict", message))
    }
}

/// Counts what a scenario that runs is made of.
fn describe(draft: &Draft, plans: &[Plan], schema: &Table, tally: &mut Tally) {
    for line in &draft.lines {
        tally.key(&line.schema_path);
    }
    let fidelity = draft.value("fidelity").unwrap_or("swept");
    tally.count(format!("fidelity {fidelity}"));
    tally.count(format!(
        "points {}",
        if plans.len() > 1 { "several" } else { "one" }
    ));
    let mut alternatives = BTreeMap::new();
    alternatives_of(schema, "", &mut alternatives);
    for (path, label) in alternatives {
        let inner = format!("{path}.");
        let is_in = |line: &&Line| line.schema_path == path || line.schema_path.starts_with(&inner);
        if draft.lines.iter().any(|line| is_in(&line)) {
            tally.count(label);
        }
    }
}

/// Schema path of every alternative, and how it is counted.
fn alternatives_of(table: &Table, path: &str, found: &mut BTreeMap<String, String>) {
    let names = table.choices.iter().flat_map(|choice| &choice.names);
    for name in names {
        found.insert(schema::join(path, name), format!("{path}: {name}"));
    }
    for (name, child) in &table.children {
        let below = schema::join(path, name);
        match child {
            Child::Table(inner) => alternatives_of(inner, &below, found),
            Child::Tables(inner) => alternatives_of(inner, &format!("{below}[]"), found),
            Child::Leaf(_) => {}
        }
    }
}

/// Takes away every key without which the fault is still there.
fn shrink(draft: &Draft, fault: &Fault, kind: Extra) -> Draft {
    let mut smallest = draft.clone();
    let started = Instant::now();
    let mut index = smallest.lines.len();
    while index > 0 && started.elapsed().as_secs() < 20 {
        index -= 1;
        if index >= smallest.lines.len() || !smallest.may_change(index) {
            continue;
        }
        let mut smaller = smallest.clone();
        smaller.remove(index);
        let workshop = Workshop::new();
        let Ok(plans) = workshop.plan(&smaller) else {
            continue;
        };
        let mut draws = Draws::new(0);
        let mut tally = Tally::default();
        let again = examine(&workshop, &smaller, &plans, kind, &mut draws, &mut tally);
        if again.is_err_and(|again| again.key == fault.key) {
            smallest = smaller;
        }
    }
    smallest
}
