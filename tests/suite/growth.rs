//! Time and memory of `check` and `plan` on long inputs, of `merge` on many repeats, and memory of the files of a
//! suite: held by their growth, which no slow machine changes.
#![cfg(target_os = "linux")]

use std::fmt::Write as _;
use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use fogbench::comparison::Comparison;
use fogbench::report::{RunOutcome, SuiteMetrics, SuiteReport, write_suite_summary};

use crate::support::write;

/// What a finished program took.
#[derive(Clone, Copy, Debug)]
struct Cost {
    /// Time of the processor, us.
    time_us: u64,
    /// Largest memory, kB.
    memory_kb: u64,
}

/// Runs `check` on a path and watches it.
fn cost_of_check(folder: &Path, path: &str) -> Cost {
    let mut program = Command::new(env!("CARGO_BIN_EXE_fogbench"));
    cost_of(program.args(["check", path]).current_dir(folder))
}

/// Runs a program and watches it.
fn cost_of(program: &mut Command) -> Cost {
    let mut child = program
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    let process = format!("/proc/{}", child.id());
    let mut memory_kb = 0;
    // It is not waited for before it has been asked: what has ended still tells its time. `check`
    // works in one thread, whose time the scheduler counts in ns; the ticks of the whole process are
    // too coarse for the short runs.
    let time_us = loop {
        let status = fs::read_to_string(format!("{process}/status")).expect("it is there");
        let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let peak = peak.and_then(|rest| rest.split_whitespace().next()?.parse().ok());
        memory_kb = peak.unwrap_or(0).max(memory_kb);
        let stat = fs::read_to_string(format!("{process}/stat")).expect("it is there");
        let (_, fields) = stat.rsplit_once(')').expect("the name ends with a bracket");
        let fields: Vec<&str> = fields.split_whitespace().collect();
        if fields[0] == "Z" {
            let times = fs::read_to_string(format!("{process}/schedstat")).expect("it is there");
            let time_ns = times.split_whitespace().next().expect("three fields");
            break time_ns.parse::<u64>().expect("a number") / 1000;
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    child.wait().expect("it has ended");
    Cost { time_us, memory_kb }
}

/// The least cost of a few runs: what else the machine does only adds.
fn least_cost(folder: &Path, path: &str, runs: usize) -> Cost {
    let costs = (0..runs).map(|_| cost_of_check(folder, path));
    let least = costs.reduce(|one, other| Cost {
        time_us: one.time_us.min(other.time_us),
        memory_kb: one.memory_kb.min(other.memory_kb),
    });
    least.expect("at least one run")
}

/// Asserts that ten times as much takes up to 13 times the time and 10 times the memory.
///
/// Whatever else the machine does only adds to the time of a run, and to that of the short one by the
/// same part: both are run in turn until the least times of both are within the bound, or so often
/// that they would be.
#[track_caller]
fn assert_growth(folder: &Path, small_path: &str, large_path: &str) {
    const MEMORY_KB_MAX: u64 = 300_000;
    const ROUNDS_MAX: usize = 8;
    let (mut small, mut large) = (Vec::new(), Vec::new());
    let least = |costs: &[Cost], of: fn(&Cost) -> u64| costs.iter().map(of).min().expect("a run");
    let ratio = loop {
        small.push(least_cost(folder, small_path, 3));
        large.push(cost_of_check(folder, large_path));
        let time = |costs: &[Cost]| least(costs, |cost| cost.time_us);
        let ratio = time(&large) as f64 / time(&small) as f64;
        if ratio <= 13.0 || small.len() == ROUNDS_MAX {
            break ratio;
        }
    };
    assert!(ratio <= 13.0, "{ratio:.1} times: {small:?}, {large:?}");
    let memory = |costs: &[Cost]| least(costs, |cost| cost.memory_kb);
    assert!(
        memory(&large) <= (10 * memory(&small)).min(MEMORY_KB_MAX),
        "{small:?}, {large:?}"
    );
}

/// A sweep of so many points over a gyro with filters and gates.
fn sweep(points: usize) -> String {
    let mut text = "schema = 1\nname = \"m\"\nduration_s = 20.0\n".to_owned();
    for index in 0..4 {
        let _ = write!(
            text,
            "[[filter]]\nname = \"f{index}\"\n[filter.rls]\ntaps = {}\n",
            4 + index
        );
        let _ = write!(
            text,
            "[[gate]]\nmetric = \"f{index}.mean_deg_per_h\"\nmax = 100.0\n"
        );
    }
    let powers: Vec<String> = (0..points / 10)
        .map(|index| format!("{:?}", 1.0 + 1e-4 * index as f64))
        .collect();
    let _ = write!(
        text,
        "[matrix]\nseed = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]\n\"gyro.source.power_uw\" = [{}]\n",
        powers.join(", ")
    );
    text
}

#[test]
fn points_of_a_sweep_cost_as_much_as_their_number() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "small.toml", &sweep(1000));
    write(folder.path(), "large.toml", &sweep(10_000));
    assert_growth(folder.path(), "small.toml", "large.toml");
}

/// Largest memory of the program with some arguments, kB.
fn memory_kb(folder: &Path, arguments: &[&str]) -> u64 {
    let mut program = Command::new(env!("CARGO_BIN_EXE_fogbench"));
    cost_of(program.args(arguments).current_dir(folder)).memory_kb
}

#[test]
fn a_plan_takes_300_bytes_for_a_run() {
    const POINTS: usize = 1000;
    let folder = tempfile::tempdir().expect("a scratch folder");
    let seeds: Vec<String> = (0..POINTS).map(|seed| seed.to_string()).collect();
    for (name, files) in [("small", 2), ("large", 20)] {
        for index in 0..files {
            let text = format!(
                "schema = 1\nname = \"s{index}\"\nduration_s = 0.1\nfidelity = \"rate\"\n\
                 [matrix]\nseed = [{}]\n",
                seeds.join(", ")
            );
            write(folder.path(), &format!("{name}/s{index}.toml"), &text);
        }
    }
    let of = |name| {
        memory_kb(
            folder.path(),
            &["plan", name, "-o", &format!("{name}.plan")],
        )
    };
    let (small_kb, large_kb) = (of("small"), of("large"));
    let runs = |name: &str| {
        let plan = fs::read_to_string(folder.path().join(format!("{name}.plan")));
        let plan = plan.expect("a plan");
        plan.lines().filter(|line| line.ends_with("\tall")).count()
    };
    let more = runs("large") - runs("small");
    assert_eq!(more, 18 * POINTS);
    let bytes = large_kb.saturating_sub(small_kb) * 1024 / more as u64;
    assert!(
        bytes <= 300,
        "{bytes} bytes a run: {small_kb} kB, {large_kb} kB"
    );
}

#[test]
fn a_merge_takes_10_kb_for_a_repeat() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let of = |repeats: u32| {
        let name = format!("r{repeats}");
        let text = format!(
            "schema = 1\nname = \"{name}\"\nduration_s = 0.1\nwarm_up_s = 0.05\nfidelity = \"rate\"\n\
             repeats = {repeats}\n"
        );
        write(folder.path(), &format!("{name}/s.toml"), &text);
        let shards = format!("{name}-shards");
        memory_kb(
            folder.path(),
            &["run", &name, "--shard", "1/1", "-o", &shards],
        );
        let merged = format!("{name}-merged");
        let memory_kb = memory_kb(folder.path(), &["merge", &shards, "-o", &merged]);
        let runs = folder.path().join(format!("{merged}/{name}/runs.csv"));
        let runs = fs::read_to_string(runs).expect("a table of the repeats");
        assert_eq!(runs.lines().count(), repeats as usize + 1, "{runs}");
        memory_kb
    };
    let (small_kb, large_kb) = (of(100), of(1000));
    assert!(
        large_kb.saturating_sub(small_kb) <= 900 * 10,
        "{small_kb} kB of 100 repeats, {large_kb} kB of 1000"
    );
}

#[test]
fn files_of_a_folder_cost_as_much_as_their_number() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    for (name, count) in [("small", 1000), ("large", 10_000)] {
        for index in 0..count {
            let text = format!("schema = 1\nname = \"s{index}\"\nduration_s = 10.0\n");
            write(folder.path(), &format!("{name}/s{index}.toml"), &text);
        }
    }
    assert_growth(folder.path(), "small", "large");
}

#[test]
fn unknown_keys_cost_as_much_as_their_number() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    for (name, count, separator) in [
        ("small", 20_000, "\n"),
        ("large", 200_000, "\n"),
        ("line", 20_000, ", "),
    ] {
        let keys: Vec<String> = (0..count).map(|index| format!("k{index} = 1")).collect();
        let keys = keys.join(separator);
        let gyro = match separator {
            "\n" => format!("[gyro]\n{keys}\n"),
            _ => format!("gyro = {{ {keys} }}\n"),
        };
        let text = format!("schema = 1\nname = \"x\"\nduration_s = 10.0\n{gyro}");
        write(folder.path(), &format!("{name}.toml"), &text);
    }
    assert_growth(folder.path(), "small.toml", "large.toml");
    let lines = least_cost(folder.path(), "small.toml", 2);
    let line = least_cost(folder.path(), "line.toml", 2);
    assert!(
        line.time_us <= 2 * lines.time_us,
        "on one line: {line:?}, on many: {lines:?}"
    );
}

/// Variable that says how many points the suite of [`writes_the_files_of_a_suite`] has.
const POINTS: &str = "FOGBENCH_TEST_POINTS";
/// Metrics of each of its points.
const ROWS: usize = 114;

/// Counts what is written and keeps nothing.
struct Counts(usize);

impl Write for Counts {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 += bytes.len();
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// `metrics.csv` of a point.
fn metrics_of_a_point(metrics: &SuiteMetrics, index: usize) -> String {
    let mut text = metrics.head();
    for row in 0..ROWS {
        let _ = writeln!(
            text,
            "m,{index},channel{},metric_of_a_usual_length{row},0.0123456789012345,0.0113456789012345,\
             0.0133456789012345,0.95,deg/sqrt(h),ok,{index}.5",
            row % 3
        );
    }
    text
}

#[test]
#[ignore = "the child of `files_of_a_suite_take_the_memory_of_one_run`"]
fn writes_the_files_of_a_suite() {
    let points = std::env::var(POINTS).expect("how many points there are");
    let points: usize = points.parse().expect("a number");
    let runs: Vec<RunOutcome> = (0..points)
        .map(|index| {
            let set = vec![("gyro.source.power_uw".to_owned(), format!("{index}.5"))];
            let run = RunOutcome::failed("m", &format!("m/{index:04}"), "m.toml", String::new());
            run.at(Some((index, set)))
        })
        .collect();
    let metrics = SuiteMetrics::of(&runs);
    let mut csv = Counts(0);
    for (index, run) in runs.iter().enumerate() {
        let own = metrics_of_a_point(&metrics, index);
        let rows = metrics.rows(run, Some(&own));
        csv.write_all(rows.as_bytes()).expect("it takes it");
    }
    let suite = SuiteReport {
        tool_version: "0.1.0",
        runs: &runs,
        across: &Comparison::default(),
        stale: &[],
        against: None,
    };
    let mut json = Counts(0);
    let own = |run: &RunOutcome| {
        let point = run.sweep.as_ref().map(|(index, _)| *index);
        Ok(point.map(|index| metrics_of_a_point(&metrics, index)))
    };
    write_suite_summary(&mut json, &suite, &own).expect("it takes it");
    assert!(csv.0 > points * ROWS * 80 && json.0 > points * ROWS * 80);
}

#[test]
fn files_of_a_suite_take_the_memory_of_one_run() {
    let own = std::env::current_exe().expect("this program");
    let memory_kb = |points: usize| {
        let mut child = Command::new(&own);
        child.args([
            "--exact",
            "suite::growth::writes_the_files_of_a_suite",
            "--ignored",
        ]);
        cost_of(child.env(POINTS, points.to_string())).memory_kb
    };
    let (small, large) = (memory_kb(100), memory_kb(10_000));
    // The files have 100 MB and more each; what is kept of each run is its outcome.
    let added = large.saturating_sub(small);
    assert!(
        added < 20_000,
        "{small} kB of 100 points, {large} kB of 10000"
    );
}
