//! Snippets of the page on build servers: their YAML is parsed, their shell lines are run.

use std::fs;
use std::path::Path;
use std::process::Command;

use saphyr::{LoadableYamlNode as _, YamlOwned};

use super::{Page, page};
use crate::support::write;

/// A scenario of the repository in which the snippets run.
const SCENARIO: &str = "schema = 1
name = \"tiny\"
duration_s = 2.0
warm_up_s = 1.0
fidelity = \"rate\"
[[gate]]
metric = \"raw.mean_deg_per_h\"
max = 12.0
decide = \"value\"
";

/// The one block of a section that is fenced as `language`.
fn snippet(page: &Page, section: &str, language: &str) -> String {
    let start = page
        .text
        .find(&format!("\n## {section}\n"))
        .expect("the section");
    let rest = &page.text[start + 1..];
    let rest = &rest[..rest[1..].find("\n## ").map_or(rest.len(), |end| end + 1)];
    let fence = format!("```{language}\n");
    assert_eq!(rest.matches(&fence).count(), 1, "{section}");
    let block = rest.split(&fence).nth(1).expect("the block");
    block.split("```").next().expect("it closes").to_owned()
}

fn yaml(text: &str) -> YamlOwned {
    let mut documents = YamlOwned::load_from_str(text).expect("the snippet is YAML");
    assert_eq!(documents.len(), 1);
    documents.remove(0)
}

fn texts(list: &YamlOwned) -> Vec<String> {
    let list = list.as_sequence().expect("a list");
    let text = |it: &YamlOwned| it.as_str().expect("a text").to_owned();
    list.iter().map(text).collect()
}

/// Runs shell lines as a server does, each by a shell of its own that stops at the first failure.
///
/// `cargo`, which installs the program and takes minutes, is a stub; the program stands on the path.
fn run_lines(lines: &[String]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    write(at, "scenarios/tiny.toml", SCENARIO);
    let stub = write(at, "bin/cargo", "#!/bin/sh\necho \"$@\" >> installed\n");
    make_executable(&stub);
    let program = Path::new(env!("CARGO_BIN_EXE_fogbench"));
    let path = format!(
        "{}:{}:{}",
        at.join("bin").display(),
        program.parent().expect("a folder").display(),
        std::env::var("PATH").expect("a path")
    );
    // A server makes it.
    write(at, "step-summary.md", "");
    let baseline = snippet(&page("docs/ci.md"), "Baseline", "sh");
    for line in baseline.lines().chain(lines.iter().map(String::as_str)) {
        let output = Command::new("sh")
            .args(["-eu", "-c", line])
            .current_dir(at)
            .env("PATH", &path)
            .env("GITHUB_STEP_SUMMARY", at.join("step-summary.md"))
            .output()
            .expect("a shell starts");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{line}\n{said}");
    }
    let installed = fs::read_to_string(at.join("installed")).expect("the program is installed");
    assert_eq!(installed, "install --locked --path .\n");
    folder
}

#[cfg(unix)]
fn make_executable(path: &Path) {
    use std::os::unix::fs::PermissionsExt as _;
    let mode = fs::Permissions::from_mode(0o755);
    fs::set_permissions(path, mode).expect("the mode can be set");
}

#[cfg(not(unix))]
fn make_executable(_path: &Path) {}

fn assert_written(folder: &Path, names: &[&str]) {
    for name in names {
        let size = fs::metadata(folder.join(name)).map_or(0, |file| file.len());
        assert!(size > 0, "{name} is not written");
    }
}

#[test]
fn the_snippet_for_github_runs_as_it_stands() {
    let workflow = yaml(&snippet(&page("docs/ci.md"), "GitHub Actions", "yaml"));
    let steps = workflow["jobs"]["gates"]["steps"]
        .as_sequence()
        .expect("steps");
    let lines = steps.iter().filter_map(|step| {
        let step = step.as_mapping().expect("a step");
        let run = step.iter().find(|(key, _)| key.as_str() == Some("run"));
        Some(run?.1.as_str().expect("a text").to_owned())
    });
    let folder = run_lines(&lines.collect::<Vec<_>>());
    let upload = steps.last().expect("a step")["with"]["path"]
        .as_str()
        .expect("paths");
    for path in upload.lines() {
        assert!(folder.path().join(path).exists(), "{path}");
    }
    assert_written(folder.path(), &["step-summary.md", "junit.xml"]);
}

#[test]
fn the_snippet_for_gitlab_runs_as_it_stands() {
    let job = &yaml(&snippet(&page("docs/ci.md"), "GitLab CI", "yaml"))["gates"];
    let lines = [texts(&job["before_script"]), texts(&job["script"])].concat();
    let folder = run_lines(&lines);
    let report = job["artifacts"]["reports"]["junit"]
        .as_str()
        .expect("a file");
    assert_written(folder.path(), &[report, "output/summary.json"]);
}

#[test]
fn the_snippet_for_jenkins_runs_as_it_stands() {
    let pipeline = snippet(&page("docs/ci.md"), "Jenkins", "groovy");
    let depth =
        |open: char, close: char| pipeline.matches(open).count() == pipeline.matches(close).count();
    assert!(depth('{', '}') && depth('(', ')') && depth('[', ']'));
    let lines = pipeline
        .lines()
        .filter_map(|line| line.trim().strip_prefix("sh '"));
    let lines = lines.map(|line| line.strip_suffix('\'').expect("it closes").to_owned());
    let folder = run_lines(&lines.collect::<Vec<_>>());
    let pattern = pipeline.split("pattern: '").nth(1).expect("a pattern");
    let report = pattern.split('\'').next().expect("it closes");
    assert_written(folder.path(), &[report, "output/summary.json"]);
}
