//! Annotations of GitHub Actions: commands in the log that mark lines of files.

use std::collections::BTreeMap;

use super::junit::gate_names;
use super::place::file_and_line;
use crate::baseline::Judged;
use crate::report::RunOutcome;
use crate::report::baseline::rows::row_line;
use crate::scenario::bounded;

/// Annotations that GitHub shows of one step and kind.
const ANNOTATIONS_MAX: usize = 10;

/// One `::error` line for each gate that is not accepted, each failed channel, each failed run and each
/// figure that fails against earlier results; the tenth of more says how many are left.
///
/// * `files`: scenario file of each run, in their order.
/// * `shown`: a path as the repository names it.
///
/// # Source
/// GitHub Docs, "Workflow commands for GitHub Actions"; escapes as in its `@actions/core`.
#[must_use]
pub fn github_annotations(
    (runs, judged): (&[RunOutcome], Option<Judged>),
    files: &[String],
    shown: impl Fn(&str) -> String,
) -> String {
    let no_file = String::new();
    let files = files.iter().chain(std::iter::repeat(&no_file));
    let of_scenario: BTreeMap<&str, &String> = runs
        .iter()
        .map(|run| run.name.as_str())
        .zip(files.clone())
        .collect();
    let mut lines: Vec<String> = runs
        .iter()
        .zip(files)
        .flat_map(|(run, file)| of_run(run, file, &shown))
        .collect();
    for row in judged.into_iter().flat_map(Judged::failed) {
        let file = of_scenario.get(row.id.scenario.as_str()).copied();
        let title = format!("{} against the baseline", row.outcome.as_str());
        let file = file.map_or_else(String::new, |file| shown(file));
        lines.push(annotation(&file, None, &title, &row_line(row)));
    }
    if lines.len() > ANNOTATIONS_MAX {
        let left = lines.len() - (ANNOTATIONS_MAX - 1);
        lines.truncate(ANNOTATIONS_MAX - 1);
        lines.push(format!("::error::and {left} more failures\n"));
    }
    lines.concat()
}

fn of_run(run: &RunOutcome, file: &str, shown: &impl Fn(&str) -> String) -> Vec<String> {
    let whole = |what: &str, text: &str| {
        let title = format!("{}: {what}", run.folder);
        annotation(&shown(file), None, &title, text)
    };
    let broken = run.error.iter().map(|error| whole("run", error));
    let channels = run.channels.iter().filter(|it| !it.expected_failure);
    let channels = channels.filter_map(|channel| {
        let name = format!("channel {}", channel.name);
        Some(whole(&name, &channel.failure_text()?))
    });
    let gates = run.verdicts.iter().zip(gate_names(&run.verdicts));
    let gates = gates.filter(|(verdict, _)| !verdict.accepted);
    let gates = gates.map(|(verdict, name)| {
        let place = verdict.location.as_deref().and_then(file_and_line);
        let (file, line) = place.map_or((file, None), |(file, line)| (file, Some(line)));
        let title = format!("{}: {name}", run.folder);
        let text = format!("{}: {}", verdict.kind.as_str(), verdict.reason);
        annotation(&shown(file), line, &title, &text)
    });
    broken.chain(channels).chain(gates).collect()
}

fn annotation(file: &str, line: Option<usize>, title: &str, text: &str) -> String {
    let mut properties = Vec::new();
    if !file.is_empty() {
        properties.push(format!("file={}", property(file)));
    }
    properties.extend(line.map(|line| format!("line={line}")));
    properties.push(format!("title={}", property(title)));
    format!(
        "::error {}::{}\n",
        properties.join(","),
        data(&bounded(text))
    )
}

fn data(text: &str) -> String {
    let text = text.replace('%', "%25");
    text.replace('\r', "%0D").replace('\n', "%0A")
}

fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_command_would_take_for_its_own_signs_is_escaped() {
        assert_eq!(
            annotation("a,b:c.toml", Some(3), "50 %", "one\ntwo: 100 %"),
            "::error file=a%2Cb%3Ac.toml,line=3,title=50 %25::one%0Atwo: 100 %25\n"
        );
    }

    #[test]
    fn no_more_lines_are_printed_than_are_shown() {
        let failed = |index: usize| {
            let name = format!("run-{index}");
            RunOutcome::failed(&name, &name, "a.toml", "broken".to_owned())
        };
        let runs: Vec<_> = (0..12).map(failed).collect();
        let files = vec!["a.toml".to_owned(); 12];
        let text = github_annotations((&runs, None), &files, str::to_owned);
        assert_eq!(text.lines().count(), ANNOTATIONS_MAX);
        assert_eq!(text.lines().last(), Some("::error::and 3 more failures"));
        let text = github_annotations((&runs[..10], None), &files, str::to_owned);
        assert_eq!(text.lines().count(), 10);
        assert!(!text.contains("more"), "{text}");
    }
}
