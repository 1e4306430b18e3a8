//! `metrics.csv` and what goes with it: every number of a suite in one table, of one type a column.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Output;

use serde_json::Value;

use crate::support::{code, fogbench, stderr, stdout, write};

const SHORT: &str = "schema = 1\nduration_s = 1.0\nwarm_up_s = 0.5\nfidelity = \"rate\"\n";
const HEAD: &str = "scenario,point,channel,metric,value,low,high,confidence,unit,status";

/// A sweep over a number and a word, a run with repeats, and one with a filter that diverges.
fn suite(folder: &Path) {
    let sweep = "[[filter]]\nname = \"lms\"\n[filter.lms]\n[matrix]\n\
                 \"gyro.source.power_uw\" = [0.5, 0.87]\n\"turntable.site.latitude_deg\" = [0.0]\n";
    write(
        folder,
        "s/sweep.toml",
        &format!("name = \"sweep\"\n{SHORT}{sweep}"),
    );
    let words = "[matrix]\nfidelity = [\"loop\"]\n";
    let short = "schema = 1\nduration_s = 0.2\nwarm_up_s = 0.1\n";
    write(
        folder,
        "s/words.toml",
        &format!("name = \"words\"\n{short}{words}"),
    );
    let diverging = "[[filter]]\nname = \"wrong\"\n[filter.rls]\nupdate_sign = \"as-printed\"\n";
    write(
        folder,
        "s/wrong.toml",
        &format!("name = \"wrong\"\nrepeats = 3\n{SHORT}{diverging}").replace("= 1.0", "= 2.0"),
    );
}

fn ran(folder: &Path, more: &[&str]) -> Output {
    fogbench(folder, &[&["run", "s", "-o", "out"], more].concat())
}

fn text(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join("out").join(name)).expect("written")
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("JSON")
}

/// Rows of a table without quotes, each by the names of its columns.
fn rows(csv: &str) -> Vec<BTreeMap<&str, &str>> {
    let mut lines = csv.lines();
    let head: Vec<&str> = lines.next().expect("a head").split(',').collect();
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            assert_eq!(cells.len(), head.len(), "{line}");
            head.iter().copied().zip(cells).collect()
        })
        .collect()
}

#[test]
fn every_metric_of_every_run_is_one_row() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    suite(at);
    let output = ran(at, &[]);
    assert_eq!(code(&output), 3, "{}", stderr(&output));
    let csv = text(at, "metrics.csv");
    let keys = "gyro.source.power_uw,turntable.site.latitude_deg,fidelity";
    assert_eq!(
        csv.lines().next().expect("a head"),
        format!("{HEAD},{keys}")
    );
    let all = rows(&csv);
    let mut count = 0;
    for (name, point, power) in [
        ("sweep", "0", "0.5"),
        ("sweep", "1", "0.87"),
        ("words", "0", ""),
        ("wrong", "", ""),
    ] {
        let of_run = |row: &&BTreeMap<&str, &str>| row["scenario"] == name && row["point"] == point;
        let own: Vec<_> = all.iter().filter(of_run).collect();
        count += own.len();
        let run = match point {
            "" => name.to_owned(),
            index => format!("{name}/000{index}"),
        };
        let summary = json(&text(at, &format!("{run}/summary.json")));
        for (channel, record) in summary["channels"].as_object().expect("channels") {
            let rows: Vec<_> = own
                .iter()
                .filter(|row| row["channel"] == *channel)
                .collect();
            let measured = record["metrics"].as_object().expect("metrics");
            let ok = rows.iter().filter(|row| row["status"] == "ok").count();
            assert_eq!(ok, measured.len(), "{run} {channel}");
            for row in rows {
                let metric = row["metric"];
                assert_eq!(row["gyro.source.power_uw"], power);
                let expected_word = if name == "words" { "loop" } else { "" };
                assert_eq!(row["fidelity"], expected_word);
                match row["status"] {
                    "ok" => {
                        let value: f64 = row["value"].parse().expect("a number");
                        let expected = measured[metric]["value"].as_f64().expect("a number");
                        assert_eq!(value.to_bits(), expected.to_bits(), "{run} {metric}");
                        assert_eq!(row["unit"], measured[metric]["unit"]);
                        // The old place of the metrics holds the same.
                        assert_eq!(record[metric], measured[metric]);
                    }
                    "unavailable" => {
                        assert!(record["unavailable"][metric].is_string(), "{metric}");
                        assert_eq!(row["value"], "");
                    }
                    "failed" => assert_eq!((name, channel.as_str()), ("wrong", "wrong")),
                    other => panic!("{other}"),
                }
            }
        }
    }
    assert_eq!(all.len(), count);
    assert!(all.iter().any(|row| row["status"] == "failed"));
}

#[test]
fn the_summary_of_a_suite_holds_the_metrics_and_typed_values_of_the_sweep() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    suite(at);
    let output = ran(at, &["--format", "json"]);
    assert_eq!(stdout(&output), text(at, "summary.json"));
    let summary = json(&stdout(&output));
    let runs = summary["runs"].as_array().expect("runs");
    assert_eq!(runs.len(), 4);
    for run in runs {
        let folder = run["folder"].as_str().expect("a text");
        let own = json(&text(at, &format!("{folder}/summary.json")));
        let point = &run["sweep"]["point"];
        assert_eq!(point, &own["scenario"]["sweep"]["point"]);
        match run["name"].as_str() {
            Some("sweep") => assert!(point["gyro.source.power_uw"].is_f64(), "{point}"),
            Some("words") => assert_eq!(point["fidelity"], "loop"),
            _ => assert!(run.get("sweep").is_none()),
        }
        for (channel, record) in own["channels"].as_object().expect("channels") {
            let metrics = run["channels"][channel]["metrics"].as_object();
            let metrics = metrics.expect("metrics");
            let expected = record["metrics"].as_object().expect("metrics");
            assert!(metrics.keys().eq(expected.keys()), "{folder} {channel}");
            for (key, metric) in metrics {
                for part in ["value", "unit"] {
                    assert_eq!(
                        metric[part], expected[key][part],
                        "{folder} {channel} {key}"
                    );
                }
                if expected[key].get("interval").is_none() {
                    assert_eq!(metric["low"], expected[key]["low"]);
                }
            }
            assert!(record["metrics"].get("curves").is_none());
        }
    }
}

#[test]
fn every_metric_of_every_repeat_stands_in_a_column() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    suite(at);
    ran(at, &[]);
    let summary = json(&text(at, "wrong/summary.json"));
    let raw = &summary["channels"]["raw"];
    let csv = text(at, "wrong/runs.csv");
    let rows = rows(&csv);
    for (key, metric) in raw["metrics"].as_object().expect("metrics") {
        // What is defined over the repeats alone has no value of one.
        if metric["repeats"].is_null() {
            continue;
        }
        let repeats = &raw["repeats"][key];
        let values = repeats["values"].as_array().expect("values");
        assert_eq!(values.len(), 3, "{key}");
        for (row, value) in rows.iter().zip(values) {
            assert_eq!(row["channel"], "raw");
            let cell: f64 = row[key.as_str()].parse().expect("a number");
            assert_eq!(Some(cell), value.as_f64(), "{key}");
        }
        let mut sorted: Vec<f64> = values.iter().filter_map(Value::as_f64).collect();
        sorted.sort_by(f64::total_cmp);
        assert_eq!(repeats["percentile_50"].as_f64(), Some(sorted[1]), "{key}");
        // 5 % of the way through two steps.
        let low = sorted[0] + 0.1 * (sorted[1] - sorted[0]);
        let found = repeats["percentile_5"].as_f64().expect("a number");
        assert!(
            (found - low).abs() <= 1e-9 * low.abs(),
            "{key}: {found} {low}"
        );
    }
}

#[test]
fn a_file_of_the_users_is_not_taken_for_the_suites() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    write(at, "s/a.toml", &format!("name = \"a\"\n{SHORT}"));
    for name in fogbench::report::suite_files() {
        write(at, &format!("out/{name}"), "mine");
        let refused = ran(at, &[]);
        assert_eq!(code(&refused), 2, "{name}: {}", stderr(&refused));
        assert!(stderr(&refused).contains(name), "{}", stderr(&refused));
        assert_eq!(text(at, name), "mine");
        fs::remove_file(at.join("out").join(name)).expect("removable");
    }
    assert_eq!(code(&ran(at, &[])), 0);
}
