//! What the reference says of one key or of one table.

use thiserror::Error;

use crate::declare::{Content, Kind, Presence, Row, Table};
use crate::scenario::config::Scenario;
use crate::scenario::generate::reference::{ALTERNATIVE, Print};
use crate::scenario::keys::schema::{Key, join};
use crate::scenario::message::suggest::{Place, unknown_key};

/// The part of the reference about a key or a table, as in `gyro.noise` or `filter.rls.taps`: type,
/// range, unit, default and meaning, in the form of the whole.
///
/// # Errors
/// The complaint about a name that nobody knows, with what may have been meant.
pub fn reference_part(key: &str) -> Result<String, UnknownKey> {
    let mut at = Reached::root();
    for part in key.split('.') {
        // An element of an array may be written as such: `filter[].rls`, `gate[2].max`.
        let name = part.split_once('[').map_or(part, |(name, _)| name);
        at = at.below(name)?;
    }
    Ok(at.print())
}

/// A name that is asked for and that no table knows.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct UnknownKey(String);

/// A row that was found, and the way to it.
struct Reached {
    /// Path as a file writes it.
    path: String,
    /// Schema path.
    schema_path: String,
    /// The row, unless it is the whole file.
    row: Option<&'static Row>,
    /// Header of the table that it stands in; empty at the root.
    parent: String,
    /// Whether it stands by default.
    is_live: bool,
    /// Whether it is one of an array of tables.
    is_element: bool,
}

impl Reached {
    fn root() -> Self {
        Self {
            path: String::new(),
            schema_path: String::new(),
            row: None,
            parent: String::new(),
            is_live: true,
            is_element: false,
        }
    }

    /// The table that it is.
    fn table(&self) -> Option<&'static Table> {
        match self.row.map(|row| row.content) {
            None => Some(&Scenario::TABLE),
            Some(Content::Table(table) | Content::Tables(table)) => Some(table),
            Some(Content::Value(_)) => None,
        }
    }

    /// What stands under a name in it.
    fn below(self, name: &str) -> Result<Self, UnknownKey> {
        let Some(table) = self.table() else {
            let said = format!("{} is a key and holds no {name}", self.path);
            return Err(UnknownKey(said));
        };
        let Some((row, is_other)) = find(table, name) else {
            let place = Place {
                schema_path: &self.schema_path,
                shown: &self.path,
                root: None,
            };
            return Err(UnknownKey(unknown_key(place, name)));
        };
        let is_element = matches!(row.content, Content::Tables(_));
        let schema_name = if is_element { "[]" } else { "" };
        Ok(Self {
            path: join(&self.path, name),
            schema_path: join(&self.schema_path, name) + schema_name,
            row: Some(row),
            parent: match self.path.as_str() {
                "" => String::new(),
                path if self.is_element => format!("[[{path}]]"),
                path => format!("[{path}]"),
            },
            is_live: self.is_live && !is_other && !is_element && row.presence != Presence::Optional,
            is_element,
        })
    }

    fn print(&self) -> String {
        let mut print = Print::default();
        let Some(row) = self.row else {
            return String::new();
        };
        match row.content {
            Content::Value(Kind::Matrix) => print.root_key(&Key::of(row, row.name, Kind::Matrix)),
            Content::Value(kind) => {
                let is_live = self.is_live && row.presence == Presence::Defaulted;
                print.lone(&self.parent, &Key::of(row, row.name, kind), is_live);
            }
            Content::Table(table) if table.rows.is_empty() => {
                print.empty(if self.is_live { "" } else { ALTERNATIVE }, &self.path, row);
            }
            Content::Table(table) if self.is_live => print.live(&self.path, table, row.about()),
            Content::Table(table) | Content::Tables(table) => {
                print.lone_example(&self.path, self.is_element, table, row.about());
            }
        }
        print.into_text()
    }
}

/// The row of a name in a table, and whether it is an alternative that does not stand by default.
fn find(table: &'static Table, name: &str) -> Option<(&'static Row, bool)> {
    for row in table.rows {
        match row.content {
            Content::Table(inner) if row.name.is_empty() => {
                if let Some(found) = find(inner, name) {
                    return Some(found);
                }
            }
            _ if row.name == name => {
                let is_other = table.group.is_some_and(|group| {
                    group.alternatives.contains(&name) && group.default() != Some(name)
                });
                return Some((row, is_other));
            }
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::generate::reference::reference_toml;
    use crate::scenario::keys::schema::keys;

    #[test]
    fn every_key_and_every_table_has_its_part_in_the_words_of_the_reference() {
        let whole = reference_toml();
        for key in keys().filter(|key| !matches!(key.kind, Kind::EmptyTable)) {
            let part = reference_part(key.path).expect(key.path);
            assert!(part.contains(&key.line()), "{}: {part}", key.path);
            let name = key.path.rsplit('.').next().expect("a name");
            assert!(part.contains(name), "{}: {part}", key.path);
            for line in part.lines().filter(|line| line.starts_with("# ")) {
                assert!(whole.contains(line), "{}: {line}", key.path);
            }
            for (at, _) in key.path.match_indices('.') {
                let table = reference_part(&key.path[..at]).expect(key.path);
                assert!(table.contains(name) || key.successor.is_some(), "{table}");
            }
        }
    }

    #[test]
    fn a_part_is_a_file_that_the_reader_of_scenarios_takes() {
        for path in keys()
            .map(|key| key.path)
            .chain(["gyro", "filter", "turntable.servo"])
        {
            let part = reference_part(path).expect(path);
            let plain = part.replace("#| ", "");
            assert!(plain.ends_with('\n'), "{part:?}");
            let is_single = plain.matches("\n[").count() + usize::from(plain.starts_with('[')) <= 1;
            if is_single {
                let read: Result<toml::Table, _> = toml::from_str(&plain);
                assert!(read.is_ok(), "{path}: {plain}: {read:?}");
            }
        }
    }

    #[test]
    fn what_nobody_knows_is_told_with_what_may_be_meant() {
        for (key, said) in [
            ("gyro.nosie", "did you mean gyro.noise?"),
            ("filter.rls.tap", "did you mean filter.rls.taps?"),
            ("filter[0].rls.tap", "did you mean filter.rls.taps?"),
            ("coil", "did you mean gyro.coil?"),
            (
                "gyro.noise.shot.x",
                "gyro.noise.shot is a key and holds no x",
            ),
            ("", "unknown key"),
        ] {
            let refused = reference_part(key).expect_err(key).to_string();
            assert!(refused.contains(said), "{key}: {refused}");
        }
    }
}
