//! The reference of the scenario file: the declarations in print.
//!
//! What stands by default is live, everything else is commented out with a mark, in blocks each of which
//! is a document of its own.

use std::sync::OnceLock;

use crate::declare::{Content, Row, Table};
use crate::scenario::config::Scenario;
use crate::scenario::keys::schema::{Group, Key, Kind, Presence, join};

/// How a line of a commented alternative begins.
pub(in crate::scenario::generate) const ALTERNATIVE: &str = "#| ";

/// The line above each section.
const RULE: &str = "# ---------------------------------------------------------------------------------------------";

/// What stands above the first key.
const HEAD: &str = "\
#:schema ./scenario.schema.json
# Reference of the fogbench scenario file, generated from the declarations of its keys.
#
# Every key stands here with its type, allowed range, unit and meaning: a key marked \"default\" may
# be left out of a scenario and then has the value written here. A key marked \"required\" must be
# given; one marked \"optional\" describes something that is absent unless it is given.
#
# Lines that begin with \"#| \" are alternatives or examples. Each block of them is a document of its
# own: taken without the marks it may stand in a scenario. In a table of alternatives (the motion,
# the servo, the amplitude of a swing, the kind of a filter) a scenario gives at most one; what it
# gives replaces whatever a file it extends gave.
#
# Values are taken, the later over the earlier, from: the defaults, the file named by `extends` (and
# the one that extends), the scenario, each `--set key=value`, the point of the matrix. Tables merge
# key by key, arrays are replaced. In `--set` and in the matrix an element of an array of tables is
# addressed by its index from 0, as in gate[2].max, and a filter also by its name, the kind left
# out: filter.rls.taps is the key `taps` of the filter whose name is \"rls\".
#
# \"The paper\" is Ma et al., Chinese Journal of Lasers 49(21), 2106004 (2022). \"Assumed\" marks
# values that no source states; they were chosen as is typical of such a gyro.
";

/// The complete, commented manual of the scenario file: every key with its default.
#[must_use]
pub fn reference_toml() -> &'static str {
    static TEXT: OnceLock<String> = OnceLock::new();
    TEXT.get_or_init(|| {
        let mut print = Print {
            text: HEAD.to_owned(),
        };
        print.file(&Scenario::TABLE);
        print.text
    })
}

/// A text on its way.
#[derive(Default)]
pub(in crate::scenario::generate) struct Print {
    text: String,
}

/// A table that does not stand by default.
#[derive(Clone, Copy)]
struct Example<'a> {
    /// Path as a file writes it.
    path: &'a str,
    /// Whether it is an element of an array of tables.
    is_element: bool,
    table: &'static Table,
}

impl Print {
    fn line(&mut self, text: &str) {
        self.text.push_str(text);
        self.text.push('\n');
    }

    fn blank(&mut self) {
        self.text.push('\n');
    }

    /// Writes documentation as comments.
    fn comment(&mut self, mark: &str, lines: &[&str]) {
        for line in lines {
            let text = line.trim();
            let space = if text.is_empty() { "" } else { " " };
            self.line(&format!("{mark}#{space}{text}"));
        }
    }

    /// Writes type and meaning of a key.
    fn meaning(&mut self, mark: &str, key: &Key) {
        self.line(&format!("{mark}# {}", key.line()));
        self.comment(mark, key.doc);
    }

    /// Writes the whole file.
    fn file(&mut self, root: &'static Table) {
        for row in root.rows {
            match row.content {
                Content::Value(kind) => {
                    self.blank();
                    self.root_key(&Key::of(row, row.name, kind));
                }
                Content::Tables(table) if table.beside.starts_with("[[") => {
                    // Without the array before it, it would be no document.
                    self.comment(ALTERNATIVE, table.about);
                    self.examples(row.name, true, table, row.name);
                }
                Content::Table(table) | Content::Tables(table) => {
                    self.blank();
                    self.line(RULE);
                    self.comment("", row.about());
                    let is_element = matches!(row.content, Content::Tables(_));
                    if is_element || row.presence == Presence::Optional {
                        self.blank();
                        self.examples(row.name, is_element, table, "");
                    } else {
                        self.live(row.name, table, &[]);
                    }
                }
            }
        }
    }

    /// Writes a key that stands in no table.
    pub(in crate::scenario::generate) fn root_key(&mut self, key: &Key) {
        self.meaning("", key);
        self.root_value(key);
    }

    /// Writes one key below the header of its table.
    ///
    /// `header` is that of its table, brackets and all; empty at the root.
    pub(in crate::scenario::generate) fn lone(&mut self, header: &str, key: &Key, is_live: bool) {
        if header.is_empty() {
            return self.root_key(key);
        }
        let mark = if is_live { "" } else { ALTERNATIVE };
        self.line(&format!("{mark}{header}"));
        self.documented(mark, key);
    }

    /// Writes one table that does not stand by default, with its alternatives.
    pub(in crate::scenario::generate) fn lone_example(
        &mut self,
        path: &str,
        is_element: bool,
        table: &'static Table,
        about: &[&str],
    ) {
        self.comment("", about);
        self.examples(path, is_element, table, "");
    }

    /// The text, without what sets it off from a text before it.
    pub(in crate::scenario::generate) fn into_text(self) -> String {
        let text = self.text.trim();
        format!("{text}\n")
    }

    /// Writes the value of a key that stands in no table.
    fn root_value(&mut self, key: &Key) {
        let Key { path, literal, .. } = *key;
        match key.kind {
            Kind::Matrix => {
                self.line(&format!("{ALTERNATIVE}[{path}]"));
                let content = toml_text(literal);
                self.line(&format!("{ALTERNATIVE}{content}"));
            }
            _ if key.presence == Presence::Defaulted => self.line(&format!("{path} = {literal}")),
            _ => self.line(&format!("{ALTERNATIVE}{path} = {literal}")),
        }
    }

    /// Writes a table that stands by default, then what stands inside; `about` was not said yet.
    pub(in crate::scenario::generate) fn live(
        &mut self,
        path: &str,
        table: &'static Table,
        about: &[&str],
    ) {
        let values = || table.current_rows().filter_map(value_key);
        let is_live = |key: &Key| key.presence == Presence::Defaulted;
        let (has_live, has_others) = (
            values().any(|key| is_live(&key)),
            values().any(|key| !is_live(&key)),
        );
        if !about.is_empty() || has_live || has_others {
            self.blank();
            self.comment("", about);
        }
        if has_others {
            self.line(&format!("{ALTERNATIVE}[{path}]"));
            for key in values().filter(|key| !is_live(key)) {
                self.documented(ALTERNATIVE, &key);
            }
            self.blank();
        }
        if has_live {
            self.line(&format!("[{path}]"));
            for key in values().filter(is_live) {
                self.documented("", &key);
            }
        }
        self.inner(path, table);
    }

    /// Writes the tables inside a table that stands by default.
    fn inner(&mut self, path: &str, table: &'static Table) {
        for row in table.rows {
            let Content::Table(inner) = row.content else {
                continue;
            };
            let below = join(path, row.name);
            let is_alternative = table
                .group
                .is_some_and(|group| group.default() != Some(row.name));
            if inner.is_renaming() {
                // Its key stands among the others.
                continue;
            }
            if row.name.is_empty() {
                self.inner(path, inner);
            } else if inner.rows.is_empty() {
                self.blank();
                let mark = if is_alternative { ALTERNATIVE } else { "" };
                self.empty(mark, &below, row);
            } else if is_alternative || row.presence == Presence::Optional {
                self.blank();
                self.comment("", row.about());
                self.examples(&below, false, inner, "");
            } else {
                self.live(&below, inner, row.about());
            }
        }
    }

    /// Writes a table without keys.
    pub(in crate::scenario::generate) fn empty(
        &mut self,
        mark: &str,
        path: &str,
        row: &'static Row,
    ) {
        self.meaning(mark, &Key::of_empty_table(row, ""));
        self.line(&format!("{mark}[{path}]"));
    }

    /// Writes a key in its table.
    fn documented(&mut self, mark: &str, key: &Key) {
        self.meaning(mark, key);
        self.line(&format!("{mark}{} = {}", key.path, literal_of(key)));
    }

    /// Writes a table that does not stand by default, once for each of its alternatives; further
    /// choices inside these follow as blocks of their own.
    ///
    /// * `joined`: the name of the table, if it goes on with the block before it; else empty.
    fn examples(&mut self, path: &str, is_element: bool, table: &'static Table, joined: &str) {
        let example = Example {
            path,
            is_element,
            table,
        };
        let (group, alternatives) = alternatives_of(table);
        let Some(group) = group else {
            self.example(example, None, true);
            self.beside(if joined.is_empty() { table.beside } else { "" });
            self.inside_example(path, table);
            return;
        };
        for (index, name) in group.alternatives.iter().enumerate() {
            let row = alternatives.rows.iter().find(|row| row.name == *name);
            let Some(row) = row else { continue };
            if index > 0 {
                self.blank();
            }
            match row.content {
                Content::Table(_) => self.comment("", row.about()),
                _ if index > 0 => self.line(&format!("# Or, as another {}:", group.noun)),
                _ => {}
            }
            self.example(example, Some((row, group)), index == 0);
            if let Content::Table(inner) = row.content {
                self.examples(&join(path, name), false, inner, "");
            }
            self.beside(table.beside);
        }
    }

    /// Writes the tables inside a table that does not stand by default.
    fn inside_example(&mut self, path: &str, table: &'static Table) {
        for row in table.rows {
            if let Content::Table(inner) = row.content
                && !inner.rows.is_empty()
                && !inner.is_renaming()
            {
                self.blank();
                self.comment("", row.about());
                self.examples(&join(path, row.name), false, inner, "");
            }
        }
    }

    /// Writes the keys of a table beside one of its alternatives: all of them with their meaning, or
    /// those that are required.
    fn example(
        &mut self,
        example: Example<'_>,
        chosen: Option<(&'static Row, Group)>,
        is_first: bool,
    ) {
        let Example {
            path,
            is_element,
            table,
        } = example;
        let is_chosen = |key: &Key| chosen.is_some_and(|(row, _)| row.name == key.path);
        let is_other = |key: &Key| {
            chosen.is_some_and(|(_, group)| group.alternatives.contains(&key.path))
                && !is_chosen(key)
        };
        let keys = table.current_rows().filter_map(value_key).filter(|key| {
            let is_needed = is_first || is_chosen(key) || key.presence == Presence::Required;
            !is_other(key) && is_needed
        });
        let mut has_header = false;
        for key in keys {
            if !has_header {
                let header = if is_element {
                    format!("{ALTERNATIVE}[[{path}]]")
                } else {
                    format!("{ALTERNATIVE}[{path}]")
                };
                self.line(&header);
                has_header = true;
            }
            if is_first || is_chosen(&key) {
                self.meaning(ALTERNATIVE, &key);
            }
            let literal = match (key.kind, chosen) {
                // A filter is best named after its kind.
                (Kind::Name, Some((row, _))) => format!("\"{}\"", row.name.replace('_', "-")),
                _ => literal_of(&key),
            };
            self.line(&format!("{ALTERNATIVE}{} = {literal}", key.path));
        }
    }

    /// Writes the header that a table cannot do without.
    fn beside(&mut self, header: &str) {
        if !header.is_empty() {
            self.line(&format!("{ALTERNATIVE}{header}"));
        }
    }
}

/// The key of a row that is a value, under its name alone.
fn value_key(row: &'static Row) -> Option<Key> {
    match row.content {
        Content::Value(kind) => Some(Key::of(row, row.name, kind)),
        Content::Table(_) | Content::Tables(_) => None,
    }
}

/// The alternatives of a table and where they are declared: in it, or in one whose rows stand in it.
fn alternatives_of(table: &'static Table) -> (Option<Group>, &'static Table) {
    let flat = table.rows.iter().find_map(|row| match row.content {
        Content::Table(inner) if row.name.is_empty() && !inner.is_renaming() => Some(inner),
        _ => None,
    });
    match (table.group, flat) {
        (None, Some(inner)) => (inner.group, inner),
        (group, _) => (group, table),
    }
}

/// The value of a key as it is written in its table.
fn literal_of(key: &Key) -> String {
    match key.kind {
        Kind::Parameters => toml_text(key.literal),
        _ => key.literal.to_owned(),
    }
}

/// The text that a TOML string stands for.
fn toml_text(literal: &str) -> String {
    literal.trim_matches('"').replace("\\\"", "\"")
}
