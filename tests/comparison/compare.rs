//! Results against earlier ones, as a user meets it: `compare`, `baseline`, `run --baseline`.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::support::transcript::Transcript;
use crate::support::{code, fogbench, stderr, stdout, tree, write};

const HEAD: &str = "schema = 1
fidelity = \"rate\"
duration_s = 4.0
warm_up_s = 0.5
[gyro.output]
average_samples = 4
";

const FILTER: &str = "[[filter]]\nname = \"mean\"\n[filter.moving_average]\ntaps = 8\n";

/// A folder with a scenario `one` with a filter and a sweep of two points.
fn scratch() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    write(
        at,
        "scenarios/one.toml",
        &format!("name = \"one\"\n{HEAD}{FILTER}"),
    );
    sweep(at, "[0.5, 1.0]");
    folder
}

fn sweep(at: &Path, powers: &str) {
    let matrix = format!("[matrix]\n\"gyro.source.power_uw\" = {powers}\n");
    write(
        at,
        "scenarios/power.toml",
        &format!("name = \"power\"\n{HEAD}{matrix}"),
    );
}

fn run(at: &Path, output: &str, more: &[&str]) {
    let arguments = [&["run", "scenarios", "-o", output], more].concat();
    let output = fogbench(at, &arguments);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
}

/// Keeps the figures of an output folder in `b.toml`.
fn save(at: &Path, output: &str) {
    let output = fogbench(at, &["baseline", "save", output, "-o", "b.toml"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
}

/// Compares two sides: exit code and what was found.
fn compare(at: &Path, old: &str, new: &str) -> (i32, Value) {
    let output = fogbench(at, &["compare", old, new, "--format", "json"]);
    let found = serde_json::from_str(&stdout(&output));
    (
        code(&output),
        found.unwrap_or_else(|_| panic!("{}", stderr(&output))),
    )
}

fn count(found: &Value, outcome: &str) -> u64 {
    found["counts"][outcome].as_u64().expect("a count")
}

/// Moves a figure of a summary, with its interval, by so many of its half widths.
fn worsen(at: &Path, run: &str, channel: &str, metric: &str, half_widths: f64) {
    let path = at.join(run).join("summary.json");
    let text = fs::read_to_string(&path).expect("a summary");
    let mut summary: Value = serde_json::from_str(&text).expect("JSON");
    let figure = &mut summary["channels"][channel][metric];
    let number = |key: &str| figure[key].as_f64().expect("a number");
    let by = half_widths * (number("high") - number("low")) / 2.0;
    for key in ["value", "low", "high"] {
        figure[key] = (figure[key].as_f64().expect("a number") + by).into();
    }
    fs::write(&path, summary.to_string()).expect("writable");
}

#[test]
fn an_output_is_the_same_as_itself_as_its_repetition_and_as_its_baseline() {
    let folder = scratch();
    let at = folder.path();
    run(at, "old", &[]);
    run(at, "new", &[]);
    let saved = fogbench(at, &["baseline", "save", "old", "-o", "baseline.toml"]);
    assert_eq!(code(&saved), 0, "{}", stderr(&saved));
    for (old, new) in [
        ("old", "old"),
        ("old", "new"),
        ("baseline.toml", "new"),
        ("old", "baseline.toml"),
        ("old/one", "new/one"),
    ] {
        let (code, found) = compare(at, old, new);
        assert_eq!(code, 0, "{old} {new}: {found}");
        let all = found["metrics"].as_array().expect("rows").len();
        assert_eq!(count(&found, "same"), all as u64, "{old} {new}");
        assert!(all > 10);
    }
}

#[test]
fn a_worse_figure_ends_with_1_and_is_named_with_what_it_was_judged_by() {
    let folder = scratch();
    let at = folder.path();
    run(at, "old", &[]);
    run(at, "new", &[]);
    let arw = "angle_random_walk_deg_per_sqrt_h";
    worsen(at, "new/one", "mean", arw, 3.0);
    let (ended, found) = compare(at, "old", "new");
    assert_eq!((ended, count(&found, "worse")), (1, 1), "{found}");
    let rows = found["metrics"].as_array().expect("rows");
    let worse = rows
        .iter()
        .find(|row| row["outcome"] == "worse")
        .expect("a row");
    assert_eq!(
        (&worse["channel"], &worse["metric"]),
        (&"mean".into(), &arw.into())
    );
    assert_eq!(worse["basis"], "same noise");
    for (fail_on, ends) in [
        ("never", 0),
        ("changed", 0),
        ("removed,worse", 1),
        ("worse,never", 2),
    ] {
        let output = fogbench(at, &["compare", "old", "new", "--fail-on", fail_on]);
        assert_eq!(code(&output), ends, "{fail_on}");
    }
    // The other way round it is better.
    let (ended, found) = compare(at, "new", "old");
    assert_eq!((ended, count(&found, "better")), (0, 1), "{found}");
}

#[test]
fn another_seed_is_compared_and_another_scenario_is_not_judged() {
    let folder = scratch();
    let at = folder.path();
    run(at, "old", &[]);
    run(at, "seed", &["--set", "seed=2"]);
    let (ended, found) = compare(at, "old", "seed");
    assert_eq!(
        (ended, count(&found, "changed-scenario")),
        (0, 0),
        "{found}"
    );
    let rows = found["metrics"].as_array().expect("rows");
    assert!(rows.iter().any(|row| row["basis"] == "unpaired"), "{found}");
    run(at, "longer", &["--set", "duration_s=5.0"]);
    let (ended, found) = compare(at, "old", "longer");
    assert_eq!(ended, 0, "{found}");
    let judged = ["same", "worse", "better", "changed"];
    assert!(
        judged.iter().all(|outcome| count(&found, outcome) == 0),
        "{found}"
    );
    assert!(count(&found, "changed-scenario") > 10);
    let output = fogbench(at, &["compare", "old", "longer"]);
    let text = stdout(&output);
    // A line for each run, and the verdict.
    assert_eq!(text.lines().count(), 4, "{text}");
}

#[test]
fn points_of_a_sweep_match_by_their_values() {
    let folder = scratch();
    let at = folder.path();
    run(at, "old", &[]);
    sweep(at, "[2.0, 1.0, 0.5]");
    run(at, "new", &[]);
    let (ended, found) = compare(at, "old", "new");
    assert_eq!(ended, 0, "{found}");
    let rows = found["metrics"].as_array().expect("rows");
    for row in rows.iter().filter(|row| row["scenario"] == "power") {
        let is_new = row["point"]["gyro.source.power_uw"].as_f64() == Some(2.0);
        assert_eq!(row["outcome"], if is_new { "new" } else { "same" }, "{row}");
    }
    assert!(count(&found, "new") > 3);
    let (ended, found) = compare(at, "new", "old");
    assert_eq!(ended, 1, "a point is gone: {found}");
    assert!(count(&found, "removed") > 3);
}

#[test]
fn repeats_and_samples_of_the_same_seed_are_compared_pair_by_pair() {
    let folder = scratch();
    let at = folder.path();
    let bases = |more: &[&str], name: &str| {
        let more = [more, &["--force"]].concat();
        run(at, "old", &more);
        // The gyro's own noise is the same, and the filter's words are another program's.
        run(at, "new", &more);
        let path = at.join("new/one").join(name);
        if name == "summary.json" {
            let text = fs::read_to_string(&path).expect("a summary");
            let mut summary: Value = serde_json::from_str(&text).expect("JSON");
            let channel = &mut summary["channels"]["mean"];
            let mut at = 0.0;
            let repeats = channel["repeats"]["mean_deg_per_h"]["values"].as_array_mut();
            for value in repeats.expect("repeats") {
                at += 1e-4;
                *value = (value.as_f64().expect("a number") + 0.01 + at).into();
            }
            let mean = &mut channel["mean_deg_per_h"]["value"];
            *mean = (mean.as_f64().expect("a number") + 0.01).into();
            fs::write(&path, summary.to_string()).expect("writable");
        } else {
            let bytes = fs::read(&path).expect("samples");
            // A header of 128 bytes, then binary64.
            let (head, words) = bytes.split_at(128);
            let mut moved = head.to_vec();
            for (index, word) in words.chunks_exact(8).enumerate() {
                let word = f64::from_le_bytes(word.try_into().expect("8 bytes"));
                let by = 0.01 + 1e-4 * (index % 7) as f64;
                moved.extend((word + by).to_le_bytes());
            }
            fs::write(&path, moved).expect("writable");
            worsen(at, "new/one", "mean", "mean_deg_per_h", 0.01);
        }
        let (_, found) = compare(at, "old", "new");
        let rows = found["metrics"].as_array().expect("rows");
        let row = rows.iter().find(|row| {
            row["scenario"] == "one"
                && row["channel"] == "mean"
                && row["metric"] == "mean_deg_per_h"
        });
        row.expect("a row").clone()
    };
    let row = bases(&["--set", "repeats=6"], "summary.json");
    assert_eq!(row["basis"], "6 pairs of repeats", "{row}");
    assert_eq!(row["outcome"], "changed", "{row}");
    let row = bases(&["--set", "output.samples=\"npy\""], "samples/mean.npy");
    assert_eq!(row["basis"], "20 pairs of blocks", "{row}");
    assert_eq!(row["outcome"], "changed", "{row}");
}

#[test]
fn a_baseline_is_updated_only_when_told_and_keeps_what_the_user_wrote() {
    let folder = scratch();
    let at = folder.path();
    run(at, "old", &[]);
    let save = ["baseline", "save", "old", "-o", "baseline.toml"];
    assert_eq!(code(&fogbench(at, &save)), 0);
    let saved = fs::read_to_string(at.join("baseline.toml")).expect("a baseline");
    let again = fogbench(at, &save);
    assert_eq!(code(&again), 2, "{}", stderr(&again));
    let own = saved.replacen(
        "direction = \"lower\"\n",
        "direction = \"higher\"\nabsolute_tolerance = 0.25\n",
        1,
    );
    fs::write(at.join("baseline.toml"), &own).expect("writable");
    run(at, "new", &["--set", "seed=2"]);
    let update = ["baseline", "update", "baseline.toml", "new"];
    let shown = fogbench(at, &update);
    assert_eq!(code(&shown), 0, "{}", stderr(&shown));
    assert!(stdout(&shown).contains("figures"), "{}", stdout(&shown));
    let read = || fs::read_to_string(at.join("baseline.toml")).expect("a baseline");
    assert_eq!(read(), own, "nothing is written untold");
    assert_eq!(
        code(&fogbench(at, &[&update[..], &["--write"]].concat())),
        0
    );
    let written = read();
    assert_ne!(written, own);
    assert!(written.contains("direction = \"higher\"\nabsolute_tolerance = 0.25\n"));
    assert!(written.contains("seed = 2\n") && !written.contains("seed = 1\n"));
    let (ended, found) = compare(at, "baseline.toml", "new");
    assert_eq!((ended, count(&found, "unsure")), (0, 0), "{found}");
}

#[test]
fn a_run_is_compared_with_its_baseline_and_never_writes_it() {
    let folder = scratch();
    let at = folder.path();
    run(at, "out", &[]);
    let save = ["baseline", "save", "out", "-o", "baseline.toml"];
    assert_eq!(code(&fogbench(at, &save)), 0);
    let read = || fs::read_to_string(at.join("baseline.toml")).expect("a baseline");
    let saved = read();
    let against = ["-o", "out", "--baseline", "baseline.toml"];
    // Of a part of the suite, nothing else is missed.
    let part = fogbench(at, &[&["run", "scenarios/one.toml"], &against[..]].concat());
    assert_eq!(code(&part), 0, "{}{}", stdout(&part), stderr(&part));
    let before = tree(&at.join("out"));
    let whole = fogbench(at, &[&["run", "scenarios"], &against[..]].concat());
    assert_eq!(code(&whole), 0, "{}", stdout(&whole));
    assert!(
        stdout(&whole).contains("PASS  compared"),
        "{}",
        stdout(&whole)
    );
    run(at, "plain", &[]);
    // The page of the suite and its JUnit file show the baseline, and its record has their digests.
    let own = |output: &str| {
        let mut files = tree(&at.join(output));
        let shows = ["index.html", "junit.xml", ".fogbench.toml"].map(Path::new);
        files.retain(|(name, _)| !shows.contains(&name.as_path()));
        files
    };
    assert!(own("out") == own("plain"), "{}", before.len());
    // What was there and is not.
    let lines = saved.replacen(
        "metric = \"mean_deg_per_h\"",
        "metric = \"gone_deg_per_h\"",
        1,
    );
    fs::write(at.join("baseline.toml"), &lines).expect("writable");
    let gone = fogbench(at, &[&["run", "scenarios"], &against[..]].concat());
    assert_eq!(code(&gone), 1, "{}", stdout(&gone));
    assert!(stdout(&gone).contains("removed"), "{}", stdout(&gone));
    let json = [&["run", "scenarios", "--format", "json"], &against[..]].concat();
    let json = fogbench(at, &json);
    let _: Value = serde_json::from_str(&stdout(&json)).expect("one document");
    assert!(stderr(&json).contains("removed") && code(&json) == 1);
    assert_eq!(read(), lines);
    let markdown = ["--summary-markdown", "summary.md"];
    fogbench(
        at,
        &[&["run", "scenarios"], &against[..], &markdown].concat(),
    );
    let summary = fs::read_to_string(at.join("summary.md")).expect("a summary");
    assert!(
        summary.contains("### Compared with the baseline"),
        "{summary}"
    );
    assert!(summary.contains("| removed |"), "{summary}");
}

#[test]
fn a_run_that_failed_or_is_gone_is_removed() {
    let folder = scratch();
    let at = folder.path();
    run(at, "old", &[]);
    fs::remove_file(at.join("scenarios/power.toml")).expect("removable");
    run(at, "new", &[]);
    let (ended, found) = compare(at, "old", "new");
    assert_eq!(ended, 1, "{found}");
    assert!(count(&found, "removed") > 3);
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let folder = scratch();
    let at = folder.path();
    write(at, "empty/readme.txt", "nothing");
    write(at, "thesis.txt", "mine");
    write(
        at,
        "wrong.toml",
        "schema = 1\n[tool]\nname = \"fogbench\"\nversion = \"0.1.0\"\n[[metric]]\nscenario = \"s\"\n",
    );
    run(at, "old", &[]);
    let mut transcript = Transcript::of("compare", "Refusals");
    let given: [(&[&str], i32); 8] = [
        (&["compare", "old", "nowhere"], 74),
        (&["compare", "old", "empty"], 2),
        (&["compare", "wrong.toml", "old"], 2),
        (&["baseline", "save", "old", "-o", "thesis.txt"], 2),
        (&["baseline", "save", "thesis.txt", "-o", "new.toml"], 2),
        (&["baseline", "update", "thesis.txt", "old"], 2),
        (
            &[
                "run",
                "scenarios",
                "--baseline",
                "wrong.toml",
                "-o",
                "never",
            ],
            2,
        ),
        (
            &["run", "scenarios", "--fail-on", "worse", "-o", "never"],
            2,
        ),
    ];
    for (arguments, ends) in given {
        let output = fogbench(at, arguments);
        assert_eq!(code(&output), ends, "{arguments:?}: {}", stderr(&output));
        transcript.case(arguments.join(" "), stderr(&output));
    }
    transcript.check();
    assert!(!at.join("never").exists());
    assert_eq!(
        fs::read_to_string(at.join("thesis.txt")).expect("stands"),
        "mine"
    );
}

#[test]
fn a_page_lays_figures_gates_and_curves_of_both_sides_over_each_other() {
    let folder = scratch();
    let at = folder.path();
    let gate = "[[gate]]\nmetric = \"raw.noise_std_deg_per_h\"\nmin = 0.001\nmax = 1000.0\n";
    write(
        at,
        "scenarios/one.toml",
        &format!("name = \"one\"\n{HEAD}{FILTER}{gate}"),
    );
    run(at, "old", &[]);
    run(at, "new", &[]);
    worsen(at, "new/one", "raw", "noise_std_deg_per_h", 8.0);
    let output = fogbench(at, &["compare", "old", "new", "--html", "page.html"]);
    assert_eq!(code(&output), 1, "{}", stderr(&output));
    let page = fs::read_to_string(at.join("page.html")).expect("a page");
    let figures = page.split("id=\"figures\"").nth(1).expect("figures");
    let first = figures.split("<tbody>").nth(1).expect("rows");
    let first = first.split("</tr>").next().expect("a row");
    assert!(first.contains("raw.noise_std_deg_per_h") || first.contains("noise_std_deg_per_h"));
    for part in [
        "worse",
        "class=\"zone\"",
        "class=\"before\"",
        "class=\"now\"",
    ] {
        assert!(first.contains(part), "{part} in {first}");
    }
    let curves = page.split("id=\"curves\"").nth(1).expect("curves");
    for part in [
        "raw, before",
        "raw, now",
        "mean, before",
        "one: Allan deviation",
    ] {
        assert!(curves.contains(part), "{part}");
    }
    // The run in which something differs comes first.
    let place = |name: &str| curves.find(&format!("{name}: Allan deviation"));
    assert!(place("one") < place("power(gyro.source.power_uw = 0.5)"));
    // It is replaced as often as one likes; a file of the user's is not.
    let again = fogbench(at, &["compare", "old", "old", "--html", "page.html"]);
    assert_eq!(code(&again), 0, "{}", stderr(&again));
    fs::write(at.join("notes.html"), "my notes").expect("writable");
    let refused = fogbench(at, &["compare", "old", "new", "--html", "notes.html"]);
    assert_eq!(code(&refused), 2, "{}", stderr(&refused));
    assert_eq!(
        fs::read_to_string(at.join("notes.html")).expect("a file"),
        "my notes"
    );
}

#[test]
fn the_page_of_a_suite_shows_its_baseline_and_no_folder_of_a_run_does() {
    let folder = scratch();
    let at = folder.path();
    run(at, "plain", &[]);
    run(at, "against", &["--baseline", "plain"]);
    let index = |output: &str| {
        fs::read_to_string(at.join(output).join("index.html")).expect("a page of the suite")
    };
    assert!(!index("plain").contains("Against the baseline"));
    for part in ["id=\"against\"", "raw, before", "raw, now"] {
        assert!(index("against").contains(part), "{part}");
    }
    for run in ["one", "power"] {
        assert_eq!(
            tree(&at.join("plain").join(run)),
            tree(&at.join("against").join(run))
        );
    }
    // A baseline in a file has figures and no curves.
    save(at, "plain");
    run(at, "file", &["--baseline", "b.toml"]);
    assert!(index("file").contains("id=\"against\"") && !index("file").contains("raw, before"));
}

#[test]
fn a_scenario_that_is_gone_from_a_folder_fails_and_one_that_was_not_asked_for_does_not() {
    let folder = scratch();
    let at = folder.path();
    run(at, "out", &[]);
    save(at, "out");
    let against = |paths: &[&str]| {
        let rest = ["-o", "later", "--baseline", "b.toml"];
        fogbench(at, &[&["run"], paths, &rest[..]].concat())
    };
    for asked in [
        &["scenarios/one.toml"][..],
        &["scenarios", "--filter", "one"],
    ] {
        let output = against(asked);
        assert_eq!(code(&output), 0, "{}", stdout(&output));
    }
    fs::remove_file(at.join("scenarios/power.toml")).expect("it is there");
    let output = against(&["scenarios"]);
    assert_eq!(code(&output), 1, "{}", stdout(&output));
    assert!(stdout(&output).contains("removed"), "{}", stdout(&output));
}

#[test]
fn what_fails_against_a_baseline_is_told_wherever_a_server_looks() {
    let folder = scratch();
    let at = folder.path();
    run(at, "out", &[]);
    save(at, "out");
    let files = ["--junit", "j.xml", "--summary-markdown", "s.md"];
    let against = || {
        let rest = ["--annotations", "github", "--baseline", "b.toml"];
        fogbench(
            at,
            &[&["run", "scenarios", "-o", "out"], &files[..], &rest].concat(),
        )
    };
    let text = |name: &str| fs::read_to_string(at.join(name)).expect("a file");
    let good = against();
    assert_eq!(code(&good), 0, "{}", stdout(&good));
    assert!(text("j.xml").contains("<testcase name=\"compared\" classname=\"baseline\""));
    assert!(
        text("s.md").starts_with("<!-- written by fogbench -->\n## fogbench: 3 of 3 runs passed\n")
    );
    // A figure that was far better before.
    let baseline = text("b.toml");
    let mut table: toml::Table = baseline.parse().expect("TOML");
    let metrics = table["metric"].as_array_mut().expect("figures");
    let noise = metrics.iter_mut().find(|it| {
        it["scenario"].as_str() == Some("one")
            && it["metric"].as_str() == Some("noise_std_deg_per_h")
            && it["channel"].as_str() == Some("raw")
    });
    let noise = noise.expect("it is there").as_table_mut().expect("a table");
    for key in ["value", "low", "high"] {
        let before = noise[key].as_float().expect("a number");
        noise.insert(key.to_owned(), (before / 2.0).into());
    }
    fs::write(at.join("b.toml"), toml::to_string(&table).expect("TOML")).expect("writable");
    let bad = against();
    assert_eq!(code(&bad), 1, "{}", stdout(&bad));
    let figure = "one raw.noise_std_deg_per_h";
    assert!(
        stdout(&bad).contains(
            "::error file=scenarios/one.toml,title=worse against the baseline::one raw.noise_std"
        ),
        "{}",
        stdout(&bad)
    );
    for junit in [text("j.xml"), text("out/junit.xml")] {
        let case = format!("<testcase name=\"{figure}\" classname=\"baseline\"");
        assert!(
            junit.contains(&case) && junit.contains("type=\"worse\""),
            "{junit}"
        );
    }
    assert!(text("s.md").contains("3 of 3 runs passed, 1 figure failed against the baseline"));
    let index = text("out/index.html");
    let badge = index.split("class=\"verdict\"").nth(1).expect("a verdict");
    assert!(badge.contains(">FAIL<"));
}

#[test]
fn no_file_that_is_read_is_written_be_it_by_force() {
    let folder = scratch();
    let at = folder.path();
    run(at, "out", &[]);
    save(at, "out");
    let before = (
        tree(&at.join("scenarios")),
        fs::read(at.join("b.toml")).expect("a file"),
    );
    for arguments in [
        "compare b.toml out --html b.toml --force",
        "compare b.toml out --html ./scenarios/../b.toml --force",
        "run scenarios -o out --baseline b.toml --junit b.toml --force",
        "run scenarios -o out --junit scenarios/one.toml --force",
        "run scenarios -o out --summary-markdown scenarios/one.toml --force",
        "run scenarios -o out --bmf scenarios/../scenarios/power.toml --force",
    ] {
        let words: Vec<&str> = arguments.split(' ').collect();
        let output = fogbench(at, &words);
        assert_eq!(code(&output), 2, "{arguments}: {}", stderr(&output));
        assert!(
            stderr(&output).contains("is read: nothing was done"),
            "{arguments}"
        );
    }
    let after = (
        tree(&at.join("scenarios")),
        fs::read(at.join("b.toml")).expect("a file"),
    );
    assert!(before == after);
}
