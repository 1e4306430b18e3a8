//! Scenarios drawn from the schema: random keys, ends of ranges, alternatives, filters and gates.
//!
//! What the schema cannot tell stands in `texts` (what a text must refer to) and `hints` (keys
//! that only work together); both only raise the share of scenarios that run. A new key is drawn
//! without an edit of either.

use super::draft::{Draft, FILE, Line};
use super::hints;
use super::schema::{self, Child, Choice, Leaf, Table, join};
use super::texts;
use super::values::{self, Setting, quoted, toml};
use crate::support::seeded::Draws;

/// Draws the scenarios of one seed.
pub(crate) struct Generator<'a> {
    pub(crate) draws: &'a mut Draws,
    schema: &'a Table,
    pub(crate) setting: Setting,
    /// Probability that a key with a default is written.
    density: f64,
    parts: usize,
    draft: Draft,
}

/// Where in the file a table is drawn.
#[derive(Clone)]
struct Place {
    schema_path: String,
    element: Option<(String, usize)>,
    key: String,
    part: String,
    stem: Option<(String, String)>,
}

impl<'a> Generator<'a> {
    pub(crate) fn new(draws: &'a mut Draws, schema: &'a Table) -> Self {
        let setting = Setting {
            duration_s: draws.log_uniform(0.02, 2.0),
            extreme: *draws.pick(&[0.02, 0.1, 0.3, 0.6]),
            count: 1,
        };
        let density = *draws.pick(&[0.0, 0.01, 0.03, 0.1, 0.3]);
        Self {
            draws,
            schema,
            setting,
            density,
            parts: 0,
            draft: Draft::default(),
        }
    }

    /// A scenario; many are refused as drawn.
    pub(crate) fn scenario(mut self) -> (Draft, Setting) {
        self.frame();
        let root = Place {
            schema_path: String::new(),
            element: None,
            key: String::new(),
            part: FILE.to_owned(),
            stem: None,
        };
        let schema = self.schema;
        self.table(schema, &root);
        hints::apply(&mut self.draft, self.draws, self.schema, self.setting);
        self.sweep();
        (self.draft, self.setting)
    }

    /// The keys without which there is no short scenario.
    fn frame(&mut self) {
        let duration_s = self.setting.duration_s;
        let warm_up_s = if self.draws.chance(0.1) {
            0.0
        } else {
            duration_s * self.draws.log_uniform(0.1, 1.0)
        };
        let repeats = *self.draws.pick(&[1, 1, 1, 1, 2, 3, 7]);
        let fidelity = *self.draws.pick(&["loop", "rate"]);
        let frame = [
            ("schema", "1".to_owned()),
            ("name", quoted("case")),
            ("duration_s", toml(duration_s)),
            ("warm_up_s", toml(warm_up_s)),
            ("fidelity", quoted(fidelity)),
            ("repeats", repeats.to_string()),
        ];
        for (key, value) in frame {
            self.draft.lines.push(Line {
                schema_path: key.to_owned(),
                element: None,
                key: key.to_owned(),
                value,
                part: FILE.to_owned(),
                stem: None,
                is_needed: true,
                blamed: 0,
            });
        }
    }

    fn table(&mut self, table: &Table, place: &Place) {
        let outer = std::mem::replace(&mut self.setting.count, values::length(self.draws));
        let chosen: Vec<String> = table
            .choices
            .iter()
            .filter_map(|choice| self.choose(choice))
            .collect();
        let is_choice = |name: &String| {
            let mut choices = table.choices.iter();
            choices.any(|choice| choice.names.contains(name))
        };
        for (name, child) in &table.children {
            let is_chosen = chosen.contains(name);
            if is_choice(name) && !is_chosen {
                continue;
            }
            let is_needed = is_chosen || table.required.contains(name);
            let below = Place {
                schema_path: join(&place.schema_path, name),
                key: join(&place.key, name),
                ..place.clone()
            };
            match child {
                Child::Leaf(leaf) => self.leaf(leaf, &below, is_needed),
                Child::Table(inner) => self.inner_table(inner, &below, is_chosen),
                Child::Tables(inner) => self.elements(inner, &below, name),
            }
        }
        self.setting.count = outer;
    }

    fn choose(&mut self, choice: &Choice) -> Option<String> {
        let is_given = choice.is_required || self.draws.chance(0.6);
        is_given.then(|| self.draws.pick(&choice.names).clone())
    }

    fn inner_table(&mut self, table: &Table, place: &Place, is_chosen: bool) {
        let is_optional =
            !table.required.is_empty() || table.choices.iter().any(|choice| choice.is_required);
        if !is_chosen && is_optional && !self.draws.chance(0.1) {
            return;
        }
        let mut place = place.clone();
        // An element is nothing without its alternative; a table falls back to the default one.
        if place.element.is_none() && (is_chosen || is_optional) {
            place.part = self.new_part(&place.part);
        }
        if is_chosen {
            place.stem = Some((place.key.clone(), place.schema_path.clone()));
        }
        let before = self.draft.lines.len();
        self.table(table, &place);
        if is_chosen && self.draft.lines.len() == before {
            self.push(&place, "{}".to_owned(), true);
        }
    }

    fn elements(&mut self, table: &Table, place: &Place, name: &str) {
        let count = match (name, self.draws.below(20)) {
            ("filter", 0) => 12,
            ("filter", _) => self.draws.below(4),
            (_, 0..14) => 0,
            _ => 1 + self.draws.below(3),
        };
        for index in 0..count {
            let part = self.new_part(&place.part);
            let element = Place {
                schema_path: format!("{}[]", place.schema_path),
                element: Some((place.key.clone(), index)),
                key: String::new(),
                part,
                stem: None,
            };
            self.table(table, &element);
        }
    }

    fn leaf(&mut self, leaf: &Leaf, place: &Place, is_needed: bool) {
        let is_written = self
            .draft
            .lines
            .iter()
            .any(|line| line.element == place.element && line.key == place.key);
        // A default meant for minutes would refuse most records of a second.
        let is_too_long = leaf.unit.as_deref() == Some("s")
            && leaf.default.is_some_and(|default| default > 0.01)
            && place.part != FILE;
        if is_written || !(is_needed || is_too_long || self.draws.chance(self.density)) {
            return;
        }
        let mut setting = self.setting;
        if self.draws.chance(0.05) {
            setting.count = values::length(self.draws);
        }
        let value = values::value(self.draws, leaf, setting)
            .or_else(|| texts::value(self.draws, &self.draft, self.schema, place_of(place), leaf));
        if let Some(value) = value {
            self.push(place, value, is_needed || is_too_long);
        }
    }

    fn push(&mut self, place: &Place, value: String, is_needed: bool) {
        self.draft.lines.push(Line {
            schema_path: place.schema_path.clone(),
            element: place.element.clone(),
            key: place.key.clone(),
            value,
            part: place.part.clone(),
            stem: place.stem.clone(),
            is_needed,
            blamed: 0,
        });
    }

    fn new_part(&mut self, outer: &str) -> String {
        self.parts += 1;
        if outer == FILE {
            self.parts.to_string()
        } else {
            format!("{outer}/{}", self.parts)
        }
    }

    /// Turns a key or two of the file itself into swept ones.
    fn sweep(&mut self) {
        if !self.draws.chance(0.06) {
            return;
        }
        let leaves = schema::leaves(self.schema);
        for _ in 0..1 + self.draws.below(2) {
            let candidates: Vec<usize> = (0..self.draft.lines.len())
                .filter(|&index| self.draft.lines[index].element.is_none())
                .filter(|&index| self.draft.may_change(index))
                .collect();
            if candidates.is_empty() {
                return;
            }
            let index = *self.draws.pick(&candidates);
            let Some(leaf) = leaves.get(&self.draft.lines[index].schema_path) else {
                continue;
            };
            let setting = self.setting;
            let mut points = vec![self.draft.lines[index].value.clone()];
            points.extend(values::value(self.draws, leaf, setting));
            let line = &mut self.draft.lines[index];
            line.key = format!("matrix.\"{}\"", line.key);
            line.schema_path = format!("matrix.{}", line.schema_path);
            line.value = format!("[{}]", points.join(", "));
        }
    }
}

/// Element and schema path of a key.
fn place_of(place: &Place) -> (&str, Option<usize>) {
    let index = place.element.as_ref().map(|(_, index)| *index);
    (&place.schema_path, index)
}
