//! Links between the pages: files and headings that exist.

use super::Page;
use crate::support::repository;

/// Targets of the links and pictures of a text, code left out.
fn targets(text: &str) -> Vec<&str> {
    let mut found = Vec::new();
    let mut is_code = false;
    for line in text.lines() {
        if line.starts_with("```") {
            is_code = !is_code;
        }
        if is_code {
            continue;
        }
        let ends = line.split("](").skip(1);
        found.extend(ends.filter_map(|rest| rest.split(')').next()));
    }
    found
}

/// Anchor that a heading gets: lower case, blanks as hyphens, punctuation left out.
fn anchor(heading: &str) -> String {
    heading
        .trim()
        .to_lowercase()
        .chars()
        .filter_map(|c| match c {
            ' ' => Some('-'),
            '-' | '_' => Some(c),
            c if c.is_alphanumeric() => Some(c),
            _ => None,
        })
        .collect()
}

fn has_anchor(text: &str, wanted: &str) -> bool {
    let headings = text.lines().filter(|line| line.starts_with('#'));
    let mut anchors = headings.map(|line| anchor(line.trim_start_matches('#')));
    anchors.any(|found| found == wanted)
}

/// Links of a page that lead nowhere.
pub(super) fn broken(page: &Page) -> Vec<String> {
    let folder = page.name.rsplit_once('/').map_or("", |(folder, _)| folder);
    let mut found = Vec::new();
    for target in targets(&page.text) {
        if target.contains("://") {
            continue;
        }
        let (file, heading) = target.split_once('#').unwrap_or((target, ""));
        let path = if file.is_empty() {
            repository(&page.name)
        } else {
            repository(folder).join(file)
        };
        let leads = if heading.is_empty() {
            path.exists()
        } else {
            std::fs::read_to_string(path).is_ok_and(|text| has_anchor(&text, heading))
        };
        if !leads {
            found.push(format!("{}: {target}", page.name));
        }
    }
    found
}

#[test]
fn a_heading_has_the_anchor_of_its_words() {
    assert_eq!(anchor(" Two models of the gyro"), "two-models-of-the-gyro");
    assert!(has_anchor("## `run`, anew\n", "run-anew"));
    assert!(!has_anchor("## Other\n", "run"));
}
