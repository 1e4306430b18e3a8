//! What `run` prints: a line for each scenario, what failed, the verdict last; everything on demand.

use std::path::Path;
use std::process::Output;

use crate::support::{code, fogbench, scratch, stderr, stdout, write};

const SHORT: &str = "schema = 1\nduration_s = 0.4\nwarm_up_s = 0.1\nfidelity = \"rate\"\n";
const HOLDS: &str = "[[gate]]\nmetric = \"raw.noise_std_deg_per_h\"\nmin = 0.0\n";
const FAILS: &str = "[[gate]]\nmetric = \"raw.noise_std_deg_per_h\"\nmax = 1e-3\n";

fn scenario(folder: &Path, name: &str, more: &str) {
    let text = format!("name = \"{name}\"\n{SHORT}{more}");
    write(folder, &format!("suite/{name}.toml"), &text);
}

/// A sweep of `count` seeds.
fn sweep(folder: &Path, name: &str, count: usize, gate: &str) {
    let seeds: Vec<String> = (1..=count).map(|seed| seed.to_string()).collect();
    let matrix = format!("{gate}[matrix]\nseed = [{}]\n", seeds.join(", "));
    scenario(folder, name, &matrix);
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    fogbench(folder, &[&["run", "-o", "out"], arguments].concat())
}

fn lines(output: &Output) -> Vec<String> {
    stdout(output).lines().map(str::to_owned).collect()
}

#[test]
fn a_suite_prints_a_line_for_each_scenario_and_the_verdict_last() {
    let folder = scratch();
    scenario(folder.path(), "a-quiet-one", HOLDS);
    scenario(folder.path(), "another", "");
    sweep(folder.path(), "swept", 40, HOLDS);
    let output = run(folder.path(), &["suite"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let lines = lines(&output);
    assert_eq!(lines.len(), 5, "{lines:?}");
    assert!(
        lines[0].starts_with("PASS  a-quiet-one  1 gate "),
        "{lines:?}"
    );
    assert!(lines[0].contains("raw noise std"), "{lines:?}");
    assert!(
        lines[1].starts_with("PASS  another      no gate"),
        "{lines:?}"
    );
    assert_eq!(lines[2], "PASS  swept        40 gates      40 points");
    assert_eq!(lines[3], "");
    assert!(
        lines[4].starts_with("PASS  42 runs: 42 passed"),
        "{lines:?}"
    );
    let talk = stderr(&output);
    assert!(
        talk.contains("42 runs in ") && talk.contains(" s; "),
        "{talk}"
    );
    assert!(talk.ends_with("results in out\n"), "{talk}");
    // Not one second stands among the results.
    let again = run(folder.path(), &["suite", "-j", "1"]);
    assert_eq!(stdout(&again), stdout(&output));
}

#[test]
fn what_failed_is_told_where_it_stands_and_once_more_at_the_end() {
    let folder = scratch();
    scenario(folder.path(), "bad", FAILS);
    scenario(folder.path(), "good", HOLDS);
    let output = run(folder.path(), &["suite"]);
    assert_eq!(code(&output), 1, "{}", stderr(&output));
    let text = stdout(&output);
    assert_eq!(text.matches("FAIL  bad ").count(), 2, "{text}");
    assert_eq!(
        text.matches("FAIL raw.noise_std_deg_per_h: ").count(),
        2,
        "{text}"
    );
    assert!(text.contains("suite/bad.toml:7:1"), "{text}");
    let (_, end) = text.split_once("\nFailures\n").expect("a closing block");
    assert!(!end.contains("good"), "{end}");
    let last = text.lines().last().expect("a line");
    assert!(
        last.starts_with("FAIL  2 runs: 1 passed, 1 with a failed gate"),
        "{last}"
    );
}

#[test]
fn a_sweep_alone_takes_at_most_twenty_five_lines() {
    let folder = scratch();
    for (name, gate, code_wanted) in [("fine", HOLDS, 0), ("broken", FAILS, 1)] {
        sweep(folder.path(), name, 60, gate);
        let file = format!("suite/{name}.toml");
        let output = run(folder.path(), &[&file]);
        assert_eq!(code(&output), code_wanted, "{}", stderr(&output));
        let lines = lines(&output);
        // Two lines of talk follow, on a slow computer more.
        assert!(lines.len() + 2 <= 25, "{lines:#?}");
        assert!(lines[1].contains("seed = 1 "), "{lines:#?}");
        assert!(
            lines.contains(&"      and 50 more points".to_owned()),
            "{lines:#?}"
        );
    }
}

#[test]
fn one_scenario_or_the_verbose_form_prints_the_full_account() {
    let folder = scratch();
    scenario(folder.path(), "one", HOLDS);
    let alone = stdout(&run(folder.path(), &["suite/one.toml"]));
    let head: Vec<&str> = alone.lines().collect();
    assert!(head[0].starts_with("one  rate model"), "{alone}");
    assert!(head[1].starts_with("  gyro: output rate "), "{alone}");
    for word in [
        "proper frequency",
        "loop gain",
        "single-fringe range",
        "ARW budget",
        "noise std",
    ] {
        assert!(alone.contains(word), "no {word} in {alone}");
    }
    assert!(
        head.last()
            .is_some_and(|line| line.starts_with("PASS  1 run: "))
    );
    scenario(folder.path(), "two", "");
    let suite = stdout(&run(folder.path(), &["suite", "-v"]));
    let (account, _) = alone.rsplit_once("\nPASS").expect("a verdict");
    assert!(suite.contains(account), "{suite}");
    assert!(suite.contains("two  rate model"), "{suite}");
}

#[test]
fn the_quiet_form_prints_what_failed_and_the_verdict() {
    let folder = scratch();
    scenario(folder.path(), "bad", FAILS);
    scenario(folder.path(), "good", HOLDS);
    let output = run(folder.path(), &["suite", "--quiet"]);
    assert_eq!(code(&output), 1);
    assert_eq!(stderr(&output), "");
    let text = stdout(&output);
    assert!(
        text.starts_with("\nFailures\nFAIL  bad") && !text.contains("good"),
        "{text}"
    );
    let good = run(folder.path(), &["suite/good.toml", "-q"]);
    assert_eq!(lines(&good).len(), 1, "{}", stdout(&good));
    assert_eq!(code(&run(folder.path(), &["suite", "-q", "-v"])), 2);
}

#[test]
fn colours_are_for_terminals_unless_asked_for() {
    let folder = scratch();
    scenario(folder.path(), "one", HOLDS);
    let coloured = |arguments: &[&str]| {
        let output = run(folder.path(), &[&["suite"], arguments].concat());
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        stdout(&output).contains('\u{1b}')
    };
    assert!(!coloured(&[]));
    assert!(!coloured(&["--color", "never"]));
    assert!(coloured(&["--color", "always"]));
    let wrong = fogbench(
        folder.path(),
        &["--color", "always", "check", "suite/none.toml"],
    );
    assert!(code(&wrong) != 0);
}
