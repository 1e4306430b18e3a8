//! The documents: generated pages, commands whose output they show, figures, links.
//!
//! `FOGBENCH_BLESS=1 cargo test --test integration generated` writes the generated ones.

mod ci_page;
mod command_line_page;
mod console;
mod figures;
mod files_page;
mod links;
mod metrics_page;
mod scenario_page;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::support::generated::generated;
use crate::support::{code, fogbench, repository, stderr};

/// Pages that are written by tests, and hence hold what they are generated from.
const GENERATED: [&str; 4] = [
    "docs/command-line.md",
    "docs/files.md",
    "docs/metrics.md",
    "docs/scenario.md",
];

/// Words of the README, tables and commands included.
const README_WORDS_MAX: usize = 900;

/// A file of documentation.
struct Page {
    /// Path from the root of the repository.
    name: String,
    text: String,
}

fn page(name: &str) -> Page {
    Page {
        name: name.to_owned(),
        text: fs::read_to_string(repository(name)).expect("a page is readable"),
    }
}

/// The README, the pages of `docs/` and those for contributors.
fn pages() -> Vec<Page> {
    let mut names: Vec<String> = fs::read_dir(repository("docs"))
        .expect("the folder is readable")
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .filter(|name| Path::new(name).extension().is_some_and(|e| e == "md"))
        .map(|name| format!("docs/{name}"))
        .collect();
    names.extend(["README.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(String::from));
    names.sort();
    names.iter().map(|name| page(name)).collect()
}

/// Every scenario and base as one text.
fn scenario_texts(folder: &Path, text: &mut String) {
    for entry in fs::read_dir(folder)
        .expect("a folder is readable")
        .flatten()
    {
        if entry.path().is_dir() {
            scenario_texts(&entry.path(), text);
        } else if entry.path().extension().is_some_and(|e| e == "toml") {
            text.push_str(&fs::read_to_string(entry.path()).expect("a scenario is readable"));
        }
    }
}

#[test]
fn generated_page_of_the_metrics() {
    generated("docs/metrics.md", &metrics_page::page());
}

#[test]
fn generated_page_of_the_files() {
    generated("docs/files.md", &files_page::page());
}

#[test]
fn generated_page_of_the_scenario_keys() {
    let reference = page("scenarios/reference.toml");
    generated("docs/scenario.md", &scenario_page::page(&reference.text));
}

#[test]
fn generated_page_of_the_command_line() {
    generated("docs/command-line.md", &command_line_page::page());
}

#[test]
fn generated_picture_of_the_trial() {
    let scratch = tempfile::tempdir().expect("a scratch folder");
    let trial = repository("scenarios/audit/trial.toml");
    let trial = trial.to_str().expect("the path is UTF-8");
    let output = fogbench(scratch.path(), &["run", trial]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let drawn = scratch.path().join("output/trial/noise-delay.svg");
    let picture = fs::read_to_string(drawn).expect("the run draws it");
    generated("docs/noise-delay.svg", &picture);
}

#[test]
fn commands_print_what_the_pages_show() {
    let mut complaints = String::new();
    let mut count = 0;
    for page in pages() {
        count += console::check_commands(&page, &mut complaints);
    }
    assert!(count > 0, "no page shows a command");
    assert!(complaints.is_empty(), "{complaints}");
}

/// Variables that name a file with what a long job printed, by the name of the job: `fogbench run -v`, and the same of
/// `scenarios/docket`. Without one the test says so.
const JOBS: [(&str, &str); 2] = [
    ("suite", "FOGBENCH_SUITE_TEXT"),
    ("docket", "FOGBENCH_DOCKET_TEXT"),
];

#[test]
fn excerpts_of_the_long_jobs_are_what_they_printed() {
    for (name, variable) in JOBS {
        let Some(path) = std::env::var_os(variable) else {
            eprintln!("skipped: {variable} names no output of the job {name}");
            continue;
        };
        let job = fs::read_to_string(path).expect("the output of the job is readable");
        let mut complaints = String::new();
        let mut count = 0;
        for page in pages() {
            count += console::check_excerpts(&page, name, &job, &mut complaints);
        }
        assert!(count > 0, "no page shows an excerpt of the job {name}");
        assert!(complaints.is_empty(), "{complaints}");
    }
}

#[test]
fn figures_of_the_prose_are_printed_by_a_command_or_stand_in_a_scenario() {
    let mut inputs = String::new();
    scenario_texts(&repository("scenarios"), &mut inputs);
    let written = pages()
        .into_iter()
        .filter(|page| page.name == "README.md" || page.name.starts_with("docs/"))
        .filter(|page| !GENERATED.contains(&page.name.as_str()));
    let unfounded: Vec<String> = written
        .flat_map(|page| figures::unfounded(&page, &inputs))
        .filter(|figure| *figure != rust_version())
        .collect();
    assert!(unfounded.is_empty(), "{}", unfounded.join("\n"));
}

/// The one figure of the README that a file of the build states.
fn rust_version() -> String {
    format!("README.md: {}", env!("CARGO_PKG_RUST_VERSION"))
}

#[test]
fn the_architecture_page_names_every_feature() {
    let package: toml::Table = page("Cargo.toml").text.parse().expect("a package file");
    let page = page("docs/architecture.md").text;
    for feature in package["features"].as_table().expect("a table").keys() {
        let row = format!("| `{feature}` |");
        assert!(feature == "default" || page.contains(&row), "{feature}");
    }
}

#[test]
fn the_page_of_filters_names_every_kind() {
    let reference = page("scenarios/reference.toml").text;
    let tables = reference
        .lines()
        .filter_map(|line| line.strip_prefix("#| [filter."));
    let tables = tables.filter_map(|rest| rest.strip_suffix(']'));
    // A table inside a kind's is none of its own.
    let kinds: BTreeSet<&str> = tables.filter(|name| !name.contains('.')).collect();
    let filters = page("docs/filters.md").text;
    assert!(kinds.contains("rls"), "{kinds:?}");
    for kind in kinds {
        assert!(filters.contains(&format!("`{kind}`")), "{kind}");
    }
}

#[test]
fn links_of_the_pages_lead_somewhere() {
    let broken: Vec<String> = pages().iter().flat_map(links::broken).collect();
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn the_readme_is_short_and_its_commands_are_what_a_merge_must_pass() {
    let readme = page("README.md").text;
    let words = readme.split_whitespace().count();
    assert!(words <= README_WORDS_MAX, "the README has {words} words");
    assert_eq!(readme.matches("![").count(), 1, "pictures in the README");
    let merge = page(".ci/run").text;
    for command in ["cargo run --release -- run", "cargo test"] {
        assert!(readme.contains(command), "{command}");
        let locked = command.replacen("cargo run", "cargo run --locked", 1);
        let locked = locked.replacen("cargo test", "cargo test --locked", 1);
        assert!(merge.contains(&locked), "{locked}");
    }
}
