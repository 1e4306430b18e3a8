//! Console blocks of the pages: the commands run, and what they print is compared.
//!
//! A block fenced as `console` holds commands after `$ `, each followed by what it prints; `? 2` as the
//! first line below a command is its exit code, 0 where none stands. A line `...` stands for any lines.
//! The commands of a page run in order in one scratch folder that holds a copy of `scenarios/`; a block
//! fenced as `csv NAME` is written there as a file first. A block fenced as `console suite` is an excerpt
//! of the complete job, one as `console docket` of the docket's, which `.ci/run` compares with what the job printed.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use super::Page;
use crate::support::{code, fogbench, repository, stderr, stdout};

/// Mark of left out lines.
const ELISION: &str = "...";

/// What a fenced block of a page is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Use<'a> {
    /// Commands that every test run executes.
    Commands,
    /// Excerpt of what a long job prints, by the name of the job.
    Excerpt(&'a str),
    /// File of the scratch folder.
    File(&'a str),
    /// Text that nobody checks.
    Other,
}

/// Fenced block of a page.
pub(super) struct Block<'a> {
    pub(super) purpose: Use<'a>,
    /// Line of its first line in the page, from 1.
    line: usize,
    pub(super) lines: Vec<&'a str>,
}

/// Blocks of a page, in order.
pub(super) fn blocks(text: &str) -> Vec<Block<'_>> {
    let mut found = Vec::new();
    let mut open: Option<Block> = None;
    for (index, line) in text.lines().enumerate() {
        let fence = line.strip_prefix("```");
        match (fence, open.take()) {
            (Some(info), None) => {
                open = Some(Block {
                    purpose: purpose(info),
                    line: index + 2,
                    lines: Vec::new(),
                });
            }
            (Some(_), Some(block)) => found.push(block),
            (None, Some(mut block)) => {
                block.lines.push(line);
                open = Some(block);
            }
            (None, None) => {}
        }
    }
    assert!(open.is_none(), "a fenced block does not end");
    found
}

fn purpose(info: &str) -> Use<'_> {
    match info.split_once(' ').unwrap_or((info, "")) {
        ("console", "") => Use::Commands,
        ("console", job @ ("suite" | "docket")) => Use::Excerpt(job),
        ("csv", name) if !name.is_empty() => Use::File(name),
        _ => Use::Other,
    }
}

/// Command of a block, and what the page says that it prints.
struct Example<'a> {
    command: &'a str,
    exit_code: i32,
    printed: Vec<&'a str>,
}

fn examples<'a>(block: &Block<'a>) -> Vec<Example<'a>> {
    let mut found: Vec<Example> = Vec::new();
    for line in &block.lines {
        if let Some(command) = line.strip_prefix("$ ") {
            found.push(Example {
                command,
                exit_code: 0,
                printed: Vec::new(),
            });
            continue;
        }
        let example = found.last_mut().expect("a console block begins with $");
        match line.strip_prefix("? ") {
            Some(number) if example.printed.is_empty() => {
                example.exit_code = number.parse().expect("an exit code is a number");
            }
            _ => example.printed.push(line),
        }
    }
    found
}

/// Whether `text` consists of the lines shown, `...` standing for any lines; else the line that is not there.
fn shows(shown: &[&str], text: &str) -> Result<(), String> {
    let lines: Vec<&str> = text.trim_end().lines().map(str::trim_end).collect();
    let mut next = 0;
    let mut is_first = true;
    for chunk in shown.split(|line| *line == ELISION) {
        let begins_anywhere = !std::mem::take(&mut is_first);
        if chunk.is_empty() {
            continue;
        }
        let found = (next..=lines.len().saturating_sub(chunk.len()))
            .take_while(|start| begins_anywhere || *start == 0)
            .find(|start| lines[*start..].starts_with(chunk));
        let Some(start) = found else {
            return Err(missing(chunk, &lines[next..]));
        };
        next = start + chunk.len();
    }
    if next < lines.len() && shown.last() != Some(&ELISION) {
        return Err(format!("prints on: {}", lines[next]));
    }
    Ok(())
}

/// First line of a chunk that the longest of its partial matches does not have.
fn missing(chunk: &[&str], lines: &[&str]) -> String {
    let matched = |start: usize| {
        let pairs = chunk.iter().zip(&lines[start..]);
        pairs.take_while(|(a, b)| a == b).count()
    };
    let best = (0..lines.len()).max_by_key(|start| matched(*start));
    let length = best.map_or(0, matched);
    let printed = best.and_then(|start| lines.get(start + length));
    format!(
        "is not printed: {}\ninstead: {}",
        chunk.get(length).unwrap_or(&""),
        printed.unwrap_or(&"(the end)")
    )
}

/// Program beside fogbench whose output the pages show.
const SYNTHESIS: &str = "yosys";

/// Output of a command; none if it needs a program that is not installed.
fn run(command: &str, scratch: &Path) -> Option<Output> {
    if let Some(arguments) = command.strip_prefix("fogbench ") {
        let arguments: Vec<&str> = arguments.split_whitespace().collect();
        return Some(fogbench(scratch, &arguments));
    }
    assert!(command.starts_with(SYNTHESIS), "not to be run: {command}");
    if Command::new(SYNTHESIS).arg("-V").output().is_err() {
        let is_ci = std::env::var("CI").is_ok_and(|value| value == "true");
        assert!(!is_ci, "{SYNTHESIS} is needed under CI=true");
        eprintln!("skipped: {SYNTHESIS} is not installed");
        return None;
    }
    let output = Command::new("sh")
        .args(["-c", command])
        .current_dir(repository(""))
        .output();
    Some(output.expect("the shell starts"))
}

fn copy_folder(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("a folder can be made");
    for entry in fs::read_dir(from).expect("a folder is readable").flatten() {
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy_folder(&entry.path(), &target);
        } else {
            fs::copy(entry.path(), target).expect("a file can be copied");
        }
    }
}

/// Appends to `complaints` what the commands of a page print otherwise than it says.
pub(super) fn check_commands(page: &Page, complaints: &mut String) -> usize {
    let scratch = tempfile::tempdir().expect("a scratch folder");
    copy_folder(&repository("scenarios"), &scratch.path().join("scenarios"));
    let mut count = 0;
    for block in blocks(&page.text) {
        if let Use::File(name) = block.purpose {
            let text = block.lines.join("\n") + "\n";
            fs::write(scratch.path().join(name), text).expect("the scratch folder is writable");
        }
        if block.purpose != Use::Commands {
            continue;
        }
        for example in examples(&block) {
            let Some(output) = run(example.command, scratch.path()) else {
                continue;
            };
            count += 1;
            let mut text = stdout(&output);
            if example.exit_code != 0 {
                text.push_str(&stderr(&output));
            }
            let code = code(&output);
            let outcome = if code == example.exit_code {
                shows(&example.printed, &text)
            } else {
                Err(format!("ends with {code}: {}", stderr(&output)))
            };
            complain(page, &block, example.command, outcome, complaints);
        }
    }
    count
}

/// Appends to `complaints` the excerpts of a page that are not in `job`, what the complete job printed.
pub(super) fn check_excerpts(page: &Page, name: &str, job: &str, complaints: &mut String) -> usize {
    let mut count = 0;
    for block in blocks(&page.text) {
        if block.purpose != Use::Excerpt(name) {
            continue;
        }
        for example in examples(&block) {
            count += 1;
            let outcome = shows(&example.printed, job);
            complain(page, &block, example.command, outcome, complaints);
        }
    }
    count
}

fn complain(
    page: &Page,
    block: &Block,
    command: &str,
    outcome: Result<(), String>,
    complaints: &mut String,
) {
    if let Err(difference) = outcome {
        let (name, line) = (&page.name, block.line);
        writeln!(complaints, "{name}:{line}: `{command}` {difference}").expect("a string takes it");
    }
}

#[test]
fn an_elision_stands_for_any_lines_and_nothing_else_does() {
    let text = "a\nb\nc\nd\n";
    assert_eq!(shows(&["a", "b", "c", "d"], text), Ok(()));
    assert_eq!(shows(&["...", "b", "...", "d"], text), Ok(()));
    assert_eq!(shows(&["a", "..."], text), Ok(()));
    assert!(shows(&["a", "b"], text).is_err());
    assert!(shows(&["b", "..."], text).is_err());
    assert!(shows(&["...", "d", "...", "b", "..."], text).is_err());
    let difference = shows(&["a", "b", "x", "..."], text);
    assert_eq!(difference, Err("is not printed: x\ninstead: c".to_owned()));
}
