//! Which runs of a suite run: by the name of the scenario, until one fails, and only with gates.

use std::path::Path;

use serde_json::Value;

use crate::support::{code, fogbench, stderr, stdout, write};

const SHORT: &str = "schema = 1\nduration_s = 1.0\nwarm_up_s = 0.5\nfidelity = \"rate\"\n";

fn scenario(folder: &Path, name: &str, more: &str) {
    let text = format!("{SHORT}name = \"{name}\"\n{more}");
    write(folder, &format!("{name}.toml"), &text);
}

fn gate(max: f64) -> String {
    format!("[[gate]]\nmetric = \"raw.noise_std_deg_per_h\"\nmax = {max:?}\n")
}

fn statuses(folder: &Path) -> Vec<(String, String)> {
    let text = std::fs::read_to_string(folder.join("output/summary.json")).expect("a summary");
    let suite: Value = serde_json::from_str(&text).expect("JSON");
    let runs = suite["runs"].as_array().expect("runs");
    let word = |run: &Value, key: &str| run[key].as_str().expect("a word").to_owned();
    runs.iter()
        .map(|run| (word(run, "name"), word(run, "status")))
        .collect()
}

#[test]
fn scenarios_are_selected_by_name() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    for name in ["rest-1", "rest-20", "swing-1"] {
        scenario(folder.path(), name, "");
    }
    let listed = |globs: &[&str]| {
        let mut arguments = vec!["list", "."];
        arguments.extend(globs.iter().flat_map(|glob| ["--filter", glob]));
        let output = fogbench(folder.path(), &arguments);
        let names = stdout(&output);
        let names = names
            .lines()
            .map(|line| line.split("  ").next().unwrap_or("").to_owned());
        (code(&output), names.collect::<Vec<String>>())
    };
    assert_eq!(listed(&["rest-?"]), (0, vec!["rest-1".to_owned()]));
    assert_eq!(listed(&["*-1"]).1, ["rest-1", "swing-1"]);
    assert_eq!(listed(&["rest-20", "sw*"]).1, ["rest-20", "swing-1"]);
    assert_eq!(listed(&["est"]), (4, Vec::new()));
    let run = fogbench(folder.path(), &["run", ".", "--filter", "rest*"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    assert_eq!(statuses(folder.path()).len(), 2);
    // What other names hold stays.
    let run = fogbench(folder.path(), &["run", ".", "--filter", "swing-1"]);
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    assert!(folder.path().join("output/rest-1/summary.json").exists());
}

#[test]
fn no_run_starts_after_the_first_failure() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    // The longest run comes first.
    scenario(folder.path(), "a", &format!("seed = 1\n{}", gate(1e-3)));
    write(
        folder.path(),
        "a.toml",
        &format!("{SHORT}name = \"a\"\n{}", gate(1e-3)).replace("1.0", "9.0"),
    );
    scenario(folder.path(), "b", &gate(1e9));
    let all = fogbench(folder.path(), &["run", ".", "-j", "1"]);
    assert_eq!(code(&all), 1);
    assert!(statuses(folder.path()).contains(&("b".to_owned(), "pass".to_owned())));
    let fast = fogbench(folder.path(), &["run", ".", "-j", "1", "--fail-fast"]);
    assert_eq!(code(&fast), 1, "{}", stderr(&fast));
    assert!(statuses(folder.path()).contains(&("b".to_owned(), "not_run".to_owned())));
    assert!(
        stderr(&fast).contains("1 of 2 runs not started"),
        "{}",
        stderr(&fast)
    );
}

#[test]
fn a_suite_that_must_have_gates_and_has_none_fails() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    scenario(folder.path(), "a", "");
    let without = fogbench(folder.path(), &["run", "a.toml", "--require-gates"]);
    assert_eq!(code(&without), 1);
    assert!(!folder.path().join("output").exists());
    scenario(folder.path(), "b", &gate(1e9));
    let with = fogbench(folder.path(), &["run", ".", "--require-gates"]);
    assert_eq!(code(&with), 0, "{}", stderr(&with));
}
