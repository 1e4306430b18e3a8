//! What the program says of an option, a table or a stream that cannot be.

use std::fs::{File, OpenOptions};
use std::process::Command;

use crate::support::transcript::said_to_each;
use crate::support::{code, fogbench, scratch, stderr, stdout, write};

/// A scenario of a second of the rate model.
const SHORT: &str = "schema = 1
name = \"short\"
duration_s = 1.0
fidelity = \"rate\"
";

#[test]
fn options_out_of_range_or_missing_are_told_with_their_ranges() {
    let folder = scratch();
    let commands = [
        "export vectors tx",
        "export vectors tx --initiation-interval 2",
        "timing --adder-latency 99999999999999999999",
        "timing --adder-latency 1001",
        "timing --initiation-interval 0",
    ];
    said_to_each(
        "commands",
        "Options of the hardware",
        commands,
        |arguments| {
            let words: Vec<&str> = arguments.split(' ').collect();
            let output = fogbench(folder.path(), &words);
            assert_eq!(code(&output), 2, "{arguments}");
            format!("{}{}", stdout(&output), stderr(&output))
        },
    );
}

#[test]
fn a_table_in_the_place_of_an_array_of_tables_is_told_how_to_be_written() {
    let folder = scratch();
    let tables = [
        "[gate]\nmetric = \"raw.noise_std_deg_per_h\"\nmax = 1.0\n",
        "[filter]\nname = \"a\"\n",
    ];
    said_to_each(
        "commands",
        "A table for an array of tables",
        tables,
        |table| {
            write(folder.path(), "x.toml", &format!("{SHORT}{table}"));
            let output = fogbench(folder.path(), &["check", "x.toml"]);
            assert_eq!(code(&output), 2);
            stderr(&output)
        },
    );
}

#[cfg(target_os = "linux")]
#[test]
fn help_and_version_that_cannot_be_written_end_with_74() {
    for word in ["--help", "--version"] {
        let full = OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .expect("the full device");
        let ended = Command::new(env!("CARGO_BIN_EXE_fogbench"))
            .arg(word)
            .stdout(full)
            .stderr(File::create("/dev/null").expect("the null device"))
            .status()
            .expect("starts");
        assert_eq!(ended.code(), Some(74), "{word}");
    }
}

#[test]
fn control_characters_of_a_description_do_not_reach_the_terminal() {
    let folder = scratch();
    let described = format!("{SHORT}description = \"a\\u001b[31mb\\u202Ec\"\n");
    write(folder.path(), "x.toml", &described);
    let output = fogbench(folder.path(), &["list", "x.toml"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let said = stdout(&output);
    assert!(!said.contains(['\u{1b}', '\u{202e}']), "{said:?}");
    assert!(said.contains("short"), "{said}");
}

#[test]
fn a_senseless_number_of_threads_in_the_environment_is_told() {
    let folder = scratch();
    write(folder.path(), "x.toml", SHORT);
    let warned = |threads: &str| {
        let output = Command::new(env!("CARGO_BIN_EXE_fogbench"))
            .current_dir(folder.path())
            .env("RAYON_NUM_THREADS", threads)
            .args(["run", "x.toml"])
            .output()
            .expect("starts");
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        stderr(&output).contains(&format!("RAYON_NUM_THREADS = `{threads}`"))
    };
    assert!(warned("abc"));
    assert!(!warned("1"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_record_past_its_bound_is_not_read() {
    let folder = scratch();
    write(folder.path(), "x.toml", SHORT);
    let run = || fogbench(folder.path(), &["run", "x.toml", "-o", "o"]);
    assert_eq!(code(&run()), 0);
    // A sparse file: it takes no room on the disk, and three gigabytes if it is read.
    let manifest = folder.path().join("o/short/manifest.toml");
    let grown = OpenOptions::new()
        .write(true)
        .open(manifest)
        .expect("the manifest");
    grown.set_len(3_000_000_000).expect("grows");
    let limited = Command::new("sh")
        .current_dir(folder.path())
        .args(["-c", "ulimit -v 2000000; exec \"$0\" run x.toml -o o -j1"])
        .arg(env!("CARGO_BIN_EXE_fogbench"))
        .output()
        .expect("starts");
    assert_eq!(code(&limited), 2, "{}", stderr(&limited));
    assert!(
        stderr(&limited).contains("manifest.toml"),
        "{}",
        stderr(&limited)
    );
}
