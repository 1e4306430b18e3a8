//! Suites: what one bad run, an interruption or another order of arguments leaves behind.

use std::path::PathBuf;

use fogbench::experiment::{Observer, SuiteOptions, plan_suite, run_suite};
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

impl Observer for Breaks {
    fn advanced(&self, _simulated_s: f64) {}

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
        output: folder.path().join("out"),
        threads: 1,
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

#[test]
fn an_earlier_verdict_does_not_outlive_a_suite_that_cannot_finish() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    named(folder.path(), "one");
    assert_eq!(code(&fogbench(folder.path(), &["run", "one.toml"])), 0);
    // A file stands where the second run needs its folder's parent.
    write(folder.path(), "output/.two.partial", "in the way");
    named(folder.path(), "two");
    let output = fogbench(folder.path(), &["run", "two.toml"]);
    assert_eq!(code(&output), 74);
    assert!(
        !folder.path().join("output/junit.xml").exists(),
        "a stale verdict stays"
    );
    assert!(
        folder.path().join("output/one/summary.json").is_file(),
        "results stay"
    );
}
