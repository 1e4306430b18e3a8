//! Required keys and choices: present, and given once.

use super::check::{Checker, Place, root_place};
use super::error::ScenarioError;
use super::faults::Taken;
use super::schema::{self, Child, Group, Presence, join};
use super::source::{Mark, Sources};
use super::tree::{Node, Table};

/// Refuses missing required keys and missing choices, after defaults have been filled in, but for
/// those that were taken out.
pub(crate) fn check_presence(
    root: &Table,
    mark: Mark,
    sources: &Sources,
    taken: &[Taken],
) -> Vec<ScenarioError> {
    let mut checker = Checker::new(sources);
    checker.taken = taken.to_vec();
    checker.presence(root_place(mark), root);
    checker.errors
}

/// Refuses a file that gives two alternatives of one group.
pub(crate) fn check_contradictions(
    root: &Table,
    mark: Mark,
    sources: &Sources,
) -> Vec<ScenarioError> {
    let mut checker = Checker::new(sources);
    checker.contradictions(root_place(mark), root);
    checker.errors
}

impl Checker<'_> {
    /// Complains of something that is missing in a table; nothing is to be seen of it in a file.
    fn miss(&mut self, mark: Mark, message: String) {
        let location = self.sources.locate(mark);
        let location = if mark.start == 0 {
            location.unseen()
        } else {
            location
        };
        self.errors
            .push(ScenarioError::at(location, message).at_key());
    }

    fn is_taken(&self, shown: &str) -> bool {
        self.taken.iter().any(|taken| taken.covers(shown))
    }

    fn presence(&mut self, place: Place<'_>, table: &Table) {
        let group = schema::group_of(place.schema_path);
        if let Some(group) = group
            && !group
                .alternatives
                .iter()
                .any(|name| table.contains_key(*name))
            && !self.is_taken(place.shown_path)
            && !(group.alternatives.iter()).any(|name| self.is_taken(&join(place.shown_path, name)))
        {
            let message = format!(
                "{} needs exactly one {}: {}",
                place.shown_path,
                group.noun,
                choices(group, place.shown_path)
            );
            self.miss(place.mark, message);
        }
        for (name, child) in schema::children(place.schema_path) {
            let node = table.get(name);
            let is_settled = match child {
                Child::Leaf(key) => node.is_some() || key.presence != Presence::Required,
                Child::Table | Child::Tables => node.is_none(),
            };
            if is_settled {
                continue;
            }
            let shown = join(place.shown_path, name);
            let below = join(place.schema_path, name);
            let mark = node.and_then(|node| node.mark).unwrap_or(place.mark);
            match (child, node) {
                (Child::Leaf(key), None) if !self.is_taken(&shown) => {
                    let message = format!(
                        "{shown} is required: expected {} ({})",
                        key.expected(),
                        key.summary()
                    );
                    self.miss(mark, message);
                }
                (Child::Table, Some(node)) => {
                    let inner = Place {
                        schema_path: &below,
                        shown_path: &shown,
                        mark,
                    };
                    if let Some(table) = node.as_table() {
                        self.presence(inner, table);
                    }
                }
                (Child::Tables, Some(node)) => self.presence_in_tables(&below, &shown, mark, node),
                _ => {}
            }
        }
    }

    fn presence_in_tables(&mut self, below: &str, shown: &str, mark: Mark, node: &Node) {
        for (index, element) in node.as_array().unwrap_or_default().iter().enumerate() {
            let inner = Place {
                schema_path: &format!("{below}[]"),
                shown_path: &format!("{shown}[{index}]"),
                mark: element.mark.unwrap_or(mark),
            };
            if let Some(table) = element.as_table() {
                self.presence(inner, table);
            }
        }
    }

    fn contradictions(&mut self, place: Place<'_>, table: &Table) {
        if let Some(group) = schema::group_of(place.schema_path) {
            let mut given: Vec<(Mark, &str)> = group
                .alternatives
                .iter()
                .filter_map(|name| Some((table.get(*name)?.mark?, *name)))
                .collect();
            given.sort_unstable();
            if let [(_, first), .., (mark, last)] = given[..] {
                let message = format!(
                    "{} contradicts {}: give exactly one {}: {}",
                    join(place.shown_path, last),
                    join(place.shown_path, first),
                    group.noun,
                    choices(group, place.shown_path)
                );
                let error = self.sources.error(mark, message).at_key();
                self.errors.push(error);
            }
        }
        for (name, node) in table {
            let mark = node.mark.unwrap_or(place.mark);
            let shown = join(place.shown_path, name);
            let below = join(place.schema_path, name);
            if let Some(table) = node.as_table() {
                let inner = Place {
                    schema_path: &below,
                    shown_path: &shown,
                    mark,
                };
                self.contradictions(inner, table);
            }
            for (index, element) in node.as_array().unwrap_or_default().iter().enumerate() {
                if let Some(table) = element.as_table() {
                    let inner = Place {
                        schema_path: &format!("{below}[]"),
                        shown_path: &format!("{shown}[{index}]"),
                        mark: element.mark.unwrap_or(mark),
                    };
                    self.contradictions(inner, table);
                }
            }
        }
    }
}

/// The alternatives of a group as they are written in a file.
fn choices(group: &Group, shown_path: &str) -> String {
    let paths: Vec<String> = group
        .alternatives
        .iter()
        .map(|name| join(shown_path, name))
        .collect();
    paths.join(", ")
}
