//! The rule: what a difference is called.

use std::collections::{BTreeMap, BTreeSet};

use super::difference::{Chance, ends, paired, unpaired};
use super::holm::{FAMILY_ERROR, HEADLINE_WEIGHT, OTHER_WEIGHT, corrected};
use super::record::{Entry, Id, Interval, Point, Side};
use crate::metrics::{Better, find};

/// Part of the earlier value that differs where the same formula is computed on another machine.
const ROUNDING: f64 = 1e-9;

/// Probability below which a difference that the correction does not let pass is left open.
const DOUBT: f64 = 0.01;

/// What a difference is called, the worst last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Outcome {
    /// Nothing speaks for a difference.
    Same,
    /// It changed for the better.
    Better,
    /// It was not there before.
    New,
    /// The scenarios differ: no judgement.
    ChangedScenario,
    /// What there is does not decide.
    Unsure,
    /// It changed, and neither direction is better.
    Changed,
    /// It is gone.
    Removed,
    /// It changed for the worse.
    Worse,
}

impl Outcome {
    /// Every outcome, the worst first.
    pub const ALL: [Self; 8] = [
        Self::Worse,
        Self::Removed,
        Self::Changed,
        Self::Unsure,
        Self::ChangedScenario,
        Self::New,
        Self::Better,
        Self::Same,
    ];

    /// The word in files and on the command line.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Same => "same",
            Self::Better => "better",
            Self::New => "new",
            Self::ChangedScenario => "changed-scenario",
            Self::Unsure => "unsure",
            Self::Changed => "changed",
            Self::Removed => "removed",
            Self::Worse => "worse",
        }
    }

    /// What a real difference is.
    fn of_difference(difference: f64, better: Better) -> Self {
        match (better, difference > 0.0) {
            (Better::Neither, _) => Self::Changed,
            (Better::Lower, true) | (Better::Higher, false) => Self::Worse,
            (Better::Lower, false) | (Better::Higher, true) => Self::Better,
        }
    }
}

/// What a difference is judged by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Basis {
    /// The two sides are the same to the bit.
    Identical,
    /// A tolerance, for want of noise.
    Tolerance,
    /// So many repeats of the same seed, pair by pair.
    Pairs(usize),
    /// The figure's own interval: the run's noise is the same on both sides.
    SameNoise,
    /// Two intervals as independent.
    Unpaired,
    /// Nothing: there is no judgement.
    None,
}

impl Basis {
    /// The same in words.
    #[must_use]
    pub fn words(self) -> String {
        match self {
            Self::Identical => "identical".to_owned(),
            Self::Tolerance => "by tolerance".to_owned(),
            Self::Pairs(count) => format!("{count} pairs"),
            Self::SameNoise => "same noise".to_owned(),
            Self::Unpaired => "unpaired".to_owned(),
            Self::None => "not judged".to_owned(),
        }
    }
}

/// One figure, judged.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Row {
    /// Which it is.
    pub id: Id,
    /// The earlier figure.
    pub old: Option<Entry>,
    /// The later figure.
    pub new: Option<Entry>,
    /// Later minus earlier value: the mean over pairs where these are compared.
    pub difference: Option<f64>,
    /// What the difference is called.
    pub outcome: Outcome,
    /// What it is judged by.
    pub basis: Basis,
    /// P-value, corrected for the number of tests of the call; of a test alone.
    pub p_value: Option<f64>,
    /// Why there is no judgement, or another than the figures suggest; empty where nothing is to be said.
    pub reason: String,
}

/// Two sides, compared.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Comparison {
    /// Version of the tool that made the earlier side.
    pub old_version: String,
    /// Version of the tool that made the later side.
    pub new_version: String,
    /// Every figure of either side, in order.
    pub rows: Vec<Row>,
}

impl Comparison {
    /// Number of figures with an outcome.
    #[must_use]
    pub fn count(&self, outcome: Outcome) -> usize {
        self.rows
            .iter()
            .filter(|row| row.outcome == outcome)
            .count()
    }

    /// Whether an outcome of the list is among the rows.
    #[must_use]
    pub fn has_any(&self, outcomes: &[Outcome]) -> bool {
        self.rows.iter().any(|row| outcomes.contains(&row.outcome))
    }
}

/// Two figures of the same conditions, as far as each can be judged by itself.
struct Draft {
    row: Row,
    /// The test that the correction is to decide.
    test: Option<Test>,
}

struct Test {
    chance: Chance,
    better: Better,
    weight: f64,
}

/// Compares two sides figure by figure.
#[must_use]
pub fn compare(old: &Side, new: &Side) -> Comparison {
    let by_id = |side: &'_ Side| -> BTreeMap<Id, Entry> {
        let entries = side.entries.iter();
        entries
            .map(|entry| (entry.id.clone(), entry.clone()))
            .collect()
    };
    let (old_entries, mut new_entries) = (by_id(old), by_id(new));
    let same_noise = runs_of_same_noise(&old_entries, &new_entries);
    let mut drafts: Vec<Draft> = Vec::new();
    for (id, earlier) in old_entries {
        drafts.push(match new_entries.remove(&id) {
            Some(later) => {
                let is_same_noise = same_noise.contains(&(id.scenario.clone(), id.point.clone()));
                pair(earlier, later, is_same_noise)
            }
            None => Draft::decided(gone(earlier, new)),
        });
    }
    for (id, later) in new_entries {
        let row = Row {
            new: Some(later),
            outcome: Outcome::New,
            ..Row::open(id)
        };
        drafts.push(Draft::decided(row));
    }
    decide(&mut drafts);
    let mut rows: Vec<Row> = drafts.into_iter().map(|draft| draft.row).collect();
    rows.sort_by(|one, other| one.id.cmp(&other.id));
    Comparison {
        old_version: old.tool_version.clone(),
        new_version: new.tool_version.clone(),
        rows,
    }
}

/// Runs whose noise is the same on both sides: of one seed, and a noisy figure of the gyro itself is the
/// same to the bit.
fn runs_of_same_noise(
    old: &BTreeMap<Id, Entry>,
    new: &BTreeMap<Id, Entry>,
) -> BTreeSet<(String, Point)> {
    let is_shared = |(id, earlier): &(&Id, &Entry)| {
        let is_raw = id.channel == "raw" || id.channel.ends_with("_raw");
        let is_noisy = matches!(earlier.interval, Interval::Confidence { low, high } if low < high);
        let later = new.get(id);
        is_raw && is_noisy && later.is_some_and(|later| is_identical(earlier, later))
    };
    let shared = old.iter().filter(is_shared);
    shared
        .map(|(id, _)| (id.scenario.clone(), id.point.clone()))
        .collect()
}

fn is_identical(old: &Entry, new: &Entry) -> bool {
    old.seed == new.seed && old.value.to_bits() == new.value.to_bits()
}

impl Row {
    /// A row that is not judged yet.
    fn open(id: Id) -> Self {
        Self {
            id,
            old: None,
            new: None,
            difference: None,
            outcome: Outcome::Unsure,
            basis: Basis::None,
            p_value: None,
            reason: String::new(),
        }
    }
}

impl Draft {
    fn decided(row: Row) -> Self {
        Self { row, test: None }
    }
}

/// A figure that the later side lacks.
fn gone(earlier: Entry, new: &Side) -> Row {
    let lack = new.lack_of(&earlier.id);
    let is_by_choice = find(&earlier.id.metric).is_some_and(|key| key.is_by_choice());
    let (outcome, reason) = match lack {
        Some(lack) if lack.is_failure => (Outcome::Removed, lack.reason.clone()),
        Some(lack) => (Outcome::Unsure, format!("unavailable: {}", lack.reason)),
        None if is_by_choice && new.has_channel(&earlier.id) => {
            (Outcome::Unsure, "the record does not ask for it".to_owned())
        }
        None => (Outcome::Removed, String::new()),
    };
    Row {
        outcome,
        reason,
        old: Some(earlier.clone()),
        ..Row::open(earlier.id)
    }
}

/// Judges two figures as far as they can be judged by themselves.
fn pair(old: Entry, new: Entry, is_same_noise: bool) -> Draft {
    let key = find(&old.id.metric);
    let better = old.better.or(new.better);
    let better = better.unwrap_or_else(|| key.map_or(Better::Neither, |key| key.better));
    let absolute = old.absolute_tolerance.or(new.absolute_tolerance);
    let relative = old.relative_tolerance.or(new.relative_tolerance);
    let has_tolerance = absolute.is_some() || relative.is_some();
    let tolerance = absolute
        .unwrap_or(0.0)
        .max(relative.unwrap_or(0.0).max(ROUNDING) * old.value.abs());
    let difference = new.value - old.value;
    let row = Row {
        difference: Some(difference),
        ..Row::open(old.id.clone())
    };
    let decided = |outcome, basis, reason: &str, old: Entry, new: Entry| {
        Draft::decided(Row {
            outcome,
            basis,
            reason: reason.to_owned(),
            old: Some(old),
            new: Some(new),
            ..row.clone()
        })
    };
    if old.conditions != new.conditions {
        return decided(Outcome::ChangedScenario, Basis::None, "", old, new);
    }
    if old.unit != new.unit {
        return decided(Outcome::Changed, Basis::None, "the units differ", old, new);
    }
    if is_identical(&old, &new) {
        return decided(Outcome::Same, Basis::Identical, "", old, new);
    }
    let is_exact = old.interval == Interval::Exact && new.interval == Interval::Exact;
    let lacks_interval = ends(&old).is_none() || ends(&new).is_none();
    if is_exact || lacks_interval {
        let is_of_settings = key.is_some_and(|key| key.is_of_settings);
        let may_judge = has_tolerance || (is_exact && (old.seed == new.seed || is_of_settings));
        return if difference.abs() <= tolerance {
            decided(Outcome::Same, Basis::Tolerance, "", old, new)
        } else if may_judge {
            let outcome = Outcome::of_difference(difference, better);
            decided(outcome, Basis::Tolerance, "", old, new)
        } else if is_exact {
            let reason = "a fact of one record, and the seeds differ";
            decided(Outcome::Unsure, Basis::None, reason, old, new)
        } else {
            let reason = "one record does not tell how sure it is";
            decided(Outcome::Unsure, Basis::None, reason, old, new)
        };
    }
    let weight = match key {
        Some(key) if key.is_headline() => HEADLINE_WEIGHT,
        _ => OTHER_WEIGHT,
    };
    if let Some((mean, chance)) = paired(&old, &new, tolerance) {
        let draft = decided(Outcome::Same, Basis::Pairs(old.repeats.len()), "", old, new);
        return Draft {
            row: Row {
                difference: Some(mean),
                ..draft.row
            },
            test: Some(Test {
                chance,
                better,
                weight,
            }),
        };
    }
    if is_same_noise {
        let outcome = beyond_own_interval(&old, &new, tolerance, better);
        return decided(outcome, Basis::SameNoise, "", old, new);
    }
    let test = unpaired(&old, &new, tolerance).map(|chance| Test {
        chance,
        better,
        weight,
    });
    Draft {
        test,
        ..decided(Outcome::Same, Basis::Unpaired, "", old, new)
    }
}

/// Of figures of the same noise: unchanged code gives the same to the bit, so that a difference is real, and
/// matters where it leaves the interval of the earlier figure. Within, less than half of it is none.
fn beyond_own_interval(old: &Entry, new: &Entry, tolerance: f64, better: Better) -> Outcome {
    let Some((low, high)) = ends(old) else {
        return Outcome::Unsure;
    };
    let difference = new.value - old.value;
    let reach = if difference > 0.0 {
        high - old.value
    } else {
        old.value - low
    };
    let size = difference.abs() - tolerance;
    if size > reach {
        Outcome::of_difference(difference, better)
    } else if size > 0.5 * reach {
        Outcome::Unsure
    } else {
        Outcome::Same
    }
}

/// Corrects the tests for their number and names what they find. Changes for the worse, for the better and
/// in metrics of which neither direction is better are three families: each raises a false alarm in at most
/// one of twenty calls.
fn decide(drafts: &mut [Draft]) {
    type Family = (Outcome, fn(&Test) -> Option<f64>);
    let families: [Family; 3] = [
        (Outcome::Better, |test| match test.better {
            Better::Lower => Some(test.chance.fall),
            Better::Higher => Some(test.chance.rise),
            Better::Neither => None,
        }),
        (Outcome::Changed, |test| {
            (test.better == Better::Neither).then(|| test.chance.either())
        }),
        (Outcome::Worse, |test| match test.better {
            Better::Lower => Some(test.chance.rise),
            Better::Higher => Some(test.chance.fall),
            Better::Neither => None,
        }),
    ];
    for (outcome, p_value) in families {
        let of_family = |draft: &Draft| {
            let test = draft.test.as_ref()?;
            Some((p_value(test)?, test.weight))
        };
        let tests: Vec<(f64, f64)> = drafts.iter().filter_map(of_family).collect();
        let mut corrected = corrected(&tests).into_iter();
        for draft in drafts.iter_mut().filter(|draft| of_family(draft).is_some()) {
            let p_value = corrected.next().unwrap_or(1.0);
            let least = draft.row.p_value.unwrap_or(1.0);
            draft.row.p_value = Some(least.min(p_value));
            let is_doubtful = draft
                .test
                .as_ref()
                .is_some_and(|it| it.chance.either() < DOUBT);
            if p_value < FAMILY_ERROR {
                draft.row.outcome = outcome;
            } else if is_doubtful && draft.row.outcome == Outcome::Same {
                draft.row.outcome = Outcome::Unsure;
            }
        }
    }
}
