//! JUnit XML in the dialect of Jenkins.

use crate::gate::{Verdict, VerdictKind, limits_text};
use crate::report::{ChannelOutcome, RunOutcome};
use crate::scenario::portable_place;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

/// The text of `output/junit.xml`: one suite per run; one case that it ran, one per failed channel
/// and one per gate. A run that a stopped suite has not run is *skipped*.
///
/// Carries no time, host or identifier, so that the same results give the same bytes. An
/// inconclusive gate that its scenario allows is *skipped*: neither a pass nor a failure.
///
/// # Panics
/// Never: the writer writes to memory.
#[must_use]
pub fn junit_xml(runs: &[RunOutcome]) -> String {
    let mut report = Report::new("fogbench");
    for run in runs {
        let mut suite = TestSuite::new(run.folder.as_str());
        suite.add_test_case(ran(run));
        for channel in &run.channels {
            if let Some(case) = failed_channel(run, channel) {
                suite.add_test_case(case);
            }
        }
        for verdict in &run.verdicts {
            suite.add_test_case(gate(run, verdict));
        }
        report.add_test_suite(suite);
    }
    report
        .to_string()
        .expect("writing XML to memory cannot fail")
}

fn case(run: &RunOutcome, name: &str, status: TestCaseStatus) -> TestCase {
    let mut case = TestCase::new(name, status);
    case.set_classname(run.folder.as_str());
    case
}

fn non_success(kind: NonSuccessKind, word: &str, message: &str, text: &str) -> TestCaseStatus {
    let mut status = TestCaseStatus::non_success(kind);
    status
        .set_type(word)
        .set_message(message)
        .set_description(text);
    status
}

fn ran(run: &RunOutcome) -> TestCase {
    let status = match &run.error {
        None if run.is_not_run => {
            let message = "not run: the suite was stopped before the end of this run";
            let mut status = TestCaseStatus::skipped();
            status.set_type("not_run").set_message(message);
            status
        }
        Some(error) => non_success(NonSuccessKind::Error, "run_failed", error, error),
        None => TestCaseStatus::success(),
    };
    case(run, "run", status)
}

fn failed_channel(run: &RunOutcome, channel: &ChannelOutcome) -> Option<TestCase> {
    let failure = channel.failure.as_ref()?;
    let text = format!(
        "channel {} failed at sample {}: {}",
        channel.name, failure.sample, failure.message
    );
    let name = format!("channel {}", channel.name);
    if channel.expected_failure {
        let mut case = case(run, &name, TestCaseStatus::success());
        case.set_system_out(format!("expected by a gate: {text}"));
        return Some(case);
    }
    let status = non_success(NonSuccessKind::Error, &failure.kind, &text, &text);
    Some(case(run, &name, status))
}

fn gate(run: &RunOutcome, verdict: &Verdict) -> TestCase {
    let limits = limits_text(verdict.min, verdict.max);
    let name = match &verdict.relative_to {
        Some(other) => format!("{} relative to {other}, {limits}", verdict.metric),
        None => format!("{}, {limits}", verdict.metric),
    };
    let message = format!("{}: {}", verdict.kind.as_str(), verdict.reason);
    let text = match &verdict.location {
        Some(location) => format!("{}: {} {message}", portable_place(location), verdict.metric),
        None => format!("{} {message}", verdict.metric),
    };
    let status = match (verdict.kind, verdict.accepted) {
        (VerdictKind::Pass, _) => TestCaseStatus::success(),
        (VerdictKind::Inconclusive, true) => {
            let mut status = TestCaseStatus::skipped();
            status
                .set_type("inconclusive")
                .set_message(message.as_str());
            status.set_description(text.as_str());
            status
        }
        (kind, _) => non_success(NonSuccessKind::Failure, kind.as_str(), &message, &text),
    };
    let mut case = case(run, &name, status);
    if verdict.kind == VerdictKind::Pass {
        case.set_system_out(text);
    }
    case
}
