//! What was meant by a key that nobody knows.
//!
//! A suggestion is a key of the same quantity, or a name that people give to it, in a form that is
//! accepted where the wrong one stands. Where there is none the keys of the table are listed.

use std::sync::OnceLock;

use crate::scenario::document::address::{Step, display};
use crate::scenario::document::tree::{Node, Table};
use crate::scenario::keys::schema::{children, groups, join, keys};
use crate::scenario::message::excerpt::excerpt;
use crate::scenario::message::synonyms::{Meaning, meaning};
use crate::wording::{Likeness, Name, Vocabulary, conversion, is_misspelling, likeness};

/// Most keys that are suggested at once, equally like.
const SUGGESTIONS_MAX: usize = 3;
/// Most bytes of a name that may stand for a known one: all are shorter.
const KNOWN_LENGTH_MAX: usize = 128;
/// Most keys of a table that are listed.
const LISTED_MAX: usize = 12;

/// Where an unknown key stands.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place<'a> {
    /// Schema path of its table.
    pub(crate) schema_path: &'a str,
    /// The table as the complaint shows it.
    pub(crate) shown: &'a str,
    /// The scenario, where keys are written as paths (`--set`, a matrix).
    pub(crate) root: Option<&'a Table>,
}

/// The complaint about a key that nobody knows.
pub(crate) fn unknown_key(place: Place<'_>, name: &str) -> String {
    let shown = join(place.shown, name);
    let unknown = format!("unknown key {}", excerpt(&shown));
    let known = (name.len() <= KNOWN_LENGTH_MAX).then(|| meaning(place.schema_path, name));
    let meant = match known.flatten() {
        Some(Meaning::Advice(advice)) => return format!("{unknown}: {advice}"),
        Some(Meaning::Key(path)) if path_is_open(place.schema_path, path) => vec![path],
        _ => suggestions(place.schema_path, name),
    };
    let shown: Vec<String> = meant.iter().map(|path| present(place, path)).collect();
    match shown.split_last() {
        None => format!("{unknown}: {}", listed(place)),
        Some((one, [])) => {
            let unit = conversion(name, last_name(meant[0]));
            let unit = unit.map_or_else(String::new, |unit| format!(" ({unit})"));
            format!("{unknown}: did you mean {one}?{unit}")
        }
        Some((last, more)) => format!("{unknown}: did you mean {} or {last}?", more.join(", ")),
    }
}

/// The complaint about a key of a table with keys of its own, outside of the scenarios.
///
/// * `shown`: the key as the user writes it; `name`: its last part; `known`: those of the table.
pub(crate) fn unknown_in_table<'a>(
    shown: &str,
    name: &str,
    mut known: impl Iterator<Item = &'a str>,
) -> String {
    let near = known.find(|known| is_misspelling(name, known));
    let near = near.map_or_else(String::new, |known| format!("; did you mean {known}?"));
    format!("unknown key {}{near}", excerpt(shown))
}

/// The one name of the same table that must have been meant.
pub(crate) fn sole_sibling(schema_path: &str, name: &str) -> Option<&'static str> {
    match suggestions(schema_path, name)[..] {
        [path] => {
            let path = path.strip_suffix("[]").unwrap_or(path);
            let (parent, last) = path.rsplit_once('.').unwrap_or(("", path));
            (parent == schema_path).then_some(last)
        }
        _ => None,
    }
}

/// Every path of the key table, those of tables and arrays of tables included.
fn paths() -> &'static [&'static str] {
    static PATHS: OnceLock<Vec<&'static str>> = OnceLock::new();
    PATHS.get_or_init(|| {
        let mut paths: Vec<&'static str> = Vec::new();
        for key in keys().filter(|key| key.successor.is_none()) {
            let ends = key.path.match_indices('.').map(|(at, _)| at);
            for end in ends.chain([key.path.len()]) {
                let path = &key.path[..end];
                if !paths.contains(&path) {
                    paths.push(path);
                }
            }
        }
        paths
    })
}

fn vocabulary() -> &'static Vocabulary {
    static VOCABULARY: OnceLock<Vocabulary> = OnceLock::new();
    VOCABULARY.get_or_init(|| keys().map(|key| key.path.trim_end_matches("[]")).collect())
}

/// Every path and the name at its end, taken apart.
fn names() -> &'static [(Name, &'static str)] {
    static NAMES: OnceLock<Vec<(Name, &'static str)>> = OnceLock::new();
    NAMES.get_or_init(|| {
        let names = paths()
            .iter()
            .map(|path| (Name::of(last_name(path)), *path));
        names.collect()
    })
}

/// Name at the end of a path, without the brackets of an array.
fn last_name(path: &str) -> &str {
    let path = path.strip_suffix("[]").unwrap_or(path);
    path.rsplit_once('.').map_or(path, |(_, last)| last)
}

/// Table a path stands in.
fn parent(path: &str) -> &str {
    path.rsplit_once('.').map_or("", |(parent, _)| parent)
}

/// Paths that may have been meant, the likest; of equally like ones those of the same table, then
/// the nearest.
pub(crate) fn suggestions(schema_path: &str, name: &str) -> Vec<&'static str> {
    if name.len() > KNOWN_LENGTH_MAX {
        return Vec::new();
    }
    // The table as a word of the name, `coil_length_m` for `coil.length_m`.
    let joined = |path: &&&str| {
        let inner = if schema_path.is_empty() {
            Some(**path)
        } else {
            path.strip_prefix(schema_path)
                .and_then(|rest| rest.strip_prefix('.'))
        };
        inner.is_some_and(|inner| inner.contains('.') && inner.replace('.', "_") == name)
    };
    if let Some(path) = paths().iter().find(joined) {
        return vec![path];
    }
    let written = Name::of(name);
    let scored = names().iter().filter_map(|(known, path)| {
        let likeness = likeness(&written, known, vocabulary())?;
        let is_meant = is_related(schema_path, parent(path))
            || likeness == Likeness::Same && is_the_only_one(path);
        let is_meant = is_meant && path_is_open(schema_path, path);
        is_meant.then(|| (rank(likeness, schema_path, path), *path))
    });
    let mut scored: Vec<((Likeness, usize), &'static str)> = scored.collect();
    scored.sort_by_key(|(rank, _)| *rank);
    let Some((best, _)) = scored.first().copied() else {
        return Vec::new();
    };
    let equal: Vec<&'static str> = scored
        .into_iter()
        .take_while(|(rank, _)| *rank == best)
        .map(|(_, path)| path)
        .collect();
    if equal.len() > SUGGESTIONS_MAX {
        return Vec::new();
    }
    equal
}

/// Whether one table is the other or holds it: what stands elsewhere is most often another thing of that
/// name, as the bits of another converter.
fn is_related(one: &str, other: &str) -> bool {
    let holds = |outer: &str, inner: &str| {
        inner
            .strip_prefix(outer)
            .is_some_and(|rest| outer.is_empty() || rest.is_empty() || rest.starts_with('.'))
    };
    holds(one, other) || holds(other, one)
}

/// Whether no other key is of the same sort, as the bits of a converter and those of a step are: it can be
/// meant from anywhere.
fn is_the_only_one(path: &str) -> bool {
    let is_key = keys().any(|key| key.path == path);
    let name = last_name(path);
    let mut others = paths().iter().filter(|other| **other != path);
    is_key && !others.any(|other| last_name(other).ends_with(name))
}

/// Likeness, then the way from one table to the other; a slip in the same table beats the very name
/// in a distant one, which beats a slip elsewhere.
fn rank(likeness: Likeness, schema_path: &str, path: &str) -> (Likeness, usize) {
    let own: Vec<&str> = schema_path
        .split('.')
        .filter(|part| !part.is_empty())
        .collect();
    let other: Vec<&str> = parent(path)
        .split('.')
        .filter(|part| !part.is_empty())
        .collect();
    let common = own.iter().zip(&other).take_while(|(a, b)| a == b).count();
    let way = own.len() + other.len() - 2 * common;
    let likeness = match likeness {
        Likeness::Misspelt(distance) if way == 0 && distance == 1 => Likeness::Same,
        other => other,
    };
    (likeness, way)
}

/// Whether a key may be given beside what stands in a table: not in another element of an array and
/// not in another alternative of a choice that has been made.
fn path_is_open(schema_path: &str, path: &str) -> bool {
    let is_elsewhere = |table: &str| {
        let inside = |path: &str| -> Option<String> {
            let rest = path.strip_prefix(table)?;
            let rest = if table.is_empty() {
                rest
            } else {
                rest.strip_prefix('.')?
            };
            rest.split('.').next().map(str::to_owned)
        };
        match (inside(schema_path), inside(path)) {
            (Some(own), Some(other)) => own != other && !own.is_empty(),
            _ => false,
        }
    };
    let is_taken = groups().iter().any(|group| {
        let is_alternative = |path: &str| {
            let rest = path
                .strip_prefix(group.table)
                .and_then(|rest| rest.strip_prefix('.'));
            rest.and_then(|rest| rest.split('.').next())
                .is_some_and(|name| group.alternatives.contains(&name))
        };
        is_elsewhere(group.table) && is_alternative(schema_path) && is_alternative(path)
    });
    let array = |path: &str| path.find("[]").map(|at| path[..at].to_owned());
    let is_in_another_array = match (array(schema_path), array(path)) {
        (Some(own), Some(other)) => own != other || path.len() <= own.len() + 2,
        (Some(_), None) => false,
        (None, _) => false,
    };
    // A log stands in the place of table and gyro.
    let is_of_log = |path: &str| path.split('.').next() == Some("log");
    let is_of_other_source = !schema_path.is_empty() && is_of_log(schema_path) != is_of_log(path);
    !is_taken && !is_in_another_array && !is_of_other_source
}

/// A suggested key in the form in which it is accepted where the unknown one stands.
fn present(place: Place<'_>, path: &str) -> String {
    let path = path.strip_suffix("[]").unwrap_or(path);
    // Below the table at hand, or in the same element of an array, the shown path leads on.
    let own_array = place
        .schema_path
        .find("[]")
        .map(|at| &place.schema_path[..at + 2]);
    let base = match own_array {
        Some(array) if path.starts_with(array) => Some((array, element(place.shown))),
        _ => None,
    };
    if let Some(below) = below(path, place.schema_path) {
        return join(place.shown, below);
    }
    if let Some((array, shown)) = base {
        return join(shown, below(path, array).unwrap_or(path));
    }
    match path.split_once("[]") {
        None => path.to_owned(),
        Some((array, rest)) => in_array(place.root, array, rest.trim_start_matches('.')),
    }
}

/// The rest of a path below a table.
fn below<'a>(path: &'a str, table: &str) -> Option<&'a str> {
    if table.is_empty() {
        return (!path.contains("[]")).then_some(path);
    }
    path.strip_prefix(table)?.strip_prefix('.')
}

/// The element of an array that a shown path leads through, as in `filter[0]`.
fn element(shown: &str) -> &str {
    let end = shown.find(']').map_or(shown.len(), |at| at + 1);
    &shown[..end]
}

/// A key in an element of an array: by the name of an element that has it, else in words.
fn in_array(root: Option<&Table>, array: &str, rest: &str) -> String {
    let (table, name) = rest.rsplit_once('.').unwrap_or(("", rest));
    let Some(root) = root else {
        let header = join(array, table);
        let header = header.trim_end_matches('.');
        return if table.is_empty() {
            format!("{name} in a table [[{array}]]")
        } else {
            format!("{name} in the table [{header}] of a [[{array}]]")
        };
    };
    let elements = root.get(array).and_then(Node::as_array).unwrap_or_default();
    let holds = |node: &Node| {
        let inner = node.as_table();
        inner.is_some_and(|inner| table.is_empty() || inner.contains_key(table))
    };
    let Some(index) = elements.iter().position(holds) else {
        return format!("{array}.<name>.{name}, once there is such a {array}");
    };
    let own_name = elements[index]
        .as_table()
        .and_then(|inner| inner.get("name"));
    match own_name.and_then(Node::as_text) {
        Some(own_name) => format!("{array}.{own_name}.{name}"),
        None => display(&[
            Step::Key(array.to_owned()),
            Step::Index(index),
            Step::Key(rest.to_owned()),
        ]),
    }
}

/// What a table knows, or how to find out.
fn listed(place: Place<'_>) -> String {
    let names: Vec<&str> = children(place.schema_path).map(|(name, _)| name).collect();
    let table = if place.shown.is_empty() {
        "a scenario".to_owned()
    } else {
        format!("[{}]", excerpt(place.shown))
    };
    if names.len() > LISTED_MAX {
        let (count, first) = (names.len() - LISTED_MAX, names[..LISTED_MAX].join(", "));
        return format!("{table} knows {first} and {count} more, as `fogbench schema` lists them");
    }
    format!("{table} knows {}", names.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wording::words_of;

    fn unknown(schema_path: &str, shown: &str, name: &str) -> String {
        let place = Place {
            schema_path,
            shown,
            root: None,
        };
        unknown_key(place, name)
    }

    /// Every key with the letters of one of its words swapped, doubled or left out.
    fn slips(name: &str) -> Vec<String> {
        let words = name.split('_');
        let words = words.filter(|word| !word.contains(|c: char| c.is_ascii_digit()));
        let longest = words.max_by_key(|word| word.len()).unwrap_or(name);
        let at = name.find(longest).unwrap_or(0) + longest.len() / 2;
        let swapped = || {
            let mut letters: Vec<char> = name.chars().collect();
            letters.swap(at - 1, at);
            letters.into_iter().collect::<String>()
        };
        if longest.len() < 4 {
            return Vec::new();
        }
        let (head, tail) = name.split_at(at);
        vec![
            swapped(),
            format!("{head}{}{tail}", &tail[..1]),
            format!("{head}{}", &tail[1..]),
        ]
    }

    #[test]
    fn every_key_with_one_slip_suggests_itself() {
        let (mut count, mut lost) = (0, Vec::new());
        for path in paths() {
            let path = path.strip_suffix("[]").unwrap_or(path);
            let name = last_name(path);
            for slip in slips(name) {
                // A slip that gives another word of the keys, as `form` for `from`, is no slip.
                let is_word = |word: &str| !name.contains(word) && vocabulary().holds(word);
                if slip.split('_').any(is_word) {
                    continue;
                }
                let found = suggestions(parent(path), &slip);
                let mut found_names = found.iter().map(|path| path.trim_end_matches("[]"));
                if !found_names.any(|found| found == path) {
                    lost.push(format!("{path}: {slip} gives {found:?}"));
                }
                count += 1;
            }
        }
        assert!(lost.is_empty(), "{lost:#?}");
        assert!(count > 600, "{count}");
    }

    #[test]
    fn no_key_is_taken_for_another_quantity() {
        for (own, one) in names() {
            for (known, other) in names() {
                let (one, other) = (last_name(one), last_name(other));
                if let Some(found) = likeness(own, known, vocabulary()) {
                    let words = (words_of(one), words_of(other));
                    assert_eq!(words.0, words.1, "{one} stands for {other}: {found:?}");
                }
            }
        }
    }

    #[test]
    fn a_suggestion_is_a_form_that_is_accepted_where_it_stands() {
        assert_eq!(
            unknown("gyro.coil", "gyro.coil", "lenght_m"),
            "unknown key gyro.coil.lenght_m: did you mean gyro.coil.length_m?"
        );
        assert_eq!(
            unknown("filter[].rls", "filter[0].rls", "tap"),
            "unknown key filter[0].rls.tap: did you mean filter[0].rls.taps?"
        );
        assert_eq!(
            unknown("", "", "taps_"),
            "unknown key taps_: a scenario knows schema, name, description, extends, seed, repeats, \
             duration_s, warm_up_s, fidelity, bias_averaging_time_s, log, turntable and 14 more, \
             as `fogbench schema` lists them"
        );
        assert_eq!(
            unknown("", "", "coil"),
            "unknown key coil: did you mean gyro.coil?"
        );
        assert_eq!(
            unknown("gyro.coil", "gyro.coil", "length_km"),
            "unknown key gyro.coil.length_km: did you mean gyro.coil.length_m? (1 km is \
             1000 m)"
        );
        // A thing of the same name elsewhere is another thing; one that has no like is meant.
        for (table, name) in [
            ("turntable.encoder", "bits"),
            ("gyro.source", "drift_ppm"),
            ("gyro.modulator", "frequency_hz"),
            ("gyro.adc", "offset"),
            ("gyro.detector", "temperature_k"),
            ("turntable.encoder", "noise"),
            ("turntable.site", "temperature"),
        ] {
            let found = unknown(table, table, name);
            assert!(!found.contains("did you mean"), "{found}");
        }
        let moved = unknown("gyro.coil", "gyro.coil", "wavelength_nm");
        assert!(
            moved.ends_with("did you mean gyro.source.wavelength_nm?"),
            "{moved}"
        );
        assert!(unknown("", "", "sweep").contains("[matrix]"));
        assert!(unknown("gyro", "gyro", "coil_length_m").ends_with("mean gyro.coil.length_m?"));
        // Another motion would contradict the one at hand.
        let swing = unknown("turntable.swing", "turntable.swing", "rate_deg_per_s");
        assert!(
            swing.contains("[turntable.swing] knows rate_amplitude_deg_per_s"),
            "{swing}"
        );
        let noise = unknown("gyro.noise", "gyro.noise", "arw");
        assert!(
            noise.ends_with("did you mean gyro.noise.angle_random_walk_deg_per_sqrt_h?"),
            "{noise}"
        );
    }
}
