//! Tables over several scenarios, what a publication leaves open, and the shipped ones of the paper.

use std::collections::BTreeSet;
use std::path::Path;

use fogbench::comparison::{
    Cause, ComparedCell, ComparedColumn, ComparedRow, ComparedTable, Comparison,
};
use fogbench::metrics::{Estimate, Finding, Metric};
use fogbench::report::comparison_text;
use fogbench::scenario::{ComparisonColumn, ComparisonKind, Resolved, load_suite};
use serde_json::Value;

use crate::support::transcript::Transcript;
use crate::support::{assert_close, code, fogbench, repository, stderr, stdout, summary, write};

const BASE: &str = r#"
schema = 1
duration_s = 8.0
warm_up_s = 1.0
fidelity = "rate"

[[filter]]
name = "lms"
[filter.lms]
[[filter]]
name = "rls"
[filter.rls]

[[comparison]]
name = "Table 9"
title = "noise at rest"
columns = [
  "raw.noise_std_deg_per_h",
  "rls.noise_std_deg_per_h / lms",
  "rls.angle_random_walk_deg_per_sqrt_h / lms",
]
[[comparison]]
name = "By latitude"
title = "gain over latitude"
kind = "sensitivity"
columns = ["rls.dc_gain"]

[[comparison_row]]
comparison = "Table 9"
label = "first, cold"
scenarios = ["cold"]
[[comparison_row]]
comparison = "Table 9"
label = "hot"
scenarios = ["hot", "never"]
[[comparison_row]]
comparison = "By latitude"
label = "at"
scenarios = ["turned"]

[[assumption]]
key = "turntable.site.latitude_deg"
statement = "read so"
silence = "nobody says"
alternatives = "another"
comparison = "By latitude"

[[figure]]
name = "Fig. 1"
scenario = "cold"
file = "allan.svg"
shows = "deviations"
[[figure]]
name = "Fig. 2"
scenario = "cold"
file = "swing.svg"
shows = "what a record at rest does not have"
"#;

/// A folder with the base and three scenarios, one of them a sweep.
fn suite() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "base.toml", BASE);
    let published = |metric: &str, value: &str, unit: &str| {
        format!(
            "[[published]]\nmetric = \"{metric}\"\nvalue = {value}\nunit = \"{unit}\"\nsource = \"s\"\n"
        )
    };
    let noise = ["lms", "rls"].map(|channel| {
        let value = if channel == "rls" { "10.0" } else { "20.0" };
        published(&format!("{channel}.noise_std_deg_per_h"), value, "deg/h")
    });
    let scenario = |name: &str, rest: &str| {
        let text = format!("name = \"{name}\"\nextends = \"base.toml\"\n{rest}");
        write(folder.path(), &format!("{name}.toml"), &text);
    };
    scenario("cold", &noise.concat());
    scenario("hot", "[gyro.temperature.soak]\ntemperature_c = 60.0\n");
    scenario(
        "turned",
        "[matrix]\n\"turntable.site.latitude_deg\" = [0.0, 34.27]\n",
    );
    folder
}

fn suite_json(output: &Path) -> Value {
    let text = std::fs::read_to_string(output.join("summary.json")).expect("written");
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn a_table_holds_the_numbers_of_its_scenarios_beside_the_published_ones() {
    let folder = suite();
    let output = fogbench(folder.path(), &["run", "-v", "."]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let results = folder.path().join("output");
    let json = suite_json(&results);
    let table = &json["published_tables"][0];
    assert_eq!(table["name"], "Table 9");
    assert_eq!(table["rows"].as_array().map(Vec::len), Some(2));

    let cold = summary(&results, "cold");
    let noise = |channel: &str| {
        let value = &cold["channels"][channel]["noise_std_deg_per_h"]["value"];
        value.as_f64().expect("measured")
    };
    let cells = &table["rows"][0]["cells"];
    assert_eq!(cells[0]["value"].as_f64(), Some(noise("raw")));
    assert_eq!(cells[0]["published"], Value::Null);
    let ratio = cells[1]["value"].as_f64().expect("a ratio");
    assert_close(ratio, noise("rls") / noise("lms"), 1e-12, 0.0);
    assert_eq!(cells[1]["published"].as_f64(), Some(0.5));
    assert_eq!(table["lacking"][0], "hot: never not run");
    assert_eq!(table["rows"][1]["cells"][1]["published"], Value::Null);

    // The cause stands beside the ratio, from the same run.
    let causes = table["causes"].as_array().expect("causes");
    let walk = causes
        .iter()
        .find(|cause| cause["metric"] == "angle_random_walk_deg_per_sqrt_h")
        .expect("a cause for the angle random walk");
    let gain = cold["channels"]["rls"]["dc_gain"]["value"].as_f64();
    let unit = cold["channels"]["lms"]["dc_gain"]["value"].as_f64();
    let expected = gain.expect("measured") / unit.expect("measured");
    assert_close(
        walk["dc_gain_ratio"][0].as_f64().expect("a gain"),
        expected,
        1e-12,
        0.0,
    );

    let text = stdout(&output);
    assert!(text.contains("Table 9  noise at rest"), "{text}");
    assert!(text.contains("left out: hot: never not run"), "{text}");
    let csv = std::fs::read_to_string(results.join("published-table-9.csv")).expect("written");
    assert!(
        csv.contains("\"first, cold\",false,raw.noise_std_deg_per_h,deg/h,,"),
        "{csv}"
    );
    assert!(results.join("published-table-9.svg").is_file());
}

#[test]
fn a_sweep_shows_how_results_move_and_marks_the_point_that_stands_elsewhere() {
    let folder = suite();
    let output = fogbench(folder.path(), &["run", ".", "--format", "json"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let json: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    let rows = json["sensitivities"][0]["rows"].as_array().expect("rows");
    let shown: Vec<_> = rows
        .iter()
        .map(|row| (row["label"].as_str(), row["base"].as_bool()))
        .collect();
    let expected = [
        (Some("at 0.0"), Some(false)),
        (Some("at 34.27"), Some(true)),
    ];
    assert_eq!(shown, expected);
    let assumption = &json["assumptions"][0];
    assert_eq!(assumption["values"], serde_json::json!(["34.27"]));
    assert_eq!(assumption["table"], "By latitude");
    // Only what was drawn is named.
    assert_eq!(json["figures"].as_array().map(Vec::len), Some(1));
    assert_eq!(json["figures"][0]["file"], "cold/allan.svg");
}

#[test]
fn a_part_of_a_suite_leaves_out_what_did_not_run_and_no_earlier_table_stays() {
    let folder = suite();
    let all = fogbench(folder.path(), &["run", "."]);
    assert_eq!(code(&all), 0, "{}", stderr(&all));
    let output = fogbench(folder.path(), &["run", "hot.toml"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let results = folder.path().join("output");
    let json = suite_json(&results);
    assert!(json.get("sensitivities").is_none(), "{json}");
    assert!(json.get("figures").is_none(), "{json}");
    assert!(json["assumptions"][0].get("table").is_none(), "{json}");
    let files: BTreeSet<String> = std::fs::read_dir(&results)
        .expect("readable")
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .filter(|name| name.starts_with("published-") || name.starts_with("sensitivity-"))
        .collect();
    let expected = ["published-table-9.csv", "published-table-9.svg"].map(str::to_owned);
    assert_eq!(files, BTreeSet::from(expected));
    let text = stdout(&output);
    assert!(
        text.contains("left out: first, cold: cold not run; hot: never not run"),
        "{text}"
    );
}

#[test]
fn a_table_that_refers_to_nothing_is_refused() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let complaint = |change: (&str, &str)| {
        let text = BASE.replacen(change.0, change.1, 1);
        let text = format!("name = \"one\"\n{text}");
        write(folder.path(), "one.toml", &text);
        let output = fogbench(folder.path(), &["check", "one.toml"]);
        assert_eq!(code(&output), 2, "{change:?} was accepted");
        stderr(&output)
    };
    let mut transcript = Transcript::of("comparison", "Tables that refer to nothing");
    for change in [
        ("comparison = \"Table 9\"", "comparison = \"Table 8\""),
        ("\"rls.dc_gain\"", "\"dc_gain\""),
        ("\"rls.dc_gain\"", "\"rls.dc_gian\""),
        ("name = \"By latitude\"", "name = \"table-9\""),
        ("turntable.site.latitude_deg", "turntable.site.latitude"),
    ] {
        transcript.case(
            format!("{}, where {} stood", change.1, change.0),
            complaint(change),
        );
    }
    transcript.check();
}

#[test]
fn two_tables_of_one_name_in_a_suite_are_refused() {
    let folder = suite();
    let other = BASE.replacen("noise at rest", "something else", 1);
    write(
        folder.path(),
        "other.toml",
        &format!("name = \"other\"\n{other}"),
    );
    let output = fogbench(folder.path(), &["check", "."]);
    assert_eq!(code(&output), 2);
    let mut transcript = Transcript::of("comparison", "Two tables of one name in a suite");
    transcript.case("check .", stderr(&output));
    transcript.check();
}

/// A table of one row whose ratio stands at `low..high` of a gain of one half.
fn table(low: f64, high: f64) -> Comparison {
    let left = Estimate::with_interval(0.5 * (low + high), low, high);
    let metric = "angle_random_walk_deg_per_sqrt_h";
    let simulated = Metric::new(left.scaled(0.5), "1");
    let table = ComparedTable {
        name: "T".to_owned(),
        slug: "t".to_owned(),
        title: "title".to_owned(),
        kind: ComparisonKind::Published,
        columns: vec![ComparedColumn {
            channel: "a".to_owned(),
            metric: metric.to_owned(),
            relative_to: Some("b".to_owned()),
        }],
        rows: vec![ComparedRow {
            label: "row".to_owned(),
            is_base: false,
            at: None,
            cells: vec![Some(ComparedCell {
                folder: "f".to_owned(),
                simulated: simulated.clone(),
                published: Some((0.0029 / 0.006, "s".to_owned())),
            })],
        }],
        causes: vec![Cause {
            label: "row".to_owned(),
            folder: "f".to_owned(),
            channel: "a".to_owned(),
            relative_to: "b".to_owned(),
            metric: metric.to_owned(),
            ratio: simulated.estimate,
            remainder: Some(Finding::of_noise(left)),
            dc_gain: Some(Estimate::exact(0.5)),
            companions: Vec::new(),
        }],
        change: None,
        lacking: Vec::new(),
    };
    Comparison {
        tables: vec![table],
        ..Comparison::default()
    }
}

#[test]
fn the_cause_is_worded_by_the_interval_of_what_the_gain_leaves() {
    let mut transcript = Transcript::of("comparison", "Causes of a ratio in words");
    for (low, high) in [(0.99, 1.01), (0.7, 0.8), (1.2, 1.4), (0.8, 1.3)] {
        let text = comparison_text(&table(low, high), 1000, false);
        transcript.case(format!("what the gain leaves is {low} to {high}"), text);
    }
    transcript.check();
}

fn shipped() -> Vec<Resolved> {
    load_suite(&[repository("scenarios/paper")], &[]).expect("sound scenarios")
}

#[test]
fn the_shipped_tables_name_shipped_scenarios_and_channels() {
    let runs = shipped();
    let names: BTreeSet<&str> = runs.iter().map(|run| run.scenario.name.as_str()).collect();
    let paper = &runs.iter().find(|run| run.scenario.name == "static-25c");
    let paper = &paper.expect("a shipped scenario").scenario;
    assert!(!paper.comparison_rows.is_empty());
    let named = paper.comparison_rows.iter().flat_map(|row| &row.scenarios);
    let named = named.chain(paper.figures.iter().map(|figure| &figure.scenario));
    // The nonlinearity column takes the scale-factor scenarios where they are shipped.
    for name in named.filter(|name| !name.starts_with("scale-factor-")) {
        assert!(names.contains(name.as_str()), "{name} is not shipped");
    }
    let channels = paper.channel_names();
    for column in paper.comparisons.iter().flat_map(|one| &one.columns) {
        let parsed = ComparisonColumn::parse(column).expect("checked");
        for channel in std::iter::once(parsed.channel).chain(parsed.relative_to) {
            assert!(channels.iter().any(|name| name == channel), "{column}");
        }
    }
}

#[test]
fn every_figure_of_the_papers_table_2_stands_in_its_scenario() {
    let runs = shipped();
    let metrics = [
        "bias_stability_100s_deg_per_h",
        "angle_random_walk_deg_per_sqrt_h",
    ];
    for (name, lms, rls) in [
        ("static-m40c", [0.0614, 0.0065], [0.0324, 0.0031]),
        ("static-25c", [0.0603, 0.0060], [0.0298, 0.0029]),
        ("static-60c", [0.0616, 0.0064], [0.0315, 0.0030]),
    ] {
        let run = runs.iter().find(|run| run.scenario.name == name);
        let published = &run.expect("a shipped scenario").scenario.published;
        for (channel, values) in [("lms", lms), ("rls", rls)] {
            for (metric, value) in metrics.iter().zip(values) {
                let wanted = format!("{channel}.{metric}");
                let figure = published.iter().find(|figure| figure.metric == wanted);
                assert_eq!(
                    figure.map(|figure| figure.value),
                    Some(value),
                    "{name} {wanted}"
                );
            }
        }
    }
}

#[test]
fn every_shipped_sweep_of_an_assumption_holds_the_reading_of_the_others() {
    let runs = shipped();
    let sweeps: BTreeSet<&str> = runs
        .iter()
        .filter(|run| run.sweep.is_some())
        .map(|run| run.scenario.name.as_str())
        .collect();
    assert_eq!(sweeps.len(), 6, "{sweeps:?}");
    for name in sweeps {
        let points = runs.iter().filter(|run| run.scenario.name == name);
        let base = points.filter(|run| run.is_base_point).count();
        assert_eq!(base, 1, "{name}");
    }
}
