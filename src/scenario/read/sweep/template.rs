//! One point of a sweep as the pattern of the others.
//!
//! The points of a sweep have the same keys, and but for the swept ones the same values. What has
//! been checked, filled in and spelled for one of them therefore holds for all: a further point
//! costs its own values and the checks across values.

use std::sync::Arc;

use crate::scenario::check::cross;
use crate::scenario::check::leaf::check_leaf;
use crate::scenario::check::numbers::settled_value;
use crate::scenario::document::address::{self, Step};
use crate::scenario::document::emit::to_toml_around;
use crate::scenario::document::tree::{Node, Table};
use crate::scenario::keys::renamed;
use crate::scenario::keys::schema::{Key, Kind};
use crate::scenario::message::error::ScenarioError;
use crate::scenario::read::resolved::{Resolved, configuration, digest};

/// First names of keys that stand for files which are read with the scenario: each point reads them for
/// itself, as it finds those that others name.
const FILES: [&str; 2] = ["compensation", "turntable.script"];

/// A resolved point and the places of its swept values.
pub(crate) struct Template {
    run: Resolved,
    slots: Vec<Slot>,
    /// The canonical text before, between and after the swept values.
    pieces: Vec<String>,
    /// Indices of the slots in the order in which the text has them.
    order: Vec<usize>,
}

/// A swept key.
struct Slot {
    path: Vec<Step>,
    key: &'static Key,
}

impl Template {
    /// The pattern that a resolved point gives; none if its swept keys are not plain values of it.
    pub(crate) fn of<'a>(
        run: &Resolved,
        swept: impl Iterator<Item = (&'a [Step], &'static Key)>,
    ) -> Option<Self> {
        let slots: Vec<Slot> = swept
            .map(|(path, key)| Slot {
                path: path.to_vec(),
                key,
            })
            .collect();
        let is_own = |slot: &Slot| {
            let kind = slot.key.kind;
            kind.names_files()
                || matches!(kind, Kind::Parameters)
                || FILES.iter().any(|name| slot.key.path.starts_with(name))
        };
        // What is left of a log depends on the values of each point.
        if run.log.is_some() || slots.iter().any(is_own) {
            return None;
        }
        let nodes = slots
            .iter()
            .map(|slot| address::get(run.tree(), &slot.path));
        let nodes: Vec<&Node> = nodes.collect::<Option<_>>()?;
        let (text, places) = to_toml_around(run.tree(), &nodes);
        // A value that is no part of a line, as an empty table, has no place of its own.
        if places.len() != nodes.len() {
            return None;
        }
        let mut pieces = Vec::new();
        let mut end = 0;
        for (_, place) in &places {
            pieces.push(text[end..place.start].to_owned());
            end = place.end;
        }
        pieces.push(text[end..].to_owned());
        let order = places.into_iter().map(|(index, _)| index).collect();
        Some(Self {
            run: run.clone(),
            slots,
            pieces,
            order,
        })
    }

    /// The point with other values, one for each swept key.
    ///
    /// # Errors
    /// Values out of range; if there are none, contradictions between values.
    pub(crate) fn point(&self, values: &[Node]) -> Result<Resolved, Vec<ScenarioError>> {
        let mut tree: Table = self.run.tree().clone();
        let mut spelled = vec![String::new(); values.len()];
        let mut errors = Vec::new();
        for (slot, (value, spelling)) in self.slots.iter().zip(values.iter().zip(&mut spelled)) {
            let shown = address::display(&slot.path);
            if let Err(fault) = check_leaf(slot.key, &shown, value) {
                let mark = fault.mark.or(value.mark);
                errors.push(self.run.error(mark, fault.message));
            }
            let mut node = value.clone();
            if let Some(settled) = settled_value(slot.key.kind, &node.value) {
                node.value = settled;
            }
            node.value.write_toml(spelling);
            if let Some(place) = address::get_mut(&mut tree, &slot.path) {
                *place = node;
            }
        }
        if !errors.is_empty() {
            return Err(errors);
        }
        let mut text = self.pieces[0].clone();
        for (index, piece) in self.order.iter().zip(&self.pieces[1..]) {
            text.push_str(&spelled[*index]);
            text.push_str(piece);
        }
        with_tree(&self.run, tree, &text)
    }
}

/// The run with other values, all of them checked one by one, and their canonical text.
///
/// # Errors
/// Every contradiction between the values.
fn with_tree(run: &Resolved, tree: Table, text: &str) -> Result<Resolved, Vec<ScenarioError>> {
    let former = renamed::warnings(&run.tree);
    let lasting = run.warnings.iter();
    let lasting = lasting.filter(|warning| !former.contains(warning)).cloned();
    let warnings = lasting.chain(renamed::warnings(&tree)).collect();
    let other = Resolved {
        scenario: configuration(&tree, run.root_mark, &run.sources)?,
        digest: digest(text),
        tree,
        file: run.file.clone(),
        inputs: run.inputs.clone(),
        named_files: run.named_files.clone(),
        log: run.log.clone(),
        sweep: None,
        warnings,
        remarks: run.remarks.clone(),
        is_base_point: false,
        campaign: run.campaign.clone(),
        gate_places: run.gate_places.clone(),
        assumed_keys: None,
        sources: Arc::clone(&run.sources),
        root_mark: run.root_mark,
        is_record: run.is_record,
        purpose: run.purpose,
    };
    let errors = cross::check(&other);
    if errors.is_empty() {
        Ok(other)
    } else {
        Err(errors)
    }
}
