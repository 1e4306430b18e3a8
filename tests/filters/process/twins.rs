//! Programs on twins of their own record: what they cannot hide, and how often they are started for it.

use std::path::Path;

use serde_json::Value;

use super::{HEAD, allowed, has, misbehaving, program, scratch};

const WHOLE: &str = "[trial]\nblack_box = \"whole\"\n";
const BRIEF: &str = "[trial]\nblack_box = \"brief\"\n";

/// Value of a figure of a channel; none where it is unavailable.
fn figure(run: &Value, channel: &str, key: &str) -> Option<f64> {
    run["channels"][channel]["metrics"][key]["value"].as_f64()
}

#[test]
fn a_program_that_reads_ahead_inside_a_block_is_found_out() {
    if !has("python3") {
        return;
    }
    let folder = tempfile::tempdir().expect("a scratch folder");
    misbehaving(
        folder.path(),
        "hello()\nwhile True:\n    n, b = block()\n    if n == 0: break\n\
         \x20   w = struct.unpack('<%dd' % n, b)\n\
         \x20   y = [0.5 * (w[k] + w[min(k + 3, n - 1)]) for k in range(n)]\n\
         \x20   say(struct.pack('<I%dd' % n, n, *y))",
    );
    let ahead = program("p", "[\"python3\", \"./bad.py\"]", "block_samples = 100");
    let run = allowed(folder.path(), &format!("{HEAD}{ahead}{WHOLE}"), 0);
    assert_eq!(figure(&run, "p", "look_ahead_samples"), Some(3.0));
    let found = &run["channels"]["p"]["metrics"]["look_ahead_samples"];
    let change = found["change_by_single_words_deg_per_h"].as_f64();
    assert!(change > Some(1.0), "{found}");
    let verdict = run["channels"]["p"]["verdict"].to_string();
    assert!(verdict.contains("looks 3 samples ahead"), "{verdict}");
}

#[test]
fn twins_show_the_same_of_a_filter_of_the_bench_and_of_a_program_with_its_words() {
    if !has("python3") {
        return;
    }
    let folder = scratch();
    let own = "[[filter]]\nname = \"own\"\n[filter.moving_average]\ntaps = 8\n";
    let taps = "parameters = { taps = 8 }\nblock_samples = 1000";
    let python = program("python", "[\"python3\", \"./mean.py\"]", taps);
    let text = format!("{HEAD}{own}{python}{WHOLE}");
    let run = allowed(folder.path(), &text, 0);
    let keys = fogbench::metrics::known_metrics().iter();
    let keys = keys.filter(|key| key.applies == fogbench::metrics::Applies::Twins);
    let mut known = 0;
    for key in keys {
        let of_bench = figure(&run, "own", key.name);
        assert_eq!(figure(&run, "python", key.name), of_bench, "{}", key.name);
        known += usize::from(of_bench.is_some());
    }
    // The record is too short for steps of 10 s and 100 s.
    assert_eq!(known, 18, "{}", run["channels"]["own"]);
    let glitch = figure(&run, "own", "glitch_response").expect("a figure");
    assert!((glitch - 0.125).abs() < 1e-12, "{glitch}");
    // Another run gives the same bytes, and a run that does not ask has none of it.
    let again = allowed(folder.path(), &text, 0);
    assert_eq!(run, again);
    let without = allowed(folder.path(), &format!("{HEAD}{own}"), 0);
    assert!(!without.to_string().contains("look_ahead"), "{without}");
}

/// A mean of two words in Python that notes each of its starts, and what it says of itself.
fn noting(folder: &Path, stateless: bool, words: &str) -> String {
    let says = if stateless {
        ", \"stateless\": true"
    } else {
        ""
    };
    let starts = folder.join("starts.txt");
    misbehaving(
        folder,
        &format!(
            "open('{}', 'a').write('x')\ni.readline()\n\
             say(b'{{\"fogbench_filter\": 1, \"name\": \"x\", \"version\": \"1\"{says}}}\\n')\n\
             seen = 0\nwhile True:\n    n, b = block()\n    if n == 0: break\n\
             \x20   w = struct.unpack('<%dd' % n, b)\n\
             \x20   y = [{words} for k in range(n)]\n    seen += 1\n\
             \x20   say(struct.pack('<I%dd' % n, n, *y))",
            starts.display()
        ),
    );
    program("p", "[\"python3\", \"./bad.py\"]", "mode = \"record\"")
}

/// Starts of the program since the last look.
fn starts(folder: &Path) -> usize {
    let path = folder.join("starts.txt");
    let count = std::fs::read(&path).expect("it was started").len();
    std::fs::remove_file(path).expect("ours");
    count
}

#[test]
fn a_stateless_program_answers_many_records_from_few_starts_with_the_same_figures() {
    if !has("python3") {
        return;
    }
    let folder = tempfile::tempdir().expect("a scratch folder");
    let mean = "0.5 * (w[k] + w[max(k - 1, 0)])";
    let fresh = noting(folder.path(), false, mean);
    let run = allowed(folder.path(), &format!("{HEAD}{fresh}{BRIEF}"), 0);
    let twins = starts(folder.path());
    assert!(twins > 15, "{twins} starts");
    let kept = noting(folder.path(), true, mean);
    let again = allowed(folder.path(), &format!("{HEAD}{kept}{BRIEF}"), 0);
    // One for the record, and one for each length of a twin and each thread that asks at the same time.
    let few = starts(folder.path());
    assert!(few < twins / 2, "{few} of {twins} starts");
    assert_eq!(run["channels"], again["channels"]);
}

#[test]
fn a_program_that_only_says_it_is_stateless_is_found_out() {
    if !has("python3") {
        return;
    }
    let folder = tempfile::tempdir().expect("a scratch folder");
    let liar = noting(folder.path(), true, "w[k] + seen");
    let run = allowed(folder.path(), &format!("{HEAD}{liar}{BRIEF}"), 0);
    let lack = &run["channels"]["p"]["unavailable"]["look_ahead_samples"];
    let lack = lack.as_str().expect("a reason");
    assert!(lack.contains("answered the same words otherwise"), "{lack}");
}
