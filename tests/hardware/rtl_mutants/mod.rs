//! Mutants of the exported RTL: the testbenches have to notice that the Verilog was changed.
//!
//! Rules make the mutants of every file that is the design; a sample of them, drawn by a fixed seed in
//! proportion to files and kinds of change, is compiled with Icarus Verilog and run in every export that
//! holds the file, until a testbench fails. A mutant that does not compile is none, and another one
//! is drawn. Who survives stands in `survivors.txt` with the reason; any other survivor fails the test.
//!
//! `cargo test` tries some. All of the sample, and the table in `docs/hardware.md`:
//!
//! ```text
//! FOGBENCH_RTL_MUTANTS=1 cargo test --test integration rtl_mutants -- --nocapture
//! ```
//!
//! Without `iverilog` the mutants are skipped; with `CI=true` that is a failure.

mod rules;
mod tokens;
mod trial;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::support::fixed::has;
use crate::support::generated::generated;
use crate::support::repository;
use crate::support::seeded::Draws;

use rules::{Kind, Mutant, mutants};
use trial::{Outcome, Place, places};

/// Mutants of the sample that are changes of resets or handshakes, or of the stream ports.
const GUARDED: usize = 60;
/// Mutants of everything else.
const OTHERS: usize = 140;
/// How many of the sample stand for one that `cargo test` tries.
const SHARE: usize = 10;
/// Workers at a time.
const WORKERS: usize = 2;
/// Seed of the sample.
const SEED: u64 = 16;

/// A mutant and the file it is one of.
#[derive(Debug)]
struct Candidate<'a> {
    file: &'a str,
    original: &'a str,
    mutant: Mutant,
}

impl Candidate<'_> {
    /// How it stands in the list of survivors.
    fn words(&self) -> String {
        format!(
            "{}: {} -> {}",
            self.file, self.mutant.before, self.mutant.after
        )
    }

    /// Whether it touches a reset, a handshake or the stream ports.
    fn is_guarded(&self) -> bool {
        matches!(self.mutant.kind, Kind::Reset | Kind::Handshake) || self.file.contains("axi")
    }
}

/// Files of the design, each once: that of the first export that has it.
fn design(places: &[Place]) -> BTreeMap<String, String> {
    let mut files = BTreeMap::new();
    for (name, text) in places.iter().flat_map(Place::design) {
        files.entry(name).or_insert(text);
    }
    files
}

/// Takes turns: in each part of a list that is sorted by file and kind, the order in which its mutants
/// are tried until one compiles. As the parts are of equal length, files and kinds are in proportion.
fn sample(candidates: Vec<Candidate<'_>>, count: usize, seed: u64) -> Vec<Vec<Candidate<'_>>> {
    let mut draws = Draws::new(seed);
    let mut drawn: Vec<(u64, Candidate<'_>)> = candidates
        .into_iter()
        .map(|candidate| (draws.bits(), candidate))
        .collect();
    drawn.sort_by(|(a_draw, a), (b_draw, b)| {
        (a.file, a.mutant.kind, a_draw).cmp(&(b.file, b.mutant.kind, b_draw))
    });
    let total = drawn.len();
    let mut parts = Vec::new();
    let mut rest = drawn.into_iter();
    for k in 0..count {
        let length = total * (k + 1) / count - total * k / count;
        let mut part: Vec<_> = rest.by_ref().take(length).collect();
        part.sort_by_key(|(draw, _)| *draw);
        parts.push(part.into_iter().map(|(_, candidate)| candidate).collect());
    }
    parts
}

/// The whole sample.
fn samples(files: &BTreeMap<String, String>) -> Vec<Vec<Candidate<'_>>> {
    let all = files.iter().flat_map(|(file, original)| {
        let of_file = mutants(original).into_iter();
        of_file.map(move |mutant| Candidate {
            file,
            original,
            mutant,
        })
    });
    let (guarded, others): (Vec<_>, Vec<_>) = all.partition(Candidate::is_guarded);
    println!(
        "{} mutants of resets, handshakes and stream ports, {} others",
        guarded.len(),
        others.len()
    );
    let mut parts = sample(guarded, GUARDED, SEED);
    parts.extend(sample(others, OTHERS, SEED + 1));
    parts
}

/// Runs the script of a place over Verilog that nobody changed, once: it passes.
fn check_unchanged(place: &Place, passed: &mut bool) {
    if !*passed {
        let (outcome, text) = place.run("");
        assert_eq!(outcome, Outcome::Survived, "{place:?}: {text}");
        *passed = true;
    }
}

/// Tries the mutants of a part until one compiles; it, and whether it was caught.
fn try_part<'a>(
    part: Vec<Candidate<'a>>,
    places: &[Place],
    passed: &[Mutex<bool>],
) -> Option<(Candidate<'a>, bool)> {
    for candidate in part {
        let mutated = candidate.mutant.text(candidate.original);
        let mut outcome = Outcome::NotCompiled;
        for (place, passed) in places.iter().zip(passed) {
            if !place.has(candidate.file, candidate.original) {
                continue;
            }
            check_unchanged(place, &mut passed.lock().expect("no panic"));
            outcome = place.run_with(candidate.file, candidate.original, &mutated);
            if outcome != Outcome::Survived {
                break;
            }
        }
        if outcome != Outcome::NotCompiled {
            return Some((candidate, outcome == Outcome::Caught));
        }
    }
    None
}

/// Tries parts of the sample; what came of each, in their order.
fn try_all<'a>(
    folder: &Path,
    places: &[Place],
    parts: Vec<Vec<Candidate<'a>>>,
) -> Vec<(Candidate<'a>, bool)> {
    let count = parts.len();
    let parts: Vec<Mutex<Option<Vec<Candidate<'a>>>>> = parts
        .into_iter()
        .map(|part| Mutex::new(Some(part)))
        .collect();
    let tried: Vec<Mutex<Option<(Candidate<'a>, bool)>>> =
        (0..count).map(|_| Mutex::new(None)).collect();
    let passed: Vec<Mutex<bool>> = places.iter().map(|_| Mutex::new(false)).collect();
    let next = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for worker in 0..WORKERS {
            let (parts, tried, passed, next) = (&parts, &tried, &passed, &next);
            scope.spawn(move || {
                let own = folder.join(format!("worker-{worker}"));
                fs::create_dir(&own).expect("a writable folder");
                let places: Vec<Place> = places
                    .iter()
                    .map(|place| place.copied_below(&own))
                    .collect();
                loop {
                    let k = next.fetch_add(1, Ordering::Relaxed);
                    let Some(part) = parts.get(k) else { return };
                    let part = part.lock().expect("no panic").take().expect("its turn");
                    let result = try_part(part, &places, passed);
                    if let Some((candidate, false)) = &result {
                        println!(
                            "survivor, line {}: {}",
                            candidate.mutant.line,
                            candidate.words()
                        );
                    }
                    *tried[k].lock().expect("no panic") = result;
                }
            });
        }
    });
    tried
        .into_iter()
        .filter_map(|slot| slot.into_inner().expect("no panic"))
        .collect()
}

/// Survivors that are known, and whether each is equivalent to the design: a line each, and below it the
/// reason, which is indented.
fn known_survivors() -> BTreeMap<&'static str, bool> {
    let mut known = BTreeMap::new();
    let mut lines = include_str!("survivors.txt")
        .lines()
        .filter(|line| !line.starts_with('#'));
    while let Some(words) = lines.next() {
        let reason = lines.next().unwrap_or_default();
        let is_equivalent = reason.starts_with("    equivalent: ");
        let is_reason = is_equivalent || reason.starts_with("    unseen: ");
        assert!(is_reason, "{words}: no reason in the next line: {reason}");
        let is_new = known.insert(words, is_equivalent).is_none();
        assert!(is_new, "twice: {words}");
    }
    known
}

/// Whether all of the sample is tried.
fn is_long() -> bool {
    std::env::var_os("FOGBENCH_RTL_MUTANTS").is_some()
}

#[test]
fn mutants_of_the_exported_rtl_are_caught() {
    if !has("iverilog") {
        return;
    }
    let folder = tempfile::tempdir().expect("a scratch folder");
    let places = places(folder.path());
    let files = design(&places);
    let mut parts = samples(&files);
    if !is_long() {
        let share = parts.into_iter().step_by(SHARE);
        parts = share.collect();
    }
    let wanted = parts.len();
    let tried = try_all(folder.path(), &places, parts);
    let compiled = tried.len();
    assert!(
        compiled * 10 >= wanted * 9,
        "{compiled} of {wanted} compile"
    );
    let known = known_survivors();
    let survivors = tried.iter().filter(|(_, is_caught)| !is_caught);
    let survivors: BTreeSet<String> = survivors.map(|(candidate, _)| candidate.words()).collect();
    let is_known = |words: &&String| known.contains_key(words.as_str());
    let unknown: Vec<&String> = survivors.iter().filter(|words| !is_known(words)).collect();
    assert!(unknown.is_empty(), "no testbench notices\n{unknown:#?}");
    if is_long() {
        let mut caught = known.keys().filter(|words| !survivors.contains(**words));
        assert_eq!(caught.next(), None, "a survivor that is none");
        check_page(&tried, &known);
    }
}

/// Holds the page on hardware to the table of what was tried.
fn check_page(tried: &[(Candidate<'_>, bool)], known: &BTreeMap<&str, bool>) {
    let page = fs::read_to_string(repository("docs/hardware.md")).expect("the page");
    let (before, after) = page.split_once(MARK).expect("the place of the table");
    let (_, after) = after.split_once("```\n").expect("its end");
    let table = table(tried, known);
    println!("{table}");
    generated(
        "docs/hardware.md",
        &format!("{before}{MARK}{table}```\n{after}"),
    );
    let all = Counts::of(tried.iter(), known);
    assert!(all.share() >= 95.0, "{table}");
}

/// What stands above the table.
const MARK: &str = "<!-- written by FOGBENCH_BLESS=1 .ci/run rtl_mutants -->\n```text\n";

/// Counts of a file or of a kind.
#[derive(Clone, Copy, Default)]
struct Counts {
    tried: usize,
    caught: usize,
    equivalent: usize,
}

impl Counts {
    fn of<'a>(
        tried: impl Iterator<Item = &'a (Candidate<'a>, bool)>,
        known: &BTreeMap<&str, bool>,
    ) -> Self {
        let mut counts = Self::default();
        for (candidate, is_caught) in tried {
            let is_equivalent = known.get(candidate.words().as_str()) == Some(&true);
            counts.tried += 1;
            counts.caught += usize::from(*is_caught);
            counts.equivalent += usize::from(!is_caught && is_equivalent);
        }
        counts
    }

    /// Share that is caught of what differs from the design, per cent.
    fn share(self) -> f64 {
        100.0 * self.caught as f64 / (self.tried - self.equivalent) as f64
    }

    fn row(self, text: &mut String, heading: &str) {
        let Self {
            tried,
            caught,
            equivalent,
        } = self;
        let unseen = tried - caught - equivalent;
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{heading:<38} {tried:>7} {caught:>7} {equivalent:>11} {unseen:>7}"
        );
    }
}

/// The table: by file, by kind, and all.
fn table(tried: &[(Candidate<'_>, bool)], known: &BTreeMap<&str, bool>) -> String {
    let mut text = format!(
        "{:<38} mutants  caught  equivalent  unseen\n",
        "file; change"
    );
    let files: BTreeSet<&str> = tried.iter().map(|(candidate, _)| candidate.file).collect();
    for file in files {
        let of_file = tried.iter().filter(|(candidate, _)| candidate.file == file);
        Counts::of(of_file, known).row(&mut text, file);
    }
    text.push('\n');
    for (kind, words) in Kind::ALL {
        let of_kind = tried
            .iter()
            .filter(|(candidate, _)| candidate.mutant.kind == kind);
        Counts::of(of_kind, known).row(&mut text, words);
    }
    let all = Counts::of(tried.iter(), known);
    text.push('\n');
    all.row(&mut text, "all");
    let _ = writeln!(
        text,
        "caught of those that are not equivalent: {:.1} %",
        all.share()
    );
    text
}
