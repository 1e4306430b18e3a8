//! JUnit XML, valid for Jenkins xUnit and for GitLab.

use std::collections::BTreeMap;
use std::time::{Duration, SystemTime};

use super::place::file_and_line;
use crate::baseline::Judged;
use crate::gate::{Verdict, VerdictKind};
use crate::report::baseline::rows::{counts, row_line};
use crate::report::{ChannelOutcome, RunOutcome};
use crate::scenario::portable_place;
use chrono::{DateTime, Utc};
use quick_junit::{NonSuccessKind, Property, Report, TestCase, TestCaseStatus, TestSuite};

/// Wall times of a suite; they stand in no file of an output folder.
#[derive(Clone, Debug, PartialEq)]
pub struct SuiteTimes {
    /// Duration of the whole.
    pub duration: Duration,
    /// Beginning and duration of each run, in the order of the plans; none of one that did not run.
    pub runs: Vec<Option<(SystemTime, Duration)>>,
}

/// Beginning of every report; by it a file is known as one.
const HEAD: &str = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"fogbench\"";

/// Whether a text is a report that [`junit_xml`] made.
#[must_use]
pub fn is_junit_xml(text: &str) -> bool {
    text.starts_with(HEAD)
}

/// The JUnit report of a suite: one test suite per run; one case that it ran, one per failed channel and
/// one per gate. A run that a stopped suite has not run is *skipped*.
///
/// * `judged`: a comparison with earlier results, a suite of its own with a case for each figure that fails.
/// * `times`: wall times; without them the same results give the same bytes, as in `output/junit.xml`.
///
/// An inconclusive gate that its scenario allows is *skipped*: neither a pass nor a failure. The schema of
/// Jenkins xUnit knows neither file and line nor properties of a case, so these are properties of the
/// suite, named by the case. The name of a case holds no limit: a server follows it over the commits.
///
/// # Panics
/// Never: the writer writes to memory.
///
/// # Source
/// `junit-10.xsd` of the Jenkins plugin xUnit 3.1.6; GitLab, "Unit test reports".
#[must_use]
pub fn junit_xml(
    runs: &[RunOutcome],
    judged: Option<Judged>,
    times: Option<&SuiteTimes>,
) -> String {
    let mut report = Report::new("fogbench");
    if let Some(times) = times {
        report.set_time(times.duration);
    }
    for (index, run) in runs.iter().enumerate() {
        let time = times.and_then(|times| *times.runs.get(index)?);
        report.add_test_suite(test_suite(run, time));
    }
    report.add_test_suites(judged.map(baseline_suite));
    let skipped = format!(" skipped=\"{}\"", report.skipped);
    let text = report.to_string();
    // The root's count of skipped cases, which the schema does not know, is the first in the text.
    text.expect("writing XML to memory cannot fail")
        .replacen(&skipped, "", 1)
}

/// Most figures that have a case; one more says how many there are.
const FIGURES_MAX: usize = 500;

/// The comparison as a case of its own, and one for each figure that fails.
fn baseline_suite(judged: Judged) -> TestSuite {
    let mut suite = TestSuite::new(BASELINE);
    let summary = counts(judged.comparison);
    let status = if judged.has_failed() {
        non_success(NonSuccessKind::Failure, "baseline", &summary, &summary)
    } else {
        TestCaseStatus::success()
    };
    let mut add = |name: &str, status| {
        let mut case = TestCase::new(name, status);
        case.set_classname(BASELINE);
        suite.add_test_case(case);
    };
    add("compared", status);
    for row in judged.failed().take(FIGURES_MAX) {
        let text = row_line(row);
        let word = row.outcome.as_str();
        let status = non_success(NonSuccessKind::Failure, word, &text, &text);
        add(&row.id.to_string(), status);
    }
    suite
}

/// Name of the suite of a comparison.
const BASELINE: &str = "baseline";

fn test_suite(run: &RunOutcome, time: Option<(SystemTime, Duration)>) -> TestSuite {
    let mut suite = TestSuite::new(run.folder.as_str());
    suite.extra.insert("file".into(), run.file.as_str().into());
    let mut ran = ran(run);
    if let Some((started, duration)) = time {
        suite.set_timestamp(DateTime::<Utc>::from(started));
        suite.set_time(duration);
        ran.set_time(duration);
    }
    suite.add_test_case(ran);
    for channel in &run.channels {
        if let Some(case) = failed_channel(run, channel) {
            suite.add_test_case(case);
        }
    }
    for (verdict, name) in run.verdicts.iter().zip(gate_names(&run.verdicts)) {
        suite.add_properties(properties(verdict, &name));
        suite.add_test_case(gate(run, verdict, &name));
    }
    suite
}

/// Names of the gates: what each is on, and a number where another one before it is on the same.
pub(super) fn gate_names(verdicts: &[Verdict]) -> Vec<String> {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    let names = verdicts.iter().map(|verdict| {
        let name = match &verdict.relative_to {
            Some(other) => format!("{} relative to {other}", verdict.metric),
            None => verdict.metric.clone(),
        };
        let count = seen.entry(name.clone()).or_default();
        *count += 1;
        match count {
            1 => name,
            count => format!("{name} #{count}"),
        }
    });
    names.collect()
}

/// What a server may show beside a gate.
fn properties(verdict: &Verdict, name: &str) -> Vec<Property> {
    let place = verdict.location.as_deref().and_then(file_and_line);
    let number = |number: Option<f64>| number.map(|number| number.to_string());
    let parts = [
        ("value", number(verdict.value)),
        ("low", number(verdict.low)),
        ("high", number(verdict.high)),
        ("min", number(verdict.min)),
        ("max", number(verdict.max)),
        (
            "unit",
            Some(verdict.unit.clone()).filter(|it| !it.is_empty()),
        ),
        (
            "file",
            place.map(|(file, _)| portable_place(file).to_owned()),
        ),
        ("line", place.map(|(_, line)| line.to_string())),
    ];
    let parts = parts.into_iter();
    let parts = parts.filter_map(|(part, text)| Some((format!("{name}.{part}"), text?)));
    parts
        .map(|(part, text)| Property::new(part, text.as_str()))
        .collect()
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
    let text = channel.failure_text()?;
    let name = format!("channel {}", channel.name);
    if channel.expected_failure {
        let mut case = case(run, &name, TestCaseStatus::success());
        case.set_system_out(format!("expected by a gate: {text}"));
        return Some(case);
    }
    let status = non_success(NonSuccessKind::Error, &failure.kind, &text, &text);
    Some(case(run, &name, status))
}

fn gate(run: &RunOutcome, verdict: &Verdict, name: &str) -> TestCase {
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
    let mut case = case(run, name, status);
    if verdict.kind == VerdictKind::Pass {
        case.set_system_out(text);
    }
    case
}
