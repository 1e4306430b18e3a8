//! Gates and reports, on a small run with every kind of record.

use crate::support::junit::assert_valid;
use crate::support::run;
use crate::support::transcript::{Transcript, said_to_each};
use fogbench::comparison::Comparison;
use fogbench::gate::{Verdict, VerdictKind, judge};
use fogbench::metrics::ChannelMetrics;
use fogbench::metrics::catalogue::{ALLAN, PSD};
use fogbench::report::{
    RunOutcome, RunReport, RunStatus, SVG_BYTES_MAX, SuiteReport, curve_csv, junit_xml, plots,
    run_summary_json, suite_text, table_text, write_suite_summary,
};
use fogbench::scenario::{AssumedInShort, GateConfig, GateDecision, InconclusivePolicy, Scenario};
use fogbench::signal::{GyroFacts, Rates, RunSignals, TheoryCurve, TheoryQuantity};

fn gate(metric: &str, min: Option<f64>, max: Option<f64>) -> GateConfig {
    GateConfig {
        metric: metric.to_owned(),
        min,
        max,
        decide: GateDecision::Interval,
        inconclusive: InconclusivePolicy::Fail,
        ..GateConfig::reference()
    }
}

fn verdict(gate: &GateConfig) -> Verdict {
    judge(gate, &run::channels(), None)
}

#[test]
fn a_gate_passes_fails_or_stays_undecided_by_its_interval() {
    let kind = |min, max| verdict(&gate("rls.delay_vs_raw_ms", min, max)).kind;
    assert_eq!(kind(Some(0.33), Some(0.35)), VerdictKind::Pass);
    assert_eq!(kind(Some(0.342), None), VerdictKind::Fail);
    assert_eq!(kind(None, Some(0.338)), VerdictKind::Fail);
    assert_eq!(kind(Some(0.3395), Some(0.35)), VerdictKind::Inconclusive);
    let passed = verdict(&gate("rls.delay_vs_raw_ms", Some(0.33), Some(0.35)));
    assert!(passed.accepted);
    assert_eq!(
        passed.reason,
        "0.34000 ±0.00100 ms (95 % interval) lies inside [0.33, 0.35] ms"
    );
}

#[test]
fn an_undecided_gate_is_accepted_only_where_it_says_so() {
    let mut straddles = gate("rls.delay_vs_raw_ms", Some(0.3395), None);
    assert!(!verdict(&straddles).accepted);
    straddles.inconclusive = InconclusivePolicy::Allow;
    let allowed = verdict(&straddles);
    assert_eq!(allowed.kind, VerdictKind::Inconclusive);
    assert!(allowed.accepted);
    straddles.decide = GateDecision::Value;
    assert_eq!(verdict(&straddles).kind, VerdictKind::Pass);
}

#[test]
fn a_relative_gate_judges_the_widest_ratio() {
    let metric = "rls.angle_random_walk_deg_per_sqrt_h";
    let mut ratio = gate(metric, Some(0.48), Some(0.51));
    ratio.relative_to = Some("lms".to_owned());
    let judged = verdict(&ratio);
    assert_eq!(judged.kind, VerdictKind::Pass);
    let (low, high) = (judged.low.unwrap(), judged.high.unwrap());
    crate::support::assert_close(low, 0.002_87 / 0.005_97, 1e-12, 0.0);
    crate::support::assert_close(high, 0.002_93 / 0.005_84, 1e-12, 0.0);
    assert_eq!(judged.unit, "1");

    // A divisor that may be zero leaves the ratio unbounded.
    let mut channels = run::channels();
    let divisor = channels[1]
        .1
        .metrics
        .get_mut("angle_random_walk_deg_per_sqrt_h");
    divisor.unwrap().estimate.low = -1e-9;
    let unbounded = judge(&ratio, &channels, None);
    assert_eq!(unbounded.kind, VerdictKind::Inconclusive);
    assert_eq!((unbounded.low, unbounded.high), (None, None));

    // A divisor that is zero leaves no ratio at all.
    let divisor = channels[1]
        .1
        .metrics
        .get_mut("angle_random_walk_deg_per_sqrt_h");
    divisor.unwrap().estimate = fogbench::metrics::Estimate::exact(0.0);
    let judged = judge(&ratio, &channels, None);
    assert_eq!((judged.kind, judged.value), (VerdictKind::Fail, None));
    assert_eq!(
        judged.reason,
        "`lms.angle_random_walk_deg_per_sqrt_h` is 0, so that the ratio to it has no value"
    );
}

#[test]
fn a_gate_without_a_number_fails_and_says_why() {
    let metrics = [
        "nobody.dc_gain",
        "raw.settling_time_s",
        "rls.rate_random_walk_deg_per_h_per_sqrt_h",
        "bad.dc_gain",
        "rls.diverged_at_s",
        "dc_gain",
    ];
    said_to_each(
        "gates",
        "Gates without a number fail and say why",
        metrics,
        |metric| {
            let judged = verdict(&gate(metric, Some(f64::MIN), Some(f64::MAX)));
            assert_eq!((judged.kind, judged.accepted), (VerdictKind::Fail, false));
            judged.reason
        },
    );
    let mut transcript = Transcript::of("gates", "Gates without a limit or an interval");
    let unlimited = verdict(&gate("rls.dc_gain", None, None));
    transcript.case("rls.dc_gain without a limit", unlimited.reason);
    let exact = verdict(&gate("bad.diverged_at_s", Some(1.0), Some(2.0)));
    transcript.case(
        "bad.diverged_at_s, which has no interval, in 1 to 2",
        exact.reason,
    );
    transcript.check();
}

#[test]
fn divergence_can_be_expected() {
    let judged = verdict(&gate("bad.diverged_at_s", Some(1.0), Some(2.0)));
    assert_eq!(judged.kind, VerdictKind::Pass);
}

/// The parts that a report borrows.
struct Fixture {
    scenario: Scenario,
    gyro: GyroFacts,
    channels: Vec<(String, ChannelMetrics)>,
    verdicts: Vec<Verdict>,
}

impl Fixture {
    fn new(motion: &str, gates: &[GateConfig]) -> Self {
        let channels = run::channels();
        let place = || Some("/home/somebody/x.toml:12".to_owned());
        Self {
            scenario: run::scenario(motion),
            gyro: run::gyro(),
            verdicts: gates
                .iter()
                .map(|gate| judge(gate, &channels, place()))
                .collect(),
            channels,
        }
    }

    fn usual() -> Self {
        let mut undecided = gate("rls.delay_vs_raw_ms", Some(0.3395), None);
        undecided.inconclusive = InconclusivePolicy::Allow;
        let gates = [
            gate("rls.delay_vs_raw_ms", Some(0.33), Some(0.35)),
            gate("lms.dc_gain", None, Some(0.5)),
            undecided,
        ];
        Self::new("static = {}", &gates)
    }

    fn report(&self) -> RunReport<'_> {
        RunReport {
            compensation: None,
            tool_version: "0.1.0",
            scenario: &self.scenario,
            file: "scenarios/fixture.toml",
            digest: "d1",
            sweep: Some((
                3,
                vec![("gyro.source.power_uw".to_owned(), "0.87".to_owned())],
            )),
            points: 5,
            gyro: Some(&self.gyro),
            log: None,
            theory: &[],
            channels: &self.channels,
            calibration: None,
            verdicts: &self.verdicts,
            notes: &[],
            assumed: AssumedInShort::default(),
        }
    }
}

#[test]
fn a_summary_has_the_documented_shape() {
    let fixture = Fixture::usual();
    let text = run_summary_json(&fixture.report());
    assert!(text.ends_with("}\n") && !text.contains("null") && !text.contains("/home"));
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    let keys: Vec<&String> = json.as_object().unwrap().keys().collect();
    let documented = [
        "schema",
        "tool",
        "scenario",
        "gyro",
        "intervals",
        "channels",
        "published",
        "gates",
    ];
    assert_eq!(keys, documented);
    assert_eq!(json["schema"], 1);
    assert_eq!(json["scenario"]["fidelity"], "loop");
    assert_eq!(json["scenario"]["sweep"]["index"], 3);
    let budget = &json["gyro"]["angle_random_walk_budget_deg_per_sqrt_h"];
    assert_eq!(budget["total"], 0.006);
    let channels: Vec<&String> = json["channels"].as_object().unwrap().keys().collect();
    assert_eq!(channels, ["raw", "lms", "rls", "bad"]);
    assert_eq!(
        json["channels"]["rls"]["bias_stability_deg_per_h"],
        serde_json::json!({"value": 0.0606, "low": 0.0495, "high": 0.0782, "confidence": 0.95,
            "unit": "deg/h", "averaging_time_s": 100.0, "count": 36.0})
    );
    assert_eq!(json["channels"]["raw"]["curves"]["allan"]["tau_s"][1], 1.0);
    assert_eq!(json["channels"]["bad"]["error"]["sample"], 5984);
    assert!(json["channels"]["rls"]["unavailable"].is_object());
    assert_eq!(json["published"][0]["source"], "paper, section 4.2");
    assert_eq!(json["gates"][0]["verdict"], "pass");
    assert_eq!(json["gates"][0]["max"], 0.35);
    assert_eq!(json["gates"][1]["verdict"], "fail");
}

#[test]
fn a_number_that_is_not_finite_is_unavailable_and_takes_nothing_with_it() {
    let mut fixture = Fixture::usual();
    let table = &mut fixture.channels[0].1;
    let metric = table.metrics.get_mut("noise_gain").unwrap();
    metric.estimate.high = f64::INFINITY;
    metric.fields.insert("count", f64::NAN);
    let curve = table.curves.get_mut("allan").unwrap();
    curve.insert("fitted".to_owned(), vec![1.0, f64::NAN]);
    let text = run_summary_json(&fixture.report());
    let json: serde_json::Value = serde_json::from_str(&text).expect("JSON, whatever reaches it");
    assert!(json["channels"]["raw"]["noise_gain"]["high"].is_null());
    assert!(!text.contains("null"), "no null passes for a number");

    fixture.channels[0].1.keep_finite();
    let text = run_summary_json(&fixture.report());
    let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let raw = &json["channels"]["raw"];
    assert!(raw["noise_gain"].is_null() && raw["curves"]["allan"].is_null());
    let reasons = &raw["unavailable"];
    assert_eq!(reasons["noise_gain"], "the record gives no finite number");
    assert_eq!(
        reasons["curves.allan"],
        "the record gives no finite number for a point of fitted"
    );
    assert!(
        raw["angle_random_walk_deg_per_sqrt_h"].is_object(),
        "the rest stays"
    );
}

#[test]
fn a_run_ends_by_its_worst_part() {
    let fixture = Fixture::usual();
    let mut outcome = RunOutcome::from_report(&fixture.report(), "fixture/0003");
    assert_eq!(outcome.status(), RunStatus::ChannelFailed);
    outcome.channels.pop();
    assert_eq!(outcome.status(), RunStatus::GateFailed);
    outcome.verdicts.remove(1);
    assert_eq!(outcome.status(), RunStatus::Pass);

    let expected = [gate("bad.diverged_at_s", Some(1.0), Some(2.0))];
    let fixture = Fixture::new("static = {}", &expected);
    let outcome = RunOutcome::from_report(&fixture.report(), "fixture");
    assert_eq!(outcome.status(), RunStatus::Pass);
}

fn suite() -> Vec<RunOutcome> {
    let fixture = Fixture::usual();
    let bare = Fixture::new("static = {}", &[]);
    let mut quiet = RunOutcome::from_report(&bare.report(), "quiet");
    quiet.channels.pop();
    vec![
        RunOutcome::from_report(&fixture.report(), "fixture"),
        quiet,
        RunOutcome::failed("broken", "broken", "b.toml", "no <space> left".to_owned()),
    ]
}

#[test]
fn junit_has_a_case_for_every_gate_and_failure_and_repeats_to_the_byte() {
    let xml = junit_xml(&suite(), None, None);
    assert_eq!(xml, junit_xml(&suite(), None, None));
    for attribute in ["timestamp=", "time=", "uuid=", "hostname=", "/home"] {
        assert!(!xml.contains(attribute), "{attribute} in {xml}");
    }
    assert_eq!(xml.matches("<testsuite ").count(), 3);
    // Three times `run`, one failed channel, three gates.
    assert_eq!(xml.matches("<testcase ").count(), 7);
    assert_eq!(xml.matches("<error ").count(), 2);
    assert_eq!(xml.matches("<failure ").count(), 1);
    assert_eq!(xml.matches("<skipped ").count(), 1);
    assert!(xml.contains("lies outside &lt;= 0.5") && xml.contains("no &lt;space&gt; left"));
    assert_valid(&xml);
}

#[test]
fn the_suite_is_counted() {
    let report = SuiteReport {
        tool_version: "0.1.0",
        runs: &suite(),
        across: &Comparison::default(),
        stale: &[],
        against: None,
    };
    let mut text = Vec::new();
    write_suite_summary(&mut text, &report, &|_| Ok(None)).unwrap();
    let json: serde_json::Value = serde_json::from_slice(&text).unwrap();
    assert_eq!(json["runs"][0]["status"], "channel_failed");
    assert_eq!(json["runs"][1]["status"], "pass");
    assert_eq!(json["runs"][2]["status"], "run_failed");
    assert_eq!(json["totals"]["gates_inconclusive"], 1);
    let text = suite_text(&suite(), 100, false);
    let last = text.lines().last().unwrap();
    assert!(last.starts_with("FAIL  3 runs: 1 passed"), "{last}");
    // The message of a failed channel stands below its line and within the width.
    assert!(text.contains("channel bad at sample 5984: "), "{text}");
    let narrow = suite_text(&suite(), 40, false);
    let message = narrow.split("channel bad").nth(1).unwrap();
    assert!(message.lines().next().unwrap().len() <= 28, "{narrow}");
}

#[test]
fn a_table_shows_published_figures_beside_the_simulated_ones() {
    let fixture = Fixture::usual();
    let text = table_text(&fixture.report(), 100, false);
    assert!(!text.contains('\u{1b}'));
    let row = text
        .lines()
        .find(|line| line.contains("paper, section 4.2"))
        .unwrap();
    assert!(row.contains("0.25") && row.contains("0.34") && row.contains("+0.09 (+36.0 %)"));
    assert!(text.contains("simulated raw 0.006012 ±0.000062"), "{text}");
    assert!(text.contains("FAILED channel bad") && text.contains("FAIL lms.dc_gain"));
    assert!(table_text(&fixture.report(), 100, true).contains("\u{1b}[32mPASS\u{1b}[0m"));
}

#[test]
fn curves_become_one_row_per_channel_and_point() {
    let fixture = Fixture::usual();
    let csv = curve_csv(&ALLAN, &fixture.channels).unwrap();
    let head = "channel,tau_s,deviation_deg_per_h,high_deg_per_h,low_deg_per_h";
    assert_eq!(csv.lines().next().unwrap(), head);
    assert_eq!(csv.lines().nth(2).unwrap(), "raw,1.0,0.36,0.37,0.35");
    assert!(curve_csv(&PSD, &fixture.channels).is_none());
}

#[test]
fn pictures_of_a_long_record_are_small_and_repeat_to_the_byte() {
    const COUNT: usize = 2_000_000;
    let motion =
        "swing = { rate_amplitude_deg_per_s = 1.0, frequency_hz = 5.0, soft_start_s = 1.0 }";
    let fixture = Fixture::new(motion, &[]);
    let period_s = 1.0 / 3989.45;
    // A sine plus steps of plus or minus 40 deg/h in a fixed disorder.
    let delayed = |delay_s: f64, jump: f64| -> Vec<f64> {
        (0..COUNT)
            .map(|index| {
                let time = (index + 1) as f64 * period_s - delay_s;
                let sign = if index * index % 7 < 3 { jump } else { -jump };
                3600.0 * (std::f64::consts::TAU * 5.0 * time).sin() + sign
            })
            .collect()
    };
    let (truth, raw, lms) = (delayed(0.0, 0.0), delayed(2e-4, 40.0), delayed(6e-4, 20.0));
    let signals = RunSignals {
        sample_period_s: period_s,
        first_measured: 4000,
        prefix: "",
        truth_deg_per_h: Rates::Words(&truth),
        encoder_rad: None,
        input_digest: None,
        channels: vec![("raw", &raw), ("lms", &lms), ("rls", &raw), ("bad", &raw)],
        temperature: None,
    };
    let pictures = plots(&fixture.report(), &signals).drawn;
    let names: Vec<&str> = pictures.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["rate.svg", "allan.svg", "swing.svg"]);
    for (name, svg) in &pictures {
        assert!(
            svg.len() <= SVG_BYTES_MAX && svg.ends_with("</svg>\n"),
            "{name}"
        );
        assert!(
            !svg.contains("NaN") && svg.contains("stroke-dasharray"),
            "{name}"
        );
    }
    assert!(pictures[2].1.contains("behind raw"));
    assert_eq!(pictures, plots(&fixture.report(), &signals).drawn);
}

/// Samples for pictures that are drawn from curves.
fn quiet_signals(zeros: &[f64]) -> RunSignals<'_> {
    RunSignals {
        sample_period_s: 1e-3,
        first_measured: 0,
        prefix: "",
        encoder_rad: None,
        truth_deg_per_h: Rates::Words(zeros),
        input_digest: None,
        channels: vec![("raw", zeros), ("lms", zeros)],
        temperature: None,
    }
}

fn theory(quantity: TheoryQuantity, x: [f64; 2], y: [f64; 2]) -> TheoryCurve {
    TheoryCurve {
        name: "closed form",
        quantity,
        x: x.to_vec(),
        y: y.to_vec(),
    }
}

#[test]
fn several_sines_are_drawn_with_the_line_of_theory() {
    let motion = "multi_sine = { frequencies_hz = [5.0, 50.0], \
                  rate_amplitudes_deg_per_s = [1.0], phases = \"zero\", soft_start_s = 0.0 }";
    let mut fixture = Fixture::new(motion, &[]);
    let column = |name: &'static str, middle: f64, half_width: f64| {
        let (quantity, unit) = name.split_once('/').unwrap();
        [("", 0.0), ("_low", -half_width), ("_high", half_width)]
            .map(|(end, shift)| (format!("{quantity}{end}{unit}"), vec![middle + shift; 2]))
    };
    for (_, metrics) in &mut fixture.channels[..2] {
        let curve = [
            column("gain/", 0.9, 0.05),
            column("phase/_deg", -20.0, 3.0),
            column("delay/_ms", 1.0, 0.1),
        ];
        let frequencies = [("frequency_hz".to_owned(), vec![5.0, 50.0])];
        let curve = curve.into_iter().flatten().chain(frequencies).collect();
        metrics
            .curves
            .insert("frequency_response".to_owned(), curve);
    }
    let lines = [
        theory(TheoryQuantity::GainDb, [5.0, 50.0], [0.0, -3.0]),
        theory(TheoryQuantity::PhaseDeg, [5.0, 50.0], [0.0, -90.0]),
    ];
    let zeros = [0.0; 64];
    let drawn = |theory: &[TheoryCurve]| {
        let report = RunReport {
            theory,
            ..fixture.report()
        };
        let pictures = plots(&report, &quiet_signals(&zeros)).drawn;
        let bode = pictures.into_iter().find(|(name, _)| name == "bode.svg");
        bode.expect("a response is drawn").1
    };
    let (with, without) = (drawn(&lines), drawn(&[]));
    assert!(with.contains("closed form") && !without.contains("closed form"));
    // The phase axis reaches down to the line of theory.
    assert!(with.contains("\n-80\n") && !without.contains("\n-80\n"));
}

#[test]
fn a_staircase_of_three_rates_is_drawn_as_a_response() {
    let motion = "steps = { rates_deg_per_s = [-1.0, 0.0, 1.0], dwell_s = 1.0, settle_s = 0.1 }";
    let mut fixture = Fixture::new(motion, &[]);
    let curve_of = |count: usize| {
        let input: Vec<f64> = [-3600.0, 0.0, 3600.0][..count].to_vec();
        run::curve(&[
            ("output_deg_per_h", input.clone()),
            ("error_deg_per_h", vec![0.25; count]),
            ("error_low_deg_per_h", vec![0.0; count]),
            ("error_high_deg_per_h", vec![0.5; count]),
            ("input_deg_per_h", input),
        ])
    };
    let lines = [theory(
        TheoryQuantity::RateErrorDegPerH,
        [-3600.0, 3600.0],
        [-9.0, 9.0],
    )];
    let zeros = [0.0; 64];
    let mut response = |count: usize| {
        let curves = &mut fixture.channels[0].1.curves;
        curves.insert("response".to_owned(), curve_of(count));
        let report = RunReport {
            theory: &lines,
            ..fixture.report()
        };
        let pictures = plots(&report, &quiet_signals(&zeros)).drawn;
        pictures
            .into_iter()
            .find(|(name, _)| name == "response.svg")
    };
    assert!(response(2).is_none());
    let svg = response(3).expect("three dwells are drawn").1;
    assert!(svg.contains("closed form") && svg.contains("true rate [deg/h]"));
    assert!(
        svg.contains("\n-5\n"),
        "the error axis reaches the line of theory"
    );
}
