//! The docket: claims of the literature, each a scenario that is only taken where it is named.

use std::fs;

use serde_json::Value;

use crate::support::{
    assert_close, code, field, fogbench, repository, stderr, stdout, summary, write,
};

fn claims() -> Vec<(String, String)> {
    let entries = fs::read_dir(repository("scenarios/docket")).expect("the docket is there");
    let texts = entries.flatten().filter_map(|entry| {
        let name = entry.file_name().into_string().ok()?;
        let text = fs::read_to_string(entry.path()).ok()?;
        let is_claim = text.contains("[[published]]");
        let head: toml::Table = match name.ends_with(".toml") {
            true => text.parse().expect("a scenario"),
            false => toml::Table::new(),
        };
        let is_base = !head.contains_key("name");
        let is_beside = text.contains("\nextends = \"side-by-side");
        let known = is_claim || is_base || is_beside || !name.ends_with(".toml");
        assert!(known, "{name} is no claim, no base and not side by side");
        is_claim.then_some((name, text))
    });
    texts.collect()
}

#[test]
fn every_claim_says_its_kind_its_figure_with_rounding_and_what_it_assumes() {
    let claims = claims();
    assert!(claims.len() >= 15, "{}", claims.len());
    for (name, text) in claims {
        for part in [
            "description = \"a filter of the kind of: ",
            "[[published]]",
            "rounding = ",
            "[[assumption]]",
        ] {
            assert!(text.contains(part), "{name}: {part}");
        }
    }
    let output = fogbench(&repository(""), &["check", "scenarios/docket"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
}

#[test]
fn a_folder_on_demand_is_left_out_unless_it_is_named() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let scenario = |name: &str| format!("schema = 1\nname = \"{name}\"\nduration_s = 1.0\n");
    write(folder.path(), "scenarios/a/one.toml", &scenario("one"));
    write(folder.path(), "scenarios/b/two.toml", &scenario("two"));
    write(folder.path(), "scenarios/b/.on-demand", "");
    let listed = |paths: &[&str]| fogbench(folder.path(), &[&["list"], paths].concat());
    let output = listed(&[]);
    assert!(!stdout(&output).contains("two"), "{}", stdout(&output));
    assert!(
        stderr(&output).contains("note: scenarios/b is left out: name it to take it"),
        "{}",
        stderr(&output)
    );
    let output = listed(&["scenarios/b"]);
    assert!(stdout(&output).contains("two"), "{}", stdout(&output));
    assert_eq!(stderr(&output), "");
}

#[test]
fn a_published_figure_with_rounding_is_judged_and_others_are_not() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = "schema = 1\nname = \"s\"\nduration_s = 4.0\nwarm_up_s = 1.0\nfidelity = \"rate\"\n\
        [[filter]]\nname = \"f\"\n[filter.moving_average]\ntaps = 4\n";
    let figure = |value: f64, more: &str| {
        format!(
            "[[published]]\nmetric = \"f.mean_deg_per_h\"\nvalue = {value}\nunit = \"1\"\n\
             source = \"a paper\"\nrelative_to = \"raw\"\n{more}"
        )
    };
    let figures = [
        figure(1.0, "rounding = 0.05\n"),
        figure(0.2, "rounding = 0.05\n"),
        figure(1.0, ""),
    ];
    write(
        folder.path(),
        "s.toml",
        &format!("{text}{}", figures.concat()),
    );
    let output = fogbench(folder.path(), &["run", "s.toml", "-o", "out"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let run = summary(&folder.path().join("out"), "s");
    let verdict = |index: usize| run["published"][index]["verdict"].clone();
    assert_eq!(verdict(0), "consistent with", "{}", run["published"]);
    assert_eq!(verdict(1), "not reached");
    assert_eq!(verdict(2), Value::Null);
    let wrong = figures[0].replace("relative_to = \"raw\"", "relative_to = \"row\"");
    write(folder.path(), "s.toml", &format!("{text}{wrong}"));
    let output = fogbench(folder.path(), &["check", "s.toml"]);
    assert_eq!(code(&output), 2);
    assert!(
        stderr(&output).contains("published[0].relative_to"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn known_answers_of_least_squares_at_rest_are_those_that_their_scenario_says() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = repository("scenarios/docket/rls.toml");
    let short = ["--set", "duration_s=24.0", "--set", "warm_up_s=8.0"];
    let run = ["run", path.to_str().expect("a path"), "-o", "out"];
    let output = fogbench(folder.path(), &[&run[..], &short[..]].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let result = summary(&folder.path().join("out"), "docket-rls");
    let gain = |key: &str| field(&result, &format!("filter.{key}"), "value");
    // Weights of a record of half a minute still scatter by some hundredths.
    assert_close(gain("dc_gain"), 0.495, 0.0, 0.03);
    assert_close(gain("step_gain_1s"), 0.50, 0.0, 0.03);
    assert_close(gain("lasting_rate_gain"), 0.88, 0.0, 0.03);
    assert_close(gain("twin_mean_ratio"), gain("dc_gain"), 0.0, 0.03);
    let text = fs::read_to_string(path).expect("the scenario is there");
    for figure in ["0.495", "0.50", "0.88"] {
        assert!(text.contains(figure), "{figure}");
    }
    // What is left out for one reason is said once.
    let verdict = result["channels"]["filter"]["verdict"].to_string();
    assert_eq!(verdict.matches("left out by").count(), 1, "{verdict}");
}

#[test]
fn the_filters_of_the_claims_stand_side_by_side_on_every_motion() {
    let read = |name: &str| fs::read_to_string(repository(name)).expect("the scenario is there");
    let parsed = |text: &str| text.parse::<toml::Table>().expect("a scenario");
    let filters = |text: &str| parsed(text)["filter"].as_array().expect("filters").clone();
    let beside = filters(&read("scenarios/docket/side-by-side.toml"));
    let kind = |filter: &toml::Value| {
        let mut table = filter.as_table().expect("a filter").clone();
        table.remove("name");
        table
    };
    for (name, text) in claims() {
        // Test signals have filters of their own.
        if name == "signals.toml" {
            continue;
        }
        let own = kind(&filters(&text)[0]);
        assert!(beside.iter().any(|filter| kind(filter) == own), "{name}");
    }
    for prefix in ["", "words-"] {
        for motion in ["rest", "swing", "step", "warm-up"] {
            let text = read(&format!("scenarios/docket/{prefix}{motion}.toml"));
            assert!(
                text.contains("extends = \"side-by-side"),
                "{prefix}{motion}"
            );
        }
    }
}
