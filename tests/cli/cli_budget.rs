//! `fogbench budget` as a user meets it, its numbers worked out here from the formulae.

use std::f64::consts::PI;

use crate::support::transcript::Transcript;
use crate::support::{assert_close, code, fogbench, repository, scratch, stderr, stdout, write};

/// Arguments of `budget` on a file of the repository.
fn arguments(file: &str, more: &[&str]) -> Vec<String> {
    let path = repository(file).to_str().expect("UTF-8").to_owned();
    let more = more.iter().map(|text| (*text).to_owned());
    ["budget".to_owned(), path]
        .into_iter()
        .chain(more)
        .collect()
}

fn run(file: &str, more: &[&str]) -> std::process::Output {
    let arguments = arguments(file, more);
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    fogbench(scratch().path(), &arguments)
}

fn json(file: &str, more: &[&str]) -> serde_json::Value {
    let output = run(file, &[more, &["--format", "json"]].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    serde_json::from_str(&stdout(&output)).expect("JSON")
}

fn number(value: &serde_json::Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{value} is no number"))
}

/// The default electronics and coil at a power (uW), depth (rad) and technical phase noise
/// (urad/sqrt(Hz)): shot, thermal, amplifier, rin, adc, technical, rate word, total, deg/sqrt(h).
fn walks(power_uw: f64, depth_rad: f64, technical: f64) -> [f64; 8] {
    let (light, visibility, gate_duty, ohm) = (299_792_458.0, 0.95, 0.7, 20e3);
    let scale_s = 2.0 * PI * 800.0 * 0.07 / (1310e-9 * light);
    let transit_s = 1.4677 * 800.0 / light;
    let mean_a = 0.9 * power_uw * 1e-6;
    let bias_a = mean_a * (1.0 + visibility * depth_rad.cos());
    let slope = mean_a * visibility * depth_rad.sin();
    let unit = 180.0 / PI * 60.0 / scale_s;
    let white = |density: f64| unit * (density / (2.0 * gate_duty)).sqrt() / slope;
    let linewidth_hz = light * 35e-9 / (1310e-9_f64 * 1310e-9);
    let rin = 2.0 * (2.0 * 2.0_f64.ln() / PI).sqrt() / linewidth_hz;
    let step_a = 2.0 / 4096.0 / (ohm * 10.0);
    let parts = [
        white(2.0 * 1.602_176_634e-19 * bias_a),
        white(4.0 * 1.380_649e-23 * 298.15 / ohm),
        white((6e-9_f64 / ohm).powi(2)),
        white(rin * bias_a * bias_a),
        unit * (transit_s / (12.0 * 8.0)).sqrt() * step_a / slope,
        unit * technical * 1e-6 / 2.0_f64.sqrt(),
        // Words of 64 half periods in steps of 1e-4 deg/s.
        60.0 * 1e-4 * (64.0 * transit_s / 12.0).sqrt(),
    ];
    let total = parts.iter().map(|part| part * part).sum::<f64>().sqrt();
    let [a, b, c, d, e, f, g] = parts;
    [a, b, c, d, e, f, g, total]
}

const SOURCES: [&str; 8] = [
    "shot",
    "thermal",
    "amplifier",
    "rin",
    "adc",
    "technical",
    "rate_word",
    "total",
];

#[test]
fn the_budget_of_two_bases_is_that_of_the_formulae() {
    for (file, power_uw, depth_deg, technical) in [
        ("scenarios/base/fog70.toml", 0.87, 120.0_f64, 0.0),
        ("scenarios/base/fog70-technical.toml", 10.0, 135.0, 2.18),
    ] {
        let report = json(file, &[]);
        assert_close(number(&report["power_uw"]), power_uw, 0.0, 0.0);
        let want = walks(power_uw, depth_deg.to_radians(), technical);
        // Both readings make the 0.0060 deg/sqrt(h) that the defaults are chosen for.
        assert_close(want[7], 0.0060, 0.0, 2e-5);
        for (source, want_walk) in SOURCES.iter().zip(want) {
            let entry = &report["sources"][source];
            let walk = number(&entry["angle_random_walk_deg_per_sqrt_h"]);
            assert_close(walk, want_walk, 1e-9, 0.0);
            let share = number(&entry["power_share"]);
            assert_close(share, (want_walk / want[7]).powi(2), 1e-9, 0.0);
        }
        let phase = &report["sources"]["technical"]["phase_noise_urad_per_sqrt_hz"];
        assert_close(number(phase), technical, 1e-9, 0.0);
    }
}

#[test]
fn curves_over_depth_and_power_are_those_of_the_formulae() {
    let report = json("scenarios/base/fog70.toml", &[]);
    let mut beyond = 0;
    for curve in ["by_depth", "by_power", "by_power_at_optimum_depth"] {
        let curve = &report[curve];
        let powers = curve["power_uw"].as_array().expect("powers");
        let depths = curve["modulation_depth_deg"].as_array().expect("depths");
        assert!(powers.len() > 30);
        for (index, (power, depth)) in powers.iter().zip(depths).enumerate() {
            let (power_uw, depth_rad) = (number(power), number(depth).to_radians());
            let bias_v = 2e5 * 0.9e-6 * power_uw * (1.0 + 0.95 * depth_rad.cos());
            for (source, want) in SOURCES.iter().zip(walks(power_uw, depth_rad, 0.0)) {
                let walk = &curve["angle_random_walk_deg_per_sqrt_h"][source][index];
                if walk.is_null() {
                    assert!(bias_v >= 2.0);
                    beyond += 1;
                } else {
                    assert!(bias_v < 2.0);
                    assert_close(number(walk), want, 1e-9, 0.0);
                }
            }
        }
    }
    assert!(
        beyond > 0,
        "the brightest points leave the converter's range"
    );
}

#[test]
fn known_answer_k15_the_searched_optimum_is_the_closed_form_at_any_visibility() {
    for (power_uw, visibility) in [("0.87", "0.95"), ("10.0", "0.6"), ("0.05", "1.0")] {
        let power = format!("gyro.source.power_uw={power_uw}");
        let visibility = format!("gyro.source.visibility={visibility}");
        let sets = [
            "--set",
            &power,
            "--set",
            &visibility,
            "--set",
            "gyro.detector.dark_current_na=20.0",
            "--set",
            "gyro.noise.technical_phase_urad_per_sqrt_hz=1.5",
        ];
        let optimum = &json("scenarios/base/fog70.toml", &sets)["optimum"];
        let searched = number(&optimum["modulation_depth_deg"]);
        let closed_form = number(&optimum["closed_form_modulation_depth_deg"]);
        assert_close(searched, closed_form, 0.0, 1e-3_f64.to_degrees());
    }
    // A grid search of the formulae above, 1e-3 rad.
    let optimum = &json("scenarios/base/fog70.toml", &[])["optimum"];
    let total = |step: u32| walks(0.87, 1e-3 * f64::from(step), 0.0)[7];
    let best = (1000..3000_u32)
        .min_by(|a, b| total(*a).total_cmp(&total(*b)))
        .expect("a step");
    let searched_rad = number(&optimum["modulation_depth_deg"]).to_radians();
    assert_close(searched_rad, 1e-3 * f64::from(best), 0.0, 1e-3);
    let least = number(&optimum["angle_random_walk_deg_per_sqrt_h"]);
    assert_close(least, total(best), 1e-6, 0.0);
}

#[test]
fn text_names_the_sources_the_optimum_and_what_is_largest() {
    let output = run("scenarios/base/fog70.toml", &[]);
    let text = stdout(&output);
    let mut transcript = Transcript::of("budget", "Budgets as they are printed");
    transcript.case("budget fog70.toml", text);
    // Eight bits: rounding is no white noise, and the budget says so.
    let set = "gyro.adc.bits=8";
    let coarse = run("scenarios/base/fog70.toml", &["--set", set]);
    transcript.case(format!("budget fog70.toml --set {set}"), stdout(&coarse));
    // Technical noise alone: nothing depends on the depth.
    let off =
        ["shot", "thermal", "amplifier", "rin"].map(|name| format!("gyro.noise.{name}=false"));
    let mut sets: Vec<&str> = off.iter().flat_map(|set| ["--set", set.as_str()]).collect();
    sets.extend(["--set", "gyro.adc.bits=0"]);
    let silent = run("scenarios/base/fog70-technical.toml", &sets);
    transcript.case(
        "budget fog70-technical.toml with that noise alone",
        stdout(&silent),
    );
    transcript.check();
    let report = json("scenarios/base/fog70-technical.toml", &sets);
    assert!(report["optimum"].is_null());
}

#[test]
fn files_are_written_only_where_asked() {
    let folder = scratch();
    let all = arguments("scenarios/quick/static.toml", &["-o", "deep/out"]);
    let all: Vec<&str> = all.iter().map(String::as_str).collect();
    let without = fogbench(folder.path(), &all[..2]);
    assert_eq!(code(&without), 0, "{}", stderr(&without));
    assert_eq!(
        std::fs::read_dir(folder.path()).expect("a folder").count(),
        0
    );
    let with = fogbench(folder.path(), &all);
    assert_eq!(code(&with), 0, "{}", stderr(&with));
    assert_eq!(stdout(&with), stdout(&without));
    let out = folder.path().join("deep/out");
    let csv = std::fs::read_to_string(out.join("budget.csv")).expect("budget.csv");
    let mut lines = csv.lines();
    let heading = lines.next().expect("a heading");
    assert!(heading.starts_with("curve,power_uw,modulation_depth_deg,shot_deg_per_sqrt_h,"));
    let columns = heading.split(',').count();
    assert!(lines.all(|line| line.split(',').count() == columns));
    let svg = std::fs::read_to_string(out.join("budget.svg")).expect("budget.svg");
    assert!(svg.starts_with("<svg") && svg.contains("modulation depth [deg]"));
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
}

#[test]
fn bad_files_and_gyros_exit_2_and_say_why() {
    let folder = scratch();
    write(folder.path(), "bare.toml", "schema = 1\n");
    write(folder.path(), "typo.toml", "[gyro.coil]\nlenght_m = 5.0\n");
    let sweep = "name = \"s\"\nduration_s = 1.0\n[matrix]\n";
    let gyros = format!("{sweep}\"gyro.source.power_uw\" = [1.0, 2.0]\n");
    write(folder.path(), "gyros.toml", &gyros);
    write(
        folder.path(),
        "seeds.toml",
        &format!("{sweep}seed = [1, 2]\n"),
    );
    let mut transcript = Transcript::of("budget", "Files and gyros without a budget");
    for arguments in [
        "budget none.toml",
        "budget .",
        "budget typo.toml",
        "budget gyros.toml",
        "budget bare.toml --set gyro.source.power_uw=500.0",
        "budget",
    ] {
        let words: Vec<&str> = arguments.split(' ').collect();
        let output = fogbench(folder.path(), &words);
        assert_eq!(code(&output), 2, "{arguments}");
        transcript.case(arguments, stderr(&output));
        assert_eq!(stdout(&output), "");
    }
    transcript.check();
    for file in ["bare.toml", "seeds.toml"] {
        let output = fogbench(folder.path(), &["budget", file, "--format", "jsonl"]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        assert_eq!(stdout(&output).lines().count(), 1);
    }
    let busy = write(folder.path(), "busy", "a file, not a folder");
    let path = busy.to_str().expect("UTF-8");
    let output = fogbench(folder.path(), &["budget", "bare.toml", "-o", path]);
    assert_eq!(code(&output), 2, "{}", stderr(&output));
}
