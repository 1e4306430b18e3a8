//! Calibration campaigns on the table: geometry, groups, estimates, files and refusals.

use std::path::Path;

use fogbench::gyro::coil_temperatures_c;
use fogbench::scenario::{MotionConfig, Scenario, load_suite};
use fogbench::signal::MotionSegment;
use fogbench::turntable::{Turntable, campaign_angles_rad};
use serde_json::Value;

use crate::support::transcript::{Transcript, said_to_each};
use crate::support::{
    assert_close, code, field, fogbench, npy, repository, stderr, stdout, summary, tree, write,
};

/// Everything but the motion: the patent's assembly, warm, without noise, rounding or drift.
const SILENT: &str = "[gyro.noise]\nshot = false\nthermal = false\namplifier = false\nrin = false\n\
    technical_phase_urad_per_sqrt_hz = 0.0\n[gyro.adc]\nbits = 0\n[gyro.modulator]\ndac_bits = 0\n";

/// One turn at 10 deg/s, five at 50 and nine at 90 take 36 s.
const GROUPS: &str = "[turntable.calibration]\naxes = [\"x\", \"x\", \"y\", \"y\", \"z\", \"z\"]\n\
    rates_deg_per_s = [10.0, -90.0, 50.0, 0.0, 90.0, -10.0]\nrecord_s = 36.0\nchange_s = 8.0\n\
    remount_s = 32.0\n";

fn base(name: &str, duration_s: f64) -> String {
    let base = repository("scenarios/base/patent.toml");
    format!(
        "schema = 1\nname = \"{name}\"\nextends = \"{}\"\nduration_s = {duration_s:?}\n",
        base.display()
    )
}

/// At the reference temperature of 40 C all the time.
const WARM: &str = "[gyro.temperature.soak]\ntemperature_c = 20.0\n[gyro.thermal]\n\
    warm_up = \"settled\"\n";

fn run(folder: &Path, name: &str, text: &str) -> Value {
    write(folder, &format!("{name}.toml"), text);
    let output = fogbench(folder, &["run", &format!("{name}.toml"), "-o", "out"]);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    summary(&folder.join("out"), name)
}

fn reals(value: &Value) -> Vec<f64> {
    let values = value.as_array().expect("an array");
    values
        .iter()
        .map(|value| value.as_f64().expect("a number"))
        .collect()
}

fn shipped(name: &str) -> Scenario {
    let file = repository(&format!("scenarios/patent/{name}.toml"));
    let runs = load_suite(&[file], &[]).expect("a sound scenario");
    runs[0].scenario.clone()
}

#[test]
fn a_silent_campaign_gives_back_the_parameters_of_the_assembly() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let settings = "[calibration]\nestimators = [\"arls\"]\napply = \"batch\"\n\
        [output]\nsamples = \"npy\"\n[gyro.output]\nrate_lsb_deg_per_s = 0.0\n\
        [[gate]]\nmetric = \"calibration_batch.bias_error_rms_deg_per_h\"\nmax = 0.01\n";
    let text = format!("{}{GROUPS}{SILENT}{WARM}{settings}", base("silent", 328.0));
    let summary = run(folder.path(), "silent", &text);
    let estimate = &summary["calibration"]["estimates"]["batch"];
    // The 36 s are cut at a sample: half of one at 10 deg/s is 1/720 of the turn, which leaves
    // 12.75 deg/h / 720 = 0.018 deg/h at most and a third of it in the bias.
    assert!(field_of(estimate, "bias_rms_deg_per_h") < 0.01);
    assert!(field_of(estimate, "scale_factor_rms_ppm") < 0.05);
    assert!(field_of(estimate, "misalignment_rms_arcsec") < 0.02);
    let applied = &summary["calibration"]["estimates"];
    assert!(
        applied.get("arls").is_some(),
        "those asked for run beside it"
    );
    assert_eq!(summary["gates"][0]["verdict"], "pass");
    let forms = &summary["calibration"]["compensation"];
    let exact = forms["exact"]["error_max_deg_per_h"].as_f64();
    assert!(exact.expect("a number") < 0.05);
    // -(D D W + D B) of the study's assembly: 0.57 deg/h at 90 deg/s about y, here 50 about y.
    let first = forms["first-order"]["residual_max_deg_per_h"].as_f64();
    assert!((0.2..0.6).contains(&first.expect("a number")));
    reference_rates_are_those_of_the_case(folder.path(), &summary);
}

fn field_of(estimate: &Value, key: &str) -> f64 {
    estimate["error"][key].as_f64().expect("a number")
}

/// The rates that a laboratory believes in against the true ones of the simulated case.
fn reference_rates_are_those_of_the_case(folder: &Path, summary: &Value) {
    let samples = folder.join("out/silent/samples");
    let truth = ["x", "y", "z"].map(|axis| npy(&samples.join(format!("{axis}_truth.npy"))));
    let time_s = npy(&samples.join("time_s.npy"));
    let groups = summary["calibration"]["groups"].as_array().expect("groups");
    assert_eq!(groups.len(), 6);
    for group in groups {
        let start_s = 15.0 + group["start_s"].as_f64().expect("a start");
        let rates = reals(&group["reference_rate_deg_per_s"]);
        let is_within = |time: f64| time > start_s + 0.2 && time < start_s + 36.0;
        let turning = group["rate_deg_per_s"].as_f64().expect("a rate");
        for (axis, rates_deg_per_h) in truth.iter().enumerate() {
            let inside = time_s.iter().zip(rates_deg_per_h);
            let inside: Vec<f64> = inside
                .filter(|(time, _)| is_within(**time))
                .map(|(_, rate)| *rate)
                .collect();
            let mean = inside.iter().sum::<f64>() / inside.len() as f64;
            // Of the horizontal Earth rate that turns past the other axes two samples are missing.
            let tolerance = if turning == 0.0 { 2e-3 } else { 0.2 };
            assert_close(mean, 3600.0 * rates[axis], 0.0, tolerance);
        }
    }
}

#[test]
fn the_base_warms_up_along_the_exponential_of_the_study() {
    let scenario = shipped("calibration");
    let shown = coil_temperatures_c(&scenario.gyro, scenario.warm_up_s, 1.0, 6480);
    for (second, shown_c) in (0_u32..).zip(&shown).skip(60) {
        let law_c = 40.0 - 20.0 * (-f64::from(second) / 1800.0).exp();
        assert_close(*shown_c, law_c, 0.0, 2e-3);
    }
}

#[test]
fn a_campaign_of_the_loop_model_keeps_its_lock_in_the_pauses() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = format!(
        "{}fidelity = \"loop\"\nwarm_up_s = 0.5\n[turntable.calibration]\n\
         axes = [\"x\", \"x\", \"y\", \"z\"]\nrates_deg_per_s = [180.0, -180.0, 180.0, 180.0]\n\
         record_s = 2.0\nchange_s = 1.0\nremount_s = 2.0\n\
         [gyro.output]\nhalf_periods_per_sample = 64\nrate_lsb_deg_per_s = 0.0\n\
         [calibration]\nestimators = [\"batch\"]\napply = \"batch\"\n{SILENT}{WARM}",
        base("loop", 13.0)
    )
    .replace("warm_up_s = 15.0", "");
    let summary = run(folder.path(), "loop", &text);
    let notes = summary["notes"].to_string();
    assert!(
        !notes.contains("lock") && !notes.contains("fringe"),
        "{notes}"
    );
    let estimate = &summary["calibration"]["estimates"]["batch"];
    assert!(field_of(estimate, "scale_factor_rms_ppm") < 10.0);
}

#[test]
fn repeated_campaigns_rank_the_estimators_as_the_study_does() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let file = repository("scenarios/patent/calibration.toml");
    let file = file.to_string_lossy();
    let output = fogbench(
        folder.path(),
        &["run", &file, "--set", "repeats=12", "-o", "out"],
    );
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    assert!(stdout(&output).contains("rms over 12 campaigns"));
    let summary = summary(&folder.path().join("out"), "patent-calibration");
    let ranking = summary["calibration"]["ranking"]
        .as_array()
        .expect("a ranking");
    let bias = |name: &str| {
        let row = ranking.iter().find(|row| row["estimator"] == name);
        row.expect("every estimator is ranked")["bias_rms_deg_per_h"]
            .as_f64()
            .expect("a number")
    };
    // 36 biases: an rms is known to 12 %. Least squares leaves the drift, 0.82 deg/h without noise;
    // a coefficient of temperature leaves noise, 0.117; forgetting lies between, 0.20.
    assert_close(bias("batch"), 0.82, 0.1, 0.0);
    assert_close(bias("batch-temperature"), 0.117, 0.4, 0.0);
    assert_close(bias("arls-temperature"), 0.132, 0.4, 0.0);
    assert_close(bias("arls"), 0.20, 0.4, 0.0);
    assert!(bias("arls-covariance") > bias("arls"), "rounding costs");
    let best = ranking[0]["bias_rms_deg_per_h"].as_f64();
    assert_close(
        best.expect("a number"),
        bias("batch-temperature").min(bias("arls-temperature")),
        0.0,
        1e-15,
    );
    // A metric over repeats is the same root mean square.
    let gated = field(
        &summary,
        "calibration_batch.bias_error_rms_deg_per_h",
        "value",
    );
    assert_close(gated, bias("batch"), 1e-12, 0.0);
}

#[test]
fn what_is_applied_and_measured_stands_in_files_of_its_own() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let file = repository("scenarios/patent/calibration.toml");
    let file = file.to_string_lossy().into_owned();
    for jobs in ["1", "2"] {
        let output = fogbench(
            folder.path(),
            &["run", &file, "--set", "repeats=2", "-j", jobs, "-o", jobs],
        );
        assert_eq!(code(&output), 0, "{}", stderr(&output));
    }
    assert!(
        tree(&folder.path().join("1")) == tree(&folder.path().join("2")),
        "bytes differ"
    );
    let out = folder.path().join("1/patent-calibration");
    let read = |name: &str| std::fs::read_to_string(out.join(name)).expect(name);
    let toml: toml::Table = read("calibration.toml").parse().expect("valid TOML");
    let summary = summary(&folder.path().join("1"), "patent-calibration");
    let found = &summary["calibration"]["estimates"]["arls-temperature"];
    let applied = toml["compensation"].as_table().expect("parameters");
    let biases = applied["bias_deg_per_h"].as_array().expect("three");
    let expected = reals(&found["parameters"]["bias_deg_per_h"]);
    for (bias, expected) in biases.iter().zip(expected) {
        assert_close(bias.as_float().expect("a number"), expected, 1e-14, 0.0);
    }
    for key in [
        "theta_xy_arcsec",
        "theta_zy_arcsec",
        "reference_temperature_c",
    ] {
        assert!(applied.contains_key(key), "{key}");
    }
    assert_eq!(
        toml["provenance"]["estimator"].as_str(),
        Some("arls-temperature")
    );
    let covariance = toml["covariance"]["matrix"].as_array().expect("rows");
    assert_eq!(covariance.len(), 12);
    let groups = read("groups.csv");
    let mut lines = groups.lines();
    let head = lines.next().expect("a header");
    for column in [
        "mounting",
        "rate_deg_per_s",
        "temperature_x_c",
        "output_z_deg_per_h",
        "standard_error_y_deg_per_h",
    ] {
        assert!(
            head.split(',').any(|name| name == column),
            "{column} in {head}"
        );
    }
    let columns = head.split(',').count();
    assert_eq!(lines.clone().count(), 9);
    assert!(lines.all(|line| line.split(',').count() == columns));
    let picture = read("calibration.svg");
    assert!(picture.contains("arls-temperature (applied)"));
}

#[test]
fn whole_turns_and_outliers_are_told_of_every_group() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let file = repository("scenarios/patent/calibration.toml");
    let output = fogbench(
        folder.path(),
        &["run", &file.to_string_lossy(), "-o", "out"],
    );
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let summary = summary(&folder.path().join("out"), "patent-calibration");
    let calibration = &summary["calibration"];
    let groups = calibration["groups"].as_array().expect("groups");
    let turns: Vec<f64> = groups
        .iter()
        .map(|group| group["turns"].as_f64().expect("whole turns"))
        .collect();
    assert_eq!(turns, [16.0, 83.0, 150.0].repeat(3));
    for group in groups {
        // 0.05 deg/sqrt(h) over 600 s is 0.1225 deg/h; twenty blocks know it to 16 %.
        for error in reals(&group["standard_error_deg_per_h"]) {
            assert_close(error, 0.1235, 0.6, 0.0);
        }
        // 6.3e-5 of 6000 normal samples lie beyond 4 sigma.
        let rejected: f64 = reals(&group["rejected"]).iter().sum();
        assert!(rejected <= 8.0, "{rejected}");
    }
    let plan = &calibration["plan"];
    assert_eq!(plan["rank"], 4);
    for condition in reals(&plan["condition_number"]) {
        assert_close(condition, 63.1, 0.0, 0.05);
    }
    for factor in reals(&plan["bias_per_standard_error"]) {
        assert_close(factor, 0.609_55, 0.0, 1e-5);
    }
}

/// `[turntable.calibration]` with more behind it.
fn plan(axes: &str, rates: &str, more: &str) -> String {
    format!("[turntable.calibration]\naxes = {axes}\nrates_deg_per_s = {rates}\n{more}")
}

const FOUR: &str = "[\"x\", \"x\", \"y\", \"z\"]";
const SIX: &str = "[\"x\", \"x\", \"y\", \"y\", \"z\", \"z\"]";
const SIX_RATES: &str = "[10.0, 50.0, 10.0, 50.0, 10.0, 50.0]";

/// Holds what is said to each plan, which must be refused.
#[track_caller]
fn assert_refused(title: &'static str, plans: impl IntoIterator<Item = String>) {
    let folder = tempfile::tempdir().expect("a scratch folder");
    said_to_each("calibrate", title, plans, |plan| {
        let text = format!("{}{plan}", base("plan", 6480.0));
        write(folder.path(), "plan.toml", &text);
        let output = fogbench(folder.path(), &["check", "plan.toml"]);
        assert_eq!(code(&output), 2, "{text}");
        stderr(&output)
    });
}

#[test]
fn plans_that_leave_parameters_open_are_refused_with_the_missing_motion() {
    let two = "[\"x\", \"x\", \"y\", \"y\"]";
    let one_rate = "[\"x\", \"y\", \"z\"]";
    let plans = [
        plan(two, "[10.0, 50.0, 10.0, 50.0]", ""),
        plan(one_rate, "[50.0, 50.0, 50.0]", ""),
        plan(SIX, SIX_RATES, WARM),
    ];
    assert_refused("Plans that leave parameters open", plans);
}

#[test]
fn contradictions_of_a_campaign_are_refused_where_they_stand() {
    let rates = "[10.0, 50.0, 50.0, 50.0]";
    let gate = |metric: &str| {
        let gate = format!("[[gate]]\nmetric = \"{metric}\"\nmax = 1.0\n");
        plan(SIX, SIX_RATES, &gate)
    };
    let along = "[turntable.mounting]\naxis_along_table = \"x\"\n";
    let plans = [
        plan(FOUR, "[10.0, 50.0, 50.0]", ""),
        plan(FOUR, rates, "record_s = 6000.0\n"),
        plan(FOUR, "[0.5, 50.0, 50.0, 50.0]", ""),
        plan(FOUR, rates, "change_s = 1.0\n"),
        plan(FOUR, rates, along),
        plan("[\"x\", \"x\", \"y\", \"w\"]", rates, ""),
        gate("calibration_arls.mean_deg_per_h"),
        gate("x_raw.mean_deg_per_h"),
    ];
    assert_refused("Contradictions of a campaign", plans);
}

#[test]
fn the_table_moves_smoothly_and_is_at_the_angle_of_the_closed_form() {
    const PERIOD_S: f64 = 0.02;
    let mut config = shipped("calibration-both-senses").turntable;
    let MotionConfig::Calibration(campaign) = &mut config.motion else {
        panic!("a campaign");
    };
    campaign.record_s = 20.0;
    let campaign = campaign.clone();
    let mut table = Turntable::new(&config, 15.0, PERIOD_S);
    let angles = campaign_angles_rad(&campaign, 15.0);
    let mut time_s = 0.0;
    let mut before: Option<MotionSegment> = None;
    let mut fastest_change: f64 = 0.0;
    for (group, angle) in campaign.groups().iter().zip(angles) {
        while time_s < 15.0 + group.start_s - 0.5 * PERIOD_S {
            let segments = table.next_platform_segments();
            let along = segments[2];
            if let Some(before) = before {
                // Earth rate changes places with a new mounting: 15 deg/h at most.
                assert_close(along.rate_at(0.0), before.rate_at(1.0), 1e-12, 2.0 * 7.3e-5);
            }
            fastest_change = segments
                .iter()
                .map(|segment| segment.slope_at(0.5).abs() / PERIOD_S)
                .fold(fastest_change, f64::max);
            before = Some(along);
            time_s += PERIOD_S;
        }
        assert_close(table.angle_rad(), angle, 1e-12, 1e-6);
    }
    // 90 deg/s in the run-up of 15 s and 80 in half a minute: pi/2 of the mean slopes.
    let steepest_rad_per_s2 = (90.0_f64 / 15.0 * std::f64::consts::FRAC_PI_2).to_radians();
    assert_close(fastest_change, steepest_rad_per_s2, 1e-3, 0.0);
}

#[test]
fn a_campaign_needs_an_assembly() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = format!("schema = 1\nname = \"alone\"\nduration_s = 400.0\n{GROUPS}");
    write(folder.path(), "alone.toml", &text);
    let output = fogbench(folder.path(), &["check", "alone.toml"]);
    assert_eq!(code(&output), 2);
    let mut transcript = Transcript::of("calibrate", "A campaign needs an assembly");
    transcript.case(GROUPS, stderr(&output));
    transcript.check();
}

#[test]
fn a_check_tells_what_a_sound_plan_determines_and_what_it_hides() {
    let plans = ["calibration", "calibration-both-senses"];
    let folder = tempfile::tempdir().expect("a scratch folder");
    let title = "A check tells what a sound plan determines and what it hides";
    said_to_each("calibrate", title, plans, |plan| {
        let file = repository(&format!("scenarios/patent/{plan}.toml"));
        let output = fogbench(folder.path(), &["check", &file.to_string_lossy()]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        format!("{}{}", stdout(&output), stderr(&output))
    });
}
