//! `init`: scenarios for gyros of all sizes, each of which runs as it is written.

use std::path::Path;

use crate::support::transcript::said_to_each;
use crate::support::{code, fogbench, scratch, stderr, stdout, summary};

fn words(line: &str) -> Vec<&str> {
    line.split(' ').collect()
}

/// Begins a scenario in a folder.
fn init(folder: &Path, gyro: &str) -> String {
    let output = fogbench(folder, &words(&format!("init -o my.toml --force {gyro}")));
    assert_eq!(code(&output), 0, "{gyro}: {}", stderr(&output));
    std::fs::read_to_string(folder.join("my.toml")).expect("written")
}

#[test]
fn a_gyro_of_any_size_gets_a_scenario_that_is_checked_and_runs() {
    let folder = scratch();
    for gyro in [
        "--length-m 1000 --diameter-mm 120 --wavelength-nm 1550",
        "--length-m 1000 --diameter-mm 120 --wavelength-nm 1550 --arw 0.0005",
        "--length-m 5000 --diameter-mm 300 --wavelength-nm 1550 --arw 0.00002",
        "--length-m 200 --diameter-mm 40 --wavelength-nm 850 --arw 0.1 --bias-instability 0.5",
        "--length-m 1000 --diameter-mm 120 --wavelength-nm 1550 --power-uw 40",
        "--length-m 50000 --diameter-mm 2000 --wavelength-nm 1310 --power-uw 0.1",
        "--length-m 50000 --diameter-mm 2000 --wavelength-nm 1310 --arw 1e-7",
        "--length-m 1 --diameter-mm 20 --wavelength-nm 1310 --arw 1",
        "--length-m 10 --diameter-mm 10 --wavelength-nm 5000 --power-uw 1000",
        "--length-m 800 --diameter-mm 70 --wavelength-nm 1310 --power-uw 100000",
        "--length-m 800 --diameter-mm 70 --wavelength-nm 1310 --power-uw 0.001",
    ] {
        let text = init(folder.path(), gyro);
        let check = fogbench(folder.path(), &["check", "my.toml"]);
        let said = format!("{}{}", stdout(&check), stderr(&check));
        assert_eq!(code(&check), 0, "{gyro}: {said}\n{text}");
        assert!(!said.contains("warning"), "{gyro}: {said}\n{text}");
        // The rate model, for the time of the test: what it refuses, the file would not have chosen.
        let short = "run my.toml --set duration_s=20.0 --set fidelity=rate";
        let run = fogbench(folder.path(), &words(short));
        assert_eq!(code(&run), 0, "{gyro}: {}\n{text}", stderr(&run));
        let Some((_, asked)) = gyro.split_once("--arw ") else {
            continue;
        };
        let asked: f64 = words(asked)[0].parse().expect("a number");
        let summary = summary(&folder.path().join("output"), "my-gyro");
        let walk = &summary["channels"]["raw"]["metrics"]["angle_random_walk_deg_per_sqrt_h"];
        if let (Some(low), Some(high)) = (walk["low"].as_f64(), walk["high"].as_f64()) {
            assert!(low < 1.02 * asked && 0.98 * asked < high, "{gyro}: {walk}");
        } else {
            panic!("{gyro}: {walk}");
        }
    }
}

#[test]
fn the_loop_model_of_a_begun_scenario_has_the_walk_of_the_data_sheet() {
    let folder = scratch();
    init(
        folder.path(),
        "--length-m 1000 --diameter-mm 120 --wavelength-nm 1550 --arw 0.002",
    );
    let run = fogbench(
        folder.path(),
        &words("run my.toml --set duration_s=4.0 --set warm_up_s=0.5"),
    );
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let summary = summary(&folder.path().join("output"), "my-gyro");
    let walk = &summary["channels"]["raw"]["metrics"]["angle_random_walk_deg_per_sqrt_h"];
    let bound = |name: &str| walk[name].as_f64().expect("a number");
    assert!(bound("low") < 0.002 && 0.002 < bound("high"), "{walk}");
    assert_eq!(summary["scenario"]["fidelity"], "loop");
}

#[test]
fn every_commented_line_of_a_begun_scenario_may_be_taken_in() {
    let folder = scratch();
    for gyro in [
        "--length-m 1000 --diameter-mm 120 --wavelength-nm 1550 --arw 0.002",
        "--length-m 800 --diameter-mm 70 --wavelength-nm 1310",
    ] {
        let text = init(folder.path(), gyro);
        assert!(text.matches("\n#| ").count() > 12, "{text}");
        let whole = text.replace("\n#| ", "\n").replace("\n#|\n", "\n\n");
        std::fs::write(folder.path().join("whole.toml"), &whole).expect("writable");
        let short = "run whole.toml --set fidelity=rate -o w";
        let run = fogbench(folder.path(), &words(short));
        assert_eq!(code(&run), 0, "{}{}\n{whole}", stdout(&run), stderr(&run));
        // A default that is written out is the default.
        let gates = |text: &str| {
            text.lines()
                .skip(1)
                .filter(|line| !line.contains("gate"))
                .count()
        };
        let expanded = |file: &str| stdout(&fogbench(folder.path(), &["expand", file]));
        let (plain, whole) = (expanded("my.toml"), expanded("whole.toml"));
        assert!(gates(&whole) > gates(&plain), "{whole}");
        for line in plain.lines().skip(1) {
            assert!(whole.contains(line), "{line}");
        }
    }
}

#[test]
fn a_file_that_stands_is_not_replaced_unasked() {
    let folder = scratch();
    let gyro = "--length-m 1000 --diameter-mm 120 --wavelength-nm 1550";
    init(folder.path(), gyro);
    std::fs::write(folder.path().join("my.toml"), "precious").expect("writable");
    let again = fogbench(folder.path(), &words(&format!("init -o my.toml {gyro}")));
    assert_eq!(code(&again), 2, "{}", stderr(&again));
    assert!(stderr(&again).contains("--force"), "{}", stderr(&again));
    let kept = std::fs::read_to_string(folder.path().join("my.toml")).expect("it stands");
    assert_eq!(kept, "precious");
}

#[test]
fn a_begun_scenario_and_what_is_refused_are_as_the_transcript_holds_them() {
    let lines = [
        "init --length-m 1000 --diameter-mm 120 --wavelength-nm 1550 --arw 0.0005 --name nav-120",
        "init --length-m 1000 --diameter-mm 120 --wavelength-nm 1550 --power-uw 20",
        "init --length-m -5 --diameter-mm 120 --wavelength-nm 1550",
        "init --length-m 1000 --diameter-mm 120 --wavelength-nm 1.55",
        "init --length-m 1000 --diameter-mm 120",
        "init --length-m 1000 --diameter-mm 120 --wavelength-nm 1550 --arw 0",
        "init --length-m 1000 --diameter-mm 120 --wavelength-nm 1550 --arw 1 --power-uw 2",
        "init --length-m 1000 --diameter-mm 120 --wavelength-nm 1550 --arw 10000",
        "init --length-m 1000 --diameter-mm 120 --wavelength-nm 1550 --name Mine",
        "init --length-m 1000 --diameter-mm 120 --wavelength-nm 1550 --name raw",
        "init --length-m 1000 --diameter-mm 120 --wavelength-nm 1550 --force",
    ];
    let folder = scratch();
    said_to_each("init", "Begun and refused", lines, |line| {
        let output = fogbench(folder.path(), &words(line));
        let ended = match code(&output) {
            0 => String::new(),
            code => format!("exit code {code}\n"),
        };
        // A line of a transcript that begins with a hash is a title.
        let said = format!("{ended}{}{}", stdout(&output), stderr(&output));
        said.lines().map(|line| format!("  {line}\n")).collect()
    });
}
