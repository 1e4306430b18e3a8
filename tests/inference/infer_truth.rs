//! `fogbench infer` beside settings that are known: how often it holds them, what it cannot tell apart, and
//! what simulated records say of its forecasts.
//!
//! The long form is run by hand, in release, 4 min of one core:
//! `FOGBENCH_INFER_DRAWS=400 cargo test --release --test integration -- infer_truth::drawn`.
//! docs/infer.md has what it found.

use std::path::Path;

use crate::support::inference::{number, published};
use crate::support::{code, fogbench, stderr, stdout, write};
use fogbench::Scenario;
use serde_json::Value;
use statrs::distribution::{Binomial, DiscreteCDF};

/// Draws of the short form; the least that gives a level of 95 %.
const DRAWS: u64 = 20;

const GYRO: &str = r#"
schema = 1
name = "rest"
duration_s = 20.0
warm_up_s = 10.0
fidelity = "rate"
[[filter]]
name = "rls"
rls = { taps = 4, forgetting_factor = 1.0, desired = "current", input_lag_samples = 1 }
"#;

/// Six readings, two parameters, figures as coarse as those of a paper. Of the 40 ranks that a value has among
/// 39 points one at either end lies outside: 95 % to the point.
const PROBLEM: &str = r#"
schema = 1
name = "truth"
points = 39
[[record]]
name = "rest"
scenario = "rest.toml"
[[parameter]]
name = "latitude"
keys = ["turntable.site.latitude_deg"]
low = 20.0
high = 60.0
[[parameter]]
name = "power"
keys = ["gyro.source.power_uw"]
low = 0.5
high = 2.0
prior = "log-uniform"
[[choice]]
question = "desired"
answer = "one ahead"
[[choice]]
question = "desired"
answer = "two ahead"
set = ["filter.rls.input_lag_samples=2"]
[[choice]]
question = "desired"
answer = "mean of two"
set = ["filter.rls.desired=\"two-sample-mean\""]
[[choice]]
question = "taps"
answer = "4"
[[choice]]
question = "taps"
answer = "10"
set = ["filter.rls.taps=10"]
"#;

fn figures() -> String {
    published(&[
        ("rest", "raw.mean_deg_per_h", 8.5, "deg/h", 0.1),
        ("rest", "raw.noise_std_deg_per_h", 19.0, "deg/h", 0.1),
        ("rest", "rls.dc_gain", 0.49, "1", 0.01),
        ("rest", "rls.noise_gain", 0.12, "1", 0.01),
    ])
}

fn count(value: &Value) -> u64 {
    value
        .as_u64()
        .unwrap_or_else(|| panic!("{value} is no count"))
}

fn answer(folder: &Path, problem: &str, options: &[&str]) -> Value {
    write(folder, "problem.toml", problem);
    let command = ["infer", "problem.toml", "--format", "json"];
    let arguments = [&command[..], options].concat();
    let output = fogbench(folder, &arguments);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    serde_json::from_str(&stdout(&output)).expect("JSON")
}

/// Draws that were asked for by hand, or those of the short form.
fn draws() -> u64 {
    let asked = std::env::var("FOGBENCH_INFER_DRAWS").ok();
    asked.map_or(DRAWS, |text| text.parse().expect("a number of draws"))
}

/// Counts of `all` that chance leaves in 99.9 % where each holds with a probability.
fn band(all: u64, probability: f64) -> std::ops::RangeInclusive<u64> {
    let law = Binomial::new(probability, all).expect("a law");
    law.inverse_cdf(0.0005)..=law.inverse_cdf(0.9995)
}

/// The least of them.
fn least(all: u64, probability: f64) -> u64 {
    *band(all, probability).start()
}

/// What has to hold of a calibration whose figures were drawn: the regions hold the truth in 95 %, neither less
/// nor more.
fn covers(calibration: &Value, draws: u64) {
    let held = count(&calibration["regions_that_hold"]);
    assert!(band(draws, 0.95).contains(&held), "{calibration:#}");
}

/// What has to hold of a calibration, whatever made its figures.
fn holds(calibration: &Value, draws: u64) {
    let of = |key: &str| count(&calibration[key]);
    assert_eq!(of("draws"), draws);
    let accepted = of("true_reading_accepted");
    assert!(
        accepted >= draws * 18 / 20 && accepted >= least(draws, 0.95),
        "{calibration:#}"
    );
    assert!(
        of("at_most_a_third_accepted") >= draws * 15 / 20,
        "{calibration:#}"
    );
    assert!(
        of("intervals_that_hold") >= least(of("intervals"), 0.95),
        "{calibration:#}"
    );
    assert!(
        of("without_unexplained") >= least(draws, 0.95),
        "{calibration:#}"
    );
    // A pull between 2, which excuses, and the limit, which all figures together need, is missed; the others
    // are named.
    let named = of("shifted_named");
    assert!(2 * named >= draws - of("shifted_open"), "{calibration:#}");
    let volumes = calibration["volumes_over_bound"]
        .as_array()
        .expect("volumes");
    assert_eq!(volumes.len() as u64, draws);
    assert!(
        number(&volumes[volumes.len() / 2]) <= 2.0,
        "{calibration:#}"
    );
}

#[test]
fn drawn_figures_lead_back_to_the_settings_that_made_them() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "rest.toml", GYRO);
    let problem = PROBLEM.to_owned() + &figures();
    let draws = draws();
    let asked = draws.to_string();
    let found = answer(folder.path(), &problem, &["--calibrate", &asked]);
    holds(&found["calibration"], draws);
    covers(&found["calibration"], draws);
    // The levels of the answer are those of the calibration.
    assert_eq!(found["pull_limit"], found["calibration"]["pull_level"]);
    let level = number(&found["calibration"]["accepted_level"]);
    let part = number(&found["accepted_part"]);
    assert!((part - level.max(0.95)).abs() < 1e-12, "{part} {level}");
}

#[test]
fn simulated_figures_lead_back_to_the_settings_that_made_them() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "rest.toml", GYRO);
    let problem = PROBLEM.to_owned() + &figures();
    let draws = draws().min(100);
    let asked = draws.to_string();
    let options = ["--calibrate", &asked, "--simulated"];
    holds(
        &answer(folder.path(), &problem, &options)["calibration"],
        draws,
    );
}

/// Values of two parameters at both ends of the only ridge.
fn ends(found: &Value, names: [&str; 2]) -> [[f64; 2]; 2] {
    let ridge = &found["ridges"][0];
    assert_eq!(ridge["parameters"], serde_json::json!(names), "{found:#}");
    ["from", "to"].map(|end| [0, 1].map(|index| number(&ridge[end][index])))
}

/// The budget has the angle random walk in closed form: both ends of the ridge have the one that was
/// printed, and lie far apart.
#[test]
fn power_and_technical_noise_are_not_told_apart_at_one_angle_random_walk() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let hour = GYRO.replace("duration_s = 20.0", "duration_s = 3600.0");
    write(folder.path(), "rest.toml", &hour);
    let walk = 0.006;
    let problem = format!(
        "schema = 1\nname = \"ridge\"\npoints = 128\n[[record]]\nname = \"rest\"\n\
         scenario = \"rest.toml\"\n{}[[parameter]]\nname = \"power\"\n\
         keys = [\"gyro.source.power_uw\"]\nlow = 0.9\nhigh = 2.0\n[[parameter]]\n\
         name = \"technical\"\nkeys = [\"gyro.noise.technical_phase_urad_per_sqrt_hz\"]\nlow = 0.0\n\
         high = 3.0\n",
        published(&[(
            "rest",
            "raw.angle_random_walk_deg_per_sqrt_h",
            walk,
            "deg/sqrt(h)",
            1e-4
        )])
    );
    let found = answer(folder.path(), &problem, &[]);
    let ends = ends(&found, ["power", "technical"]);
    for [power, technical] in ends {
        let plans = Scenario::from_toml(GYRO)
            .and_then(|own| own.set("gyro.source.power_uw", power))
            .and_then(|own| own.set("gyro.noise.technical_phase_urad_per_sqrt_hz", technical))
            .and_then(|own| own.points())
            .expect("a plan");
        let facts = plans[0].facts().expect("a gyro");
        let mut budget = facts.angle_random_walk_budget_deg_per_sqrt_h.iter();
        let (_, total) = budget.find(|(name, _)| *name == "total").expect("a total");
        // Half a step of the print and four deviations of the fit over an hour, 0.09 % each.
        assert!(
            (total - walk).abs() < 5e-5 + 4.0 * 9e-4 * walk,
            "{power} {technical}: {total}"
        );
    }
    assert!(ends[1][0] - ends[0][0] > 0.3, "{ends:?}");
}

/// The Wiener gain of the RLS filter falls with the bandwidth, as its noise turns white, and rises with the
/// mean: records of both ends have the gain that was printed.
#[test]
fn bandwidth_and_mean_rate_are_not_told_apart_at_one_dc_gain() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "rest.toml", GYRO);
    let problem = format!(
        "schema = 1\nname = \"ridge\"\npoints = 64\n[[record]]\nname = \"rest\"\n\
         scenario = \"rest.toml\"\n{}[[parameter]]\nname = \"bandwidth\"\n\
         keys = [\"gyro.controller.loop_bandwidth_hz\"]\nlow = 500.0\nhigh = 4000.0\n\
         prior = \"log-uniform\"\n[[parameter]]\nname = \"latitude\"\n\
         keys = [\"turntable.site.latitude_deg\"]\nlow = 5.0\nhigh = 60.0\n",
        published(&[("rest", "rls.dc_gain", 0.49, "1", 0.01)])
    );
    let found = answer(folder.path(), &problem, &[]);
    let ends = ends(&found, ["bandwidth", "latitude"]);
    for [bandwidth, latitude] in ends {
        let run = Scenario::from_toml(GYRO)
            .and_then(|own| own.set("gyro.controller.loop_bandwidth_hz", bandwidth))
            .and_then(|own| own.set("turntable.site.latitude_deg", latitude))
            .expect("a scenario")
            .run()
            .expect("a run");
        let gain = run["rls"]
            .metric(&fogbench::metrics::catalogue::DC_GAIN)
            .expect("a gain");
        // Half a step, and four deviations of a record of 20 s.
        assert!(
            (gain.value - 0.49).abs() < 0.05,
            "{bandwidth} {latitude}: {gain:?}"
        );
    }
    assert!(
        (ends[1][0] / ends[0][0]).ln().abs() > 0.7 && (ends[1][1] - ends[0][1]).abs() > 5.0,
        "{ends:?}"
    );
}

/// The most likely settings and both ends of a ridge, simulated on both models; what is written runs.
#[test]
fn a_confirmation_simulates_what_was_found_and_leaves_scenarios_that_run() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    write(at, "rest.toml", &GYRO.replace("20.0", "6.0"));
    let problem = format!(
        "schema = 1\nname = \"confirmed\"\npoints = 64\n[[record]]\nname = \"rest\"\n\
         scenario = \"rest.toml\"\n{}[[parameter]]\nname = \"bandwidth\"\n\
         keys = [\"gyro.controller.loop_bandwidth_hz\"]\nlow = 500.0\nhigh = 4000.0\n\
         prior = \"log-uniform\"\n[[parameter]]\nname = \"latitude\"\n\
         keys = [\"turntable.site.latitude_deg\"]\nlow = 5.0\nhigh = 60.0\n[[experiment]]\n\
         name = \"level-axis\"\nrecord = \"rest\"\nset = [\"turntable.site.latitude_deg=0.0\"]\n\
         metric = \"rls.dc_gain\"\n[[gate]]\nof = \"disagreeing-forecasts\"\nmax = 0.0\n",
        published(&[("rest", "rls.dc_gain", 0.49, "1", 0.01)])
    );
    let options = ["--confirm=4", "-o", "found"];
    let found = answer(at, &problem, &options);
    let candidates = found["confirmation"]["candidates"]
        .as_array()
        .expect("candidates");
    let names: Vec<&str> = candidates
        .iter()
        .filter_map(|candidate| candidate["name"].as_str())
        .collect();
    assert_eq!(names, ["best", "ridge-1-low", "ridge-1-high"]);
    for candidate in candidates {
        let figure = &candidate["figures"][0];
        for model in ["rate_model", "loop_model"] {
            assert!(number(&figure[model]["value"]) > 0.3, "{figure:#}");
        }
        assert_eq!(figure["agrees"], true, "{figure:#}");
    }
    assert_eq!(found["gates"][0]["accepted"], true);
    let read = |name: &str| std::fs::read_to_string(at.join("found").join(name)).expect(name);
    let page = read("report.html");
    for name in ["profile.svg", "ridge.svg", "pulls.svg", "infer.txt"] {
        assert!(page.contains(name) && !read(name).is_empty(), "{name}");
    }
    // All at once: no two of them share a name.
    let output = fogbench(at, &["check", "found/scenarios"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(stdout(&output), "4 runs of 4 files are sound\n");
    assert_eq!(answer(at, &problem, &options), found);
    assert_eq!(read("report.html"), page);
}

#[test]
fn a_gate_that_is_not_accepted_gives_exit_code_1() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let at = folder.path();
    write(at, "rest.toml", GYRO);
    let figure = published(&[("rest", "raw.mean_deg_per_h", 8.5, "deg/h", 0.1)]);
    let problem = |gate: &str| {
        format!(
            "schema = 1\nname = \"gated\"\npoints = 32\n[[record]]\nname = \"rest\"\n\
             scenario = \"rest.toml\"\n{figure}[[gate]]\n{gate}\n"
        )
    };
    let ended = |gate: &str| {
        write(at, "problem.toml", &problem(gate));
        code(&fogbench(at, &["infer", "problem.toml"]))
    };
    assert_eq!(ended("of = \"accepted-readings\"\nmax = 1.0"), 0);
    assert_eq!(ended("of = \"accepted-readings\"\nmin = 2.0"), 1);
    assert_eq!(ended("of = \"disagreeing-forecasts\"\nmax = 0.0"), 1);
    assert_eq!(ended("of = \"largest-pull\""), 2);
    assert_eq!(ended("of = \"largest-pull\"\nmin = 2.0\nmax = 1.0"), 2);
}
