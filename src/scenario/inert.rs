//! Keys that somebody set and that act nowhere.
//!
//! A key is a wish if it was set in the scenario itself, by `--set` or by a sweep: not inherited, not
//! a default, not from a manifest or another file in which every key is written out, as `expand`
//! prints it. A key of the scenario's own file that says what the default says asks for nothing. A
//! wish that acts in no point of a sweep is refused; one by `--set` if it acts in no run of the suite.

use super::address::{Step, display};
use super::defaults::default_of;
use super::error::{Location, ScenarioError};
use super::inert_rules::{Acts, RULES, Rule};
use super::resolved::Resolved;
use super::source::Mark;
use super::tree::{Node, Value};

/// A wish that has acted nowhere yet.
#[derive(Clone)]
struct Wish {
    rule: &'static Rule,
    path: Vec<Step>,
    mark: Mark,
    is_swept: bool,
}

/// The wishes of a scenario that have acted nowhere yet.
pub(crate) struct Idle(Vec<Wish>);

/// A wish by `--set` that acts in no point of a scenario; it may act in another one.
pub(crate) struct IdleSet {
    /// The argument and its key: what is the same in every scenario.
    pub(crate) identity: (Location, Vec<Step>),
    /// The complaint, should it act nowhere.
    pub(crate) error: ScenarioError,
}

impl Idle {
    /// The wishes that do not act in a first point; `swept` are the paths of a matrix and its marks.
    pub(crate) fn of(first: &Resolved, swept: &[(Vec<Step>, Mark)]) -> Self {
        let mut wishes = Vec::new();
        for rule in RULES {
            for (path, node) in places(first, rule) {
                let Some(mark) = node.mark else {
                    continue;
                };
                let axis = swept.iter().find(|(swept, _)| *swept == path);
                let mark = axis.map_or(mark, |(_, mark)| *mark);
                let is_set = first.is_set_argument(mark);
                let says_default = || {
                    default_of(rule.path)
                        .is_some_and(|default| default.to_toml() == node.value.to_toml())
                };
                let is_own = first.is_own(mark);
                if is_set || (is_own && (axis.is_some() || !says_default())) {
                    let is_swept = axis.is_some();
                    wishes.push(Wish {
                        rule,
                        path,
                        mark,
                        is_swept,
                    });
                }
            }
        }
        let mut idle = Self(wishes);
        idle.keep_idle(first);
        idle
    }

    /// Lets go of the wishes that act in another point.
    pub(crate) fn keep_idle(&mut self, point: &Resolved) {
        self.0.retain(|wish| !acts(point, wish));
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The complaints: those about the scenario itself, and those about `--set`.
    pub(crate) fn complaints(self, of: &Resolved) -> (Vec<ScenarioError>, Vec<IdleSet>) {
        let (mut own, mut sets) = (Vec::new(), Vec::new());
        let is_written_out = !self.0.is_empty() && of.is_written_out();
        for wish in self.0 {
            let location = of.place(wish.mark);
            let error = ScenarioError::at(location.clone(), message(of, &wish));
            if of.is_set_argument(wish.mark) {
                let identity = (location, wish.path);
                sets.push(IdleSet { identity, error });
            } else if wish.is_swept || !is_written_out {
                own.push(error);
            }
        }
        (own, sets)
    }
}

/// Wishes by `--set` that have acted in no file so far; none before the first file.
#[derive(Default)]
pub(crate) struct IdleSets(Option<Vec<IdleSet>>);

impl IdleSets {
    /// Keeps those that do not act in another file either.
    pub(crate) fn add(&mut self, found: Vec<IdleSet>) {
        match &mut self.0 {
            None => self.0 = Some(found),
            Some(kept) => {
                kept.retain(|one| found.iter().any(|other| other.identity == one.identity))
            }
        }
    }

    pub(crate) fn complaints(self) -> impl Iterator<Item = ScenarioError> {
        self.0.into_iter().flatten().map(|one| one.error)
    }
}

fn acts(run: &Resolved, wish: &Wish) -> bool {
    let scenario = &run.scenario;
    let index = wish.path.iter().find_map(|step| match step {
        Step::Index(index) => Some(*index),
        Step::Key(_) => None,
    });
    match wish.rule.acts {
        Acts::Run(acts) => acts(scenario),
        Acts::Filter(acts) => index
            .and_then(|index| scenario.filters.get(index))
            .is_none_or(acts),
        Acts::Gate(acts) => index
            .and_then(|index| scenario.gates.get(index))
            .is_none_or(acts),
    }
}

/// Every place at which a run has the key of a rule.
fn places<'a>(run: &'a Resolved, rule: &Rule) -> Vec<(Vec<Step>, &'a Node)> {
    let mut found: Vec<(Vec<Step>, &Node)> = Vec::new();
    for (depth, name) in rule.path.split('.').enumerate() {
        let (name, is_array) = match name.strip_suffix("[]") {
            Some(name) => (name, true),
            None => (name, false),
        };
        let tables = if depth == 0 {
            vec![(Vec::new(), run.tree())]
        } else {
            let inner = found.into_iter();
            inner
                .filter_map(|(path, node)| Some((path, node.as_table()?)))
                .collect()
        };
        found = Vec::new();
        for (mut path, table) in tables {
            let Some(node) = table.get(name) else {
                continue;
            };
            path.push(Step::Key(name.to_owned()));
            match &node.value {
                Value::Array(elements) if is_array => {
                    for (index, element) in elements.iter().enumerate() {
                        let mut path = path.clone();
                        path.push(Step::Index(index));
                        found.push((path, element));
                    }
                }
                _ => found.push((path, node)),
            }
        }
    }
    found
}

fn message(of: &Resolved, wish: &Wish) -> String {
    let path = display(&wish.path);
    let subject = match of.value_toml(&wish.path) {
        Some(value) if !wish.is_swept => format!("{path} = {value} has no effect"),
        _ => format!("{path} is swept without effect in any point"),
    };
    match wish.rule.needs.rsplit_once("; ") {
        Some((reason, needs)) => {
            format!("{subject}: {reason}; set {needs} or leave the key out")
        }
        None => {
            let needs = wish.rule.needs;
            format!("{subject}: it acts only with {needs}; set that or leave the key out")
        }
    }
}
