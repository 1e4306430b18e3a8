//! Key paths as people write them in `--set`, in `[matrix]` and in code.
//!
//! `gyro.coil.length_m` is a key. An element of an array of tables is `gate[2].max` by its index
//! from 0; a filter is also `filter.<name>.<key>`, where the kind of the filter need not be said:
//! `filter.rls.taps` is the key `taps` of whatever kind the filter named `rls` is.

use std::sync::Arc;

use crate::scenario::document::source::Mark;
use crate::scenario::document::tree::{Node, Table, Value, merge_node};
use crate::scenario::keys::schema::{self, Child, Key, Kind, join};
use crate::scenario::message::excerpt::excerpt;
use crate::scenario::message::suggest::{self, unknown_key};

/// One step into a tree.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// Into a table.
    Key(String),
    /// Into an array.
    Index(usize),
}

/// Why a written path leads to no place of a scenario, or a place takes no value.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum AddressError {
    /// Other than names between dots.
    #[error("`{0}` is not a key path: expected names separated by dots, as in gyro.coil.length_m")]
    NotNames(String),
    /// Brackets around something other than an index.
    #[error("`{0}` is not a key path: expected an index from 0 in brackets, as in gate[2].max")]
    NotAnIndex(String),
    /// Empty brackets, as the schema writes them.
    #[error("`{path}` does not say which {array}")]
    NoIndex {
        /// The path as it was written.
        path: String,
        /// The array of tables.
        array: String,
    },
    /// What is wrong, and what to write.
    #[error("{error}: {instead}")]
    Instead {
        /// What is wrong.
        error: Box<AddressError>,
        /// The path to an element that there is.
        instead: String,
    },
    /// An index behind something that is no array.
    #[error("{0} has no elements to number")]
    NotAnArray(String),
    /// A key inside a value.
    #[error("{0} is not a table")]
    NotATable(String),
    /// A key that nobody knows, and what may have been meant.
    #[error("{0}")]
    UnknownKey(String),
    /// An index behind the last element.
    #[error("there is no {array}[{index}]: the scenario has {count} of them, counted from 0")]
    NoElement {
        /// The array of tables.
        array: String,
        /// The index that was asked for.
        index: usize,
        /// Number of elements.
        count: usize,
    },
    /// A name that no element has.
    #[error("there is no {array} named {name}: {}", instead_of_name(array, names))]
    NoName {
        /// The array of tables.
        array: String,
        /// The name that was asked for.
        name: String,
        /// Names that there are.
        names: Vec<String>,
    },
    /// A table where a value of its own is expected.
    #[error("{0} cannot be set as a whole")]
    Whole(String),
    /// An element that is gone.
    #[error("{0} does not exist")]
    Missing(String),
}

fn instead_of_name(array: &str, names: &[String]) -> String {
    match names {
        [] => format!("give an index, as in {array}[0]"),
        _ => format!("expected one of {}", names.join(", ")),
    }
}

/// Splits a written path.
///
/// # Errors
/// What is wrong with its spelling.
pub(crate) fn parse(path: &str) -> Result<Vec<Step>, AddressError> {
    let mut steps = Vec::new();
    for part in path.split('.') {
        let (name, indices) = part.split_at(part.find('[').unwrap_or(part.len()));
        let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        if name.is_empty() || !name.chars().all(is_bare) {
            return Err(AddressError::NotNames(excerpt(path).to_string()));
        }
        steps.push(Step::Key(name.to_owned()));
        if indices.is_empty() {
            continue;
        }
        let index = indices
            .strip_prefix('[')
            .and_then(|rest| rest.strip_suffix(']'))
            .and_then(|digits| digits.parse().ok());
        match index {
            Some(index) => steps.push(Step::Index(index)),
            None if indices == "[]" => {
                return Err(AddressError::NoIndex {
                    path: excerpt(path).into_owned(),
                    array: name.to_owned(),
                });
            }
            None => return Err(AddressError::NotAnIndex(excerpt(path).to_string())),
        }
    }
    Ok(steps)
}

/// The path as text.
pub(crate) fn display(steps: &[Step]) -> String {
    let mut text = String::new();
    for step in steps {
        match step {
            Step::Key(name) => text = join(&text, name),
            Step::Index(index) => text.push_str(&format!("[{index}]")),
        }
    }
    text
}

/// Turns filter names into indices, fills in the kind of the filter and refuses unknown keys.
/// Returns the full path and, if it is one, the key at its end.
///
/// # Errors
/// The unknown key with its nearest known one, or the element that does not exist.
pub(crate) fn resolve(
    root: &Table,
    written: &str,
) -> Result<(Vec<Step>, Option<&'static Key>), AddressError> {
    let steps = parse(written).map_err(|error| match written.split_once("[]") {
        Some((array, rest)) if !array.contains('[') => AddressError::Instead {
            error: Box::new(error),
            instead: which_element(root, array, rest),
        },
        _ => error,
    })?;
    let mut rest = steps.into_iter().peekable();
    let mut path: Vec<Step> = Vec::new();
    let mut schema_path = String::new();
    let mut key: Option<&'static Key> = None;
    while let Some(step) = rest.next() {
        let Step::Key(name) = step else {
            return Err(AddressError::NotAnArray(display(&path)));
        };
        match key {
            // Their names are the user's.
            Some(Key {
                kind: Kind::Parameters,
                ..
            }) if rest.peek().is_none() => {
                path.push(Step::Key(name));
                continue;
            }
            Some(_) => return Err(AddressError::NotATable(display(&path))),
            None => {}
        }
        match schema::child(&schema_path, &name) {
            None => {
                let table = suggest::Place {
                    schema_path: &schema_path,
                    shown: written_table(written, &path, &name),
                    root: Some(root),
                };
                return Err(AddressError::UnknownKey(unknown_key(table, &name)));
            }
            Some(Child::Leaf(leaf)) => {
                key = Some(leaf);
                path.push(Step::Key(name));
            }
            Some(Child::Table) => {
                schema_path = join(&schema_path, &name);
                path.push(Step::Key(name));
            }
            Some(Child::Tables) => {
                let elements = root.get(&name).and_then(Node::as_array).unwrap_or_default();
                schema_path = format!("{}[]", join(&schema_path, &name));
                path.push(Step::Key(name.clone()));
                let Some(selector) = rest.next() else {
                    continue;
                };
                let index = element_index(&name, elements, &selector)?;
                path.push(Step::Index(index));
                let table = elements[index].as_table();
                if let (Some(Step::Key(next)), Some(kind)) = (
                    rest.peek(),
                    table.and_then(|table| kind_of(&schema_path, table)),
                ) && schema::child(&schema_path, next).is_none()
                {
                    schema_path = join(&schema_path, kind);
                    path.push(Step::Key(kind.to_owned()));
                }
            }
        }
    }
    Ok((path, key))
}

/// How to say which element of an array is meant by a path with `[]`, or that there is none.
fn which_element(root: &Table, array: &str, rest: &str) -> String {
    let elements = root.get(array).and_then(Node::as_array).unwrap_or_default();
    let kinds = schema::group_of(&format!("{array}[]")).map(|group| group.alternatives);
    let kind = rest.trim_start_matches('.').split(['.', '[']).next();
    let kind = kind.filter(|kind| kinds.is_some_and(|kinds| kinds.contains(kind)));
    let is_meant = |node: &Node| {
        let table = node.as_table();
        table.is_some_and(|table| kind.is_none_or(|kind| table.contains_key(kind)))
    };
    let Some(index) = elements.iter().position(is_meant) else {
        let of_kind = kind.map_or_else(String::new, |kind| {
            format!(" with a table [{array}.{kind}]")
        });
        return format!("the scenario has no [[{array}]]{of_kind}");
    };
    let by_index = format!("give its index, as in {array}[{index}]{}", excerpt(rest));
    let name = elements[index]
        .as_table()
        .and_then(|table| table.get("name"));
    let Some(name) = name.and_then(Node::as_text) else {
        return by_index;
    };
    let own_kind = kind.map_or_else(String::new, |kind| format!(".{kind}"));
    let key = rest.strip_prefix(own_kind.as_str()).unwrap_or(rest);
    format!(
        "{by_index}, or its name, as in {array}.{name}{}",
        excerpt(key)
    )
}

/// What a value at a resolved path does to the element that it is put into, if it makes that another
/// kind.
pub(crate) fn kind_replaced(root: &Table, path: &[Step]) -> Option<String> {
    let [Step::Key(array), Step::Index(index), Step::Key(kind), ..] = path else {
        return None;
    };
    let schema_path = format!("{array}[]");
    let group = schema::group_of(&schema_path)?;
    let element = root.get(array)?.as_array()?.get(*index)?.as_table()?;
    let had = kind_of(&schema_path, element)?;
    let is_other = group.alternatives.contains(&kind.as_str()) && had != kind;
    let name = element.get("name").and_then(Node::as_text);
    let shown = name.map_or_else(
        || format!("[{index}]"),
        |name| format!(" \"{}\"", excerpt(name)),
    );
    is_other.then(|| format!("{array}{shown}, of the kind {had}, is of the kind {kind} by this"))
}

/// The table of an unknown key as it was written.
fn written_table<'a>(written: &'a str, path: &[Step], name: &str) -> &'a str {
    if path.is_empty() {
        return "";
    }
    // The kind of a filter may stand in the path though it was not written: the name is found from
    // the left, behind as many dots as the shorter of both has.
    let ends = written.match_indices('.').map(|(at, _)| at);
    let follows = |at: &usize| written[at + 1..].split(['.', '[']).next() == Some(name);
    ends.rev().find(follows).map_or("", |at| &written[..at])
}

/// The index of the element that a step selects by index or by name.
fn element_index(array: &str, elements: &[Node], selector: &Step) -> Result<usize, AddressError> {
    match selector {
        Step::Index(index) if *index < elements.len() => Ok(*index),
        Step::Index(index) => Err(AddressError::NoElement {
            array: array.to_owned(),
            index: *index,
            count: elements.len(),
        }),
        Step::Key(name) => {
            let name_of =
                |node: &'_ Node| node.as_table()?.get("name")?.as_text().map(str::to_owned);
            let position = elements
                .iter()
                .position(|node| name_of(node).as_ref() == Some(name));
            position.ok_or_else(|| AddressError::NoName {
                array: array.to_owned(),
                name: excerpt(name).to_string(),
                names: elements.iter().filter_map(name_of).collect(),
            })
        }
    }
}

/// The alternative that stands in a table of alternatives.
fn kind_of(schema_path: &str, table: &Table) -> Option<&'static str> {
    let group = schema::group_of(schema_path)?;
    let is_there = |name: &&&str| table.contains_key(**name);
    group.alternatives.iter().find(is_there).copied()
}

/// Puts a value at a resolved path, making the tables on the way; a table is merged into.
///
/// # Errors
/// The value on the way that is no table.
pub(crate) fn assign(
    root: &mut Table,
    path: &[Step],
    value: Node,
    mark: Mark,
) -> Result<(), AddressError> {
    let mut over = value;
    over.mark = Some(mark);
    // The part below the last array is wrapped into tables and merged, so that alternatives
    // replace one another exactly as they do between files.
    let last_index = path.iter().rposition(|step| matches!(step, Step::Index(_)));
    let (outer, inner) = path.split_at(last_index.map_or(0, |at| at + 1));
    for (depth, step) in inner.iter().enumerate().rev() {
        if let Step::Key(name) = step {
            let table = Table::from([(name.clone(), over)]);
            let is_new = get(root, &path[..outer.len() + depth]).is_none();
            over = Node {
                value: table.into(),
                mark: is_new.then_some(mark),
            };
        }
    }
    let Value::Table(over_table) = over.value else {
        return Err(AddressError::Whole(display(path)));
    };
    match outer {
        [] => {
            crate::scenario::document::tree::merge("", root, Arc::unwrap_or_clone(over_table));
            Ok(())
        }
        [Step::Key(array), Step::Index(index)] => {
            let element = root
                .get_mut(array)
                .and_then(Node::as_array_mut)
                .and_then(|elements| elements.get_mut(*index))
                .ok_or_else(|| AddressError::Missing(display(outer)))?;
            let over = Node {
                value: Value::Table(over_table),
                mark: None,
            };
            merge_node(&format!("{array}[]"), element, over);
            Ok(())
        }
        _ => Err(AddressError::Missing(display(outer))),
    }
}

/// The value at a path, or its nearest ancestor that was written down.
pub(crate) fn nearest_mark(root: &Table, path: &[Step]) -> Option<Mark> {
    let mut mark = None;
    let mut steps = path.iter();
    let Some(Step::Key(first)) = steps.next() else {
        return None;
    };
    let mut node = root.get(first)?;
    loop {
        mark = node.mark.or(mark);
        let next = match steps.next() {
            Some(Step::Key(name)) => node.as_table().and_then(|table| table.get(name)),
            Some(Step::Index(index)) => node.as_array().and_then(|array| array.get(*index)),
            None => None,
        };
        match next {
            Some(next) => node = next,
            None => return mark,
        }
    }
}

/// The value at a path to change.
pub(crate) fn get_mut<'a>(root: &'a mut Table, path: &[Step]) -> Option<&'a mut Node> {
    let (first, rest) = path.split_first()?;
    let Step::Key(first) = first else {
        return None;
    };
    rest.iter()
        .try_fold(root.get_mut(first)?, |node, step| match step {
            Step::Key(name) => node.as_table_mut()?.get_mut(name),
            Step::Index(index) => node.as_array_mut()?.get_mut(*index),
        })
}

/// The value at a path.
pub(crate) fn get<'a>(root: &'a Table, path: &[Step]) -> Option<&'a Node> {
    let (first, rest) = path.split_first()?;
    let Step::Key(first) = first else {
        return None;
    };
    rest.iter()
        .try_fold(root.get(first)?, |node, step| match step {
            Step::Key(name) => node.as_table()?.get(name),
            Step::Index(index) => node.as_array()?.get(*index),
        })
}
