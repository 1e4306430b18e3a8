//! `run --resume`: what stands undamaged is taken over, and the end is that of an uninterrupted run.

use std::fs;
use std::path::Path;
use std::process::Output;

use crate::support::{code, fogbench, repository, stderr, stdout, tree, write};

const ANY: &str = "--resume=any-build";

fn copied(folder: &Path, set: &str) {
    let source = repository(&format!("scenarios/{set}"));
    for entry in fs::read_dir(source).expect("readable").flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if let Ok(text) = fs::read_to_string(entry.path()) {
            write(folder, &format!("scenarios/{set}/{name}"), &text);
        }
    }
}

fn run(folder: &Path, output: &str, more: &[&str]) -> Output {
    fogbench(
        folder,
        &[
            &["run", "scenarios/quick", "scenarios/own", "-o", output],
            more,
        ]
        .concat(),
    )
}

/// Names of the runs that a command says it took over.
fn taken_over(output: &Output) -> Vec<String> {
    let text = stderr(output);
    let names = text
        .lines()
        .filter_map(|line| line.strip_suffix(": taken over"));
    let mut names: Vec<String> = names.map(str::to_owned).collect();
    names.sort();
    names
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("writable");
    for entry in fs::read_dir(from).expect("readable").flatten() {
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &target);
        } else {
            fs::copy(entry.path(), target).expect("writable");
        }
    }
}

/// The shipped quick scenarios, a sweep with repeats and a table, and a diverging filter.
fn suite(folder: &Path) {
    copied(folder, "base");
    copied(folder, "quick");
    let short = "schema = 1\nduration_s = 2.0\nwarm_up_s = 0.5\nfidelity = \"rate\"\n";
    let sweep = "repeats = 2\n[matrix]\n\"gyro.source.power_uw\" = [0.5, 0.87]\n\
                 [[gate]]\nmetric = \"raw.noise_std_deg_per_h\"\nmax = 1.0\n\
                 [[comparison]]\nname = \"T\"\ntitle = \"t\"\nkind = \"sensitivity\"\n\
                 columns = [\"raw.noise_std_deg_per_h\"]\n\
                 [[comparison_row]]\ncomparison = \"T\"\nlabel = \"a\"\nscenarios = [\"sweep\"]\n";
    write(
        folder,
        "scenarios/own/sweep.toml",
        &format!("name = \"sweep\"\n{short}{sweep}"),
    );
    let diverging = "[[filter]]\nname = \"wrong\"\n[filter.rls]\nupdate_sign = \"as-printed\"\n";
    let text = format!("name = \"diverging\"\n{short}{diverging}");
    write(folder, "scenarios/own/diverging.toml", &text);
}

#[test]
fn a_resumed_suite_ends_as_an_uninterrupted_one() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    suite(at);
    let whole = run(at, "whole", &[]);
    let all: Vec<String> = ["diverging", "quick-script", "quick-static", "quick-step"]
        .into_iter()
        .chain([
            "quick-swing",
            "quick-three-axis",
            "sweep/0000",
            "sweep/0001",
        ])
        .map(str::to_owned)
        .collect();
    copy(&at.join("whole"), &at.join("out"));
    // Nothing to run: nothing changes, and the same is printed.
    let again = run(at, "out", &[ANY]);
    assert_eq!(taken_over(&again), all, "{}", stderr(&again));
    assert!(
        tree(&at.join("whole")) == tree(&at.join("out")),
        "taken over as a whole"
    );
    assert_eq!(stdout(&whole), stdout(&again));
    assert_eq!(code(&whole), code(&again));
    // A run that is lacking, one without a file, a suite without its verdict.
    fs::remove_dir_all(at.join("out/sweep/0001")).expect("removable");
    fs::remove_file(at.join("out/diverging/rate.svg")).expect("removable");
    fs::remove_file(at.join("out/summary.json")).expect("removable");
    let resumed = run(at, "out", &[ANY]);
    let mut left = all.clone();
    left.retain(|name| name != "sweep/0001" && name != "diverging");
    assert_eq!(taken_over(&resumed), left, "{}", stderr(&resumed));
    assert!(
        tree(&at.join("whole")) == tree(&at.join("out")),
        "the same bytes"
    );
    assert_eq!(stdout(&whole), stdout(&resumed));
    // A file that was changed is the user's until forced; then that run alone is run again.
    write(at, "out/sweep/0000/psd.csv", "changed");
    let refused = run(at, "out", &[ANY]);
    assert_eq!(code(&refused), 2, "{}", stderr(&refused));
    let forced = run(at, "out", &[ANY, "--force"]);
    left = all;
    left.retain(|name| name != "sweep/0000");
    assert_eq!(taken_over(&forced), left, "{}", stderr(&forced));
    assert!(
        tree(&at.join("whole")) == tree(&at.join("out")),
        "the same bytes"
    );
}

#[test]
fn only_the_same_scenario_seed_and_build_are_taken_over() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    let text = |comment: &str, seed: u32| {
        format!(
            "{comment}name = \"s\"\nschema = 1\nseed = {seed}\nduration_s = 1.0\nwarm_up_s = 0.5\n\
             fidelity = \"rate\"\n"
        )
    };
    let resumed = |with: &[&str]| {
        let output = fogbench(at, &[&["run", "s.toml"], with].concat());
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        taken_over(&output) == ["s"]
    };
    write(at, "s.toml", &text("", 1));
    assert!(!resumed(&[]));
    assert!(resumed(&[ANY]));
    let build = env!("FOGBENCH_BUILD");
    let is_certain = build != "unknown" && !build.ends_with("-dirty");
    assert_eq!(resumed(&["--resume"]), is_certain);
    // An input file with other bytes, another seed, another resolved value.
    write(at, "s.toml", &text("# said anew\n", 1));
    assert!(!resumed(&[ANY]));
    assert!(resumed(&[ANY]));
    write(at, "s.toml", &text("", 2));
    assert!(!resumed(&[ANY]));
    assert!(!resumed(&[ANY, "--set", "duration_s=1.5"]));
    // Another build of the same version.
    let manifest = at.join("output/s/manifest.toml");
    let written = fs::read_to_string(&manifest).expect("written");
    let line = format!("build = \"{build}\"");
    assert!(written.contains(&line), "{written}");
    fs::write(
        &manifest,
        written.replace(&line, "build = \"v9-1-gabcdef\""),
    )
    .expect("writable");
    let set = ["--set", "duration_s=1.5"];
    assert!(!resumed(&[&["--resume"], &set[..]].concat()));
    fs::write(
        &manifest,
        written.replace(&line, "build = \"v9-1-gabcdef\""),
    )
    .expect("writable");
    assert!(resumed(&[&[ANY], &set[..]].concat()));
}

#[test]
fn the_build_stands_in_the_version_and_the_manifest_alone() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    let build = env!("FOGBENCH_BUILD");
    let version = stdout(&fogbench(at, &["--version"]));
    let expected = format!("fogbench {} (build {build})\n", env!("CARGO_PKG_VERSION"));
    assert_eq!(version, expected);
    let text = "name = \"s\"\nschema = 1\nduration_s = 1.0\nwarm_up_s = 0.5\nfidelity = \"rate\"\n";
    write(at, "s.toml", text);
    assert_eq!(code(&fogbench(at, &["run", "s.toml"])), 0);
    for (name, bytes) in tree(&at.join("output")) {
        let found = String::from_utf8_lossy(&bytes).contains(&format!("\"{build}\""));
        assert_eq!(found, name.ends_with("manifest.toml"), "{}", name.display());
    }
}
