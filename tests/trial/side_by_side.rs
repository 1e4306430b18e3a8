//! The page that lays the filters of a suite side by side, and the figures that it adds.

use std::fs;
use std::path::Path;

use crate::support::{assert_close, code, field, fogbench, stderr, summary, write};

const HEAD: &str = "schema = 1\nduration_s = 20.0\nwarm_up_s = 2.0\nfidelity = \"rate\"\n\
    [gyro.output]\naverage_samples = 20\n";

const FILTERS: &str = "[trial]\nblack_box = \"brief\"\n\
    [[filter]]\nname = \"mean\"\n[filter.moving_average]\ntaps = 16\n\
    [[filter]]\nname = \"pole\"\n[filter.one_pole]\ncutoff_hz = 4.0\n\
    [[filter]]\nname = \"line\"\n[filter.savitzky_golay]\ntaps = 16\n";

fn run(folder: &Path, scenarios: &[(&str, String)]) -> Option<String> {
    for (name, text) in scenarios {
        write(folder, &format!("{name}.toml"), text);
    }
    let files: Vec<String> = scenarios
        .iter()
        .map(|(name, _)| format!("{name}.toml"))
        .collect();
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    let output = fogbench(folder, &[&["run", "-o", "out"], &files[..]].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    fs::read_to_string(folder.join("out/filters.html")).ok()
}

fn scenario(name: &str, filters: &str, motion: &str) -> (&'static str, String) {
    let name: &'static str = name.to_owned().leak();
    (name, format!("name = \"{name}\"\n{HEAD}{motion}{filters}"))
}

#[test]
fn runs_of_the_same_filters_stand_side_by_side_and_others_on_their_own() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let swing = "[turntable.swing]\nrate_amplitude_deg_per_s = 0.1\nfrequency_hz = 0.5\n";
    let step = "[turntable.steps]\nrates_deg_per_s = [0.0, 0.1]\ndwell_s = 10.0\n";
    let other = FILTERS
        .replace("ntaps = 16", "ntaps = 17")
        .replace("taps = 16", "taps = 17");
    let alone = "[trial]\nblack_box = \"brief\"\n[[filter]]\nname = \"one\"\n[filter.one_pole]\ncutoff_hz = 4.0\n";
    let page = run(
        folder.path(),
        &[
            scenario("a-rest", FILTERS, ""),
            scenario("b-swing", FILTERS, swing),
            scenario("c-step", FILTERS, step),
            scenario("d-other", &other, ""),
            scenario("e-alone", alone, ""),
        ],
    )
    .expect("the page is written");
    assert_eq!(page.matches("<section id=\"filters-").count(), 2);
    assert!(page.contains("3 filters: a-rest to c-step") && page.contains("3 filters: d-other"));
    for run in ["a-rest", "b-swing", "c-step", "d-other"] {
        assert!(
            page.contains(&format!("href=\"{run}/report.html\"")),
            "{run}"
        );
    }
    assert!(!page.contains("e-alone"));
    let index = fs::read_to_string(folder.path().join("out/index.html")).expect("the index");
    assert!(index.contains("href=\"filters.html\""));
    // Without twins there is nothing to lay side by side, and no page of an earlier suite is left.
    let plain = FILTERS.replace("[trial]\nblack_box = \"brief\"\n", "");
    assert_eq!(run(folder.path(), &[scenario("a-rest", &plain, "")]), None);
    let index = fs::read_to_string(folder.path().join("out/index.html")).expect("the index");
    assert!(!index.contains("filters.html"));
}

#[test]
fn known_answers_of_the_noise_at_equal_delay() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    drop(run(folder.path(), &[scenario("rest", FILTERS, "")]));
    let found = summary(&folder.path().join("out"), "rest");
    let noise = |filter: &str| field(&found, &format!("{filter}.noise_at_equal_delay"), "value");
    // 4000 words of nearly white noise; the mean has 250 independent ones: a scatter of a tenth.
    assert_close(noise("mean"), 1.0, 0.0, 0.25);
    assert_close(noise("pole"), 1.0, 0.0, 0.25);
    // A straight line fitted to p words has no delay and (4 p - 2) / (p (p + 1)) of the noise.
    assert_close(noise("line"), 62.0 / 272.0, 0.2, 0.0);
    let of = |filter: &str, name: &str| {
        let metric = &found["channels"][filter]["metrics"]["noise_at_equal_delay"];
        metric[name]
            .as_f64()
            .or_else(|| metric["fields"][name].as_f64())
    };
    assert_eq!(of("mean", "mean_of_words"), Some(16.0), "{found}");
    assert_eq!(of("line", "mean_of_words").map(f64::round), Some(1.0));
    let cost = |filter: &str| field(&found, &format!("{filter}.operations_per_word"), "value");
    assert_close(cost("mean"), 31.0, 0.0, 0.0);
    assert_close(cost("pole"), 3.0, 0.0, 0.0);
}
