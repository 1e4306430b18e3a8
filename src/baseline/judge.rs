//! The rule: what a difference is called.

use std::collections::BTreeMap;

use super::difference::{Chance, Pairs, ends, paired, unpaired};
use super::holm::{FAMILY_ERROR, HEADLINE_WEIGHT, OTHER_WEIGHT, corrected};
use super::record::{Entry, Id, Interval, Point, Side};
use crate::metrics::{Better, MetricKey, find};

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

    /// The sentence of the command line.
    #[must_use]
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Same => "Nothing that speaks for a difference",
            Self::Better => "A change for the better",
            Self::New => "A figure that was not there before",
            Self::ChangedScenario => "A scenario that differs",
            Self::Unsure => "What does not decide",
            Self::Changed => "A change where neither direction is better",
            Self::Removed => "A figure that is gone",
            Self::Worse => "A change for the worse",
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
    /// So many blocks of the samples of the same seed, pair by pair.
    Blocks(usize),
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
            Self::Pairs(count) => format!("{count} pairs of repeats"),
            Self::Blocks(count) => format!("{count} pairs of blocks"),
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

/// A comparison with the outcomes that fail.
#[derive(Clone, Copy, Debug)]
pub struct Judged<'a> {
    /// Every figure.
    pub comparison: &'a Comparison,
    /// What fails.
    pub fail_on: &'a [Outcome],
}

impl<'a> Judged<'a> {
    /// The figures that fail.
    pub fn failed(self) -> impl Iterator<Item = &'a Row> {
        let rows = self.comparison.rows.iter();
        rows.filter(move |row| self.fail_on.contains(&row.outcome))
    }

    /// Whether a figure fails.
    #[must_use]
    pub fn has_failed(self) -> bool {
        self.failed().next().is_some()
    }
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

    /// The same with the outcomes that fail.
    #[must_use]
    pub fn judged<'a>(&'a self, fail_on: &'a [Outcome]) -> Judged<'a> {
        Judged {
            comparison: self,
            fail_on,
        }
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
    let runs = facts_of_runs(&old_entries, &new_entries);
    let mut drafts: Vec<Draft> = Vec::new();
    for (id, earlier) in old_entries {
        drafts.push(match new_entries.remove(&id) {
            Some(later) => pair(earlier, later, &runs[&run_of(&id)]),
            None if runs[&run_of(&id)].is_changed => Draft::decided(Row {
                old: Some(earlier),
                outcome: Outcome::ChangedScenario,
                ..Row::open(id)
            }),
            None => Draft::decided(gone(earlier, new)),
        });
    }
    for (id, later) in new_entries {
        let is_changed = runs.get(&run_of(&id)).is_some_and(|run| run.is_changed);
        let row = Row {
            new: Some(later),
            outcome: if is_changed {
                Outcome::ChangedScenario
            } else {
                Outcome::New
            },
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

/// What is known of a run as a whole.
#[derive(Default)]
struct RunFacts {
    /// Whether its noise is the same on both sides: of one seed, and a noisy figure of the gyro itself is
    /// the same to the bit.
    is_same_noise: bool,
    /// Whether its conditions differ.
    is_changed: bool,
    /// Metrics that it has, by which its motion is known.
    metrics: Vec<&'static MetricKey>,
}

impl RunFacts {
    /// Share of the error that a metric may spend.
    fn weight(&self, key: Option<&MetricKey>) -> f64 {
        match key {
            Some(key) if key.is_headline_of(&self.metrics) => HEADLINE_WEIGHT,
            _ => OTHER_WEIGHT,
        }
    }
}

fn run_of(id: &Id) -> (String, Point) {
    (id.scenario.clone(), id.point.clone())
}

fn facts_of_runs(
    old: &BTreeMap<Id, Entry>,
    new: &BTreeMap<Id, Entry>,
) -> BTreeMap<(String, Point), RunFacts> {
    let mut runs: BTreeMap<(String, Point), RunFacts> = BTreeMap::new();
    for (id, earlier) in old {
        let facts = runs.entry(run_of(id)).or_default();
        let is_raw = id.channel == "raw" || id.channel.ends_with("_raw");
        let is_noisy = matches!(earlier.interval, Interval::Confidence { low, high } if low < high);
        let later = new.get(id);
        let is_shared = later.is_some_and(|later| is_identical(earlier, later));
        facts.is_changed |= later.is_some_and(|later| later.conditions != earlier.conditions);
        facts.is_same_noise |= is_raw && is_noisy && is_shared;
        facts.metrics.extend(find(&id.metric));
    }
    runs
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

/// What two figures are judged with.
struct Terms {
    key: Option<&'static MetricKey>,
    better: Better,
    /// Difference that counts for none.
    tolerance: f64,
    /// Whether a file gives it.
    has_tolerance: bool,
}

impl Terms {
    fn of(old: &Entry, new: &Entry) -> Self {
        let key = find(&old.id.metric);
        let declared = || key.map_or(Better::Neither, |key| key.better);
        let absolute = old.absolute_tolerance.or(new.absolute_tolerance);
        let relative = old.relative_tolerance.or(new.relative_tolerance);
        let least = relative.unwrap_or(0.0).max(ROUNDING) * old.value.abs();
        Self {
            key,
            better: old.better.or(new.better).unwrap_or_else(declared),
            tolerance: absolute.unwrap_or(0.0).max(least),
            has_tolerance: absolute.is_some() || relative.is_some(),
        }
    }
}

/// What two figures say by themselves.
struct Finding {
    outcome: Outcome,
    basis: Basis,
    reason: &'static str,
    /// The test that the correction is to decide; the outcome is then what holds if it finds nothing.
    test: Option<Test>,
}

impl Finding {
    fn new(outcome: Outcome, basis: Basis) -> Self {
        Self {
            outcome,
            basis,
            reason: "",
            test: None,
        }
    }

    fn because(outcome: Outcome, reason: &'static str) -> Self {
        Self {
            reason,
            ..Self::new(outcome, Basis::None)
        }
    }
}

/// Judges two figures as far as they can be judged by themselves.
fn pair(old: Entry, new: Entry, run: &RunFacts) -> Draft {
    let (finding, difference) = judge(&old, &new, run);
    let row = Row {
        difference: Some(difference),
        outcome: finding.outcome,
        basis: finding.basis,
        reason: finding.reason.to_owned(),
        ..Row::open(old.id.clone())
    };
    Draft {
        row: Row {
            old: Some(old),
            new: Some(new),
            ..row
        },
        test: finding.test,
    }
}

/// What two figures say by themselves, and how far they differ.
fn judge(old: &Entry, new: &Entry, run: &RunFacts) -> (Finding, f64) {
    let difference = new.value - old.value;
    if old.conditions != new.conditions {
        let finding = Finding::new(Outcome::ChangedScenario, Basis::None);
        return (finding, difference);
    }
    if old.unit != new.unit {
        let finding = Finding::because(Outcome::Changed, "the units differ");
        return (finding, difference);
    }
    if is_identical(old, new) {
        return (Finding::new(Outcome::Same, Basis::Identical), difference);
    }
    let terms = Terms::of(old, new);
    let is_exact = old.interval == Interval::Exact && new.interval == Interval::Exact;
    if is_exact || ends(old).is_none() || ends(new).is_none() {
        return (by_tolerance(old, new, is_exact, &terms), difference);
    }
    let test = |chance: Chance| Test {
        chance,
        better: terms.better,
        weight: run.weight(terms.key),
    };
    if let Some((pairs, mean, chance)) = paired(old, new, terms.tolerance) {
        let basis = match pairs {
            Pairs::Repeats(count) => Basis::Pairs(count),
            Pairs::Blocks(count) => Basis::Blocks(count),
        };
        let finding = Finding {
            test: Some(test(chance)),
            ..Finding::new(Outcome::Same, basis)
        };
        return (finding, mean);
    }
    if run.is_same_noise {
        let outcome = beyond_own_interval(old, new, terms.tolerance, terms.better);
        return (Finding::new(outcome, Basis::SameNoise), difference);
    }
    let finding = Finding {
        test: unpaired(old, new, terms.tolerance).map(test),
        ..Finding::new(Outcome::Same, Basis::Unpaired)
    };
    (finding, difference)
}

/// Of figures of which one has no interval.
fn by_tolerance(old: &Entry, new: &Entry, is_exact: bool, terms: &Terms) -> Finding {
    let difference = new.value - old.value;
    let is_of_settings = terms.key.is_some_and(|key| key.is_of_settings);
    let may_judge = is_exact && (old.seed == new.seed || is_of_settings);
    if difference.abs() <= terms.tolerance {
        Finding::new(Outcome::Same, Basis::Tolerance)
    } else if terms.has_tolerance || may_judge {
        let outcome = Outcome::of_difference(difference, terms.better);
        Finding::new(outcome, Basis::Tolerance)
    } else if is_exact {
        Finding::because(
            Outcome::Unsure,
            "a fact of one record, and the seeds differ",
        )
    } else {
        Finding::because(Outcome::Unsure, "one record does not tell how sure it is")
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::baseline::record::Lack;

    const ARW: &str = "angle_random_walk_deg_per_sqrt_h";

    fn entry(metric: &str, value: f64, half_width: f64) -> Entry {
        Entry {
            interval: Interval::Confidence {
                low: value - half_width,
                high: value + half_width,
            },
            ..exact(metric, value)
        }
    }

    fn exact(metric: &str, value: f64) -> Entry {
        Entry::of_test("s", metric, value)
    }

    fn side(entries: &[Entry]) -> Side {
        Side {
            entries: entries.to_vec(),
            ..Side::default()
        }
    }

    fn only(old: Entry, new: Entry) -> Row {
        let comparison = compare(&side(&[old]), &side(&[new]));
        assert_eq!(comparison.rows.len(), 1);
        comparison.rows[0].clone()
    }

    fn reseeded(entry: Entry) -> Entry {
        Entry { seed: 2, ..entry }
    }

    #[test]
    fn a_noisy_figure_is_worse_beyond_its_noise_in_the_worse_direction() {
        let judged = |metric: &str, value: f64| {
            only(entry(metric, 1.0, 0.1), reseeded(entry(metric, value, 0.1))).outcome
        };
        assert_eq!(judged(ARW, 1.3), Outcome::Worse);
        assert_eq!(judged(ARW, 0.7), Outcome::Better);
        assert_eq!(judged(ARW, 1.05), Outcome::Same);
        assert_eq!(judged("bandwidth_hz", 1.3), Outcome::Better);
        assert_eq!(judged("bandwidth_hz", 0.7), Outcome::Worse);
        assert_eq!(judged("mean_deg_per_h", 1.3), Outcome::Changed);
        assert_eq!(judged("mean_deg_per_h", 0.7), Outcome::Changed);
    }

    #[test]
    fn a_difference_that_one_test_would_find_and_many_do_not_is_left_open() {
        // 2.8 standard errors: p of 0.0026 on one side, of 0.05 in twenty.
        let shift = 2.8 * 0.1 * 2.0_f64.sqrt() / 1.96;
        let many = |shift: f64| {
            let named = |index: usize, value: f64| {
                let mut entry = entry(ARW, value, 0.1);
                entry.id.scenario = format!("s{index:02}");
                entry
            };
            let old: Vec<Entry> = (0..30).map(|index| named(index, 1.0)).collect();
            let mut new: Vec<Entry> = (0..30).map(|index| reseeded(named(index, 1.001))).collect();
            new[0] = reseeded(named(0, 1.0 + shift));
            compare(&side(&old), &side(&new)).rows[0].outcome
        };
        assert_eq!(many(shift), Outcome::Unsure);
        assert_eq!(many(5.0 / 2.8 * shift), Outcome::Worse);
        let alone = only(entry(ARW, 1.0, 0.1), reseeded(entry(ARW, 1.0 + shift, 0.1)));
        assert_eq!(alone.outcome, Outcome::Worse);
    }

    #[test]
    fn exact_figures_are_judged_by_tolerance() {
        let latency = |value: f64| exact("latency_us", value);
        assert_eq!(only(latency(1.0), latency(1.1)).outcome, Outcome::Worse);
        assert_eq!(
            only(latency(1.0), reseeded(latency(1.1))).outcome,
            Outcome::Worse
        );
        assert_eq!(
            only(latency(1.0), latency(1.0 + 1e-12)).outcome,
            Outcome::Same
        );
        // A fact of one record says nothing of another seed.
        let largest = |value: f64| exact("maximum_deg_per_h", value);
        assert_eq!(
            only(largest(1.0), reseeded(largest(1.1))).outcome,
            Outcome::Unsure
        );
        assert_eq!(only(largest(1.0), largest(1.1)).outcome, Outcome::Changed);
        let tolerant = |entry: Entry| Entry {
            absolute_tolerance: Some(0.2),
            ..entry
        };
        assert_eq!(
            only(tolerant(latency(1.0)), latency(1.1)).outcome,
            Outcome::Same
        );
        assert_eq!(
            only(tolerant(latency(1.0)), latency(1.3)).outcome,
            Outcome::Worse
        );
    }

    #[test]
    fn a_tolerance_and_a_direction_of_the_file_count() {
        let old = Entry {
            relative_tolerance: Some(0.5),
            ..entry(ARW, 1.0, 0.01)
        };
        assert_eq!(
            only(old.clone(), reseeded(entry(ARW, 1.4, 0.01))).outcome,
            Outcome::Same
        );
        assert_eq!(
            only(old, reseeded(entry(ARW, 1.6, 0.01))).outcome,
            Outcome::Worse
        );
        let turned = Entry {
            better: Some(Better::Higher),
            ..entry(ARW, 1.0, 0.01)
        };
        assert_eq!(
            only(turned, reseeded(entry(ARW, 1.6, 0.01))).outcome,
            Outcome::Better
        );
    }

    #[test]
    fn repeats_of_the_same_seed_are_compared_pair_by_pair() {
        let repeated = |shift: f64| Entry {
            // They scatter by far more than they differ.
            repeats: [3.0, -2.0, 5.0, 0.5, -4.0, 1.0]
                .iter()
                .zip([0.01, -0.01, 0.02, 0.0, -0.02, 0.0])
                .map(|(noise, own)| 10.0 + noise + shift + own * shift)
                .collect(),
            ..entry(ARW, 10.0 + shift, 4.0)
        };
        let row = only(repeated(0.0), repeated(0.5));
        assert_eq!((row.outcome, row.basis), (Outcome::Worse, Basis::Pairs(6)));
        assert!((row.difference.unwrap() - 0.5).abs() < 1e-12);
        // The same of another seed share no noise, and four are too few.
        let row = only(repeated(0.0), reseeded(repeated(0.5)));
        assert_eq!((row.outcome, row.basis), (Outcome::Same, Basis::Unpaired));
        let four = |entry: Entry| Entry {
            repeats: entry.repeats[..4].to_vec(),
            ..entry
        };
        let row = only(four(repeated(0.0)), four(repeated(0.5)));
        assert_eq!(row.basis, Basis::Unpaired);
        let blocks = |entry: Entry| Entry {
            blocks: entry.repeats.clone(),
            repeats: Vec::new(),
            ..entry
        };
        let row = only(blocks(repeated(0.0)), blocks(repeated(0.5)));
        assert_eq!((row.outcome, row.basis), (Outcome::Worse, Basis::Blocks(6)));
    }

    #[test]
    fn where_the_noise_is_the_same_a_figure_is_judged_by_its_own_interval() {
        let mean = entry("mean_deg_per_h", 8.0, 0.5);
        let judged = |value: f64| {
            let (old, new) = (entry(ARW, 1.0, 0.1), entry(ARW, value, 0.1));
            let comparison = compare(&side(&[mean.clone(), old]), &side(&[mean.clone(), new]));
            let row = comparison.rows.iter().find(|row| row.id.metric == ARW);
            let row = row.unwrap();
            (row.outcome, row.basis)
        };
        assert_eq!(judged(1.11), (Outcome::Worse, Basis::SameNoise));
        assert_eq!(judged(0.89), (Outcome::Better, Basis::SameNoise));
        assert_eq!(judged(1.07), (Outcome::Unsure, Basis::SameNoise));
        assert_eq!(judged(1.02), (Outcome::Same, Basis::SameNoise));
        assert_eq!(judged(1.0), (Outcome::Same, Basis::Identical));
    }

    #[test]
    fn other_conditions_are_not_judged_and_what_is_gone_or_new_is_named() {
        let other = Entry {
            conditions: "d".to_owned(),
            ..entry(ARW, 9.0, 0.1)
        };
        assert_eq!(
            only(entry(ARW, 1.0, 0.1), other).outcome,
            Outcome::ChangedScenario
        );
        let (one, two) = (entry(ARW, 1.0, 0.1), entry("mean_deg_per_h", 1.0, 0.1));
        let outcome = |old: &Side, new: &Side, place: usize| compare(old, new).rows[place].outcome;
        let (both, one) = (side(&[one.clone(), two.clone()]), side(&[one]));
        assert_eq!(outcome(&both, &one, 1), Outcome::Removed);
        assert_eq!(outcome(&one, &both, 1), Outcome::New);
        let lacking = |is_failure| {
            let lack = Lack {
                reason: "too short".to_owned(),
                is_failure,
            };
            Side {
                lacks: [(two.id.clone(), lack)].into(),
                ..one.clone()
            }
        };
        assert_eq!(outcome(&both, &lacking(false), 1), Outcome::Unsure);
        assert_eq!(outcome(&both, &lacking(true), 1), Outcome::Removed);
    }

    #[test]
    fn points_match_by_their_values_whatever_their_order() {
        let at = |power: &str, value: f64| {
            let mut entry = entry(ARW, value, 0.01);
            entry.id.point = crate::baseline::point_of([("gyro.source.power_uw", power)]);
            entry
        };
        let old = side(&[at("0.5", 1.0), at("1.0", 2.0)]);
        let new = side(&[at("2.0", 9.0), at("1.0", 2.0), at("0.50", 1.0)]);
        let comparison = compare(&old, &new);
        let outcomes: Vec<Outcome> = comparison.rows.iter().map(|row| row.outcome).collect();
        assert_eq!(outcomes, [Outcome::Same, Outcome::Same, Outcome::New]);
    }

    #[test]
    fn standard_deviations_of_few_values_are_compared_by_their_degrees_of_freedom() {
        let few = |value: f64| Entry {
            degrees_of_freedom: Some(4.0),
            ..entry("bias_stability_10s_deg_per_h", value, 0.01)
        };
        // The interval alone, which is made far too narrow here, would find it.
        let row = only(few(1.0), reseeded(few(2.0)));
        // P(F(4, 4) > 4) = 0.104.
        assert_eq!(row.outcome, Outcome::Same);
        assert!(
            (row.p_value.unwrap() - 0.104).abs() < 1e-3,
            "{:?}",
            row.p_value
        );
        assert_eq!(only(few(1.0), reseeded(few(4.0))).outcome, Outcome::Worse);
    }
}
