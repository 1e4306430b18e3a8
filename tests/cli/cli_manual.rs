//! What the program says of itself: the reference, the pages of the manual, completions.

use std::path::Path;

use crate::support::transcript::said_to_each;
use crate::support::{code, fogbench, stderr, stdout};

fn said(arguments: &str) -> String {
    let words: Vec<&str> = arguments.split(' ').collect();
    let output = fogbench(Path::new("."), &words);
    let ended = match code(&output) {
        0 => String::new(),
        code => format!("exit code {code}\n"),
    };
    format!("{ended}{}{}", stdout(&output), stderr(&output))
}

#[test]
fn the_reference_is_printed_by_key_and_by_table() {
    // A line of a transcript that begins with a hash is a title.
    let said = |arguments: &str| format!("  {}", said(arguments).replace('\n', "\n  "));
    let commands = [
        "reference gyro.controller.loop_bandwidth_hz",
        "reference gyro.noise",
        "reference filter.rls.taps",
        "reference filter.moving_average",
        "reference duration_s",
        "reference gate.max",
        "reference gyro.nosie",
        "reference filter.rls.tap",
        "reference gyro.noise.shot.x",
    ];
    said_to_each("commands", "Parts of the reference", commands, said);
}

#[test]
fn the_whole_reference_is_the_file_of_the_repository() {
    assert_eq!(said("reference"), fogbench::scenario::reference_toml());
}

#[test]
fn every_shell_gets_completions_that_name_every_command() {
    let help = said("--help");
    let commands = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let commands: Vec<&str> = commands
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    assert!(commands.contains(&"completions"), "{commands:?}");
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = said(&format!("completions {shell}"));
        for command in &commands {
            assert!(script.contains(command), "{shell}: {command}");
        }
    }
    assert!(said("completions csh").starts_with("exit code 2"));
}

#[test]
fn every_command_has_a_page_of_the_manual() {
    let main = said("man");
    assert!(main.starts_with(".ie"), "{main}");
    let whole = [
        ".TH fogbench",
        "Exit codes: 0 all well",
        "fogbench\\-run(1)",
    ];
    for part in whole {
        assert!(main.contains(part), "{part}: {main}");
    }
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    let pages = || fogbench(at, &["man", "pages"]);
    assert_eq!(code(&pages()), 0, "{}", stderr(&pages()));
    let page = |name: &str| std::fs::read_to_string(at.join("pages").join(name)).expect("a page");
    assert_eq!(page("fogbench.1"), main);
    assert!(page("fogbench-run.1").contains("\\-\\-require\\-gates"));
    assert!(page("fogbench-baseline-save.1").contains("fogbench\\-baseline\\-save"));
    std::fs::write(at.join("file"), "").expect("writable");
    let output = fogbench(at, &["man", "file"]);
    assert_eq!(code(&output), 74, "{}", stderr(&output));
    assert!(
        stderr(&output).contains("file can be no folder"),
        "{}",
        stderr(&output)
    );
    // A file of the user's stays, and no other page is written.
    std::fs::write(at.join("pages/fogbench-run.1"), "mine").expect("writable");
    std::fs::remove_file(at.join("pages/fogbench.1")).expect("it is there");
    assert_eq!(code(&pages()), 2, "{}", stderr(&pages()));
    assert_eq!(page("fogbench-run.1"), "mine");
    assert!(!at.join("pages/fogbench.1").exists());
}
