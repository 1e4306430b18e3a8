//! Bounds of what is read and printed: each is named in the message, and none is passed by a
//! hostile input.

use std::fs;
use std::path::Path;
use std::process::Command;

use fogbench::scenario::{load_suite, manifest_toml};

use crate::support::{code, fogbench, stderr, stdout, write};

/// A sound scenario.
const SOUND: &str = "schema = 1\nname = \"x\"\nduration_s = 20.0\n";

/// Most bytes of a text.
const BYTES_MAX: usize = 16_000_000;

fn scratch() -> tempfile::TempDir {
    tempfile::tempdir().expect("a scratch folder")
}

/// What `check` says about `x.toml`, whose text this is; it must refuse it.
#[track_caller]
fn refusal(folder: &Path, text: &str) -> String {
    write(folder, "x.toml", text);
    let output = fogbench(folder, &["check", "x.toml"]);
    assert_eq!(code(&output), 2, "{}", stdout(&output));
    stderr(&output)
}

/// A text of so many bytes: a sound scenario and a comment.
fn padded(bytes: usize) -> String {
    let head = format!("{SOUND}#");
    format!("{head}{}\n", "x".repeat(bytes - head.len() - 1))
}

#[cfg(unix)]
#[test]
fn devices_and_pipes_are_refused_wherever_a_file_is_named() {
    let folder = scratch();
    let pipe = folder.path().join("pipe.toml");
    let made = Command::new("mkfifo").arg(&pipe).status();
    assert!(made.expect("mkfifo is there").success());
    for (name, kind) in [("/dev/zero", "a device"), ("pipe.toml", "a pipe")] {
        let said = format!("it is {kind}, not a regular file");
        let output = fogbench(folder.path(), &["check", name]);
        assert_eq!(code(&output), 2);
        assert!(stderr(&output).contains(&said), "{}", stderr(&output));
        for text in [
            format!("extends = \"{name}\"\n{SOUND}"),
            format!("{SOUND}[turntable.script]\nfile = \"{name}\"\n"),
            format!("{SOUND}[gyro.assembly]\n[compensation]\nfile = \"{name}\"\n"),
            format!("{SOUND}[gyro.assembly]\n[compensation]\ncampaign = \"{name}\"\n"),
        ] {
            let refusal = refusal(folder.path(), &text);
            assert!(refusal.contains(&said), "{text}: {refusal}");
            assert!(
                refusal.contains(name) && refusal.contains("x.toml:"),
                "{refusal}"
            );
        }
    }
}

#[cfg(unix)]
#[test]
fn a_link_to_a_regular_file_is_as_good_as_the_file() {
    let folder = scratch();
    let file = write(folder.path(), "there/x.toml", SOUND);
    std::os::unix::fs::symlink(file, folder.path().join("link.toml")).expect("a link");
    assert_eq!(code(&fogbench(folder.path(), &["check", "link.toml"])), 0);
}

#[test]
fn a_text_may_hold_16_megabytes_and_not_a_byte_more() {
    let folder = scratch();
    write(folder.path(), "x.toml", &padded(BYTES_MAX));
    assert_eq!(code(&fogbench(folder.path(), &["check", "x.toml"])), 0);
    let said = "the file holds 16000001 bytes: allowed up to 16000000 (16 MB)";
    let long = padded(BYTES_MAX + 1);
    let refused = refusal(folder.path(), &long);
    assert!(
        refused.contains("x.toml: ") && refused.contains(said),
        "{refused}"
    );
    for (name, key) in [
        ("long.csv", "[turntable.script]\nfile = \"long.csv\"\n"),
        (
            "c.toml",
            "[gyro.assembly]\n[compensation]\nfile = \"c.toml\"\n",
        ),
    ] {
        write(folder.path(), name, &long);
        let refused = refusal(folder.path(), &format!("{SOUND}{key}"));
        assert!(
            refused.contains(name) && refused.contains(said),
            "{refused}"
        );
    }
    write(folder.path(), "base.toml", &padded(BYTES_MAX / 2 + 1));
    let both = format!("extends = \"base.toml\"\n{}", padded(BYTES_MAX / 2));
    let refused = refusal(folder.path(), &both);
    assert!(
        refused.contains("more than 16000000 bytes together"),
        "{refused}"
    );
}

#[test]
fn bases_stand_64_below_one_another_and_no_more() {
    let folder = scratch();
    for index in 0..2000 {
        let text = format!("extends = \"b{}.toml\"\n", index + 1);
        write(folder.path(), &format!("b{index}.toml"), &text);
    }
    write(folder.path(), "b2000.toml", "duration_s = 20.0\n");
    let last = folder.path().join("b64.toml");
    let scenario = "extends = \"b1.toml\"\nschema = 1\nname = \"x\"\n";
    let refused = refusal(folder.path(), scenario);
    let said =
        "b64.toml:1:1: extends = \"b65.toml\" is base 65 below one another: allowed up to 64";
    assert!(refused.contains(said), "{refused}");
    fs::write(last, "duration_s = 20.0\n").expect("writable");
    assert_eq!(code(&fogbench(folder.path(), &["check", "x.toml"])), 0);
}

#[test]
fn arrays_have_a_length_and_documents_a_size() {
    let folder = scratch();
    let rates = "0.0, ".repeat(100_001);
    let text = format!("{SOUND}[turntable.steps]\nrates_deg_per_s = [{rates}]\ndwell_s = 1.0\n");
    let refused = refusal(folder.path(), &text);
    assert!(
        refused.contains("rates_deg_per_s holds 100001 values: allowed up to 100000"),
        "{refused}"
    );
    for (part, count) in [("1,", 7_900_000), ("[],", 5_200_000), ("{},", 5_200_000)] {
        let text = format!("{SOUND}x = [{}]\n", part.repeat(count));
        assert!(
            text.len() < BYTES_MAX,
            "the size of the text is not the point"
        );
        let refused = refusal(folder.path(), &text);
        assert!(refused.contains("x.toml:4:"), "{refused}");
        assert!(
            refused.contains("too many values") && refused.contains("200 MB"),
            "{refused}"
        );
    }
    let tables = format!("{SOUND}{}", "[[gate]]\n".repeat(10_001));
    let refused = refusal(folder.path(), &tables);
    assert!(
        refused.contains("gate holds 10001 tables: allowed up to 10000"),
        "{refused}"
    );
}

#[test]
fn fifty_complaints_are_printed_and_the_rest_counted() {
    let folder = scratch();
    let keys: String = (0..1000).map(|index| format!("k{index} = 1\n")).collect();
    for command in ["check", "run", "expand", "list", "budget", "calibrate"] {
        write(folder.path(), "x.toml", &format!("{SOUND}{keys}"));
        let output = fogbench(folder.path(), &[command, "x.toml"]);
        assert_eq!(code(&output), 2);
        let said = stderr(&output);
        let complaints = said.matches("unknown key k").count();
        assert_eq!(complaints, 50, "{command}");
        assert_eq!(said.lines().last(), Some("and 950 more"), "{command}");
    }
}

#[test]
fn long_values_and_keys_are_shortened_with_their_length() {
    let folder = scratch();
    let long = "y".repeat(100_000);
    write(folder.path(), "x.toml", SOUND);
    let brackets = format!("gyro.coil.length_m={}", "[".repeat(100_000));
    for argument in [
        brackets.as_str(),
        &format!("fidelity={long}"),
        &format!("{long}=1"),
        &format!("filter.{long}.taps=1"),
        &long,
    ] {
        let output = fogbench(folder.path(), &["check", "x.toml", "--set", argument]);
        assert_eq!(code(&output), 2);
        let said = stderr(&output);
        assert!(said.len() < 1500, "{} bytes: {}", said.len(), &said[..500]);
        assert!(said.contains("characters)"), "{said}");
    }
    for text in [
        format!("{SOUND}fidelity = \"{long}\"\n"),
        format!("{SOUND}seed = \"{long}\"\n"),
        format!("{SOUND}{long} = 1\n"),
        format!("{SOUND}[[filter]]\nname = \"{long}\"\n[filter.rls]\n"),
        format!("extends = \"{long}\"\n{SOUND}"),
        format!("{SOUND}[[gate]]\nmetric = \"{long}.mean\"\nmax = 1.0\n"),
    ] {
        let said = refusal(folder.path(), &text);
        assert!(
            said.len() < 10_000,
            "{} bytes: {}",
            said.len(),
            &said[..500]
        );
        assert!(said.contains("characters)"), "{said}");
    }
    let output = fogbench(folder.path(), &["timing", "--taps", &long]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).len() < 10_000);
}

/// What `check` says about a manifest with one text in the place of another.
#[track_caller]
fn said_about_manifest(from: &str, to: &str) -> (i32, String) {
    let folder = scratch();
    let sweep = "[matrix]\nseed = [5, 6]\n";
    let file = write(folder.path(), "s/x.toml", &format!("{SOUND}{sweep}"));
    let run = load_suite(&[file], &[]).expect("a sound sweep").remove(1);
    let manifest = manifest_toml(&run, env!("CARGO_PKG_VERSION"), "unknown");
    assert!(manifest.contains(from), "{manifest}");
    write(folder.path(), "m.toml", &manifest.replace(from, to));
    let output = fogbench(folder.path(), &["check", "m.toml"]);
    (code(&output), stderr(&output))
}

#[test]
fn a_changed_manifest_says_so_and_what_was_changed() {
    assert_eq!(said_about_manifest("name", "name"), (0, String::new()));
    for (from, to, what) in [
        ("seed = 6", "seed = 7", "[scenario] has the digest"),
        ("digest = \"", "digest = \"0", "[scenario] has the digest"),
        (
            "value = \"6\"",
            "value = \"5\"",
            "origin.sweep says seed = 5, but [scenario] has 6",
        ),
        (
            "[origin]\nfile = \"x.toml\"",
            "[origin]\nfile = \"y.toml\"",
            "origin.file = \"y.toml\"",
        ),
    ] {
        let (code, said) = said_about_manifest(from, to);
        assert_eq!(code, 0, "{said}");
        assert!(
            said.contains("warning: m.toml: this manifest was changed: "),
            "{said}"
        );
        assert!(said.contains(what), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
    }
}

#[test]
fn a_manifest_holds_a_point_that_a_sweep_can_have() {
    for (from, to, what) in [
        (
            "\nindex = 1",
            "\nindex = 99999999999",
            ":1: origin.sweep.index = 99999999999 is out",
        ),
        (
            "\nindex = 1",
            "\nindex = 2",
            "origin.sweep.index = 2 is out of range: allowed 0..=1",
        ),
        ("\nindex = 1", "\nindex = -1", "origin.sweep.index = -1"),
        (
            "count = 2",
            "count = 10001",
            "origin.sweep.count = 10001 is out of range: allowed 1..=",
        ),
    ] {
        let (code, said) = said_about_manifest(from, to);
        assert_eq!(code, 2, "{said}");
        assert!(said.contains(what), "{said}");
    }
}

#[test]
fn the_note_about_a_changed_manifest_is_no_part_of_the_results() {
    let folder = scratch();
    let text = format!("{SOUND}fidelity = \"rate\"\n");
    write(folder.path(), "x.toml", &text);
    assert_eq!(
        code(&fogbench(folder.path(), &["run", "x.toml", "-o", "a"])),
        0
    );
    let manifest = folder.path().join("a/x/manifest.toml");
    let changed = fs::read_to_string(&manifest).expect("written");
    write(
        folder.path(),
        "m.toml",
        &changed.replace("seed = 1", "seed = 2"),
    );
    let output = fogbench(folder.path(), &["run", "m.toml", "-o", "b"]);
    assert_eq!(code(&output), 0);
    assert!(
        stderr(&output).contains("this manifest was changed"),
        "{}",
        stderr(&output)
    );
    // The manifest of the changed run is true of itself, and repeats it to the byte.
    let output = fogbench(folder.path(), &["run", "b/x/manifest.toml", "-o", "c"]);
    assert_eq!(code(&output), 0);
    assert!(!stderr(&output).contains("changed"), "{}", stderr(&output));
    let read = |run: &str| fs::read(folder.path().join(run).join("x/summary.json")).expect(run);
    assert!(read("b") == read("c"), "the results depend on the note");
}

#[test]
fn an_input_beside_a_manifest_that_is_another_file_now_is_named() {
    let folder = scratch();
    let file = write(folder.path(), "x.toml", SOUND);
    let run = load_suite(&[file], &[]).expect("sound").remove(0);
    write(
        folder.path(),
        "m.toml",
        &manifest_toml(&run, env!("CARGO_PKG_VERSION"), "unknown"),
    );
    let check = || stderr(&fogbench(folder.path(), &["check", "m.toml"]));
    assert_eq!(check(), "");
    write(folder.path(), "x.toml", &format!("{SOUND}seed = 3\n"));
    let said = check();
    assert!(
        said.contains("warning: m.toml: x.toml is not the file that this manifest"),
        "{said}"
    );
}

#[test]
fn a_sweep_over_a_long_script_has_a_size() {
    let folder = scratch();
    let row = |row| format!("{:.3},0.0\n", f64::from(row) * 1e-3);
    let rows: String = (0..=20_000).map(row).collect();
    write(
        folder.path(),
        "t.csv",
        &format!("time_s,rate_deg_per_s\n{rows}"),
    );
    let seeds: Vec<String> = (0..1000).map(|seed| seed.to_string()).collect();
    let script = "[turntable.script]\nfile = \"t.csv\"\n";
    let text = format!("{SOUND}{script}[matrix]\nseed = [{}]\n", seeds.join(", "));
    let refused = refusal(folder.path(), &text);
    let said = "numbers in arrays each: allowed up to 10000000 in all";
    assert!(
        refused.contains("1000 points") && refused.contains(said),
        "{refused}"
    );
}
