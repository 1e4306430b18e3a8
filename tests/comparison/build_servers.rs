//! What build servers get of a suite: JUnit, annotations, Markdown, metrics for Bencher.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::support::junit::{assert_valid, elements};
use crate::support::transcript::Transcript;
use crate::support::{code, fogbench, stderr, stdout, summary, tree, write};

const SHORT: &str = "schema = 1
duration_s = 2.0
warm_up_s = 1.0
fidelity = \"rate\"
";

/// Two gates on the same metric, of which the second fails, one that is open and one relative to raw.
const GATES: &str = "
[[filter]]
name = \"lms\"
lms = {}

[[gate]]
metric = \"raw.mean_deg_per_h\"
min = 5.0
max = 12.0
decide = \"value\"
[[gate]]
metric = \"raw.mean_deg_per_h\"
max = 1.0
decide = \"value\"
[[gate]]
metric = \"lms.noise_std_deg_per_h\"
relative_to = \"raw\"
max = 2.0
";

/// A folder with a scenario that fails and one that passes, in `scenarios/`.
fn scratch() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let scenario = |name: &str, gates: &str| {
        let text = format!("name = \"{name}\"\n{SHORT}{gates}");
        write(folder.path(), &format!("scenarios/{name}.toml"), &text);
    };
    scenario("fails", GATES);
    scenario(
        "passes",
        "[[gate]]\nmetric = \"raw.mean_deg_per_h\"\nmax = 12.0\ndecide = \"value\"\n",
    );
    folder
}

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// A report without its wall times.
fn timeless(xml: &str) -> String {
    let mut text = xml.to_owned();
    for attribute in [" timestamp=\"", " time=\""] {
        while let Some(start) = text.find(attribute) {
            let value = start + attribute.len();
            let end = value + text[value..].find('"').expect("the value ends") + 1;
            text.replace_range(start..end, "");
        }
    }
    text
}

#[test]
fn a_report_is_valid_and_a_case_is_named_without_its_limit() {
    let folder = scratch();
    assert_eq!(code(&fogbench(folder.path(), &["run", "scenarios"])), 1);
    let xml = read(folder.path(), "output/junit.xml");
    assert_valid(&xml);
    let found = elements(&xml);
    let of = |name: &'static str| found.iter().filter(move |(_, it)| it.name == name);
    let cases: Vec<&str> = of("testcase").map(|(_, case)| case.get("name")).collect();
    let gates = [
        "run",
        "raw.mean_deg_per_h",
        "raw.mean_deg_per_h #2",
        "lms.noise_std_deg_per_h relative to raw",
        "run",
        "raw.mean_deg_per_h",
    ];
    assert_eq!(cases, gates);
    let property = |name: &str| {
        let found = of("property").find(|(_, property)| property.get("name") == name);
        found.map(|(_, property)| property.get("value").to_owned())
    };
    let part = |part: &str| property(&format!("raw.mean_deg_per_h #2.{part}"));
    let mean =
        &summary(&folder.path().join("output"), "fails")["channels"]["raw"]["mean_deg_per_h"];
    for (name, key) in [("value", "value"), ("low", "low"), ("high", "high")] {
        let number: f64 = part(name).expect(name).parse().expect("a number");
        assert_eq!(Some(number), mean[key].as_f64(), "{name}");
    }
    assert_eq!(part("max").as_deref(), Some("1"));
    assert_eq!(part("min"), None);
    assert_eq!(part("unit").as_deref(), Some("deg/h"));
    assert_eq!(part("file").as_deref(), Some("fails.toml"));
    let text = read(folder.path(), "scenarios/fails.toml");
    let metric = text
        .match_indices("metric = \"raw.mean")
        .nth(1)
        .expect("a gate")
        .0;
    let line = text[..metric].matches('\n').count() + 1;
    assert_eq!(part("line"), Some(line.to_string()));
    let suites: Vec<&str> = of("testsuite")
        .map(|(_, suite)| suite.get("file"))
        .collect();
    assert_eq!(suites, ["fails.toml", "passes.toml"]);
}

#[test]
fn a_limit_that_moves_leaves_the_names_of_the_cases() {
    let folder = scratch();
    let names = || {
        fogbench(folder.path(), &["run", "scenarios"]);
        let found = elements(&read(folder.path(), "output/junit.xml"));
        let cases = found.into_iter().filter(|(_, it)| it.name == "testcase");
        cases
            .map(|(_, case)| case.get("name").to_owned())
            .collect::<Vec<_>>()
    };
    let before = names();
    let text = read(folder.path(), "scenarios/fails.toml");
    let moved = text
        .replace("max = 1.0", "max = 20.0")
        .replace("max = 2.0", "min = 0.1");
    assert_ne!(text, moved);
    fs::write(folder.path().join("scenarios/fails.toml"), moved).expect("writable");
    assert_eq!(names(), before);
}

#[test]
fn a_file_of_its_own_is_the_report_of_the_output_folder_with_wall_times() {
    let folder = scratch();
    let run = ["run", "scenarios", "--junit", "verdict.xml"];
    assert_eq!(code(&fogbench(folder.path(), &run)), 1);
    let (own, kept) = (
        read(folder.path(), "verdict.xml"),
        read(folder.path(), "output/junit.xml"),
    );
    assert_valid(&own);
    assert_eq!(timeless(&own), kept);
    let found = elements(&own);
    let timed = |(_, it): &&(String, crate::support::junit::Found)| {
        it.name == "testsuite" || it.get("name") == "run" || it.name == "testsuites"
    };
    for (_, element) in found.iter().filter(timed) {
        assert!(!element.get("time").is_empty(), "{}", element.name);
    }
    for (_, suite) in found.iter().filter(|(_, it)| it.name == "testsuite") {
        let timestamp = suite.get("timestamp");
        assert!(
            timestamp.starts_with("20") && timestamp.contains('T'),
            "{timestamp}"
        );
    }
    // It replaces itself, and nothing under the output folder tells the time.
    let before = tree(&folder.path().join("output"));
    assert_eq!(code(&fogbench(folder.path(), &run)), 1);
    assert_eq!(tree(&folder.path().join("output")), before);
}

#[test]
fn files_for_servers_that_are_refused_are_refused_before_the_run() {
    let folder = scratch();
    let at = folder.path();
    write(at, "thesis.txt", "mine");
    let mut transcript = Transcript::of("build-servers", "Refusals");
    let options: [(&[&str], i32); 7] = [
        (&["--junit", "output/mine.xml"], 2),
        (&["--bmf", "./output/../output/deeper/mine.json"], 2),
        (&["--junit", "thesis.txt"], 2),
        (&["--summary-markdown", "thesis.txt"], 2),
        (&["--bmf", "thesis.txt"], 2),
        (&["--junit", "one", "--bmf", "./one"], 2),
        (&["--junit", "nowhere/verdict.xml"], 74),
    ];
    for (given, ends) in options {
        let output = fogbench(at, &[&["run", "scenarios"], given].concat());
        assert_eq!(
            (code(&output), stdout(&output)),
            (ends, String::new()),
            "{given:?}"
        );
        let said = stderr(&output).replace(
            &*fs::canonicalize(at).expect("stands").to_string_lossy(),
            ".",
        );
        transcript.case(given.join(" "), said);
        assert!(!at.join("output").exists(), "{given:?}");
    }
    transcript.check();
    assert_eq!(read(at, "thesis.txt"), "mine");
    let forced = fogbench(
        at,
        &["run", "scenarios", "--junit", "thesis.txt", "--force"],
    );
    assert_eq!(code(&forced), 1);
    assert_valid(&read(at, "thesis.txt"));
}

#[test]
fn a_failure_is_annotated_where_its_gate_stands() {
    let folder = scratch();
    let at = folder.path();
    let absolute = at.join("scenarios").display().to_string();
    let line = read(at, "scenarios/fails.toml");
    let metric = line
        .match_indices("metric = \"raw.mean")
        .nth(1)
        .expect("a gate")
        .0;
    let line = line[..metric].matches('\n').count() + 1;
    let start = format!(
        "::error file=scenarios/fails.toml,line={line},title=fails%3A raw.mean_deg_per_h #2::fail: "
    );
    for paths in ["scenarios", absolute.as_str()] {
        let output = fogbench(at, &["run", paths, "--annotations", "github"]);
        let text = stdout(&output);
        let found: Vec<&str> = text.lines().filter(|line| line.starts_with("::")).collect();
        assert_eq!(found.len(), 1, "{text}");
        assert!(found[0].starts_with(&start), "{} is not {start}", found[0]);
    }
    // A document stays one.
    let json = [
        "run",
        "scenarios",
        "--annotations",
        "github",
        "--format",
        "json",
    ];
    let output = fogbench(at, &json);
    let _: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    assert!(stderr(&output).contains(&start), "{}", stderr(&output));
}

#[test]
fn a_summary_names_what_failed_and_replaces_an_empty_file_and_itself() {
    let folder = scratch();
    let at = folder.path();
    write(at, "summary.md", "");
    let run = ["run", "scenarios", "--summary-markdown", "summary.md"];
    for _ in 0..2 {
        assert_eq!(code(&fogbench(at, &run)), 1);
    }
    let text = read(at, "summary.md");
    let mut transcript = Transcript::of("build-servers", "Summary in Markdown");
    transcript.case(run.join(" "), &text);
    transcript.check();
    assert!(text.contains("1 of 2 runs passed"), "{text}");
}

#[test]
fn every_metric_is_a_measure_for_bencher() {
    let folder = scratch();
    let at = folder.path();
    let run = ["run", "scenarios", "--bmf", "metrics.json"];
    for _ in 0..2 {
        assert_eq!(code(&fogbench(at, &run)), 1);
    }
    let metrics: Value = serde_json::from_str(&read(at, "metrics.json")).expect("JSON");
    let benchmarks = metrics.as_object().expect("benchmarks");
    let names: Vec<&String> = benchmarks.keys().collect();
    assert_eq!(names, ["fails/raw", "fails/lms", "passes/raw"]);
    let mean = &summary(&at.join("output"), "fails")["channels"]["raw"]["mean_deg_per_h"];
    let measure = &metrics["fails/raw"]["mean_deg_per_h"];
    for (ours, theirs) in [
        ("value", "value"),
        ("low", "lower_value"),
        ("high", "upper_value"),
    ] {
        assert_eq!(mean[ours], measure[theirs], "{ours}");
    }
    for benchmark in benchmarks.values() {
        for (name, measure) in benchmark.as_object().expect("measures") {
            let parts = measure.as_object().expect("a measure");
            assert!(parts["value"].is_number(), "{name}");
            assert!(parts.values().all(Value::is_number), "{name}");
            assert!(name.len() <= 64, "{name}");
        }
    }
}
