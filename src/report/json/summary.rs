//! `summary.json` of a run.

use crate::gate::{Verdict, judge_claim, simulated};
use crate::report::RunReport;
use crate::report::calibration::documents::calibration_json;
use crate::report::json::channel::channel;
use crate::report::json::compensation::compensation_json;
use crate::report::layout::json::{INTERVALS, SCHEMA, tool};
use crate::report::layout::json::{numbers, object, pretty, put};
use crate::report::record::sweep::{PointOfSweep, swept_value};
use crate::report::text::scale_factor::filter_state_word;
use crate::scenario::LogFacts;
use crate::scenario::{Fidelity, PublishedConfig, portable_place};
use crate::signal::GyroFacts;
use serde_json::{Map, Value};

/// The text of `<scenario>/summary.json`.
///
/// Keys stand in a fixed order: those of the record as documented, metrics, curves and reasons by
/// name, channels and gates as given.
#[must_use]
pub fn run_summary_json(report: &RunReport) -> String {
    let channels: Map<String, Value> = report
        .channels
        .iter()
        .map(|(name, metrics)| (name.clone(), channel(metrics)))
        .collect();
    let published = report.scenario.published.iter();
    let published = published
        .map(|figure| published_figure(report, figure))
        .collect();
    let gates = report.verdicts.iter();
    let gates = gates.map(|verdict| gate_of_run(report, verdict)).collect();
    let mut root = object([
        ("schema", SCHEMA.into()),
        ("tool", tool(report.tool_version)),
        ("scenario", scenario(report)),
        source(report),
        ("intervals", INTERVALS.into()),
        ("channels", channels.into()),
        ("published", Value::Array(published)),
        ("gates", Value::Array(gates)),
    ]);
    if let Some(sheet) = report.compensation {
        root.insert("compensation".to_owned(), compensation_json(sheet));
    }
    if let Some(sheet) = report.calibration {
        root.insert("calibration".to_owned(), calibration_json(sheet));
    }
    if report.assumed.count > 0 {
        root.insert("assumed".to_owned(), assumed(report));
    }
    if !report.notes.is_empty() {
        root.insert("notes".to_owned(), report.notes.to_vec().into());
    }
    pretty(&root.into())
}

/// Where the words come from.
fn source(report: &RunReport) -> (&'static str, Value) {
    match (report.gyro, report.log) {
        (Some(facts), _) => ("gyro", gyro(facts)),
        (None, Some(facts)) => ("log", log(facts)),
        (None, None) => ("gyro", Value::Null),
    }
}

/// A recorded log.
fn log(facts: &LogFacts) -> Value {
    let mut record = object([
        ("file", facts.file.as_str().into()),
        ("unit", facts.unit.as_str().into()),
    ]);
    if let Some(column) = &facts.column {
        record.insert("column".to_owned(), column.as_str().into());
    }
    put(&mut record, "rate_hz", facts.sample_rate_hz);
    record.insert("samples".to_owned(), facts.samples.into());
    record.into()
}

fn scenario(report: &RunReport) -> Value {
    let scenario = report.scenario;
    let fidelity = match scenario.fidelity {
        Fidelity::Loop => "loop",
        Fidelity::Rate => "rate",
    };
    let mut record = object([
        ("name", scenario.name.as_str().into()),
        ("file", report.file.into()),
        ("digest", report.digest.into()),
        ("seed", scenario.seed.into()),
        ("repeats", scenario.repeats.into()),
    ]);
    if report.log.is_none() {
        record.insert("fidelity".to_owned(), fidelity.into());
    }
    put(&mut record, "duration_s", scenario.duration_s);
    put(&mut record, "warm_up_s", scenario.warm_up_s);
    if let Some(stairs) = scenario.turntable.motion.stairs() {
        let state = filter_state_word(scenario.trial.filter_state);
        record.insert("filter_state".to_owned(), state.into());
        put(&mut record, "settle_s", stairs.settle_s);
    }
    if let Some(description) = &scenario.description {
        record.insert("description".to_owned(), description.as_str().into());
    }
    if let Some(sweep) = &report.sweep {
        record.insert("sweep".to_owned(), point_json(sweep));
    }
    record.into()
}

/// The point in JSON: `index`, and `point` with the keys.
pub(super) fn point_json((index, assignments): &PointOfSweep) -> Value {
    let point = assignments.iter();
    let point = point.map(|(key, value)| (key.clone(), swept_value(value)));
    let point: Map<String, Value> = point.collect();
    object([("index", (*index).into()), ("point", point.into())]).into()
}

fn gyro(facts: &GyroFacts) -> Value {
    let mut budget = Map::new();
    for (source, value) in &facts.angle_random_walk_budget_deg_per_sqrt_h {
        put(&mut budget, source, *value);
    }
    let mut record = numbers([
        ("scale_factor_s", facts.scale_factor_s),
        ("transit_time_us", facts.transit_time_us),
        ("proper_frequency_khz", facts.proper_frequency_khz),
        ("output_rate_hz", facts.output_rate_hz),
        ("loop_gain", facts.loop_gain),
        ("loop_bandwidth_hz", facts.loop_bandwidth_hz),
        ("delay_ms", facts.delay_ms),
    ]);
    record.insert(
        "angle_random_walk_budget_deg_per_sqrt_h".to_owned(),
        budget.into(),
    );
    if !facts.replaced_noise_sources.is_empty() {
        record.insert(
            "replaced_noise_sources".to_owned(),
            facts.replaced_noise_sources.clone().into(),
        );
    }
    record.into()
}

/// What nobody set: the keys that shape the figures, and how many there are in all.
fn assumed(report: &RunReport) -> Value {
    let named = report.assumed.named.iter().map(|assumed| {
        object([
            ("key", assumed.key.as_str().into()),
            ("value", swept_value(&assumed.value)),
            ("unit", assumed.unit.into()),
        ])
    });
    let named = named.map(Value::from).collect();
    object([
        ("count", report.assumed.count.into()),
        ("shaping", Value::Array(named)),
    ])
    .into()
}

fn published_figure(report: &RunReport, figure: &PublishedConfig) -> Value {
    let mut record = object([("metric", figure.metric.as_str().into())]);
    put(&mut record, "value", figure.value);
    record.extend(object([
        ("unit", figure.unit.as_str().into()),
        ("source", figure.source.as_str().into()),
    ]));
    if let Some(reference) = &figure.relative_to {
        record.insert("relative_to".to_owned(), reference.as_str().into());
    }
    if let Some(verdict) = judge_claim(figure, report.channels) {
        if let Some(metric) = simulated(figure, report.channels) {
            put(&mut record, "simulated", metric.estimate.value);
            put(&mut record, "low", metric.estimate.low);
            put(&mut record, "high", metric.estimate.high);
        }
        record.extend(object([
            ("verdict", verdict.kind.as_str().into()),
            ("reason", verdict.reason.as_str().into()),
        ]));
    }
    record.into()
}

/// A gate with its verdict, and the key that nobody set and that its metric says again.
fn gate_of_run(report: &RunReport, verdict: &Verdict) -> Value {
    let mut record = gate(verdict);
    if let Some(key) = report.assumption_behind(verdict.metric_name()) {
        record.insert("says_again".to_owned(), key.into());
    }
    record.into()
}

/// A gate with its verdict.
pub(in crate::report) fn gate(verdict: &Verdict) -> Map<String, Value> {
    let mut record = object([
        ("metric", verdict.metric.as_str().into()),
        ("verdict", verdict.kind.as_str().into()),
        ("accepted", verdict.accepted.into()),
    ]);
    let numbers = [
        ("value", verdict.value),
        ("low", verdict.low),
        ("high", verdict.high),
        ("min", verdict.min),
        ("max", verdict.max),
    ];
    for (key, value) in numbers {
        put(&mut record, key, value);
    }
    let words = [
        ("unit", Some(verdict.unit.as_str())),
        ("relative_to", verdict.relative_to.as_deref()),
        ("reason", Some(verdict.reason.as_str())),
        ("location", verdict.location.as_deref().map(portable_place)),
    ];
    for (key, value) in words {
        if let Some(value) = value.filter(|value| !value.is_empty()) {
            record.insert(key.to_owned(), value.into());
        }
    }
    record
}
