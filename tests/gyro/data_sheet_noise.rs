//! The angle random walk of a data sheet as an input: what the words then have, and what the budget says.

use fogbench::gyro::{GyroError, LoopModel, RateModel, facts};
use fogbench::random::Streams;
use fogbench::scenario::{GyroConfig, NoiseDraw};
use fogbench::signal::MotionSegment;
use fogbench::units::deg_per_h_sqrt_s_to_deg_per_sqrt_h;

use crate::support::gyro_cases::{allan_deviation, budget_of};
use crate::support::reference_gyro::{reference_gyro, undisturbed};
use crate::support::transcript::Transcript;
use crate::support::{assert_close, code, fogbench, stderr, stdout, write};

/// Averaging factor of the walks: 40 words and more, tens of the loop's time constants.
const FACTOR: usize = 40;
const WORDS: usize = 60_000;

/// The reference gyro without slow noise, with a walk.
fn sheet(walk: f64) -> GyroConfig {
    let mut config = undisturbed(reference_gyro());
    config.noise.angle_random_walk_deg_per_sqrt_h = Some(walk);
    config.controller.loop_bandwidth_hz = 3000.0;
    config
}

/// How a gyro is changed.
type Change = fn(&mut GyroConfig);

/// Angle random walks of the words at rest of both models, deg/sqrt(h).
fn walks(config: &GyroConfig) -> [(&'static str, f64); 2] {
    let period_s = fogbench::gyro::sample_period_s(config);
    let time_s = WORDS as f64 * period_s;
    let streams = Streams::new(31, 0);
    let mut loop_model = LoopModel::new(config, time_s, &streams).expect("the gyro is sound");
    let mut rate_model = RateModel::new(config, time_s, &streams).expect("the gyro is sound");
    // A steady rate, so that a word that is rounded takes many values.
    let turning = MotionSegment::constant(4e-5);
    let walk = |mut word: Box<dyn FnMut() -> f64 + '_>| {
        for _ in 0..200 {
            word();
        }
        let words: Vec<f64> = (0..WORDS).map(|_| word()).collect();
        let averaging_s = FACTOR as f64 * period_s;
        deg_per_h_sqrt_s_to_deg_per_sqrt_h(allan_deviation(&words, FACTOR) * averaging_s.sqrt())
    };
    [
        ("loop", walk(Box::new(|| loop_model.next_word(&turning)))),
        ("rate", walk(Box::new(|| rate_model.next_word(&turning)))),
    ]
}

#[test]
fn the_words_have_the_walk_of_the_data_sheet_whatever_the_gyro() {
    let cases: [(&str, Change); 8] = [
        ("as the reference", |_| {}),
        ("no latency", |gyro| {
            gyro.controller.loop_latency_periods = 0
        }),
        ("short coil, much light", |gyro| {
            gyro.coil.length_m = 300.0;
            gyro.source.power_uw = 5.0;
            gyro.detector.post_gain *= 0.15;
        }),
        ("long coil", |gyro| {
            gyro.coil.length_m = 1500.0;
            gyro.controller.loop_bandwidth_hz = 1500.0;
        }),
        ("ideal converter, little light", |gyro| {
            gyro.adc.bits = 0;
            gyro.source.power_uw = 0.01;
        }),
        ("another depth", |gyro| gyro.modulator.depth_deg = 95.0),
        ("coarse words", |gyro| gyro.output.rate_lsb_deg_per_s = 0.01),
        ("every source on its own", |gyro| {
            gyro.noise.draw = NoiseDraw::Exact;
            gyro.adc.samples_per_half_period = 2;
            gyro.adc.bits = 16;
        }),
    ];
    for (name, change) in cases {
        let mut config = sheet(0.008);
        change(&mut config);
        assert_close(budget_of(&config, "total"), 0.008, 1e-9, 0.0);
        for (model, got) in walks(&config) {
            // Standard error sqrt(0.75 factor / words) of an overlapping deviation: 2.2 %.
            let error = (got / 0.008 - 1.0).abs();
            assert!(error < 0.05, "{name}, {model} model: {got} for 0.008");
        }
    }
}

#[test]
fn the_walk_of_a_data_sheet_scales_the_words_and_nothing_else_does() {
    let mut config = sheet(0.02);
    config.adc.bits = 0;
    config.output.rate_lsb_deg_per_s = 0.0;
    let [_, (_, one)] = walks(&config);
    config.source.power_uw = 9.0;
    config.source.linewidth_nm = 5.0;
    config.detector.transimpedance_kohm = 1.0;
    let [_, (_, other)] = walks(&config);
    assert_close(other, one, 1e-9, 0.0);
    config.noise.angle_random_walk_deg_per_sqrt_h = Some(0.04);
    let [_, (_, twice)] = walks(&config);
    assert_close(twice, 2.0 * one, 1e-6, 0.0);
}

#[test]
fn the_budget_has_one_line_in_the_place_of_the_sources() {
    let facts = facts(&sheet(0.008)).expect("the gyro is sound");
    let budget = facts.angle_random_walk_budget_deg_per_sqrt_h;
    let names: Vec<&str> = budget.iter().map(|(name, _)| *name).collect();
    assert_eq!(names, ["adc", "equivalent", "rate_word", "total"]);
    let squares: f64 = budget[..3].iter().map(|(_, walk)| walk * walk).sum();
    assert_close(squares.sqrt(), 0.008, 1e-9, 0.0);
    let replaced = ["shot", "thermal", "amplifier", "rin", "technical"];
    assert_eq!(facts.replaced_noise_sources, replaced);
}

#[test]
fn a_walk_that_rounding_swallows_is_refused_with_the_way_out() {
    let refused = |change: fn(&mut GyroConfig)| {
        let mut config = sheet(0.0005);
        change(&mut config);
        facts(&config).expect_err("rounding is more than the walk")
    };
    let by_converter = refused(|_| {});
    assert!(matches!(by_converter, GyroError::RoundingBeyondWalk { .. }));
    assert!(by_converter.to_string().contains("gyro.adc.bits"));
    let by_words = refused(|gyro| {
        gyro.adc.bits = 0;
        gyro.output.rate_lsb_deg_per_s = 0.01;
    });
    assert!(by_words.to_string().contains("rate_lsb_deg_per_s"));
}

/// A gyro by its data sheet.
const SHEET: &str = "schema = 1
name = \"sheet\"
duration_s = 20.0
fidelity = \"rate\"
[gyro.noise]
angle_random_walk_deg_per_sqrt_h = 0.008
";

#[test]
fn budget_and_run_say_what_the_walk_of_a_data_sheet_replaces() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "sheet.toml", SHEET);
    let mut transcript = Transcript::of("budget", "the walk of a data sheet");
    for line in [
        "budget sheet.toml -o b",
        "check sheet.toml --set gyro.noise.shot=false",
        "check sheet.toml --set gyro.adc.bits=0 --set gyro.source.power_uw=20.0",
        "check sheet.toml --set gyro.noise.angle_random_walk_deg_per_sqrt_h=0.001",
        "check sheet.toml --set gyro.noise.arw=0.001",
        "check sheet.toml --set gyro.angle_random_walk=0.001",
    ] {
        let words: Vec<&str> = line.split(' ').collect();
        let output = fogbench(folder.path(), &words);
        transcript.case(
            format!("fogbench {line}"),
            format!("{}{}", stdout(&output), stderr(&output)),
        );
    }
    transcript.check();
    let picture = std::fs::read_to_string(folder.path().join("b/budget.svg")).expect("written");
    assert!(picture.contains("equivalent: of a data sheet"));
    let output = fogbench(folder.path(), &["budget", "sheet.toml", "--format", "json"]);
    let json: serde_json::Value = serde_json::from_str(&stdout(&output)).expect("it is JSON");
    assert_eq!(json["replaced_sources"][0], "shot");
    assert!(json["sources"]["equivalent"].is_object(), "{json}");

    let output = fogbench(folder.path(), &["run", "sheet.toml"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let said = stdout(&output).replace("\n  ", " ");
    assert!(
        said.contains("in the place of shot, thermal, amplifier, rin and technical"),
        "{said}"
    );
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).expect("written");
    let summary: serde_json::Value =
        serde_json::from_str(&read("output/sheet/summary.json")).expect("it is JSON");
    assert_eq!(summary["gyro"]["replaced_noise_sources"][4], "technical");
    let walk = &summary["channels"]["raw"]["metrics"]["angle_random_walk_deg_per_sqrt_h"];
    let bound = |name: &str| walk[name].as_f64().expect("a number");
    assert!(bound("low") < 0.008 && 0.008 < bound("high"), "{walk}");
    assert!(read("output/sheet/report.html").contains("in the place of shot"));
}
