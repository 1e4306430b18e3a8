//! What a declaration says of a table of keys.

use super::kind::Content;

/// A declared table of keys.
#[derive(Clone, Copy, Debug)]
pub struct Table {
    /// What it is for: its documentation, line by line.
    pub about: &'static [&'static str],
    /// What stands in it, in order.
    pub rows: &'static [Row],
    /// The rows of which exactly one stands.
    pub group: Option<Group>,
    /// Header of a table that must stand beside it, if there is one.
    pub beside: &'static str,
}

/// A name inside a table.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// The name; empty for a table whose rows stand in this one.
    pub name: &'static str,
    /// What stands under it.
    pub content: Content,
    /// Unit as printed; empty for a number without unit and for everything that is no number.
    pub unit: &'static str,
    /// What happens when it is absent.
    pub presence: Presence,
    /// Default, or an example where there is none, as TOML writes it.
    pub literal: &'static str,
    /// What it means and where its default comes from, line by line.
    pub doc: &'static [&'static str],
    /// Where it is named if nobody sets it, or each of its rows that says nothing of its own.
    pub told: &'static [Told],
    /// The key that has taken its place, if its name is a former one.
    pub successor: Option<Successor>,
}

/// What names a value that nobody set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Told {
    /// The account of every run, whose figures it shapes.
    Account,
    /// The noise budget, which rests on it.
    Budget,
}

/// The key that has taken the place of one with a former name and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Successor {
    /// Its name, in the same table.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Its value over that of the former key.
    pub factor: f64,
}

impl Table {
    /// The rows that stand in it, those of tables without a name among them; former names are left out.
    pub fn current_rows(&'static self) -> impl Iterator<Item = &'static Row> {
        let rows = self.rows.iter().flat_map(|row| match row.content {
            Content::Table(inner) if inner.is_renaming() => inner.rows,
            _ => std::slice::from_ref(row),
        });
        rows.filter(|row| row.successor.is_none())
    }

    /// Whether it only joins a key and its former name.
    #[must_use]
    pub fn is_renaming(&self) -> bool {
        self.rows.iter().any(|row| row.successor.is_some())
    }
}

impl Row {
    /// Its documentation; of a table that has none here, that of the table.
    #[must_use]
    pub fn about(&self) -> &'static [&'static str] {
        match self.content {
            Content::Table(table) | Content::Tables(table) if self.doc.is_empty() => table.about,
            _ => self.doc,
        }
    }
}

/// What happens when a key is absent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Presence {
    /// Its declared default stands.
    Defaulted,
    /// The file is refused.
    Required,
    /// The thing it describes is absent.
    Optional,
}

impl Presence {
    /// Presence of a key without a default.
    #[must_use]
    pub const fn without_default(is_optional: bool) -> Self {
        if is_optional {
            Self::Optional
        } else {
            Self::Required
        }
    }
}

/// Alternatives of a table, of which a file gives at most one and a resolved run has exactly one.
///
/// A later source that gives one replaces whichever an earlier source gave.
#[derive(Clone, Copy, Debug)]
pub struct Group {
    /// Schema path of the table they stand in; empty in a declaration, which knows no path.
    pub table: &'static str,
    /// What they are alternatives of.
    pub noun: &'static str,
    /// Names of the alternatives.
    pub alternatives: &'static [&'static str],
    /// Whether the first one stands where a file gives none; without it a choice is needed.
    pub has_default: bool,
}

impl Group {
    /// The alternative that stands where a file gives none.
    #[must_use]
    pub fn default(&self) -> Option<&'static str> {
        self.alternatives
            .first()
            .filter(|_| self.has_default)
            .copied()
    }
}
