//! Page of the command line: the help of every command.

use std::fmt::Write as _;
use std::path::Path;

use crate::support::{code, fogbench, stdout};

const HEAD: &str = "\
# Command line

<!-- Generated from the help of the program by the test `generated_page_of_the_command_line`. -->

Exit codes are described in [results](output.md#exit-codes), how files of numbers are read in
[logs and groups](logs.md#how-numbers-are-read).
";

/// Commands that a help text lists.
fn listed(help: &str) -> Vec<&str> {
    help.lines()
        .skip_while(|line| *line != "Commands:")
        .skip(1)
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.split_whitespace().next())
        .filter(|name| *name != "help")
        .collect()
}

fn append(path: &[&str], page: &mut String) {
    let mut arguments = path.to_vec();
    arguments.push("--help");
    let output = fogbench(Path::new("."), &arguments);
    assert_eq!(code(&output), 0, "{path:?}");
    let help = stdout(&output);
    let title = ["fogbench"]
        .iter()
        .chain(path)
        .copied()
        .collect::<Vec<_>>()
        .join(" ");
    write!(page, "\n## {title}\n\n```text\n").expect("a string takes it");
    for line in help.trim_end().lines() {
        writeln!(page, "{}", line.trim_end()).expect("a string takes it");
    }
    page.push_str("```\n");
    for command in listed(&help) {
        let deeper: Vec<&str> = path.iter().copied().chain([command]).collect();
        append(&deeper, page);
    }
}

/// Markdown page of the command line.
pub(crate) fn page() -> String {
    let mut page = HEAD.to_owned();
    append(&[], &mut page);
    page
}
