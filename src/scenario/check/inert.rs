//! Keys that somebody set and that act nowhere.
//!
//! A key is a wish if it was set in the scenario itself, by `--set` or by a sweep: not inherited, not
//! a default, not from a manifest or another file in which every key is written out, as `expand`
//! prints it. A key of the scenario's own file that says what the default says asks for nothing. A
//! wish that acts in no point of a sweep is refused; one by `--set` if it acts in no run of the suite.

use crate::scenario::check::inert_rules::{Acts, Rule, bench_rules, is_of_bench, rules};
use crate::scenario::document::address::{Step, display};
use crate::scenario::document::source::Mark;
use crate::scenario::document::tree::{Node, Table};
use crate::scenario::keys::defaults::default_of;
use crate::scenario::message::error::{Location, ScenarioError};
use crate::scenario::message::excerpt::excerpt;
use crate::scenario::read::resolved::Resolved;

/// A wish that has acted nowhere yet.
struct Wish {
    rule: &'static Rule,
    path: Vec<Step>,
    is_set: bool,
    /// The complaint, should it act nowhere.
    error: ScenarioError,
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
        let mut is_written_out = None;
        let of_bench = first.scenario.log.as_ref().map(|_| bench_rules());
        for rule in rules().iter().chain(of_bench.into_iter().flatten()) {
            for Written { path, node, mark } in places(first, rule) {
                let axis = swept.iter().find(|(swept, _)| *swept == path);
                let mark = axis.map_or(mark, |(_, mark)| *mark);
                let (is_swept, is_set) = (axis.is_some(), first.is_set_argument(mark));
                let says_default = || {
                    default_of(rule.path)
                        .is_some_and(|default| default.to_toml() == node.value.to_toml())
                };
                let is_wish = is_set || (first.is_own(mark) && (is_swept || !says_default()));
                if !is_wish || acts(first, rule, &path) {
                    continue;
                }
                let mut is_record =
                    || *is_written_out.get_or_insert_with(|| first.is_written_out());
                if is_set || is_swept || !is_record() {
                    let message = message(rule, &path, node, is_swept);
                    wishes.push(Wish {
                        rule,
                        path,
                        is_set,
                        error: ScenarioError::at(first.place(mark), message),
                    });
                }
            }
        }
        Self(wishes)
    }

    /// Lets go of the wishes that act in another point.
    pub(crate) fn keep_idle(&mut self, point: &Resolved) {
        self.0.retain(|wish| !acts(point, wish.rule, &wish.path));
    }

    /// The complaints: those about the scenario itself, and those about `--set`.
    pub(crate) fn complaints(self) -> (Vec<ScenarioError>, Vec<IdleSet>) {
        let (mut own, mut sets) = (Vec::new(), Vec::new());
        for Wish {
            path,
            is_set,
            error,
            ..
        } in self.0
        {
            if is_set {
                let identity = (error.location.clone(), path);
                sets.push(IdleSet { identity, error });
            } else {
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

/// Whether a key acts on nothing in a run.
pub(crate) fn is_idle(run: &Resolved, schema_path: &str) -> bool {
    if run.scenario.log.is_some() && is_of_bench(schema_path) {
        return true;
    }
    let mut own = rules().iter().filter(|rule| rule.path == schema_path);
    own.any(|rule| matches!(rule.acts, Acts::Run(acts) if !acts(&run.scenario)))
}

/// Whether a key outside arrays acts in a run.
pub(in crate::scenario) fn acts_in(run: &Resolved, schema_path: &str) -> bool {
    let mut own = rules().iter().filter(|rule| rule.path == schema_path);
    own.all(|rule| acts(run, rule, &[]))
}

/// Whether the key of a rule acts in a run, at a path.
fn acts(run: &Resolved, rule: &Rule, path: &[Step]) -> bool {
    let scenario = &run.scenario;
    let index = path.iter().find_map(|step| match step {
        Step::Index(index) => Some(*index),
        Step::Key(_) => None,
    });
    match rule.acts {
        Acts::Run(acts) => acts(scenario),
        Acts::Motion => {
            let motion = &scenario.turntable.motion;
            !motion.is_idle(rule.path, scenario.duration_s)
        }
        Acts::Filter(kind, key) => index
            .and_then(|index| scenario.filters.get(index))
            .is_none_or(|filter| filter.kind.name() != kind || filter.kind.acts(key)),
        Acts::Gate(acts) => index
            .and_then(|index| scenario.gates.get(index))
            .is_none_or(acts),
    }
}

/// A key that somebody wrote.
struct Written<'a> {
    path: Vec<Step>,
    node: &'a Node,
    mark: Mark,
}

/// Every place at which somebody wrote the key of a rule in what became a run.
fn places<'a>(run: &'a Resolved, rule: &Rule) -> Vec<Written<'a>> {
    let mut found = Vec::new();
    gather(run.tree(), rule.path, &mut Vec::new(), &mut found);
    found
}

/// Gathers the written places below a table. What has no mark was filled in as a whole.
fn gather<'a>(
    table: &'a Table,
    names: &'static str,
    way: &mut Vec<(&'static str, Option<usize>)>,
    found: &mut Vec<Written<'a>>,
) {
    let (name, rest) = names.split_once('.').unwrap_or((names, ""));
    let (name, is_array) = match name.strip_suffix("[]") {
        Some(name) => (name, true),
        None => (name, false),
    };
    let Some((node, mark)) = table.get(name).and_then(|node| Some((node, node.mark?))) else {
        return;
    };
    if is_array {
        for (index, element) in node.as_array().unwrap_or_default().iter().enumerate() {
            if let Some(inner) = element.as_table() {
                way.push((name, Some(index)));
                gather(inner, rest, way, found);
                way.pop();
            }
        }
        return;
    }
    way.push((name, None));
    match node.as_table() {
        Some(inner) if !rest.is_empty() => gather(inner, rest, way, found),
        _ if rest.is_empty() => {
            let steps = way.iter().flat_map(|(name, index)| {
                let key = Step::Key((*name).to_owned());
                std::iter::once(key).chain(index.map(Step::Index))
            });
            let path = steps.collect();
            found.push(Written { path, node, mark });
        }
        _ => {}
    }
    way.pop();
}

/// The complaint about a key that acts nowhere.
fn message(rule: &Rule, path: &[Step], node: &Node, is_swept: bool) -> String {
    let path = display(path);
    let subject = if is_swept {
        format!("{path} is swept without effect in any point")
    } else {
        let value = node.value.to_toml();
        format!("{path} = {} has no effect", excerpt(&value))
    };
    match rule.needs.rsplit_once("; ") {
        Some((reason, needs)) => {
            format!("{subject}: {reason}; set {needs} or leave the key out")
        }
        None => {
            let needs = rule.needs;
            format!("{subject}: it acts only with {needs}; set that or leave the key out")
        }
    }
}
