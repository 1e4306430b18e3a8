//! Suites: what one bad run, an interruption or another order of arguments leaves behind.

use std::path::PathBuf;

use fogbench::experiment::{Observer, Progress, SuiteOptions, plan_suite, run_suite};
use fogbench::report::{RunOutcome, RunReport, RunStatus};

use crate::support::{code, fogbench, tree, write};

const SHORT: &str = "schema = 1\nduration_s = 1.0\nwarm_up_s = 0.5\nfidelity = \"rate\"\n";

fn named(folder: &std::path::Path, name: &str) -> PathBuf {
    write(
        folder,
        &format!("{name}.toml"),
        &format!("name = \"{name}\"\n{SHORT}"),
    )
}

/// Breaks while the run called `broken` is being reported.
struct Breaks;

impl Progress for Breaks {}

impl Observer for Breaks {
    fn finished(&self, _index: usize, report: &RunReport) {
        assert!(report.scenario.name != "broken", "planted fault");
    }

    fn failed(&self, _index: usize, outcome: &RunOutcome) {
        assert_eq!(outcome.name, "broken");
    }
}

#[test]
fn a_broken_run_fails_by_itself_and_the_suite_still_has_a_verdict() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let paths = ["broken", "fine"].map(|name| named(folder.path(), name));
    let plans = plan_suite(&paths, &[]).expect("sound scenarios");
    let options = SuiteOptions {
        threads: 1,
        ..SuiteOptions::new(folder.path().join("out"))
    };
    let outcome = run_suite(&plans, &options, &Breaks).expect("a writable folder");
    assert!(outcome.broken);
    let statuses: Vec<_> = outcome.runs.iter().map(RunOutcome::status).collect();
    assert_eq!(statuses, [RunStatus::RunFailed, RunStatus::Pass]);
    let junit = std::fs::read_to_string(options.output.join("junit.xml")).expect("written");
    assert!(junit.contains("planted fault"), "{junit}");
    assert!(options.output.join("fine/summary.json").is_file());
}

#[test]
fn the_order_of_the_arguments_leaves_no_trace() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    for name in ["one", "two"] {
        named(folder.path(), name);
    }
    for (first, second, output) in [("one", "two", "a"), ("two", "one", "b")] {
        let (first, second) = (format!("{first}.toml"), format!("{second}.toml"));
        let arguments = ["run", first.as_str(), second.as_str(), "-o", output];
        assert_eq!(code(&fogbench(folder.path(), &arguments)), 0);
    }
    assert_eq!(
        tree(&folder.path().join("a")),
        tree(&folder.path().join("b"))
    );
}

/// Puts a file of the user's in the way of the run called `two` once `one` is done.
struct GetsInTheWay(PathBuf);

impl Progress for GetsInTheWay {}

impl Observer for GetsInTheWay {
    fn finished(&self, _index: usize, report: &RunReport) {
        if report.scenario.name == "one" {
            write(&self.0, "two/thesis.txt", "in the way");
        }
    }
}

#[test]
fn an_earlier_verdict_does_not_outlive_a_suite_that_cannot_finish() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    named(folder.path(), "two");
    // The longest run comes first.
    write(
        folder.path(),
        "one.toml",
        &format!("name = \"one\"\n{SHORT}repeats = 3\n"),
    );
    assert_eq!(code(&fogbench(folder.path(), &["run", "one.toml"])), 0);
    let paths = ["one", "two"].map(|name| folder.path().join(format!("{name}.toml")));
    let plans = plan_suite(&paths, &[]).expect("sound scenarios");
    let output = folder.path().join("output");
    let options = SuiteOptions {
        threads: 1,
        ..SuiteOptions::new(output.clone())
    };
    let outcome = run_suite(&plans, &options, &GetsInTheWay(output.clone()))
        .expect("what stands in the way of one run fails that run alone");
    assert!(outcome.unwritten);
    let error = outcome.runs[1].error.as_deref().expect("the run failed");
    assert!(error.contains("thesis.txt"), "{error}");
    let junit = std::fs::read_to_string(output.join("junit.xml")).expect("the suite's verdict");
    assert!(
        junit.contains("thesis.txt"),
        "a stale verdict stays: {junit}"
    );
    assert!(output.join("one/summary.json").is_file(), "results stay");
    assert!(
        output.join("two/thesis.txt").is_file(),
        "the user's file stays"
    );
}
