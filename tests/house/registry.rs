//! Each row of a registry keeps what a row promises: one loop over each, without a list of its own.
//!
//! Filter kinds, motions and keys are read from the JSON Schema, noise sources from the budget, so that
//! a new one is tested without an edit, or asks for the one line that it needs.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::Value;

use crate::scenario::campaign::schema::{Child, Kind, Table, leaves, root};
use crate::scenario::extremes::shortest;
use crate::support::{code, fogbench, kinds_of_the_bench, npy, stderr, stdout, summary, write};

/// The alternatives of a table of the root.
fn alternatives(table: &str, among: &str) -> Vec<String> {
    let root = root();
    let found = root.children.iter().find(|(name, _)| name == table);
    let (Child::Table(table) | Child::Tables(table)) = &found.expect("the table").1 else {
        panic!("{table} is a key");
    };
    let Table { choices, .. } = table;
    let group = choices
        .iter()
        .find(|choice| choice.names.iter().any(|name| name == among));
    group.expect("the group").names.clone()
}

/// Runs a scenario that must pass, and gives what it prints.
#[track_caller]
fn run(folder: &Path, text: &str) -> String {
    write(folder, "s.toml", text);
    let output = fogbench(folder, &["run", "s.toml", "-o", "out"]);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    stdout(&output)
}

#[test]
fn every_filter_kind_filters_the_words_and_is_measured_and_judged() {
    let kinds = kinds_of_the_bench();
    let filters: String = kinds
        .iter()
        .map(|kind| format!("[[filter]]\nname = \"{kind}\"\n[filter.{kind}]\n"))
        .collect();
    let folder = tempfile::tempdir().expect("a scratch folder");
    let head = "name = \"s\"\nduration_s = 4.0\nwarm_up_s = 2.0\nfidelity = \"rate\"\n";
    let samples = "[output]\nsamples = \"npy\"\n";
    let printed = run(folder.path(), &format!("{head}{samples}{filters}"));
    let out = folder.path().join("out");
    let result = summary(&out, "s");
    let words = |name: &str| npy(&out.join(format!("s/samples/{name}.npy")));
    let raw = words("raw");
    assert!(kinds.len() >= 9, "{kinds:?}");
    for kind in &kinds {
        let channel = &result["channels"][*kind];
        assert!(channel["error"].is_null(), "{kind}: {channel}");
        let noise_gain = channel["noise_gain"]["value"].as_f64();
        assert!(
            noise_gain.is_some_and(|gain| gain > 0.0 && gain < 1.0),
            "{kind} passes {noise_gain:?} of white noise"
        );
        assert!(channel["dc_gain"]["value"].is_number(), "{kind}");
        assert!(channel["verdict"].is_string(), "{kind} is not judged");
        assert!(printed.contains(kind), "{kind} is not printed");
        let filtered = words(kind);
        assert_eq!(filtered.len(), raw.len(), "{kind}");
        assert!(filtered.iter().all(|word| word.is_finite()), "{kind}");
        assert!(filtered != raw, "{kind} is without effect");
    }
}

#[test]
fn every_motion_turns_the_table_and_is_measured() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    for motion in alternatives("turntable", "static") {
        // A script is found by its points here; its file has tests of its own.
        let key = match motion.as_str() {
            "script" => "turntable.script.points.".to_owned(),
            motion => format!("turntable.{motion}."),
        };
        let text = shortest(&key);
        assert!(
            motion == "static" || text.contains(&format!("[turntable.{motion}")),
            "{motion} has no shortest scenario in tests/scenario/extremes.rs"
        );
        // Keys of a base may be without effect, which here those of the other motions are.
        write(folder.path(), "bases/s.toml", &text);
        let own = "name = \"s\"\nextends = \"bases/s.toml\"\n[output]\nsamples = \"npy\"\n";
        run(folder.path(), own);
        let out = folder.path().join("out");
        let result = summary(&out, "s");
        let channels = result["channels"].as_object().expect("channels");
        let metrics = |channel: &Value| channel.as_object().map_or(0, serde_json::Map::len);
        assert!(
            channels.values().any(|channel| metrics(channel) > 3),
            "{motion}"
        );
        let mut fastest: f64 = 0.0;
        for entry in std::fs::read_dir(out.join("s/samples"))
            .expect("samples")
            .flatten()
        {
            if entry.file_name().to_string_lossy().contains("truth") {
                let rates = npy(&entry.path());
                fastest = rates
                    .iter()
                    .fold(fastest, |most, rate| most.max(rate.abs()));
            }
        }
        // The Earth turns by 15 deg/h.
        assert_eq!(
            fastest > 16.0,
            motion != "static",
            "{motion}: {fastest} deg/h"
        );
    }
}

/// The assignments that switch a noise source on, from the keys below `gyro.noise`.
fn switch(source: &str, is_on: bool) -> Option<String> {
    leaves(&root()).iter().find_map(|(path, leaf)| {
        let name = path.strip_prefix("gyro.noise.")?;
        let value = match leaf.kind {
            Kind::Boolean if name == source => is_on.to_string(),
            Kind::Number(_) if name.starts_with(source) => {
                if is_on { "10.0" } else { "0.0" }.to_owned()
            }
            _ => return None,
        };
        Some(format!("{path}={value}"))
    })
}

/// Arguments of a short run in which the named sources are on and all others off.
fn sets(sources: &[String], on: &[&str], more: &[&str]) -> Vec<String> {
    let mut sets: Vec<String> = sources
        .iter()
        .filter_map(|source| switch(source, on.contains(&source.as_str())))
        .collect();
    let bits = if on.contains(&"adc") { 12 } else { 0 };
    sets.push(format!("gyro.adc.bits={bits}"));
    sets.extend(more.iter().map(|&set| set.to_owned()));
    sets.into_iter()
        .flat_map(|set| ["--set".to_owned(), set])
        .collect()
}

#[test]
fn every_noise_source_stands_in_the_budget_and_moves_the_words_of_both_models() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = "name = \"s\"\nduration_s = 0.05\nwarm_up_s = 0.05\nbias_averaging_time_s = 0.01\n\
                [output]\nsamples = \"npy\"\n";
    write(folder.path(), "s.toml", text);
    let ask = |command: &[&str], sets: &[String]| {
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        let output = fogbench(folder.path(), &[command, &sets].concat());
        assert_eq!(code(&output), 0, "{sets:?}: {}", stderr(&output));
        stdout(&output)
    };
    let budget = |sets: &[String]| -> BTreeMap<String, f64> {
        let text = ask(&["budget", "s.toml", "--format", "json"], sets);
        let report: Value = serde_json::from_str(&text).expect("JSON");
        let rows = report["sources"].as_object().expect("sources").clone();
        rows.into_iter()
            .map(|(name, row)| {
                let walk = row["angle_random_walk_deg_per_sqrt_h"].as_f64();
                (name, walk.expect("a number"))
            })
            .collect()
    };
    let sources: Vec<String> = budget(&[])
        .into_keys()
        .filter(|name| name != "total" && name != "rate_word")
        .collect();
    assert!(sources.len() >= 6, "{sources:?}");
    let words = |on: &[&str], fidelity: &str, draw: &str| {
        let mut more = vec![format!("fidelity={fidelity}")];
        if draw != "combined" {
            more.push(format!("gyro.noise.draw={draw}"));
        }
        let more: Vec<&str> = more.iter().map(String::as_str).collect();
        let sets = sets(&sources, on, &more);
        ask(&["run", "s.toml", "-o", "out"], &sets);
        npy(&folder.path().join("out/s/samples/raw.npy"))
    };
    for source in &sources {
        // Rounding is a source where another noise dithers it.
        let beside: &[&str] = if source == "adc" { &["thermal"] } else { &[] };
        let with: Vec<&str> = [beside, &[source.as_str()]].concat();
        let without = budget(&sets(&sources, beside, &[]));
        let found = budget(&sets(&sources, &with, &[]));
        assert!(
            found[source] > 0.0 && without[source] == 0.0,
            "{source}: {found:?}"
        );
        // The words round to their step as soon as they move.
        let detection =
            |budget: &BTreeMap<String, f64>| budget["total"].powi(2) - budget["rate_word"].powi(2);
        let squares = detection(&found) - detection(&without);
        crate::support::assert_close(squares, found[source].powi(2), 1e-9, 0.0);
        for (fidelity, draw) in [
            ("rate", "combined"),
            ("loop", "combined"),
            ("loop", "exact"),
        ] {
            assert!(
                words(&with, fidelity, draw) != words(beside, fidelity, draw),
                "{source} moves no word of the {fidelity} model, {draw}"
            );
        }
    }
}
