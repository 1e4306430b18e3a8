//! Whose the output folder is: nothing of the user's is replaced, one writes at a time, no finished folder
//! is lost and no stale result passes for a new one.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use fogbench::experiment::{Observer, Progress, SuiteOptions, SuiteOutcome, plan_suite, run_suite};
use fogbench::report::RunReport;
use fogbench::store::{OutputFolder, StoreOptions, SuiteFileNames};

use crate::support::{code, fogbench, repository, scratch, stderr, summary, tree, write};

const SHORT: &str = "schema = 1\nduration_s = 1.0\nwarm_up_s = 0.5\nfidelity = \"rate\"\n";

fn plain(folder: &Path, name: &str) {
    write(
        folder,
        &format!("{name}.toml"),
        &format!("name = \"{name}\"\n{SHORT}"),
    );
}

fn sweep(folder: &Path, name: &str, powers: &str) {
    let matrix = format!("[matrix]\n\"gyro.source.power_uw\" = {powers}\n");
    let text = format!("name = \"{name}\"\n{SHORT}{matrix}");
    write(folder, &format!("{name}.toml"), &text);
}

#[track_caller]
fn runs(folder: &Path, arguments: &[&str]) -> Output {
    let output = fogbench(folder, &[&["run"], arguments].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    output
}

/// Asserts that a command is refused with both names, and that nothing below `folder` changes.
#[track_caller]
fn is_refused(folder: &Path, arguments: &[&str], names: &[&str]) {
    let before = tree(folder);
    for _ in 0..3 {
        let output = fogbench(folder, arguments);
        let text = stderr(&output);
        assert_eq!(code(&output), 2, "{text}");
        for name in names {
            assert!(text.contains(name), "no `{name}` in {text}");
        }
        assert!(text.contains("--force"), "{text}");
        assert!(before == tree(folder), "something changed");
    }
}

fn names_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .expect("readable")
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

/// The points in the folder of a sweep.
fn points_in(folder: &Path) -> Vec<String> {
    let mut names = names_in(folder);
    names.retain(|name| name.bytes().all(|byte| byte.is_ascii_digit()));
    names
}

#[test]
fn a_folder_of_the_users_is_never_replaced_by_a_run() {
    let folder = scratch();
    let at = folder.path();
    plain(at, "s0");
    write(at, "s0/thesis.txt", "years of work");
    is_refused(at, &["run", "s0.toml", "-o", "."], &["s0", "thesis.txt"]);
    assert!(!at.join(".fogbench").exists(), "a refusal leaves no trace");
    // Among results as well, deep inside, as an empty folder, and among the points of a sweep.
    fs::remove_dir_all(at.join("s0")).expect("removable");
    runs(at, &["s0.toml", "-o", "."]);
    for file in ["s0/thesis.txt", "s0/samples/deep/thesis.txt"] {
        let path = write(at, file, "years of work");
        is_refused(at, &["run", "s0.toml", "-o", "."], &["thesis.txt"]);
        fs::remove_file(path).expect("removable");
    }
    fs::remove_dir(at.join("s0/samples/deep")).expect("removable");
    is_refused(at, &["run", "s0.toml", "-o", "."], &["samples"]);
    sweep(at, "sw", "[0.5, 0.87]");
    runs(at, &["sw.toml"]);
    for file in ["output/sw/thesis.txt", "output/sw/0001/thesis.txt"] {
        let path = write(at, file, "years of work");
        is_refused(at, &["run", "sw.toml"], &["sw", "thesis.txt"]);
        fs::remove_file(path).expect("removable");
    }
    runs(at, &["sw.toml"]);
}

#[test]
fn a_scenario_named_as_the_folder_of_scenarios_leaves_it_alone() {
    let folder = scratch();
    let text = format!("name = \"scenarios\"\n{SHORT}");
    write(folder.path(), "scenarios/set/a.toml", &text);
    is_refused(folder.path(), &["run", "-o", "."], &["scenarios", "a.toml"]);
}

#[test]
fn a_changed_file_and_a_link_are_the_users_until_forced() {
    let folder = scratch();
    let at = folder.path();
    plain(at, "s0");
    runs(at, &["s0.toml"]);
    let result = tree(at);
    for file in ["psd.csv", "manifest.toml", "summary.json"] {
        let path = at.join("output/s0").join(file);
        let text = fs::read_to_string(&path).expect("written");
        write(at, &format!("output/s0/{file}"), &format!("{text}# mine\n"));
        is_refused(at, &["run", "s0.toml"], &["s0", file, "changed"]);
        runs(at, &["s0.toml", "--force"]);
        assert!(result == tree(at), "the result is whole again");
    }
    // A file that is lacking is nobody's.
    fs::remove_file(at.join("output/s0/psd.csv")).expect("removable");
    runs(at, &["s0.toml"]);
    assert!(result == tree(at), "the result is whole again");
}

#[cfg(unix)]
#[test]
fn links_in_the_place_of_results_are_not_followed() {
    use std::os::unix::fs::symlink;

    let folder = scratch();
    let at = folder.path();
    plain(at, "s0");
    write(at, "elsewhere/kept.txt", "kept");
    runs(at, &["s0.toml"]);
    let link = at.join("output/s0/link");
    symlink(at.join("elsewhere"), &link).expect("links are supported");
    is_refused(at, &["run", "s0.toml"], &["s0", "link"]);
    fs::remove_dir_all(at.join("output/s0")).expect("removable");
    symlink(at.join("elsewhere"), at.join("output/s0")).expect("links are supported");
    is_refused(at, &["run", "s0.toml"], &["s0", "symbolic link"]);
    assert!(at.join("elsewhere/kept.txt").is_file());
}

#[test]
fn a_file_in_the_place_of_a_folder_stays_and_the_run_is_refused_each_time() {
    let folder = scratch();
    let at = folder.path();
    plain(at, "fl");
    write(at, "o/fl", "x");
    is_refused(at, &["run", "fl.toml", "-o", "o"], &["fl", "stands where"]);
    assert_eq!(names_in(&at.join("o")), ["fl"]);
}

#[test]
fn hidden_neighbours_of_the_users_are_no_leftovers() {
    let folder = scratch();
    let at = folder.path();
    plain(at, "s0");
    let own = [
        ".s0.old/a",
        ".s0.partial/b",
        ".junit.xml.partial",
        "notes.txt",
    ];
    for name in own {
        write(at, &format!("output/{name}"), "mine");
    }
    runs(at, &["s0.toml"]);
    runs(at, &["s0.toml"]);
    for name in own {
        assert_eq!(
            fs::read_to_string(at.join("output").join(name)).expect(name),
            "mine"
        );
    }
}

#[test]
fn the_suites_own_files_are_replaced_only_where_they_are_ours() {
    let folder = scratch();
    let at = folder.path();
    plain(at, "s0");
    for name in ["summary.json", "junit.xml", ".fogbench.toml"] {
        let path = write(at, &format!("out/{name}"), "{\"mine\": true}");
        is_refused(at, &["run", "s0.toml", "-o", "out"], &[name]);
        fs::remove_file(path).expect("removable");
    }
    runs(at, &["s0.toml", "-o", "out"]);
    runs(at, &["s0.toml", "-o", "out"]);
    write(at, "out/junit.xml", "<mine/>");
    is_refused(
        at,
        &["run", "s0.toml", "-o", "out"],
        &["junit.xml", "changed"],
    );
    // The folder of a run is no output folder.
    is_refused(at, &["run", "s0.toml", "-o", "out/s0"], &["summary.json"]);
    let table = "[[comparison]]\nname = \"T 1\"\ntitle = \"t\"\nkind = \"published\"\n\
                 columns = [\"raw.noise_std_deg_per_h\"]\n\
                 [[comparison_row]]\ncomparison = \"T 1\"\nlabel = \"a\"\nscenarios = [\"t\"]\n";
    write(at, "t.toml", &format!("name = \"t\"\n{SHORT}{table}"));
    write(at, "tables/published-t-1.csv", "mine");
    write(at, "tables/published-other.csv", "mine");
    is_refused(
        at,
        &["run", "t.toml", "-o", "tables"],
        &["published-t-1.csv"],
    );
    fs::remove_file(at.join("tables/published-t-1.csv")).expect("removable");
    runs(at, &["t.toml", "-o", "tables"]);
    assert!(at.join("tables/published-t-1.svg").is_file());
    assert!(at.join("tables/published-other.csv").is_file(), "not ours");
    // Without its table a suite leaves no file of it behind.
    runs(at, &["s0.toml", "-o", "tables"]);
    assert!(!at.join("tables/published-t-1.svg").exists());
    assert!(at.join("tables/published-other.csv").is_file(), "not ours");
}

/// Files that 0.1.0 did not write.
const LATER: [&str; 3] = ["metrics.csv", "index.html", "report.html"];

/// What 0.1.0 wrote, in its form: a manifest and a summary that name the tool, and no record.
fn without_records(folder: &Path) {
    for (path, _) in tree(folder) {
        let path = folder.join(path);
        let is_of_sweep = path.parent().is_some_and(|it| it.join("0000").is_dir());
        let is_later = is_of_sweep || LATER.iter().any(|name| path.ends_with(name));
        if is_later || path.ends_with(".fogbench.toml") {
            fs::remove_file(path).expect("removable");
        } else if path.ends_with("manifest.toml") {
            let text = fs::read_to_string(&path).expect("written");
            let head = text.split("\n[[file]]\n").next().expect("a head");
            let lines = head.lines().filter(|line| !line.starts_with("build = "));
            let old: String = lines.map(|line| format!("{line}\n")).collect();
            fs::write(&path, old).expect("writable");
        }
    }
    fs::remove_dir_all(folder.join(".fogbench")).expect("removable");
}

#[test]
fn results_of_the_version_without_records_are_known_by_their_names() {
    let folder = scratch();
    let at = folder.path();
    plain(at, "s0");
    sweep(at, "sw", "[0.5, 0.87]");
    runs(at, &["s0.toml", "sw.toml"]);
    let result = tree(&at.join("output"));
    without_records(&at.join("output"));
    write(at, "output/s0/thesis.txt", "mine");
    is_refused(at, &["run", "s0.toml"], &["s0", "thesis.txt"]);
    fs::remove_file(at.join("output/s0/thesis.txt")).expect("removable");
    runs(at, &["s0.toml", "sw.toml"]);
    assert!(result == tree(&at.join("output")), "replaced as a whole");
    without_records(&at.join("output"));
    write(at, "output/s0/manifest.toml", "[tool]\nname = \"other\"\n");
    is_refused(at, &["run", "s0.toml"], &["s0"]);
}

#[test]
fn a_second_writer_is_turned_away_and_told_who_holds_the_folder() {
    let folder = scratch();
    let at = folder.path();
    plain(at, "s0");
    let output = at.join("output");
    let held = OutputFolder::of_suite(
        &output,
        StoreOptions::default(),
        SuiteFileNames::default(),
        &|_| Ok(()),
    )
    .expect("a free folder");
    let second = fogbench(at, &["run", "s0.toml"]);
    let text = stderr(&second);
    assert_eq!(code(&second), 74, "{text}");
    assert!(
        text.contains(&format!("process {}", std::process::id())),
        "{text}"
    );
    assert!(!output.join("s0").exists());
    drop(held);
    let lock = output.join(".fogbench/lock");
    assert_eq!(fs::read(&lock).expect("the lock stays").len(), 0);
    runs(at, &["s0.toml"]);
    assert_eq!(fs::read(&lock).expect("the lock stays").len(), 0);
}

#[test]
fn of_two_at_once_either_ends_well_or_is_turned_away() {
    let folder = scratch();
    let at = folder.path();
    for name in ["s0", "s1", "s2"] {
        plain(at, name);
    }
    let files = ["s0.toml", "s1.toml", "s2.toml"];
    runs(at, &[&files[..], &["-o", "reference"]].concat());
    let start = || {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fogbench"));
        command.arg("run").args(files).current_dir(at);
        command.stdout(std::process::Stdio::null());
        command.stderr(std::process::Stdio::null());
        command.spawn().expect("the program starts")
    };
    for _ in 0..3 {
        let pair = [start(), start()];
        let codes = pair.map(|mut child| child.wait().expect("it ends").code());
        assert!(codes.contains(&Some(0)), "{codes:?}");
        assert!(
            codes.iter().all(|code| matches!(code, Some(0 | 74))),
            "{codes:?}"
        );
        assert!(tree(&at.join("reference")) == tree(&at.join("output")));
    }
}

#[test]
fn a_swap_cut_short_is_mended_by_the_run_of_another_scenario() {
    let folder = scratch();
    let at = folder.path();
    for name in ["s0", "s1"] {
        plain(at, name);
    }
    runs(at, &["s0.toml", "s1.toml"]);
    let result = tree(&at.join("output/s0"));
    let workshop = at.join("output/.fogbench");
    let journal = "place = \"s0\"\nnew = \"new-7\"\nold = \"old-7\"\n";
    // Killed between the two renames: with the new folder at hand, and without.
    for stands_as in ["new-7", "old-7"] {
        fs::rename(at.join("output/s0"), workshop.join(stands_as)).expect("movable");
        write(&workshop, "swap-7.toml", journal);
        write(&workshop, "new-9/half", "left by a kill");
        runs(at, &["s1.toml"]);
        assert!(result == tree(&at.join("output/s0")), "{stands_as}");
        assert_eq!(names_in(&workshop), ["lock"], "{stands_as}");
    }
}

#[test]
fn no_point_of_a_larger_sweep_and_no_plain_result_stays_beside_the_new_one() {
    let folder = scratch();
    let at = folder.path();
    let points = |output: &str| points_in(&at.join(output).join("s"));
    sweep(at, "s", "[0.5, 0.87, 2.0]");
    runs(at, &["s.toml"]);
    assert_eq!(points("output"), ["0000", "0001", "0002"]);
    sweep(at, "s", "[0.5]");
    runs(at, &["s.toml"]);
    assert_eq!(points("output"), ["0000"]);
    plain(at, "s");
    runs(at, &["s.toml"]);
    assert!(!points("output").contains(&"0000".to_owned()));
    assert!(at.join("output/s/summary.json").is_file());
    sweep(at, "s", "[0.5, 0.87]");
    runs(at, &["s.toml"]);
    assert_eq!(points("output"), ["0000", "0001"]);
    runs(at, &["s.toml", "-o", "fresh"]);
    assert!(
        tree(&at.join("output")) == tree(&at.join("fresh")),
        "as a fresh run"
    );
}

#[test]
fn one_point_touches_only_its_own_and_the_summary_names_what_is_stale() {
    let folder = scratch();
    let at = folder.path();
    sweep(at, "s", "[0.5, 0.87]");
    runs(at, &["s.toml", "-o", "small"]);
    plain(at, "s");
    runs(at, &["s.toml", "-o", "plain"]);
    sweep(at, "s", "[0.5, 0.87, 2.0, 3.0]");
    runs(at, &["s.toml"]);
    let before = tree(&at.join("output/s"));
    runs(at, &["small/s/0001/manifest.toml"]);
    let after = tree(&at.join("output/s"));
    let names = |tree: &[(PathBuf, Vec<u8>)]| -> Vec<PathBuf> {
        tree.iter().map(|(name, _)| name.clone()).collect()
    };
    assert_eq!(names(&before), names(&after));
    let suite = summary(&at.join("output"), ".");
    assert_eq!(suite["stale"], serde_json::json!(["s/0002", "s/0003"]));
    runs(at, &["small/s/0001/manifest.toml", "-o", "plain"]);
    assert_eq!(
        summary(&at.join("plain"), ".")["stale"],
        serde_json::json!(["s"])
    );
    assert!(at.join("plain/s/summary.json").is_file());
    sweep(at, "s", "[0.5, 0.87]");
    for output in ["output", "plain"] {
        runs(at, &["s.toml", "-o", output]);
        assert!(summary(&at.join(output), ".").get("stale").is_none());
        assert!(
            tree(&at.join(output)) == tree(&at.join("small")),
            "{output}"
        );
    }
}

/// Breaks every run while it is reported.
struct Breaks;

impl Progress for Breaks {}

impl Observer for Breaks {
    fn finished(&self, _: usize, _: &RunReport) {
        panic!("planted fault");
    }
}

#[test]
fn a_run_that_fails_leaves_no_earlier_result_in_its_place() {
    let folder = scratch();
    let at = folder.path();
    plain(at, "s0");
    runs(at, &["s0.toml"]);
    let result = tree(&at.join("output"));
    let plans = plan_suite(&[at.join("s0.toml")], &[]).expect("a sound scenario");
    let options = SuiteOptions::new(at.join("output"));
    run_suite(&plans, &options, &Breaks).expect("a writable folder");
    assert_eq!(
        names_in(&at.join("output/s0")),
        ["manifest.toml", "summary.json"]
    );
    let failed = summary(&at.join("output"), "s0");
    assert_eq!(failed["status"], "failed");
    let reason = failed["reason"].as_str().expect("a reason");
    assert!(reason.contains("planted fault"), "{reason}");
    runs(at, &["s0.toml"]);
    assert!(result == tree(&at.join("output")), "the result is back");
}

fn log(folder: &Path) {
    let text: String = (0..2000)
        .map(|k| format!("{}\n", (k * 37 % 101) - 50))
        .collect();
    write(folder, "log.csv", &text);
}

/// Groups of a perfect assembly at 32.03 degrees north.
fn groups(folder: &Path) {
    let heading = "mounting,rate_deg_per_s,temperature_c,averaging_time_s,output_x_deg_per_h,\
                  output_y_deg_per_h,output_z_deg_per_h\n";
    let mut rows = heading.to_owned();
    for (axis, index) in [("x", 0), ("y", 1), ("z", 2)] {
        for rate in [10.0, 50.0, 90.0] {
            let mut outputs = [0.0; 3];
            outputs[index] = 3600.0 * rate + 7.977;
            let [x, y, z] = outputs;
            rows += &format!("{axis},{rate},20,3600,{x},{y},{z}\n");
        }
    }
    write(folder, "groups.csv", &rows);
}

/// Runs a command that writes `file` into `dir` with files of the user's in its way, and without.
#[track_caller]
fn replaces_only_its_own(at: &Path, dir: &str, arguments: &[&str], file: &str) {
    let done = |arguments: &[&str]| {
        let output = fogbench(at, arguments);
        assert!(matches!(code(&output), 0 | 3), "{}", stderr(&output));
    };
    for name in ["thesis.txt", file] {
        let path = write(at, &format!("{dir}/{name}"), "mine");
        is_refused(at, arguments, &[dir, name]);
        fs::remove_file(path).expect("removable");
    }
    done(arguments);
    let result = tree(&at.join(dir));
    done(arguments);
    assert!(result == tree(&at.join(dir)), "{arguments:?}");
    write(at, &format!("{dir}/{file}"), "mine");
    is_refused(at, arguments, &[dir, file, "changed"]);
    write(at, &format!("{dir}/thesis.txt"), "mine");
    done(&[arguments, &["--force"]].concat());
    let mut forced = tree(&at.join(dir));
    forced.retain(|(name, bytes)| !(name.ends_with("thesis.txt") && bytes == b"mine"));
    assert!(
        result == forced,
        "what has another name stays: {arguments:?}"
    );
    fs::remove_file(at.join(dir).join("thesis.txt")).expect("it stays");
}

#[test]
fn commands_with_one_result_replace_only_what_is_theirs() {
    let folder = scratch();
    let at = folder.path();
    log(at);
    let scenario = repository("scenarios/quick/static.toml");
    let scenario = scenario.to_str().expect("a path in Unicode");
    groups(at);
    let log_options = ["--unit", "deg/h", "--rate-hz", "100"];
    let commands: [(Vec<&str>, &str); 5] = [
        (
            [&["analyze", "log.csv"], &log_options[..], &["-o", "DIR"]].concat(),
            "summary.json",
        ),
        (
            [
                &["filter", "log.csv"],
                &log_options[..],
                &["--filters", scenario, "-o", "DIR"],
            ]
            .concat(),
            "summary.json",
        ),
        (
            vec![
                "calibrate",
                "groups.csv",
                "--latitude-deg",
                "32.03",
                "-o",
                "DIR",
            ],
            "groups.csv",
        ),
        (vec!["budget", scenario, "-o", "DIR"], "budget.csv"),
        (
            vec![
                "export",
                "rtl",
                "DIR",
                "--stimulus",
                "log.csv",
                "--samples",
                "20",
            ],
            "run.sh",
        ),
    ];
    for (number, (command, file)) in commands.iter().enumerate() {
        let dir = format!("out-{number}");
        let arguments: Vec<&str> = command
            .iter()
            .map(|word| if *word == "DIR" { dir.as_str() } else { *word })
            .collect();
        replaces_only_its_own(at, &dir, &arguments, file);
    }
}

#[test]
fn an_export_leaves_no_file_of_an_earlier_one() {
    let folder = scratch();
    let at = folder.path();
    log(at);
    let scenario = repository("scenarios/quick/static.toml");
    let scenario = scenario.to_str().expect("a path in Unicode");
    let export = |form: &str, more: &[&str]| {
        let arguments = [&["export", form, "dir"], more].concat();
        let output = fogbench(at, &arguments);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
    };
    export("vectors", &["--samples", "20", "--scenario", scenario]);
    assert!(at.join("dir/in_codes.hex").is_file());
    export("vectors", &["--samples", "20", "--stimulus", "log.csv"]);
    assert!(!at.join("dir/in_codes.hex").exists());
    export("waveform", &["--stimulus", "log.csv"]);
    let left = [
        ".fogbench",
        ".fogbench.toml",
        "states.gtkwfilter",
        "wave.fst",
        "wave.vcd",
    ];
    assert_eq!(names_in(&at.join("dir")), left);
}

/// Does something in the output folder once the first run is finished.
struct Meanwhile<F>(std::sync::Mutex<Option<F>>);

impl<F> Progress for Meanwhile<F> where F: FnOnce() + Send {}

impl<F: FnOnce() + Send> Observer for Meanwhile<F> {
    fn finished(&self, _: usize, _: &RunReport) {
        let act = self.0.lock().expect("nothing panics here").take();
        if let Some(act) = act {
            act();
        }
    }
}

/// Runs scenarios one after the other into `output`, with `act` after the first.
fn run_with(at: &Path, files: &[&str], act: impl FnOnce() + Send) -> SuiteOutcome {
    let files: Vec<PathBuf> = files.iter().map(|file| at.join(file)).collect();
    let plans = plan_suite(&files, &[]).expect("sound scenarios");
    let options = SuiteOptions {
        threads: 1,
        ..SuiteOptions::new(at.join("output"))
    };
    let observer = Meanwhile(std::sync::Mutex::new(Some(act)));
    run_suite(&plans, &options, &observer).expect("a free folder")
}

/// Folder and status of every run in the suite's summary, which names `words` in its one error.
#[track_caller]
fn statuses(at: &Path, words: &[&str]) -> Vec<(String, String)> {
    let suite = summary(&at.join("output"), ".");
    let mut errors = Vec::new();
    let mut statuses = Vec::new();
    for run in suite["runs"].as_array().expect("runs") {
        let word = |key: &str| run[key].as_str().map(str::to_owned);
        statuses.push((
            word("folder").expect("a name"),
            word("status").expect("a word"),
        ));
        errors.extend(word("error"));
    }
    let [error] = &errors[..] else {
        panic!("{errors:?}");
    };
    for word in words {
        assert!(error.contains(word), "no `{word}` in {error}");
    }
    let junit = fs::read_to_string(at.join("output/junit.xml")).expect("written");
    assert!(junit.contains(words[0]), "{junit}");
    assert!(at.join("output/.fogbench.toml").is_file());
    statuses
}

fn pairs(expected: &[(&str, &str)]) -> Vec<(String, String)> {
    let pairs = expected.iter();
    pairs
        .map(|(one, other)| ((*one).to_owned(), (*other).to_owned()))
        .collect()
}

#[test]
fn a_file_that_comes_into_one_run_fails_that_run_alone() {
    let folder = scratch();
    let at = folder.path();
    sweep(at, "sw", "[0.5, 0.87, 2.0]");
    runs(at, &["sw.toml"]);
    let result = tree(&at.join("output"));
    for (file, reason) in [
        ("sw/0001/thesis.txt", "not written by fogbench"),
        ("sw/0001/allan.csv", "was changed"),
    ] {
        let file = file.replace("allan.csv", "psd.csv");
        let outcome = run_with(at, &["sw.toml"], || {
            write(at, &format!("output/{file}"), "years of work");
        });
        assert!(
            outcome.unwritten && outcome.failures.is_empty(),
            "{outcome:?}"
        );
        let expected = [
            ("sw/0000", "pass"),
            ("sw/0001", "run_failed"),
            ("sw/0002", "pass"),
        ];
        assert_eq!(statuses(at, &["sw/0001", &file, reason]), pairs(&expected));
        let text = fs::read_to_string(at.join("output").join(&file)).expect("it stays");
        assert_eq!(text, "years of work");
        let stale = &summary(&at.join("output"), ".")["stale"];
        assert_eq!(*stale, serde_json::json!(["sw/0001"]));
        assert_eq!(names_in(&at.join("output/.fogbench")), ["lock"]);
        fs::remove_file(at.join("output").join(&file)).expect("removable");
        runs(at, &["sw.toml", "--resume=any-build"]);
        assert!(result == tree(&at.join("output")), "brought right");
    }
}

#[test]
fn a_file_that_comes_into_a_stale_point_keeps_it_and_the_verdict_is_written() {
    let folder = scratch();
    let at = folder.path();
    sweep(at, "sw", "[0.5, 0.87, 2.0]");
    runs(at, &["sw.toml"]);
    sweep(at, "sw", "[0.5, 0.87]");
    let thesis = at.join("output/sw/0002/thesis.txt");
    let outcome = run_with(at, &["sw.toml"], || {
        fs::write(&thesis, "years of work").expect("writable");
    });
    let [failure] = &outcome.failures[..] else {
        panic!("{outcome:?}");
    };
    assert!(failure.contains("0002/thesis.txt"), "{failure}");
    assert!(thesis.is_file());
    let suite = summary(&at.join("output"), ".");
    assert_eq!(suite["stale"], serde_json::json!(["sw/0002"]));
    assert_eq!(suite["totals"]["passed"], 2);
    fs::remove_file(thesis).expect("removable");
    runs(at, &["sw.toml"]);
    assert_eq!(points_in(&at.join("output/sw")), ["0000", "0001"]);
}

#[test]
fn a_summary_that_comes_in_the_suites_place_stays_and_the_new_one_is_kept() {
    let folder = scratch();
    let at = folder.path();
    plain(at, "s0");
    runs(at, &["s0.toml"]);
    let verdict = fs::read_to_string(at.join("output/summary.json")).expect("written");
    let outcome = run_with(at, &["s0.toml"], || {
        write(at, "output/summary.json", "mine");
    });
    let [failure] = &outcome.failures[..] else {
        panic!("{outcome:?}");
    };
    for word in ["summary.json", "stays as it is", "kept-"] {
        assert!(failure.contains(word), "{failure}");
    }
    let text = |file: &str| fs::read_to_string(at.join("output").join(file)).expect("written");
    assert_eq!(text("summary.json"), "mine");
    assert!(text("junit.xml").contains("s0"));
    let names = names_in(&at.join("output/.fogbench"));
    let kept = names.iter().find(|name| name.starts_with("kept-"));
    let kept = kept.expect("the new one is kept");
    assert_eq!(text(&format!(".fogbench/{kept}/summary.json")), verdict);
    is_refused(at, &["run", "s0.toml"], &["summary.json"]);
    fs::remove_file(at.join("output/summary.json")).expect("removable");
    let next = runs(at, &["s0.toml"]);
    assert!(stderr(&next).contains(kept.as_str()), "{}", stderr(&next));
}

#[test]
fn journals_take_nothing_of_the_users() {
    let folder = scratch();
    let at = folder.path();
    for name in ["p", "q"] {
        plain(at, name);
    }
    // Killed while it changed the files of the folder; then the user wrote into one of them.
    runs(at, &["p.toml"]);
    let workshop = at.join("output/.fogbench");
    let journal = "new = \"new-7-0\"\nremoved = [\"note\"]\n\
                   installed = [\"summary.json\", \".fogbench.toml\"]\n";
    fs::create_dir(workshop.join("new-7-0")).expect("writable");
    for name in ["summary.json", ".fogbench.toml"] {
        let new = workshop.join("new-7-0").join(name);
        fs::rename(at.join("output").join(name), new).expect("movable");
    }
    write(&workshop, "update-7-0.toml", journal);
    write(at, "output/note", "mine");
    write(at, "output/summary.json", "thesis");
    for command in [
        &["run", "q.toml"][..],
        &["budget", "p.toml", "-o", "output"],
    ] {
        let output = fogbench(at, command);
        assert_eq!(code(&output), 2, "{}", stderr(&output));
        for (file, text) in [("note", "mine"), ("summary.json", "thesis")] {
            let path = at.join("output").join(file);
            assert_eq!(fs::read_to_string(path).expect("it stays"), text);
        }
    }
    assert!(workshop.join("kept-7-0/summary.json").is_file());
    fs::remove_file(at.join("output/summary.json")).expect("removable");
    runs(at, &["q.toml"]);
    assert_eq!(
        fs::read_to_string(at.join("output/note")).expect("mine"),
        "mine"
    );
}

#[test]
fn a_damaged_journal_is_named_and_stops_nobody() {
    let folder = scratch();
    let at = folder.path();
    plain(at, "p");
    runs(at, &["p.toml"]);
    let workshop = at.join("output/.fogbench");
    write(&workshop, "old-7-0/summary.json", "the only copy");
    fs::write(workshop.join("swap-7-0.toml"), b"\xff\xfe\x00").expect("writable");
    fs::create_dir(workshop.join("swap-8-0.toml")).expect("writable");
    write(&workshop, "update-9-0.toml", "");
    #[cfg(unix)]
    rustix_fifo(&workshop.join("swap-6-0.toml"));
    let output = runs(at, &["p.toml"]);
    let text = stderr(&output);
    for name in ["swap-7-0.toml", "swap-8-0.toml", "update-9-0.toml"] {
        assert!(text.contains(name), "{text}");
    }
    assert!(workshop.join("old-7-0/summary.json").is_file());
}

/// A pipe that nobody writes to.
#[cfg(unix)]
fn rustix_fifo(path: &Path) {
    let made = Command::new("mkfifo").arg(path).status();
    assert!(made.expect("a shell has it").success());
}

#[cfg(unix)]
#[test]
fn a_lock_is_never_taken_for_a_file_of_the_users() {
    let folder = scratch();
    let at = folder.path();
    plain(at, "p");
    write(at, "precious", "thesis");
    for kind in ["link", "hard link", "file", "pipe"] {
        let lock = at.join("output/.fogbench/lock");
        fs::create_dir_all(at.join("output/.fogbench")).expect("writable");
        match kind {
            "link" => std::os::unix::fs::symlink("../../precious", &lock).expect("links"),
            "hard link" => fs::hard_link(at.join("precious"), &lock).expect("links"),
            "file" => fs::write(&lock, "thesis").expect("writable"),
            _ => rustix_fifo(&lock),
        }
        for command in [
            &["run", "p.toml"][..],
            &["budget", "p.toml", "-o", "output"],
            &["run", "p.toml", "--force"],
        ] {
            let output = fogbench(at, command);
            assert_eq!(code(&output), 2, "{kind}: {}", stderr(&output));
            assert!(stderr(&output).contains("lock"), "{}", stderr(&output));
            let precious = fs::read_to_string(at.join("precious")).expect("it stays");
            assert_eq!(precious, "thesis", "{kind}");
            assert!(!at.join("output/p").exists());
        }
        if kind == "file" {
            assert_eq!(fs::read_to_string(&lock).expect("it stays"), "thesis");
        }
        fs::remove_dir_all(at.join("output")).expect("removable");
    }
    // What a killed holder leaves is no file of the user's.
    write(at, "output/.fogbench/lock", "process 12 on here\n");
    runs(at, &["p.toml"]);
}

#[test]
fn nobody_writes_inside_a_folder_that_is_being_written() {
    let folder = scratch();
    let at = folder.path();
    plain(at, "p");
    runs(at, &["p.toml"]);
    let output = at.join("output");
    let names = SuiteFileNames::default();
    let held = OutputFolder::of_suite(&output, StoreOptions::default(), names, &|_| Ok(()));
    let held = held.expect("a free folder");
    for inside in ["output/p", "output/new/deep"] {
        let second = fogbench(at, &["run", "p.toml", "-o", inside]);
        let text = stderr(&second);
        assert_eq!(code(&second), 74, "{text}");
        assert!(text.contains("output is in use by process"), "{text}");
        assert!(!at.join(inside).join(".fogbench").exists());
    }
    drop(held);
    runs(at, &["p.toml", "-o", "output/new/deep"]);
}

#[test]
fn an_output_folder_inside_the_folder_of_a_run_is_named_as_one() {
    let folder = scratch();
    let at = folder.path();
    plain(at, "p");
    runs(at, &["p.toml"]);
    runs(at, &["p.toml", "-o", "output/p/q"]);
    is_refused(
        at,
        &["run", "p.toml"],
        &["output/p/q", "output folder of its own"],
    );
    fs::remove_dir_all(at.join("output/p/q")).expect("removable");
    write(at, "output/p/manifest.toml", "");
    is_refused(at, &["run", "p.toml"], &["manifest.toml", "damaged"]);
}

#[test]
fn what_cannot_be_an_output_folder_is_refused_before_anything_runs() {
    let folder = scratch();
    let at = folder.path();
    plain(at, "p");
    write(at, "a-file", "mine");
    #[cfg(unix)]
    std::os::unix::fs::symlink("nowhere", at.join("dangling")).expect("links");
    let mut places = vec!["a-file", "a-file/deep", "o/.fogbench"];
    if cfg!(unix) {
        places.push("dangling");
    }
    for place in places {
        for command in [&["run"][..], &["budget"]] {
            let output = fogbench(at, &[command, &["p.toml", "-o", place]].concat());
            let text = stderr(&output);
            assert_eq!(code(&output), 2, "{place}: {text}");
            assert!(
                text.contains(place) && text.contains("nothing was done"),
                "{text}"
            );
        }
    }
    assert_eq!(
        fs::read_to_string(at.join("a-file")).expect("it stays"),
        "mine"
    );
    assert!(!at.join("o").exists() && !at.join("nowhere").exists());
}

#[test]
fn a_command_replaces_neither_what_it_reads_nor_results_of_another_kind() {
    let folder = scratch();
    let at = folder.path();
    log(at);
    groups(at);
    let scenario = repository("scenarios/quick/static.toml");
    let scenario = scenario.to_str().expect("a path in Unicode");
    let of_log = ["--unit", "deg/h", "--rate-hz", "100", "-o", "c"];
    let filter = |input| [&["filter", input, "--filters", scenario], &of_log[..]].concat();
    let analyze = |input| [&["analyze", input], &of_log[..]].concat();
    assert!(matches!(code(&fogbench(at, &filter("log.csv"))), 0 | 3));
    let samples = names_in(&at.join("c/samples"));
    let input = format!("c/samples/{}", samples[0]);
    let before = tree(at);
    for command in [
        analyze(&input),
        filter(&input),
        [&analyze(&input)[..], &["--force"]].concat(),
    ] {
        let output = fogbench(at, &command);
        let text = stderr(&output);
        assert_eq!(code(&output), 2, "{text}");
        assert!(text.contains(&input), "{text}");
        assert!(before == tree(at), "something changed");
    }
    let calibrate = |place| {
        vec![
            "calibrate",
            "groups.csv",
            "--latitude-deg",
            "32.03",
            "-o",
            place,
        ]
    };
    let budget = |place| vec!["budget", scenario, "-o", place];
    let export = |place| {
        vec![
            "export",
            "vectors",
            place,
            "--samples",
            "20",
            "--stimulus",
            "log.csv",
        ]
    };
    for command in [calibrate("c"), budget("c"), export("c")] {
        is_refused(at, &command, &["another kind"]);
    }
    assert_eq!(code(&fogbench(at, &budget("b"))), 0);
    for command in [calibrate("b"), export("b")] {
        is_refused(at, &command, &["another kind"]);
    }
    assert_eq!(
        code(&fogbench(
            at,
            &export("b")[..]
                .iter()
                .chain(&["--force"])
                .copied()
                .collect::<Vec<_>>()
        )),
        0
    );
    plain(at, "s0");
    runs(at, &["s0.toml"]);
    is_refused(at, &budget("output/s0"), &["manifest.toml", "another kind"]);
    is_refused(at, &budget("output"), &["another kind"]);
}
