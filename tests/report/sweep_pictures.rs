//! Pictures of sweeps: what they show, where they stand and whose they are.

use std::fs;
use std::path::Path;

use crate::support::svg::Svg;
use crate::support::{code, fogbench, stderr, stdout, tree, write};

const SHORT: &str = "schema = 1\nduration_s = 1.0\nwarm_up_s = 0.5\nfidelity = \"rate\"\n\
                     [[filter]]\nname = \"l\"\n[filter.lms]\n";
const PICTURE: &str = "mean-deg-per-h.svg";

fn sweep(folder: &Path, matrix: &str) {
    let text = format!("name = \"s\"\n{SHORT}[matrix]\n{matrix}\n");
    write(folder, "s.toml", &text);
}

fn read(folder: &Path, name: &str) -> Svg {
    Svg::read(&fs::read_to_string(folder.join(name)).expect("a picture"))
}

#[track_caller]
fn run(folder: &Path, arguments: &[&str], expected: u8) -> String {
    let output = fogbench(folder, &[&["run"], arguments].concat());
    assert_eq!(code(&output), i32::from(expected), "{}", stderr(&output));
    stderr(&output)
}

#[test]
fn a_sweep_draws_its_headline_metrics_beside_its_points_and_in_the_page() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    let matrix = "\"gyro.source.power_uw\" = { from = 0.5, to = 2.0, count = 4 }\nseed = [3]";
    sweep(at, matrix);
    run(at, &["s.toml"], 0);
    let svg = read(at, &format!("output/s/{PICTURE}"));
    assert!(svg.says("s: mean over gyro.source.power_uw"), "{svg:?}");
    assert!(svg.says("seed = 3"), "what stays the same is said");
    for text in [
        "gyro.source.power_uw [uW]",
        "raw",
        "l",
        "0.5",
        "1",
        "1.5",
        "2",
    ] {
        assert!(svg.says(text), "{text}");
    }
    // A circle and its ring at each of the four points, all of them in the frame.
    let inside = svg.circles.iter().filter(|at| svg.is_in_frame(**at));
    assert_eq!(inside.count(), 8);
    let places: Vec<f64> = svg.circles.iter().map(|(x, _)| *x).take(8).collect();
    let steps: Vec<f64> = places.windows(3).map(|it| it[2] - it[0]).collect();
    let steps: Vec<f64> = steps.into_iter().step_by(2).collect();
    assert!((steps[0] - steps[2]).abs() < 1.0, "equal steps: {steps:?}");
    let page = fs::read_to_string(at.join("output/index.html")).expect("a page");
    assert!(page.contains(&format!("href=\"s/{PICTURE}\"")));
    assert!(page.contains("aria-label=\"mean over gyro.source.power_uw\""));
    let record = fs::read_to_string(at.join("output/s/.fogbench.toml")).expect("a record");
    assert!(record.contains(PICTURE) && record.contains("holds = \"sweep\""));
}

#[test]
fn a_list_says_what_each_point_sets() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    let range = "{ from = 0.5, to = 2.0, count = 3, spacing = \"log\" }";
    sweep(at, &format!("\"gyro.source.power_uw\" = {range}"));
    let text = stdout(&fogbench(at, &["list", "s.toml"]));
    assert!(
        text.contains("s/0001  1 s  gyro.source.power_uw = 1.0\n"),
        "{text}"
    );
    let json = stdout(&fogbench(at, &["list", "s.toml", "--format", "json"]));
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(json[2]["sweep"]["gyro.source.power_uw"], 2.0);
}

#[test]
fn an_axis_is_logarithmic_where_the_values_are_spaced_so() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    for (range, is_log) in [
        (
            "{ from = 0.1, to = 10.0, count = 3, spacing = \"log\" }",
            true,
        ),
        ("{ from = 0.1, to = 10.0, count = 3 }", false),
        (
            "{ from = 0.1, to = 2.0, count = 9, spacing = \"log\" }",
            true,
        ),
        ("{ from = 0.1, to = 2.0, count = 9 }", false),
    ] {
        sweep(at, &format!("\"gyro.source.power_uw\" = {range}"));
        run(at, &["s.toml", "--set", "gyro.adc.bits=0"], 0);
        let svg = read(at, &format!("output/s/{PICTURE}"));
        assert_eq!(svg.panels[0]["x"]["log"], is_log, "{range}");
    }
}

#[test]
fn the_folder_of_a_sweep_stays_the_programs() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    sweep(at, "\"gyro.source.power_uw\" = [0.5, 1.0, 2.0]");
    run(at, &["s.toml"], 0);
    let first = tree(&at.join("output"));
    run(at, &["s.toml"], 0);
    assert!(first == tree(&at.join("output")), "the same again");
    // One point is no sweep: it draws nothing, and leaves what stands.
    let point = "output/s/0001/manifest.toml";
    let said = run(at, &[point, "-o", "alone"], 0);
    assert!(!at.join("alone/s").join(PICTURE).exists(), "{said}");
    let sweep_folder = tree(&at.join("output/s"));
    run(at, &[point], 0);
    assert!(sweep_folder == tree(&at.join("output/s")), "left alone");
    // A smaller sweep replaces points and pictures.
    sweep(at, "\"gyro.source.power_uw\" = [0.5, 2.0]");
    run(at, &["s.toml"], 0);
    run(at, &["s.toml", "-o", "fresh"], 0);
    assert!(tree(&at.join("fresh/s")) == tree(&at.join("output/s")));
    // What the user changed is the user's.
    write(at, &format!("output/s/{PICTURE}"), "mine");
    let refused = run(at, &["s.toml"], 2);
    assert!(refused.contains(PICTURE), "{refused}");
    run(at, &["s.toml", "--force"], 0);
    assert!(tree(&at.join("fresh/s")) == tree(&at.join("output/s")));
}

#[test]
fn a_point_without_a_value_is_said_and_words_have_an_axis_of_their_own() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    sweep(
        at,
        "\"filter.l.update_sign\" = [\"corrected\", \"as-printed\"]",
    );
    run(at, &["s.toml"], 3);
    let svg = read(at, &format!("output/s/{PICTURE}"));
    for text in [
        "no value at 1 of 2 points",
        "corrected",
        "as-printed",
        "filter.l.update_sign",
    ] {
        assert!(svg.says(text), "{text}");
    }
}
