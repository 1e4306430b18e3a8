//! Numbers at the ends of their ranges: finite results or a clear refusal, never a panic.

use std::path::{Path, PathBuf};

use fogbench::experiment::{Plan, SuiteOptions, plan_suite, run_suite};
use fogbench::metrics::{AllanOptions, Motion, Record, Settings, measure, predict};
use fogbench::report::SVG_BYTES_MAX;
use fogbench::signal::{FilterShape, Rates, WeightRule};
use serde_json::Value;

use crate::scenario::campaign::schema::{leaves, root};
use crate::support::transcript::{Transcript, said_to_each};
use crate::support::{code, field, fogbench, stderr, stdout, summary, tree, write};

/// The shortest scenario that has words, noise and a filter.
const SHORT: &str = "schema = 1\nduration_s = 0.1\nwarm_up_s = 0.1\nfidelity = \"rate\"\n\
                     bias_averaging_time_s = 0.01\n";

/// What stands beside the key under test, by the beginning of its path: longest first.
const BESIDE: [(&str, &str); 30] = [
    (
        "turntable.swing",
        "rate_amplitude_deg_per_s = 1.0\nfrequency_hz = 50.0\nsoft_start_s = 0.05",
    ),
    (
        "turntable.multi_sine",
        "frequencies_hz = [50.0]\nrate_amplitudes_deg_per_s = [1.0]\nsoft_start_s = 0.05",
    ),
    (
        "turntable.steps",
        "rates_deg_per_s = [0.0, 1.0]\ndwell_s = 0.05\nsettle_s = 0.01",
    ),
    (
        "turntable.scale_factor_test",
        "from_deg_per_s = 0.1\nto_deg_per_s = 10.0\ndwell_s = 0.02\nstatic_s = 0.02\nsettle_s = 0.005",
    ),
    (
        "turntable.rotation",
        "rate_deg_per_s = 1.0\nsoft_start_s = 0.05",
    ),
    (
        "turntable.trapezoid",
        "rate_deg_per_s = 1.0\nacceleration_deg_per_s2 = 100.0\nhold_s = 0.01",
    ),
    (
        "turntable.chirp",
        "rate_amplitude_deg_per_s = 1.0\nstart_frequency_hz = 50.0\nend_frequency_hz = 100.0\nsweep_s = 0.05\nsoft_start_s = 0.05\nsoft_stop_s = 0.01",
    ),
    (
        "turntable.test_signal",
        "shape = \"step\"\nrate_amplitude_deg_per_s = 1.0\nlength_s = 0.05",
    ),
    (
        "turntable.script.points",
        "time_s = [0.0, 1.0]\nrate_deg_per_s = [0.0, 1.0]",
    ),
    (
        "turntable.calibration",
        "axes = [\"x\", \"x\", \"y\", \"z\"]\nrates_deg_per_s = [10.0, 50.0, 50.0, 50.0]\nrecord_s = 0.1\nchange_s = 0.05\nremount_s = 0.05\nwhole_turns = false",
    ),
    (
        "turntable.servo.second_order",
        "natural_frequency_hz = 50.0\ndamping_ratio = 0.7",
    ),
    (
        "turntable.servo.direct_drive",
        "natural_frequency_hz = 20.0",
    ),
    ("turntable.encoder", "resolution_arcsec = 1.0"),
    (
        "gyro.temperature.ramp",
        "start_c = 20.0\nend_c = 30.0\nrate_c_per_min = 10.0",
    ),
    (
        "gyro.temperature.profile",
        "times_s = [0.0, 1.0]\ntemperatures_c = [20.0, 30.0]",
    ),
    ("gyro.thermal.power.quadratic", ""),
    ("gyro.thermal.power.exponential", "fall_k = 100.0"),
    (
        "gyro.vibration.sine",
        "frequency_hz = 100.0\nacceleration_g = 1.0",
    ),
    (
        "gyro.vibration.random",
        "from_hz = 50.0\nto_hz = 100.0\nacceleration_psd_g2_per_hz = 1e-4",
    ),
    (
        "gyro.injection",
        "frequencies_hz = [50.0]\nrate_amplitudes_deg_per_s = [0.1]\nsoft_start_s = 0.05",
    ),
    ("gyro.assembly", "bias_deg_per_h = [1.0, 2.0, 3.0]"),
    (
        "compensation.parameters",
        "bias_deg_per_h = [1.0, 2.0, 3.0]",
    ),
    ("gate[]", "metric = \"raw.mean_deg_per_h\"\nmin = -1e6"),
    (
        "published[]",
        "metric = \"raw.mean_deg_per_h\"\nvalue = 1.0\nunit = \"deg/h\"\nsource = \"none\"",
    ),
    ("calibration", ""),
    ("filter[].sign_lms", "pipeline = \"fpga\"\nunit = \"rad/s\""),
    ("filter[].lms", "pipeline = \"fpga\""),
    ("filter[].rls", "pipeline = \"fpga\""),
    ("filter[].process", "command = [\"cat\"]"),
    ("filter[]", ""),
];

/// Writes a scenario in which a key means something. It inherits all but its name: keys beside the
/// one under test may be without effect.
fn write_scenario(folder: &Path, name: &str, path: &str) -> PathBuf {
    write(folder, &format!("bases/{name}.toml"), &shortest(path));
    let own = format!("name = \"{name}\"\nextends = \"bases/{name}.toml\"\n");
    write(folder, &format!("{name}.toml"), &own)
}

/// The text of the shortest scenario, without a name, in which a key means something.
pub(crate) fn shortest(path: &str) -> String {
    let mut text = SHORT.to_owned();
    let (table, beside) = match BESIDE.iter().find(|(table, _)| path.starts_with(table)) {
        Some(("calibration", _)) => BESIDE[8],
        Some(found) => *found,
        None => return text,
    };
    if ["turntable.calibration", "turntable.scale_factor_test"].contains(&table) {
        text = text.replace("duration_s = 0.1", "duration_s = 1.0");
    }
    let kind = path.split('.').nth(1).unwrap_or_default();
    let header = match table {
        _ if table.starts_with("filter[]") => {
            format!("[[filter]]\nname = \"f\"\n[filter.{kind}]\n")
        }
        "gate[]" => "[[gate]]\n".to_owned(),
        "published[]" => "[[published]]\n".to_owned(),
        "compensation.parameters" => "[gyro.assembly]\n[compensation.parameters]\n".to_owned(),
        "turntable.calibration" => {
            "[gyro.assembly]\n[calibration]\napply = \"batch\"\n[turntable.calibration]\n"
                .to_owned()
        }
        table => format!("[{table}]\n"),
    };
    text.push_str(&header);
    text.push_str(beside);
    text.push('\n');
    text
}

/// How `--set` names a key.
fn set(path: &str, value: &str) -> String {
    let address = path.replace("filter[].", "filter.f.").replace("[]", "[0]");
    format!("{address}={value}")
}

/// Every number of the schema: path, end of its range as `--set` takes it.
fn ends(end: &str) -> Vec<(String, String)> {
    fn walk(path: &str, schema: &Value, end: &str, found: &mut Vec<(String, String)>) {
        let limit = |schema: &Value| schema.get(end).map(ToString::to_string);
        let items = &schema["items"];
        if let Some(number) = limit(schema) {
            found.push((path.to_owned(), number));
        } else if let Some(number) = limit(items) {
            let count = schema["maxItems"].as_u64().unwrap_or(1).min(3);
            let numbers: Vec<String> = (0..count).map(|_| number.clone()).collect();
            found.push((path.to_owned(), format!("[{}]", numbers.join(", "))));
        }
        for (schema, suffix) in [(schema, ""), (items, "[]")] {
            for (name, child) in schema["properties"].as_object().into_iter().flatten() {
                let inside = if path.is_empty() {
                    name.clone()
                } else {
                    format!("{path}{suffix}.{name}")
                };
                walk(&inside, child, end, found);
            }
        }
    }
    let mut found = Vec::new();
    walk("", &fogbench::scenario::json_schema(), end, &mut found);
    found.retain(|(path, _)| path != "schema" && path != "seed" && path != "repeats");
    found
}

/// Whether a text holds a word for what is no number.
fn has_no_number(text: &str) -> bool {
    let mut words = text.split(|c: char| !c.is_ascii_alphanumeric());
    words.any(|word| ["NaN", "nan", "inf", "Infinity"].contains(&word))
}

/// Every binary64 whose range holds 0, at the least number above it: path, value as `--set` takes it.
fn least_above_zero() -> Vec<(String, String)> {
    let tiny = |(path, least): (String, String)| {
        let numbers: Vec<&str> = least.trim_matches(['[', ']']).split(", ").collect();
        let holds_zero =
            |text: &&str| text.contains('.') && text.parse().is_ok_and(|it: f64| it <= 0.0);
        let is_array = least.starts_with('[');
        numbers.iter().all(holds_zero).then(|| {
            let value = vec!["5e-324"; numbers.len()].join(", ");
            (
                path,
                if is_array {
                    format!("[{value}]")
                } else {
                    value
                },
            )
        })
    };
    ends("minimum").into_iter().filter_map(tiny).collect()
}

/// Plans each key at its value and runs what is sound; gives the numbers of both.
fn run_all(folder: &Path, ends: &[(String, String)]) -> (usize, usize) {
    let mut plans: Vec<Plan> = Vec::new();
    let mut refused = 0;
    for (index, (path, value)) in ends.iter().enumerate() {
        let name = format!("k{index}");
        let file = write_scenario(folder, &name, path);
        let base = plan_suite(std::slice::from_ref(&file), &[]);
        assert!(base.is_ok(), "{path}: {base:?}");
        match plan_suite(&[file], &[set(path, value)]) {
            Ok(plan) => plans.extend(plan),
            Err(errors) => {
                refused += 1;
                for error in errors {
                    let text = error.to_string();
                    assert!(!has_no_number(&text), "{path} = {value}: {text}");
                    assert!(text.contains(": "), "{path} = {value}: {text}");
                }
            }
        }
    }
    let output = folder.join("out");
    let options = SuiteOptions {
        threads: 0,
        ..SuiteOptions::new(output.clone())
    };
    let done = run_suite(&plans, &options, &()).expect("a writable folder");
    for run in &done.runs {
        let index: usize = run.name[1..].parse().expect("a number");
        let what = &ends[index];
        assert_eq!(run.error, None, "{what:?}");
    }
    let mut faulty = Vec::new();
    for (path, bytes) in tree(&output) {
        let is_text = path.extension().is_some_and(|it| it != "npy");
        let text = String::from_utf8_lossy(&bytes);
        let run = path.components().next().expect("a folder").as_os_str();
        let what = run
            .to_string_lossy()
            .strip_prefix('k')
            .and_then(|it| ends.get(it.parse::<usize>().ok()?));
        if is_text && let Some(line) = text.lines().find(|line| has_no_number(line)) {
            faulty.push(format!("{what:?}: {}: {line}", path.display()));
        }
        if path.ends_with("summary.json") {
            let summary: Value = serde_json::from_slice(&bytes).expect("JSON");
            assert!(!text.contains("null"), "{what:?}: {summary}");
        }
    }
    assert!(faulty.is_empty(), "{}", faulty.join("\n"));
    assert!(!done.broken);
    (plans.len(), refused)
}

#[test]
fn every_key_at_its_least_value_runs_or_is_refused_with_finite_numbers() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let ends = ends("minimum");
    assert!(ends.len() > 180, "{} keys have a minimum", ends.len());
    let (ran, refused) = run_all(folder.path(), &ends);
    assert!(
        ran > 120 && refused > 0,
        "{ran} ran, {refused} were refused"
    );
}

#[test]
fn every_key_just_above_zero_runs_or_is_refused_with_finite_numbers() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let values = least_above_zero();
    assert!(
        values.len() > 60,
        "the ranges of {} keys hold 0",
        values.len()
    );
    let (ran, refused) = run_all(folder.path(), &values);
    assert!(ran > 40 && refused > 3, "{ran} ran, {refused} were refused");
}

/// The number of binary64, or the whole number, next to `end` on the side of `step`.
fn beyond(end: &str, step: i64) -> String {
    match end.parse::<i64>() {
        Ok(end) => (end + step).to_string(),
        Err(_) => {
            let end: f64 = end.parse().expect("a number");
            let next = if step < 0 {
                end.next_down()
            } else {
                end.next_up()
            };
            format!("{next:?}")
        }
    }
}

#[test]
fn every_key_refuses_the_number_beyond_either_end_with_unit_and_range() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let leaves = leaves(&root());
    for (end, step) in [("minimum", -1), ("maximum", 1)] {
        for (index, (path, value)) in ends(end).iter().enumerate() {
            let unit = leaves[path].unit.as_ref();
            let unit = unit.map_or(String::new(), |unit| format!(" {unit}"));
            let is_array = value.starts_with('[');
            let limit = value.trim_matches(['[', ']']).split(", ").next();
            let limit = limit.expect("a number");
            let wrong = beyond(limit, step);
            let given = if is_array {
                value.replacen(limit, &wrong, 1)
            } else {
                wrong.clone()
            };
            let file = write_scenario(folder.path(), &format!("k{index}"), path);
            let found = plan_suite(&[file], &[set(path, &given)])
                .map(|_| ())
                .expect_err(path);
            let text = found[0].to_string();
            let place = if is_array { "[0]" } else { "" };
            let key = path.replace("[]", "[0]");
            let said = format!("{key}{place} = {wrong}{unit} is out of range: allowed ");
            assert!(text.contains(&said), "{said}\n{text}");
            let (_, range) = text
                .split_once("is out of range: allowed ")
                .expect("a range");
            let range = range.trim_end_matches(&unit).trim_matches(['[', ']']);
            let range = range.trim_start_matches("even ").replace("..=", ", ");
            let (low, high) = range.split_once(", ").expect("two ends");
            let stated: f64 = if step < 0 { low } else { high }.parse().expect("a number");
            let limit: f64 = limit.parse().expect("a number");
            assert_eq!(stated.to_bits(), limit.to_bits(), "{text}");
        }
    }
}

/// White-looking words about 10 deg/h: a linear congruence.
fn words(count: usize) -> Vec<f64> {
    let mut state = 1_u64;
    let uniform = |_| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        10.0 + f64::from((state >> 40) as u32) / f64::from(1_u32 << 24)
    };
    (0..count).map(uniform).collect()
}

fn text_of(words: &[f64]) -> String {
    words.iter().map(|word| format!("{word:?}\n")).collect()
}

#[test]
fn a_corrupt_cell_of_a_log_is_refused_with_its_line_and_value() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let mut log = words(2000);
    log[1234] = 1e153;
    write(folder.path(), "log.csv", &text_of(&log));
    write(
        folder.path(),
        "rls.toml",
        "schema = 1\n[[filter]]\nname = \"f\"\n[filter.rls]\n",
    );
    let on = ["log.csv", "--unit", "deg/h", "--rate-hz", "100"];
    let mut transcript = Transcript::of("bounds", "A corrupt cell of a log");
    for more in [
        &["analyze", "--format", "json"][..],
        &["analyze", "-o", "out"],
        &["analyze", "--allan-estimator", "modified"],
        &["filter", "--filters", "rls.toml"],
    ] {
        let output = fogbench(folder.path(), &[&more[..1], &on[..], &more[1..]].concat());
        let said = stderr(&output);
        assert_eq!(code(&output), 2, "{more:?}: {said}");
        transcript.case(more.join(" "), said);
    }
    transcript.check();
    assert!(!folder.path().join("out").exists());
}

#[test]
fn logs_of_odd_but_possible_words_are_measured_in_finite_numbers() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(
        folder.path(),
        "f.toml",
        "schema = 1\n[[filter]]\nname = \"rls\"\n[filter.rls]\n[[filter]]\nname = \"lms\"\n\
         [filter.lms]\n[[filter]]\nname = \"line\"\n[filter.sign_lms]\n[[filter]]\n\
         name = \"kalman\"\n[filter.kalman]\n[[filter]]\nname = \"held\"\n[filter.constrained_rls]\n",
    );
    let alternating = |size: f64| move |k: u32| if k.is_multiple_of(2) { size } else { -size };
    type Word = Box<dyn Fn(u32) -> f64>;
    let cases: [(&str, Word); 7] = [
        ("zeros", Box::new(|_| 0.0)),
        ("constant", Box::new(|_| 7.25)),
        ("largest", Box::new(alternating(1e12))),
        ("smallest", Box::new(alternating(5e-324))),
        (
            "squares below binary64",
            Box::new(|k| 1e-200 * f64::from(k % 7)),
        ),
        (
            "one large word",
            Box::new(|k| {
                if k == 900 {
                    1e12
                } else {
                    1e-12 * f64::from(k % 5)
                }
            }),
        ),
        ("ramp", Box::new(|k| 1e8 * f64::from(k))),
    ];
    for (name, word) in &cases {
        let log: Vec<f64> = (0..2000).map(word).collect();
        write(folder.path(), "log.csv", &text_of(&log));
        let on = [
            "log.csv",
            "--unit",
            "deg/h",
            "--rate-hz",
            "1000",
            "--bias-averaging-time-s",
            "0.1",
        ];
        for (command, more) in [("analyze", &[][..]), ("filter", &["--filters", "f.toml"])] {
            for form in [&["--format", "json"][..], &["-o", "out"]] {
                let arguments = [&[command], &on[..], more, form].concat();
                let output = fogbench(folder.path(), &arguments);
                let said = stderr(&output);
                // A filter that gives up on such words says so.
                assert!([0, 3].contains(&code(&output)), "{name}, {command}: {said}");
                assert!(
                    !has_no_number(&stdout(&output)),
                    "{name}: {}",
                    stdout(&output)
                );
            }
        }
        for (path, bytes) in tree(&folder.path().join("out")) {
            let is_text = path.extension().is_some_and(|it| it != "npy");
            let text = String::from_utf8_lossy(&bytes);
            assert!(
                !is_text || !has_no_number(&text),
                "{name}: {}",
                path.display()
            );
        }
    }
}

#[test]
fn measuring_words_whose_squares_overflow_ends_with_reasons() {
    // Far beyond what a reader lets in: the library alone must come to an end too.
    let values: Vec<f64> = words(4000).iter().map(|word| word * 1e199).collect();
    let truth: Vec<f64> = (0..4000)
        .map(|k| 1e200 * (0.01 * f64::from(k)).sin())
        .collect();
    for motion in [
        Motion::Steady,
        Motion::Swing { frequency_hz: 5.0 },
        Motion::General,
    ] {
        let record = Record {
            channel_deg_per_h: &values,
            raw_deg_per_h: &values,
            truth_deg_per_h: Rates::Words(&truth),
            response_deg_per_h: &[],
            encoder_rad: None,
            sample_period_s: 1e-3,
            first_stamp_s: 1e-3,
            drift: None,
        };
        let settings = Settings {
            motion,
            bias_averaging_time_s: 0.1,
            fit_tau_min_s: 0.01,
            allan: AllanOptions::default(),
            bridges: Vec::new(),
        };
        let table = measure(&record, &settings, None);
        for (name, metric) in &table.metrics {
            let estimate = metric.estimate;
            let ends = [estimate.value, estimate.low, estimate.high];
            assert!(ends.iter().all(|it| it.is_finite()), "{name}: {estimate:?}");
        }
        let points = table
            .curves
            .values()
            .flat_map(|curve| curve.values())
            .flatten();
        assert!(points.copied().all(f64::is_finite));
        let reasons = table.unavailable.values();
        assert!(
            reasons
                .filter(|reason| reason.as_str().contains("no finite number"))
                .count()
                > 0,
            "{:?}",
            table.unavailable
        );
    }
}

#[test]
fn optimal_weights_of_a_second_moment_that_is_not_finite_are_none() {
    let shape = FilterShape {
        taps: Some(4),
        newest_age_samples: 1,
        register_samples: 0,
        rule: WeightRule::Adaptive {
            desired_weights: vec![1.0],
            is_dc_gain_one: false,
            forgetting_factor: None,
        },
    };
    let moment = |last: f64| [1.0, 0.5, 0.25, 0.125, 0.1, 0.05, 0.02, last];
    assert!(predict(&shape, &moment(0.01)).is_some());
    let mut broken = moment(0.01);
    for value in [f64::INFINITY, f64::NAN] {
        broken[2] = value;
        assert!(predict(&shape, &broken).is_none(), "{value}");
    }
}

#[test]
fn options_without_a_physical_meaning_exit_2_with_their_range() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "log.csv", &text_of(&words(200)));
    let analyze = "analyze log.csv --unit deg/h --rate-hz";
    let export = "export waveform waves --stimulus log.csv";
    let cases = [
        format!("{analyze} 5e-324"),
        format!("{analyze} 1e-200"),
        format!("{analyze} 100 --bias-averaging-time-s 1e-300"),
        format!("{analyze} 100 --bias-averaging-time-s 0.009"),
        format!("{analyze} 100 --motion swing:5e-324"),
        format!("{analyze} 100 --scale 1e-300"),
        format!("{analyze} 100 --fit-tau-min-s 5e-324"),
        "timing --clock-mhz 5e-324".to_owned(),
        format!("{export} --clock-mhz 1e-12"),
        format!("{export} --samples 18446744073709551615"),
        "timing --forgetting-factor 5e-324".to_owned(),
    ];
    said_to_each(
        "bounds",
        "Options without a physical meaning",
        cases,
        |arguments| {
            let words: Vec<&str> = arguments.split(' ').collect();
            let output = fogbench(folder.path(), &words);
            assert_eq!(code(&output), 2, "{arguments}: {}", stderr(&output));
            stderr(&output)
        },
    );
    assert!(!folder.path().join("waves").exists());
    let slowest = fogbench(folder.path(), &["timing", "--clock-mhz", "0.001"]);
    assert!(!has_no_number(&stdout(&slowest)) && code(&slowest) == 0);
    let slow = format!("{export} --clock-mhz 0.001");
    let waves = fogbench(folder.path(), &slow.split(' ').collect::<Vec<_>>());
    assert_eq!(code(&waves), 0, "{}", stderr(&waves));
}

#[test]
fn a_bias_stability_is_labelled_with_the_time_that_was_averaged() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    write(folder.path(), "log.csv", &text_of(&words(2000)));
    let measured = |rate_hz: &str, time_s: &str| {
        let log = ["analyze", "log.csv", "--unit", "deg/h", "--format", "json"];
        let options = ["--rate-hz", rate_hz, "--bias-averaging-time-s", time_s];
        let output = fogbench(folder.path(), &[&log[..], &options].concat());
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        serde_json::from_str::<Value>(&stdout(&output)).expect("JSON")
    };
    let label = |summary: &Value, field_name: &str| {
        field(summary, "raw.bias_stability_deg_per_h", field_name)
    };
    let coarse = measured("1", "1.4");
    assert_eq!(
        label(&coarse, "averaging_time_s").to_bits(),
        1.0_f64.to_bits()
    );
    assert_eq!(label(&coarse, "block_samples").to_bits(), 1.0_f64.to_bits());
    // Half a sample in a hundred seconds of 4 kHz is no reason for another name.
    let fine = measured("3989.45", "0.0501");
    assert_eq!(
        label(&fine, "averaging_time_s").to_bits(),
        0.0501_f64.to_bits()
    );
    // One sample in ten seconds has no mean over one second.
    let slow = measured("0.1", "100");
    let reasons = &slow["channels"]["raw"]["unavailable"];
    let mut transcript = Transcript::of("metrics", "Means over less than a sample");
    let reason = &reasons["bias_stability_1s_deg_per_h"];
    transcript.case(
        "--rate-hz 0.1, bias_stability_1s_deg_per_h",
        reason.as_str().expect("a reason"),
    );
    transcript.check();
}

#[test]
fn a_bias_averaging_time_below_a_sample_is_refused_with_its_line() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = "schema = 1\nname = \"a\"\nduration_s = 1.0\nbias_averaging_time_s = 1e-6\n";
    write(folder.path(), "a.toml", text);
    let output = fogbench(folder.path(), &["check", "a.toml"]);
    assert_eq!(code(&output), 2, "{}", stderr(&output));
    let mut transcript = Transcript::of("bounds", "A bias averaging time below a sample");
    transcript.case(text, stderr(&output));
    transcript.check();
}

/// A scenario with so many moving averages.
fn averages(count: usize, duration: &str, more: &str) -> String {
    let mut text = format!(
        "schema = 1\nname = \"many\"\n{duration}\nwarm_up_s = 0.5\nfidelity = \"rate\"\n\
         bias_averaging_time_s = 0.1\n{more}"
    );
    for index in 1..=count {
        let filter =
            format!("[[filter]]\nname = \"f{index}\"\n[filter.moving_average]\ntaps = {index}\n");
        text.push_str(&filter);
    }
    text
}

#[test]
fn a_picture_that_would_be_too_large_is_thinned_or_left_out_with_a_note() {
    let all = "[allan]\naveraging_times = \"all\"\n";
    for (count, duration, more) in [
        (15, "duration_s = 20.0", all),
        (120, "duration_s = 0.2", ""),
    ] {
        let folder = tempfile::tempdir().expect("a scratch folder");
        write(folder.path(), "many.toml", &averages(count, duration, more));
        let output = fogbench(folder.path(), &["run", "many.toml", "-o", "out"]);
        assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
        let run = folder.path().join("out/many");
        let notes = summary(&folder.path().join("out"), "many")["notes"].to_string();
        for name in ["allan.svg", "rate.svg", "filter-response.svg"] {
            match std::fs::read(run.join(name)) {
                Ok(svg) => assert!(
                    svg.len() <= SVG_BYTES_MAX && svg.ends_with(b"</svg>\n"),
                    "{name}"
                ),
                Err(_) => assert!(notes.contains(&format!("{name} is left out")), "{notes}"),
            }
        }
        // The curves themselves lose no point; fifteen of them fit into the picture.
        assert!(run.join("allan.csv").is_file());
        assert!(count > 15 || run.join("allan.svg").is_file(), "{notes}");
    }
}

/// Group means of an assembly without errors, standard errors of gyro x as given.
fn groups(errors: [&str; 4]) -> String {
    let mut text = String::from(
        "mounting,rate_deg_per_s,temperature_c,reference_x_deg_per_s,reference_y_deg_per_s,\
         reference_z_deg_per_s,output_x_deg_per_h,output_y_deg_per_h,output_z_deg_per_h,\
         standard_error_x_deg_per_h,standard_error_y_deg_per_h,standard_error_z_deg_per_h\n",
    );
    for (index, (axis, rate)) in [(0, 10.0), (0, 50.0), (1, 50.0), (2, 50.0)]
        .iter()
        .enumerate()
    {
        let rates: [f64; 3] = [0, 1, 2].map(|own| if own == *axis { *rate } else { 0.0 });
        let [x, y, z] = rates;
        let outputs = rates.map(|it| it * 3600.0 + 0.5);
        let error = errors[index];
        let line = format!(
            "{},{rate},25.0,{x},{y},{z},{},{},{},{error},0.1,0.1\n",
            ["x", "y", "z"][*axis],
            outputs[0],
            outputs[1],
            outputs[2]
        );
        text.push_str(&line);
    }
    text
}

#[test]
fn standard_errors_that_no_mean_has_are_refused_with_their_line() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    for (errors, line) in [
        (["0.1"; 4], None),
        (["0"; 4], None),
        (["0.1", "1e-300", "0.1", "0.1"], Some(3)),
        (["0.1", "0.1", "0.1", "0"], Some(5)),
        (["5e-324"; 4], Some(2)),
    ] {
        write(folder.path(), "groups.csv", &groups(errors));
        for form in ["text", "json"] {
            let output = fogbench(
                folder.path(),
                &["calibrate", "groups.csv", "--format", form],
            );
            let (said, printed) = (stderr(&output), stdout(&output));
            assert_eq!(
                code(&output),
                if line.is_some() { 2 } else { 0 },
                "{errors:?}: {said}"
            );
            assert!(!has_no_number(&printed), "{errors:?}: {printed}");
            if let Some(line) = line {
                let place = format!("groups.csv:{line}: the standard error of x, ");
                assert!(
                    said.contains(&place) && said.contains("allowed from 1e-9 deg/h on"),
                    "{said}"
                );
            }
        }
    }
}
