//! What the program says, held by transcripts in `tests/snapshots`.
//!
//! A transcript is a file for each subject, a section for each test and in it, case by case, what was
//! given (lines that begin with `> `) above all that was said. So a message is asserted as a whole
//! and read beside its siblings. `FOGBENCH_BLESS=1 cargo test` writes the sections anew.

use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::{repository, rust_files};

/// One test's section while it is being spoken.
pub(crate) struct Transcript {
    subject: &'static str,
    title: &'static str,
    text: String,
}

impl Transcript {
    /// The section `title` of `tests/snapshots/<subject>.txt`.
    pub(crate) fn of(subject: &'static str, title: &'static str) -> Self {
        Self {
            subject,
            title,
            text: String::new(),
        }
    }

    /// Adds what was given and what was said to it.
    pub(crate) fn case(&mut self, given: impl Display, said: impl Display) {
        for line in given.to_string().trim_end().lines() {
            self.text
                .push_str(format!("> {}", as_anywhere(line)).trim_end());
            self.text.push('\n');
        }
        let said = said.to_string();
        for line in said.trim_end().lines().filter(|line| !is_time(line)) {
            self.text.push_str(as_anywhere(line).trim_end());
            self.text.push('\n');
        }
        self.text.push('\n');
    }

    /// Asserts that all was said as the transcript holds it, or writes it there if asked to.
    #[track_caller]
    pub(crate) fn check(self) {
        /// Tests run at once, and a file holds the sections of several.
        static WRITING: Mutex<()> = Mutex::new(());
        let _one_at_a_time = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
        let path = path_of(self.subject);
        let mut sections = sections(&path);
        let place = sections.binary_search_by(|(title, _)| title.as_str().cmp(self.title));
        if std::env::var_os("FOGBENCH_BLESS").is_some_and(|value| value == "1") {
            let section = (self.title.to_owned(), self.text);
            match place {
                Ok(place) => sections[place] = section,
                Err(place) => sections.insert(place, section),
            }
            write(&path, &sections);
            return;
        }
        let held = place.map_or("", |place| sections[place].1.as_str());
        let differences = differences(held, &self.text);
        assert!(
            differences.is_empty(),
            "tests/snapshots/{}.txt, {}:\n\n{differences}if that is meant, FOGBENCH_BLESS=1 cargo test \
             writes it\n",
            self.subject,
            self.title
        );
    }
}

/// The cases that are held and not said, marked `-`, and those that are said and not held, marked `+`.
fn differences(held: &str, said: &str) -> String {
    fn cases(text: &str) -> Vec<&str> {
        text.trim_end().split("\n\n").collect()
    }
    let (held, said) = (cases(held), cases(said));
    let mut shown = String::new();
    for (mark, these, those) in [('-', &held, &said), ('+', &said, &held)] {
        for case in these.iter().filter(|case| !those.contains(case)) {
            for line in case.lines() {
                shown.push_str(&format!("{mark} {line}\n"));
            }
            shown.push('\n');
        }
    }
    if shown.is_empty() && held != said {
        shown.push_str("the same cases in another order\n\n");
    }
    shown
}

/// A section of what is said to each of some inputs.
#[track_caller]
pub(crate) fn said_to_each<I: Display>(
    subject: &'static str,
    title: &'static str,
    given: impl IntoIterator<Item = I>,
    answer: impl Fn(&str) -> String,
) {
    let mut transcript = Transcript::of(subject, title);
    for given in given {
        let given = given.to_string();
        let said = answer(&given);
        assert!(!said.is_empty(), "nothing is said to {given}");
        transcript.case(given, said);
    }
    transcript.check();
}

fn path_of(subject: &str) -> PathBuf {
    repository(&format!("tests/snapshots/{subject}.txt"))
}

/// Titles and texts of the sections of a file, in the order of their titles.
fn sections(path: &Path) -> Vec<(String, String)> {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    let mut sections: Vec<(String, String)> = Vec::new();
    for line in text.lines() {
        if let Some(title) = line.strip_prefix("# ") {
            sections.push((title.to_owned(), String::new()));
        } else if let Some((_, text)) = sections.last_mut() {
            // The empty line below a title belongs to no case.
            if !(text.is_empty() && line.is_empty()) {
                text.push_str(line);
                text.push('\n');
            }
        }
    }
    sections
}

fn write(path: &Path, sections: &[(String, String)]) {
    let text: Vec<String> = sections
        .iter()
        .map(|(title, text)| format!("# {title}\n\n{}\n", text.trim_end()))
        .collect();
    let text = format!("{}\n", text.join("\n").trim_end());
    std::fs::write(path, text).expect("tests/snapshots is writable");
}

/// Whether a line tells how long runs took, which no two runs share: `2 runs in 0.3 s; ...`.
fn is_time(line: &str) -> bool {
    let mut words = line.split(' ');
    let count = words
        .next()
        .is_some_and(|word| word.parse::<usize>().is_ok());
    let noun = words.next();
    count && matches!(noun, Some("run" | "runs")) && words.next() == Some("in")
}

/// A line without the folders of this run and of this computer, and without digests, which change
/// with every new key.
fn as_anywhere(line: &str) -> String {
    let scratch = format!("{}/.tmp", std::env::temp_dir().display());
    let mut line = line.replace(&format!("{}/", env!("CARGO_MANIFEST_DIR")), "");
    while let Some(from) = line.find(&scratch) {
        let name = &line[from + scratch.len()..];
        let length = name
            .find(|c: char| !c.is_ascii_alphanumeric())
            .unwrap_or(name.len());
        // The folder is left out with the slash that follows it.
        let slash = usize::from(name[length..].starts_with('/'));
        line.replace_range(from..from + scratch.len() + length + slash, "");
    }
    // Whole, or the beginning of one as reports show it.
    let is_digest = |word: &&str| {
        [16, 64].contains(&word.len())
            && word.bytes().all(|c| c.is_ascii_hexdigit())
            && word.bytes().any(|c| c.is_ascii_alphabetic())
    };
    let mut words = line.split(|c: char| !c.is_ascii_alphanumeric());
    match words.find(is_digest) {
        Some(digest) => as_anywhere(&line.replace(digest, "[digest]")),
        None => line,
    }
}

#[test]
fn a_changed_message_is_told_from_its_siblings() {
    let held = "> a\nfirst\n\n> b\nsecond\n";
    assert_eq!(differences(held, held), "");
    let changed = differences(held, "> a\nfirst\n\n> b\nother\n");
    assert_eq!(changed, "- > b\n- second\n\n+ > b\n+ other\n\n");
    let added = differences(held, "> a\nfirst\n\n> b\nsecond\n\n> c\nthird\n");
    assert_eq!(added, "+ > c\n+ third\n\n");
    assert!(!differences(held, "> b\nsecond\n\n> a\nfirst\n").is_empty());
}

#[test]
fn every_section_of_a_transcript_is_one_that_a_test_speaks() {
    let sources = rust_files(&repository("tests")).into_iter();
    let sources = sources.map(|path| std::fs::read_to_string(path).expect("a source"));
    let sources: String = sources.collect();
    let mut count = 0;
    for entry in std::fs::read_dir(repository("tests/snapshots"))
        .expect("transcripts")
        .flatten()
    {
        for (title, text) in sections(&entry.path()) {
            let name = entry.path().display().to_string();
            assert!(
                sources.contains(&format!("\"{title}\"")),
                "{name}: {title}: no test"
            );
            assert!(!text.is_empty(), "{name}: {title}: nothing is said");
            count += 1;
        }
    }
    assert!(count > 0, "no transcript is found");
}
