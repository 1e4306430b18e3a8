//! Circles of files that import one another: a folder whose files need each other has no first one to
//! read.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Most files of a circle.
const FILES_MAX: usize = 3;

/// Path of a module from the root of the crate, or of something in it.
type Place = Vec<String>;

/// Files of the crate by the module that each is.
struct Modules {
    texts: BTreeMap<Place, String>,
    /// What a module hands on of others, by its name there.
    reexports: BTreeMap<Place, BTreeMap<String, Place>>,
}

impl Modules {
    /// Reads every source file under a folder, tests left out.
    fn read(source: &Path) -> Self {
        let mut texts = BTreeMap::new();
        let mut folders = vec![source.to_owned()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(&folder).expect("a source folder").flatten() {
                let path = entry.path();
                if path.is_dir() {
                    folders.push(path);
                } else if let Some(place) = place_of(source, &path) {
                    let text = fs::read_to_string(&path).expect("a source file");
                    texts.insert(place, code_of(&text));
                }
            }
        }
        Self::of(texts)
    }

    fn of(texts: BTreeMap<Place, String>) -> Self {
        let mut modules = Self {
            texts,
            reexports: BTreeMap::new(),
        };
        for (place, text) in &modules.texts {
            let mut handed_on = BTreeMap::new();
            let (statements, _) = apart(text);
            let handing = statements.iter().filter(|one| one.starts_with("pub"));
            for (path, name) in handing.flat_map(|statement| leaves(tree_of(statement))) {
                handed_on.insert(name, modules.absolute(place, path));
            }
            modules.reexports.insert(place.clone(), handed_on);
        }
        modules
    }

    /// A path as written in a module, from the root of the crate.
    fn absolute(&self, from: &[String], path: Place) -> Place {
        let mut place = from.to_vec();
        let mut rest = path.into_iter().peekable();
        match rest.peek().map(String::as_str) {
            Some("crate") => place.clear(),
            Some("super" | "self") => {}
            Some(first) => {
                let child = [from, &[first.to_owned()]].concat();
                if !self.texts.contains_key(&child) {
                    // Of another crate.
                    return rest.collect();
                }
            }
            None => {}
        }
        for segment in rest {
            match segment.as_str() {
                "crate" | "self" => {}
                "super" => drop(place.pop()),
                _ => place.push(segment),
            }
        }
        place
    }

    /// The module that defines what a place names; none outside the crate.
    fn home(&self, place: &[String], hops_left: usize) -> Option<Place> {
        let length = (1..=place.len())
            .rev()
            .find(|length| self.texts.contains_key(&place[..*length]))?;
        let (module, rest) = place.split_at(length);
        let handed_on = rest.first().and_then(|name| {
            let target = self.reexports.get(module)?.get(name)?;
            let target = [target, &rest[1..]].concat();
            self.home(&target, hops_left.checked_sub(1)?)
        });
        Some(handed_on.unwrap_or_else(|| module.to_vec()))
    }

    /// Modules that each module needs, what it merely hands on left out.
    fn needs(&self) -> BTreeMap<Place, BTreeSet<Place>> {
        let needs = self.texts.iter().map(|(place, text)| {
            let (statements, code) = apart(text);
            let mut paths: Vec<Place> = Vec::new();
            let own = statements.iter().filter(|one| one.starts_with("use "));
            for (path, name) in own.flat_map(|statement| leaves(tree_of(statement))) {
                let path = self.absolute(place, path);
                if self.texts.contains_key(&path) {
                    // A module by its name: what is asked of it stands in the code.
                    let asked = names_behind(&code, &name).map(segments);
                    paths.extend(asked.map(|inner| [path.clone(), inner].concat()));
                } else {
                    paths.push(path);
                }
            }
            for word in ["crate", "super"] {
                paths.extend(names_behind(&code, word).map(|inner| {
                    let path = [vec![word.to_owned()], segments(inner)].concat();
                    self.absolute(place, path)
                }));
            }
            let homes = paths.iter().filter_map(|path| self.home(path, 8));
            (place.clone(), homes.filter(|home| home != place).collect())
        });
        needs.collect()
    }
}

/// The module that a file is; none for files of tests.
fn place_of(source: &Path, path: &Path) -> Option<Place> {
    let stem = path.file_stem()?.to_string_lossy().into_owned();
    let is_test = stem == "tests" || stem.ends_with("_tests");
    if path.extension()? != "rs" || is_test || stem == "main" {
        return None;
    }
    let inside: PathBuf = path.strip_prefix(source).ok()?.with_extension("");
    let parts = inside.components().map(|part| part.as_os_str());
    let mut place: Place = parts
        .map(|part| part.to_string_lossy().into_owned())
        .collect();
    if stem == "mod" || stem == "lib" {
        place.pop();
    }
    Some(place)
}

/// The code of a file without comments, without the places of visibility and without its tests.
fn code_of(text: &str) -> String {
    text.lines()
        .take_while(|line| *line != "#[cfg(test)]")
        .map(|line| line.split("//").next().unwrap_or_default())
        .collect::<Vec<_>>()
        .join("\n")
        .replace("pub(in crate::", "pub(in ")
}

/// The `use` statements of a text, `pub` included, on one line each, and the code without them.
fn apart(text: &str) -> (Vec<String>, String) {
    let (mut statements, mut code) = (Vec::new(), String::new());
    for part in text.split_inclusive(';') {
        let begins_statement = |at: &usize| {
            let line = part[..*at].rsplit('\n').next().unwrap_or_default().trim();
            line.is_empty() || (line.starts_with("pub") && !line.contains(' '))
        };
        let starts = part.match_indices("use ").map(|(at, _)| at);
        match starts.into_iter().find(begins_statement) {
            Some(at) => {
                let begin = part[..at].rfind('\n').map_or(0, |newline| newline + 1);
                let (before, statement) = part.split_at(begin);
                code.push_str(before);
                let words: Vec<&str> = statement.trim_end_matches(';').split_whitespace().collect();
                statements.push(words.join(" "));
            }
            None => code.push_str(part),
        }
    }
    (statements, code)
}

/// The tree behind the word `use` of a statement.
fn tree_of(statement: &str) -> &str {
    statement.split_once("use ").map_or("", |(_, tree)| tree)
}

/// Paths in a tree of imports, each with the name that it gets.
fn leaves(tree: &str) -> Vec<(Place, String)> {
    let tree = tree.trim();
    if let Some((head, group)) = tree.split_once('{') {
        let group = group.trim_end().strip_suffix('}').unwrap_or(group);
        let head: Place = segments(head);
        let mut depth = 0;
        let items = group.split(|c: char| {
            depth += i32::from(c == '{') - i32::from(c == '}');
            c == ',' && depth == 0
        });
        let inner = items.flat_map(leaves);
        return inner
            .map(|(path, name)| ([head.clone(), path].concat(), name))
            .collect();
    }
    let (path, alias) = tree
        .split_once(" as ")
        .map_or((tree, None), |(path, alias)| {
            (path, Some(alias.trim().to_owned()))
        });
    let mut path = segments(path);
    let mut name = alias.or_else(|| path.last().cloned());
    if path.last().is_some_and(|last| last == "self") && path.len() > 1 {
        path.pop();
        name = path.last().cloned();
    }
    name.map(|name| (path, name)).into_iter().collect()
}

fn segments(path: &str) -> Place {
    let parts = path.split("::").map(str::trim);
    parts
        .filter(|part| !part.is_empty())
        .map(str::to_owned)
        .collect()
}

/// What stands behind `word::` wherever a text has it, as far as it is a path.
fn names_behind<'a>(text: &'a str, word: &'a str) -> impl Iterator<Item = &'a str> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let starts = text.match_indices(word).map(|(at, _)| at);
    starts.filter_map(move |at| {
        let before = text[..at].chars().next_back();
        let rest = text[at + word.len()..].strip_prefix("::")?;
        let end = rest.find(|c: char| !is_part(c) && c != ':');
        let path = rest[..end.unwrap_or(rest.len())].trim_end_matches(':');
        let is_word = !before.is_some_and(|c| is_part(c) || c == ':');
        (is_word && !path.is_empty()).then_some(path)
    })
}

/// Groups of modules each of which needs all others of its group.
fn circles(needs: &BTreeMap<Place, BTreeSet<Place>>) -> Vec<Vec<&Place>> {
    let reached = |start| {
        let mut reached: BTreeSet<&Place> = BTreeSet::new();
        let mut open: Vec<&Place> = vec![start];
        while let Some(place) = open.pop() {
            let next = needs.get(place).into_iter().flatten();
            open.extend(next.filter(|place| reached.insert(place)));
        }
        reached
    };
    let reached: BTreeMap<&Place, BTreeSet<&Place>> =
        needs.keys().map(|place| (place, reached(place))).collect();
    let mut found: Vec<Vec<&Place>> = Vec::new();
    for (place, own) in &reached {
        let returns = |other: &&&Place| reached.get(*other).is_some_and(|of| of.contains(place));
        let circle: Vec<&Place> = own.iter().filter(returns).copied().collect();
        if circle.len() > 1 && circle.first() == Some(place) {
            found.push(circle);
        }
    }
    found
}

#[test]
fn no_circle_of_imports_holds_more_than_three_files() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let needs = Modules::read(&source).needs();
    let arrows: usize = needs.values().map(BTreeSet::len).sum();
    assert!(
        arrows > 3 * needs.len(),
        "{arrows} arrows of {} files",
        needs.len()
    );
    let too_large: Vec<String> = circles(&needs)
        .into_iter()
        .filter(|circle| circle.len() > FILES_MAX)
        .map(|circle| {
            let arrow = |from: &Place| {
                let to = needs[from].iter().filter(|to| circle.contains(to));
                let to: Vec<String> = to.map(|to| to.join("::")).collect();
                format!("  {} -> {}", from.join("::"), to.join(", "))
            };
            circle
                .iter()
                .map(|place| arrow(place))
                .collect::<Vec<_>>()
                .join("\n")
        })
        .collect();
    assert!(
        too_large.is_empty(),
        "circles of more than {FILES_MAX} files:\n{}",
        too_large.join("\n\n")
    );
}

fn modules(files: &[(&str, &str)]) -> Modules {
    let texts = files
        .iter()
        .map(|(place, text)| (segments(place), code_of(text)));
    Modules::of(texts.collect())
}

#[test]
fn a_circle_is_found_through_rooms_aliases_and_lines() {
    let files = [
        (
            "a",
            "mod one;\nmod two;\npub use one::One;\npub(crate) use two::{\n    Two,\n    More as Else,\n};",
        ),
        (
            "a::one",
            "use crate::b::{\n    self, Other,\n};\nfn f() { b::three::g(); }",
        ),
        (
            "a::two",
            "use super::one::One;\n// use crate::b::four::Four;",
        ),
        (
            "b",
            "pub(crate) mod three;\nmod four;\npub use three::Other;",
        ),
        ("b::three", "use super::four::Four;"),
        (
            "b::four",
            "fn f() -> crate::a::Else { std::mem::take(super::super::a::Two) }",
        ),
    ];
    let needs = modules(&files).needs();
    let found = circles(&needs);
    let names: Vec<Vec<String>> = found
        .iter()
        .map(|circle| circle.iter().map(|place| place.join("::")).collect())
        .collect();
    assert_eq!(names, [["a::one", "a::two", "b::four", "b::three"]]);
}

#[test]
fn what_a_room_hands_on_and_what_tests_need_makes_no_circle() {
    let files = [
        (
            "a",
            "mod one;\nmod two;\npub use one::One;\npub use two::Two;",
        ),
        (
            "a::one",
            "struct One;\n#[cfg(test)]\nmod tests { use super::super::two::Two; }",
        ),
        ("a::two", "use super::One;\nuse std::one::Two;"),
    ];
    assert!(circles(&modules(&files).needs()).is_empty());
}
