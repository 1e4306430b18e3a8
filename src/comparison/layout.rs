//! Tables over several scenarios: what they ask of each run, and how they are put together.

use std::collections::{BTreeMap, BTreeSet};

use super::beside::{Standing, beside, stands};
use super::change_per_unit::{self, change_per_unit};
use super::table::{
    Assumed, Cause, ComparedCell, ComparedColumn, ComparedRow, ComparedTable, Comparison,
    DrawnFigure,
};
use crate::gate::quotient;
use crate::metrics::catalogue::{
    AMPLITUDE_RATIO, ANGLE_RANDOM_WALK_OVER_DC_GAIN, DC_GAIN, MEAN_RATIO, NOISE_GAIN,
    WEIGHT_NOISE_RATIO,
};
use crate::metrics::{Estimate, Finding, Metric, MetricKey, find, known_metrics, paired_ratio};
use crate::scenario::{
    AssumptionConfig, ComparisonColumn, ComparisonConfig, ComparisonKind, ComparisonRowConfig,
    FigureConfig, Resolved, Scenario, ScenarioError, slug,
};

/// Metrics that bear on the cause of a lower noise, beside those of the columns.
static COMPANIONS: [&MetricKey; 5] = [
    &MEAN_RATIO,
    &ANGLE_RANDOM_WALK_OVER_DC_GAIN,
    &WEIGHT_NOISE_RATIO,
    &AMPLITUDE_RATIO,
    &NOISE_GAIN,
];

/// The tables, assumptions and figures that the scenarios of a suite carry, each once.
#[derive(Debug, Default)]
pub(crate) struct Layout<'a> {
    pub(crate) comparisons: Vec<&'a ComparisonConfig>,
    rows: Vec<&'a ComparisonRowConfig>,
    assumptions: Vec<&'a AssumptionConfig>,
    figures: Vec<&'a FigureConfig>,
    metrics: BTreeSet<&'a str>,
    scenarios: BTreeSet<&'a str>,
    /// Every metric, and the scenarios whose filters stand side by side, of which all are kept.
    all: BTreeSet<&'a str>,
    beside: BTreeSet<&'a str>,
}

impl<'a> Layout<'a> {
    /// Gathers what the scenarios of a suite carry.
    pub(crate) fn of(suite: &[&'a Resolved]) -> Self {
        let mut layout = Self::default();
        for resolved in suite {
            let scenario = &resolved.scenario;
            add(&mut layout.comparisons, &scenario.comparisons);
            add(&mut layout.rows, &scenario.comparison_rows);
            if reproduces(scenario) {
                add(&mut layout.assumptions, &scenario.assumptions);
            }
            add(&mut layout.figures, &scenario.figures);
        }
        let columns = layout.comparisons.iter().flat_map(|one| &one.columns);
        let columns = columns.filter_map(|column| ComparisonColumn::parse(column));
        layout.metrics = columns.map(|column| column.metric).collect();
        if !layout.metrics.is_empty() {
            layout.metrics.extend(COMPANIONS.map(|key| key.name));
            layout.metrics.insert(DC_GAIN.name);
        }
        let named = layout.rows.iter().flat_map(|row| &row.scenarios);
        layout.scenarios = named.map(String::as_str).collect();
        layout.all = known_metrics().iter().map(|key| key.name).collect();
        let scenarios = suite.iter().map(|resolved| &resolved.scenario);
        let standing = scenarios.filter(|scenario| stands(scenario));
        layout.beside = standing.map(|scenario| scenario.name.as_str()).collect();
        layout
    }

    /// The metrics that a table or the page of the filters may ask of a scenario; empty where none does.
    pub(crate) fn metrics_of(&self, scenario: &str) -> &BTreeSet<&'a str> {
        static NONE: BTreeSet<&str> = BTreeSet::new();
        if self.beside.contains(scenario) {
            &self.all
        } else if self.scenarios.contains(scenario) {
            &self.metrics
        } else {
            &NONE
        }
    }

    /// The tables of a suite that has run.
    pub(crate) fn fill(&self, suite: &[ComparedRun]) -> Comparison {
        let tables: Vec<ComparedTable> = self
            .comparisons
            .iter()
            .map(|comparison| self.table(comparison, suite))
            .filter(|table| !table.rows.is_empty())
            .collect();
        let assumptions = self.assumptions.iter();
        let readings = self.reproducing(suite);
        let figures = self.figures.iter();
        let standing = suite.iter().map(|run| Standing {
            scenario: &run.resolved.scenario,
            folder: run.folder,
            kept: run.kept,
        });
        let standing: Vec<Standing> = standing.collect();
        Comparison {
            assumptions: assumptions
                .filter_map(|one| assumed(one, &readings, &tables))
                .collect(),
            figures: figures.filter_map(|figure| drawn(figure, suite)).collect(),
            beside: beside(&standing),
            tables,
        }
    }

    /// The runs that stand beside published figures, whose values are the readings of what the
    /// publication leaves open; all runs if none does.
    fn reproducing<'b>(&self, suite: &'b [ComparedRun<'b>]) -> Vec<&'b ComparedRun<'b>> {
        let is_published = |row: &&&ComparisonRowConfig| {
            let mut tables = self.comparisons.iter();
            tables.any(|table| {
                table.name == row.comparison && table.kind == ComparisonKind::Published
            })
        };
        let rows = self.rows.iter().filter(is_published);
        let named: BTreeSet<&String> = rows.flat_map(|row| &row.scenarios).collect();
        let stands = |run: &&ComparedRun| named.contains(&run.resolved.scenario.name);
        let found: Vec<&ComparedRun> = suite.iter().filter(stands).collect();
        if found.is_empty() {
            suite.iter().collect()
        } else {
            found
        }
    }

    fn table(&self, comparison: &ComparisonConfig, suite: &[ComparedRun]) -> ComparedTable {
        let columns: Vec<ComparedColumn> = comparison
            .columns
            .iter()
            .filter_map(|text| ComparisonColumn::parse(text))
            .map(|column| ComparedColumn {
                channel: column.channel.to_owned(),
                metric: column.metric.to_owned(),
                relative_to: column.relative_to.map(str::to_owned),
            })
            .collect();
        let mut table = ComparedTable {
            name: comparison.name.clone(),
            slug: slug(&comparison.name),
            title: comparison.title.clone(),
            kind: comparison.kind,
            columns,
            rows: Vec::new(),
            causes: Vec::new(),
            change: None,
            lacking: Vec::new(),
        };
        let own = self
            .rows
            .iter()
            .filter(|row| row.comparison == comparison.name);
        for row in own {
            enter(&mut table, row, comparison.per_change_of.as_deref(), suite);
        }
        if let (Some(key), Some(run)) = (&comparison.per_change_of, suite.first()) {
            table.change = change_per_unit(&table, key, run.resolved.unit_of(key));
        }
        if table.kind == ComparisonKind::Published {
            for row in &table.rows {
                table.causes.extend(causes(row, &table.columns, suite));
            }
        }
        table
    }
}

/// Adds what is not there yet.
fn add<'a, T: PartialEq>(all: &mut Vec<&'a T>, more: &'a [T]) {
    for one in more {
        if !all.contains(&one) {
            all.push(one);
        }
    }
}

/// Complaints about tables of a suite that share a file name and are not the same.
pub(crate) fn contradictions(suite: &[&Resolved]) -> Vec<ScenarioError> {
    let mut first: BTreeMap<String, (&Resolved, &ComparisonConfig)> = BTreeMap::new();
    let mut errors = Vec::new();
    for resolved in suite {
        for (index, comparison) in resolved.scenario.comparisons.iter().enumerate() {
            let earlier = first.entry(slug(&comparison.name));
            let (other, known) = *earlier.or_insert((resolved, comparison));
            if known != comparison {
                let key = format!("comparison[{index}].name");
                let message = format!(
                    "{key} = \"{}\" stands for another table in {}: give each table of a suite a \
                     name of its own",
                    comparison.name,
                    other.shown_file()
                );
                errors.push(ScenarioError::at(resolved.locate(&key), message));
            }
        }
    }
    let layout = Layout::of(suite);
    let changes = change_per_unit::contradictions(&layout.comparisons, &layout.rows, suite);
    errors.extend(changes);
    errors
}

/// A run of the suite, as tables see it.
#[derive(Clone, Debug)]
pub(crate) struct ComparedRun<'a> {
    /// Its scenario.
    pub(crate) resolved: &'a Resolved,
    /// Folder below the output folder.
    pub(crate) folder: &'a str,
    /// Metrics that the layout asks for, by channel and key.
    pub(crate) kept: &'a [(String, BTreeMap<String, Metric>)],
    /// Pictures in its folder.
    pub(crate) pictures: &'a [String],
}

impl ComparedRun<'_> {
    fn metric(&self, channel: &str, key: &str) -> Option<&Metric> {
        let mut kept = self.kept.iter();
        let (_, metrics) = kept.find(|(name, _)| name == channel)?;
        metrics.get(key)
    }

    fn point(&self) -> &[(String, String)] {
        let sweep = &self.resolved.sweep;
        sweep.as_ref().map_or(&[], |point| &point.assignments)
    }

    /// The published figure for a metric, with its source.
    fn published(&self, channel: &str, key: &str) -> Option<(f64, String)> {
        let wanted = format!("{channel}.{key}");
        let mut figures = self.resolved.scenario.published.iter();
        let figure =
            figures.find(|figure| figure.metric == wanted && figure.relative_to.is_none())?;
        Some((figure.value, figure.source.clone()))
    }

    fn cell(&self, column: &ComparedColumn) -> Option<ComparedCell> {
        let own = self.metric(&column.channel, &column.metric)?;
        let published = self.published(&column.channel, &column.metric);
        let (simulated, published) = match &column.relative_to {
            None => (own.clone(), published),
            Some(other) => {
                let below = self.metric(other, &column.metric)?;
                let paired = paired_ratio(own, below);
                let estimate = paired.or_else(|| quotient(&own.estimate, &below.estimate))?;
                let fields = own.fields.clone();
                let unit = "1";
                let figures = published.zip(self.published(other, &column.metric));
                let published = figures
                    .filter(|(_, (below, _))| *below != 0.0)
                    .map(|((own, source), (below, _))| (own / below, source));
                (
                    Metric {
                        estimate,
                        unit,
                        fields,
                    },
                    published,
                )
            }
        };
        Some(ComparedCell {
            folder: self.folder.to_owned(),
            simulated,
            published,
        })
    }
}

/// The runs of one scenario.
fn runs_of<'s, 'a>(
    suite: &'s [ComparedRun<'a>],
    name: &'s str,
) -> impl Iterator<Item = &'s ComparedRun<'a>> {
    suite
        .iter()
        .filter(move |run| run.resolved.scenario.name == name)
}

/// Enters a row, or a row for each point of a sweep, and what it lacks.
fn enter(
    table: &mut ComparedTable,
    row: &ComparisonRowConfig,
    key: Option<&str>,
    suite: &[ComparedRun],
) {
    let absent = row.scenarios.iter().map(String::as_str);
    let absent: Vec<&str> = absent
        .filter(|name| runs_of(suite, name).next().is_none())
        .collect();
    if !absent.is_empty() {
        let lack = format!("{}: {} not run", row.label, absent.join(", "));
        table.lacking.push(lack);
    }
    let mut points: Vec<&[(String, String)]> = Vec::new();
    for name in &row.scenarios {
        for run in runs_of(suite, name) {
            if !points.contains(&run.point()) {
                points.push(run.point());
            }
        }
    }
    for point in points {
        let runs: Vec<&ComparedRun> = row
            .scenarios
            .iter()
            .flat_map(|name| runs_of(suite, name))
            .filter(|run| run.point() == point)
            .collect();
        let cells: Vec<_> = table
            .columns
            .iter()
            .map(|column| runs.iter().find_map(|run| run.cell(column)))
            .collect();
        if cells.iter().all(Option::is_none) {
            continue;
        }
        let values = point.iter().map(|(_, value)| value.trim_matches('"'));
        let label: Vec<&str> = std::iter::once(row.label.as_str()).chain(values).collect();
        table.rows.push(ComparedRow {
            label: label.join(" "),
            is_base: runs.iter().any(|run| run.resolved.is_base_point),
            at: key.and_then(|key| runs.first()?.resolved.number_of(key)),
            cells,
        });
    }
}

/// Why slow noise is lower in one channel than in another: a finding for each ratio of a row; for a
/// ratio of delays what the channel does to noise under the motion.
fn causes(row: &ComparedRow, columns: &[ComparedColumn], suite: &[ComparedRun]) -> Vec<Cause> {
    let found = columns.iter().zip(&row.cells).filter_map(|(column, cell)| {
        let (cell, other) = (cell.as_ref()?, column.relative_to.as_ref()?);
        let mut runs = suite.iter();
        let run = runs.find(|run| run.folder == cell.folder)?;
        let gain = |channel: &str| {
            run.metric(channel, DC_GAIN.name)
                .map(|metric| metric.estimate)
        };
        let dc_gain = gain(&column.channel)
            .zip(gain(other))
            .and_then(|(own, other)| quotient(&own, &other));
        let is_slow = find(&column.metric).is_some_and(|key| key.is_slow_noise);
        let left = |gain: Estimate| quotient(&cell.simulated.estimate, &gain);
        let remainder = dc_gain.filter(|_| is_slow).and_then(left);
        let companions = COMPANIONS.iter().filter_map(|key| {
            let metric = run.metric(&column.channel, key.name)?;
            Some((key.name.to_owned(), metric.clone()))
        });
        Some(Cause {
            label: row.label.clone(),
            folder: cell.folder.clone(),
            channel: column.channel.clone(),
            relative_to: other.clone(),
            metric: column.metric.clone(),
            ratio: cell.simulated.estimate,
            remainder: remainder.map(Finding::of_noise),
            dc_gain,
            companions: companions.collect(),
        })
    });
    found.collect()
}

/// Whether a scenario has to do with the publication whose open readings it carries: it has published
/// figures or is one of its tables or figures. One that only builds on the same base carries tables and figures
/// of others alone.
fn reproduces(scenario: &Scenario) -> bool {
    let rows = scenario.comparison_rows.iter();
    let of_rows = rows.flat_map(|row| &row.scenarios);
    let of_figures = scenario.figures.iter().map(|figure| &figure.scenario);
    let mut named = of_rows.chain(of_figures).peekable();
    !scenario.published.is_empty()
        || named.peek().is_none()
        || named.any(|name| *name == scenario.name)
}

/// An assumption with the values that the runs have; none if no run has the key.
fn assumed(
    one: &AssumptionConfig,
    suite: &[&ComparedRun],
    tables: &[ComparedTable],
) -> Option<Assumed> {
    let mut values: Vec<String> = Vec::new();
    for run in suite {
        let resolved = run.resolved;
        let carries = resolved.scenario.assumptions.contains(one);
        if !carries || (resolved.sweep.is_some() && !resolved.is_base_point) {
            continue;
        }
        values.extend(resolved.value_of(&one.key));
    }
    values.sort();
    values.dedup();
    if values.is_empty() {
        return None;
    }
    let differs = |value: &&String| {
        one.reading
            .as_ref()
            .is_some_and(|reading| reading != *value)
    };
    let table = one.comparison.clone();
    Some(Assumed {
        key: one.key.clone(),
        otherwise: values.iter().filter(differs).cloned().collect(),
        values,
        statement: one.statement.clone(),
        silence: one.silence.clone(),
        alternatives: one.alternatives.clone(),
        table: table.filter(|name| tables.iter().any(|table| table.name == *name)),
    })
}

fn drawn(figure: &FigureConfig, suite: &[ComparedRun]) -> Option<DrawnFigure> {
    let mut named = runs_of(suite, &figure.scenario);
    let run = named.find(|run| run.pictures.contains(&figure.file))?;
    Some(DrawnFigure {
        name: figure.name.clone(),
        file: format!("{}/{}", run.folder, figure.file),
        shows: figure.shows.clone(),
    })
}
