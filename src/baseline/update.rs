//! A baseline brought up to date.

use std::collections::{BTreeMap, BTreeSet};

use super::record::{Entry, Id, Side};

/// The baseline with the figures of a later side. Directions and tolerances stay those of the baseline, and
/// so do scenarios of which the later side holds nothing.
#[must_use]
pub fn updated(baseline: &Side, later: &Side) -> Side {
    let kept: BTreeMap<&Id, &Entry> = baseline.entries.iter().map(|it| (&it.id, it)).collect();
    let scenarios = later.entries.iter().map(|it| it.id.scenario.as_str());
    let scenarios: BTreeSet<&str> = scenarios
        .chain(later.lacks.keys().map(|id| id.scenario.as_str()))
        .collect();
    let own = baseline.entries.iter();
    let own = own.filter(|entry| !scenarios.contains(entry.id.scenario.as_str()));
    let fresh = later.entries.iter().map(|entry| {
        let before = kept.get(&entry.id);
        Entry {
            better: before.map_or(entry.better, |it| it.better),
            absolute_tolerance: before.and_then(|it| it.absolute_tolerance),
            relative_tolerance: before.and_then(|it| it.relative_tolerance),
            ..entry.clone()
        }
    });
    let mut entries: Vec<Entry> = own.cloned().chain(fresh).collect();
    entries.sort_by(|one, other| one.id.cmp(&other.id));
    Side {
        tool_version: later.tool_version.clone(),
        entries,
        ..Side::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::Better;

    fn entry(scenario: &str, value: f64) -> Entry {
        Entry::of_test(scenario, "mean_deg_per_h", value)
    }

    #[test]
    fn figures_are_new_and_what_the_user_wrote_stays() {
        let own = Entry {
            better: Some(Better::Lower),
            absolute_tolerance: Some(0.5),
            ..entry("a", 1.0)
        };
        let baseline = Side {
            entries: vec![own.clone(), entry("kept", 4.0)],
            ..Side::default()
        };
        let later = Side {
            tool_version: "0.2.0".to_owned(),
            entries: vec![entry("b", 3.0), entry("a", 2.0)],
            ..Side::default()
        };
        let updated = updated(&baseline, &later);
        assert_eq!(updated.tool_version, "0.2.0");
        let fresh = Entry { value: 2.0, ..own };
        let want = [fresh, entry("b", 3.0), entry("kept", 4.0)];
        assert_eq!(updated.entries, want);
    }
}
