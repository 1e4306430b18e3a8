//! A resolved scenario of which numbers are moved again and again without reading it again.

use crate::gyro::GyroConfig;
use crate::scenario::check::inert::acts_in;
use crate::scenario::config::Scenario;
use crate::scenario::document::address::{self, AddressError, Step};
use crate::scenario::document::deserialize::from_table;
use crate::scenario::document::tree::{Node, Table, Value};
use crate::scenario::keys::schema::{Key, Kind};
use crate::scenario::read::resolved::Resolved;
use crate::turntable::TurntableConfig;

/// Tables whose numbers can be moved.
const GYRO: &str = "gyro";
const TURNTABLE: &str = "turntable";

/// A scenario with numbers to move.
#[derive(Clone, Debug)]
pub struct Movable {
    scenario: Scenario,
    tree: Table,
    /// Where each number stands.
    paths: Vec<Vec<Step>>,
    moves_gyro: bool,
    moves_turntable: bool,
}

/// A key that cannot be moved.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{fault}")]
pub struct NotMovable {
    /// Place of the key.
    pub index: usize,
    fault: MoveFault,
}

/// Why a key cannot be moved.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
enum MoveFault {
    #[error(transparent)]
    Address(#[from] AddressError),
    #[error(
        "{0} cannot be a parameter: expected a number of gyro or turntable; put other keys into a \
         [[choice]]"
    )]
    Other(String),
    #[error("{key} does not stand in {file}")]
    Absent { key: String, file: String },
}

impl Resolved {
    /// Whether a key of gyro or turntable does something in this run: what `--set` would not refuse.
    #[must_use]
    pub fn acts(&self, key: &str) -> bool {
        acts_in(self, key)
    }

    /// The scenario with these keys to move, each as `--set` writes it.
    ///
    /// # Errors
    /// What is wrong with a key: it is unknown, no number with a fraction, or of another table than the
    /// gyro's and the turntable's.
    pub fn movable(&self, keys: &[String]) -> Result<Movable, NotMovable> {
        let mut paths = Vec::new();
        for (index, written) in keys.iter().enumerate() {
            let path = self.number(written);
            paths.push(path.map_err(|fault| NotMovable { index, fault })?);
        }
        let moves = |table: &str| {
            let first =
                |path: &Vec<Step>| matches!(path.first(), Some(Step::Key(own)) if own == table);
            paths.iter().any(first)
        };
        let (moves_gyro, moves_turntable) = (moves(GYRO), moves(TURNTABLE));
        Ok(Movable {
            scenario: self.scenario.clone(),
            tree: self.tree.clone(),
            paths,
            moves_gyro,
            moves_turntable,
        })
    }

    /// Where a number of gyro or turntable stands.
    fn number(&self, written: &str) -> Result<Vec<Step>, MoveFault> {
        let (path, key) = address::resolve(&self.tree, written)?;
        let is_number = matches!(
            key,
            Some(Key {
                kind: Kind::Float(_),
                ..
            })
        );
        let is_reached =
            |step: &Step| matches!(step, Step::Key(table) if table == GYRO || table == TURNTABLE);
        let is_plain = path.iter().all(|step| matches!(step, Step::Key(_)));
        if !is_number || !is_plain || !path.first().is_some_and(is_reached) {
            return Err(MoveFault::Other(written.to_owned()));
        }
        match address::get(&self.tree, &path) {
            Some(_) => Ok(path),
            None => Err(MoveFault::Absent {
                key: written.to_owned(),
                file: self.file.clone(),
            }),
        }
    }

    /// Range of a key that is a number; none of others.
    #[must_use]
    pub fn range_of(&self, written: &str) -> Option<(f64, f64)> {
        match address::resolve(&self.tree, written).ok()?.1?.kind {
            Kind::Float(range) => Some((range.low, range.high)),
            _ => None,
        }
    }
}

impl Movable {
    /// Whether its gyro moves.
    #[must_use]
    pub fn moves_gyro(&self) -> bool {
        self.moves_gyro
    }

    /// The scenario as it stands.
    #[must_use]
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// Moves the numbers, in the order of their keys, and hands out the scenario.
    ///
    /// # Panics
    /// Never: a number takes the place of a number.
    pub fn at(&mut self, values: impl IntoIterator<Item = f64>) -> &Scenario {
        for (path, value) in self.paths.iter().zip(values) {
            if let Some(node) = node_mut(&mut self.tree, path) {
                node.value = Value::Float(value);
            }
        }
        if self.moves_gyro {
            self.scenario.gyro = read::<GyroConfig>(&self.tree, GYRO);
        }
        if self.moves_turntable {
            self.scenario.turntable = read::<TurntableConfig>(&self.tree, TURNTABLE);
        }
        &self.scenario
    }
}

/// A table of a whole tree.
fn read<'de, T: serde::Deserialize<'de>>(tree: &'de Table, table: &str) -> T {
    let inner = tree.get(table).and_then(Node::as_table);
    from_table(inner.expect(WHOLE)).expect(WHOLE)
}

/// Why a table of a resolved scenario cannot be missing or wrong.
const WHOLE: &str = "a resolved scenario holds every table, and a number stays a number";

/// The value at a path of keys.
fn node_mut<'a>(tree: &'a mut Table, path: &[Step]) -> Option<&'a mut Node> {
    let mut table = tree;
    let mut steps = path.iter().peekable();
    while let Some(Step::Key(name)) = steps.next() {
        let node = table.get_mut(name)?;
        if steps.peek().is_none() {
            return Some(node);
        }
        table = node.as_table_mut()?;
    }
    None
}
