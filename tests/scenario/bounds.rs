//! Bounds of what is read and printed: each is named in the message, and none is passed by a
//! hostile input.

use std::fs;
use std::path::Path;
use std::process::Command;

use fogbench::scenario::{Resolved, load_suite, manifest_toml};

use crate::support::transcript::Transcript;
use crate::support::{code, fogbench, scratch, stderr, stdout, write};

/// The transcript of bounds.
const BOUNDS: &str = "bounds";

/// A sound scenario.
const SOUND: &str = "schema = 1\nname = \"x\"\nduration_s = 20.0\n";

/// Most bytes of a text.
const BYTES_MAX: usize = 16_000_000;

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
    let mut transcript = Transcript::of(BOUNDS, "Devices and pipes are refused");
    for name in ["/dev/zero", "pipe.toml"] {
        let output = fogbench(folder.path(), &["check", name]);
        assert_eq!(code(&output), 2);
        transcript.case(format!("check {name}"), stderr(&output));
        for text in [
            format!("extends = \"{name}\"\n{SOUND}"),
            format!("{SOUND}[turntable.script]\nfile = \"{name}\"\n"),
            format!("{SOUND}[gyro.assembly]\n[compensation]\nfile = \"{name}\"\n"),
            format!("{SOUND}[gyro.assembly]\n[compensation]\ncampaign = \"{name}\"\n"),
        ] {
            transcript.case(&text, refusal(folder.path(), &text));
        }
    }
    transcript.check();
}

#[cfg(target_os = "linux")]
#[test]
fn a_stream_that_passes_for_a_regular_file_is_refused_without_waiting() {
    // The messages of the kernel; who may not read them has nothing to wait for.
    let stream = "/proc/kmsg";
    let folder = scratch();
    let said = refusal(folder.path(), &format!("extends = \"{stream}\"\n{SOUND}"));
    match std::fs::File::open(stream) {
        Ok(_) => assert!(said.contains("it is a stream of the system"), "{said}"),
        Err(_) => assert!(said.contains(stream), "{said}"),
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
    let mut transcript = Transcript::of(BOUNDS, "Texts hold up to 16 MB");
    let long = padded(BYTES_MAX + 1);
    transcript.case("a scenario of a byte more", refusal(folder.path(), &long));
    for (name, key) in [
        ("long.csv", "[turntable.script]\nfile = \"long.csv\"\n"),
        (
            "c.toml",
            "[gyro.assembly]\n[compensation]\nfile = \"c.toml\"\n",
        ),
    ] {
        write(folder.path(), name, &long);
        let refused = refusal(folder.path(), &format!("{SOUND}{key}"));
        transcript.case(format!("{name} of a byte more\n{key}"), refused);
    }
    write(folder.path(), "base.toml", &padded(BYTES_MAX / 2 + 1));
    let both = format!("extends = \"base.toml\"\n{}", padded(BYTES_MAX / 2));
    let refused = refusal(folder.path(), &both);
    transcript.case("a base and a scenario of a byte more together", refused);
    transcript.check();
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
    let mut transcript = Transcript::of(BOUNDS, "Bases stand 64 below one another");
    transcript.case("2000 bases, each below the one before", refused);
    transcript.check();
    fs::write(last, "duration_s = 20.0\n").expect("writable");
    assert_eq!(code(&fogbench(folder.path(), &["check", "x.toml"])), 0);
}

#[test]
fn arrays_have_a_length_and_documents_a_size() {
    let folder = scratch();
    let rates = "0.0, ".repeat(100_001);
    let text = format!("{SOUND}[turntable.steps]\nrates_deg_per_s = [{rates}]\ndwell_s = 1.0\n");
    let mut transcript = Transcript::of(BOUNDS, "Arrays have a length and documents a size");
    transcript.case("100001 rates", refusal(folder.path(), &text));
    for (part, count) in [("1,", 7_900_000), ("[],", 5_200_000), ("{},", 5_200_000)] {
        let text = format!("{SOUND}x = [{}]\n", part.repeat(count));
        assert!(
            text.len() < BYTES_MAX,
            "the size of the text is not the point"
        );
        let refused = refusal(folder.path(), &text);
        transcript.case(format!("x = [{part} and so on, {count} of them]"), refused);
    }
    let tables = format!("{SOUND}{}", "[[gate]]\n".repeat(10_001));
    transcript.case("10001 gates", refusal(folder.path(), &tables));
    transcript.check();
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
    let mut transcript = Transcript::of(BOUNDS, "Long values and keys are shortened");
    // Runs of one character are shown by three of them.
    let shown = |text: &str| {
        let mut shown = String::new();
        let mut run = 0;
        for character in text.chars() {
            run = if shown.ends_with(character) {
                run + 1
            } else {
                1
            };
            if !"y[^".contains(character) || run <= 3 {
                shown.push(character);
            }
        }
        shown
    };
    let mut heard = |given: &str, said: &str, bytes_max: usize| {
        assert!(
            said.len() < bytes_max,
            "{} bytes: {}",
            said.len(),
            &said[..500]
        );
        assert!(said.contains("characters)"), "{said}");
        transcript.case(shown(given), shown(said));
    };
    for argument in [
        brackets.as_str(),
        &format!("fidelity={long}"),
        &format!("{long}=1"),
        &format!("filter.{long}.taps=1"),
        &long,
    ] {
        let output = fogbench(folder.path(), &["check", "x.toml", "--set", argument]);
        assert_eq!(code(&output), 2);
        heard(&format!("--set {argument}"), &stderr(&output), 1500);
    }
    for text in [
        format!("{SOUND}fidelity = \"{long}\"\n"),
        format!("{SOUND}seed = \"{long}\"\n"),
        format!("{SOUND}{long} = 1\n"),
        format!("{SOUND}[[filter]]\nname = \"{long}\"\n[filter.rls]\n"),
        format!("extends = \"{long}\"\n{SOUND}"),
        format!("{SOUND}[[gate]]\nmetric = \"{long}.mean\"\nmax = 1.0\n"),
    ] {
        heard(&text, &refusal(folder.path(), &text), 10_000);
    }
    transcript.check();
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
    let manifest = unrecorded(&run);
    assert!(manifest.contains(from), "{manifest}");
    write(folder.path(), "m.toml", &manifest.replace(from, to));
    let output = fogbench(folder.path(), &["check", "m.toml"]);
    (code(&output), stderr(&output))
}

/// A manifest as 0.1.0 wrote it: without the record of its folder, and so without a seal of its own.
fn unrecorded(run: &Resolved) -> String {
    let manifest = manifest_toml(run, env!("CARGO_PKG_VERSION"), "unknown");
    manifest.replacen("build = \"unknown\"\n", "", 1)
}

#[test]
fn any_change_of_a_manifest_in_a_folder_of_results_is_said() {
    let folder = scratch();
    let sweep = "fidelity = \"rate\"\n[matrix]\nseed = [5, 6]\n";
    write(folder.path(), "x.toml", &format!("{SOUND}{sweep}"));
    let run = |words: &[&str]| fogbench(folder.path(), &[&["run"], words].concat());
    assert_eq!(code(&run(&["x.toml", "-o", "a"])), 0);
    let manifest = folder.path().join("a/x/0001/manifest.toml");
    let text = fs::read_to_string(manifest).expect("written");
    let said = |text: &str| {
        write(folder.path(), "m.toml", text);
        let output = fogbench(folder.path(), &["check", "m.toml"]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        stderr(&output)
    };
    assert_eq!(said(&text), "");
    let build = text
        .lines()
        .find(|line| line.starts_with("build = "))
        .expect("a build");
    assert_eq!(said(&text.replace(build, "build = \"another\"")), "");
    let record = text.find("\n[record]\n").expect("a record");
    for changed in [
        text.replace("\nindex = 1", "\nindex = 0"),
        text.replace("version = \"", "version = \"9"),
        text.replace("file = \"x.toml\"", "file = \"y.toml\""),
        text[..record].to_owned(),
        format!("{text}\n[more]\nkey = 1\n"),
    ] {
        assert!(changed != text);
        let words = said(&changed);
        assert!(
            words.contains("this manifest was changed"),
            "{words}: {changed}"
        );
    }
}

#[test]
fn a_changed_manifest_says_so_and_what_was_changed() {
    assert_eq!(said_about_manifest("name", "name"), (0, String::new()));
    let mut transcript = Transcript::of(BOUNDS, "Changed manifests say what was changed");
    for (from, to) in [
        ("seed = 6", "seed = 7"),
        ("digest = \"", "digest = \"0"),
        ("value = \"6\"", "value = \"5\""),
        ("[origin]\nfile = \"x.toml\"", "[origin]\nfile = \"y.toml\""),
    ] {
        let (code, said) = said_about_manifest(from, to);
        assert_eq!(code, 0, "{said}");
        transcript.case(format!("{to}, where {from} stood"), said);
    }
    transcript.check();
}

#[test]
fn a_manifest_holds_a_point_that_a_sweep_can_have() {
    let mut transcript = Transcript::of(BOUNDS, "Manifests hold a point that a sweep can have");
    for (from, to) in [
        ("\nindex = 1", "\nindex = 99999999999"),
        ("\nindex = 1", "\nindex = 2"),
        ("\nindex = 1", "\nindex = -1"),
        ("count = 2", "count = 10001"),
    ] {
        let (code, said) = said_about_manifest(from, to);
        assert_eq!(code, 2, "{said}");
        transcript.case(to.trim_start(), said);
    }
    transcript.check();
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
    let mut transcript = Transcript::of(BOUNDS, "A changed manifest runs with a note");
    let output = fogbench(folder.path(), &["run", "m.toml", "-o", "b"]);
    assert_eq!(code(&output), 0);
    transcript.case("run m.toml", stderr(&output));
    // The manifest of the changed run is true of itself, and repeats it to the byte.
    let output = fogbench(folder.path(), &["run", "b/x/manifest.toml", "-o", "c"]);
    assert_eq!(code(&output), 0);
    transcript.case("run b/x/manifest.toml", stderr(&output));
    transcript.check();
    let read = |run: &str| fs::read(folder.path().join(run).join("x/summary.json")).expect(run);
    assert!(read("b") == read("c"), "the results depend on the note");
}

#[test]
fn an_input_beside_a_manifest_that_is_another_file_now_is_named() {
    let folder = scratch();
    let file = write(folder.path(), "x.toml", SOUND);
    let run = load_suite(&[file], &[]).expect("sound").remove(0);
    write(folder.path(), "m.toml", &unrecorded(&run));
    let check = || stderr(&fogbench(folder.path(), &["check", "m.toml"]));
    assert_eq!(check(), "");
    write(folder.path(), "x.toml", &format!("{SOUND}seed = 3\n"));
    let mut transcript = Transcript::of(BOUNDS, "An input that is another file now is named");
    transcript.case("x.toml with another seed", check());
    transcript.check();
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
    let mut transcript = Transcript::of(BOUNDS, "A sweep over a long script has a size");
    transcript.case("1000 points of 20001 rows", refused);
    transcript.check();
}
