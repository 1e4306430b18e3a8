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
