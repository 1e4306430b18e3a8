//! Scripted and profiled motion from the scenario file to the report.

use std::fs;
use std::path::Path;

use fogbench::metrics::{
    AllanOptions, Applies, Motion, Record, Settings, known_metrics, measure, support,
};
use fogbench::scenario::{MotionConfig, Resolved, ScenarioError, load_suite, manifest_toml};
use fogbench::signal::Rates;

use crate::support::transcript::{Transcript, said_to_each};
use crate::support::{assert_close, fogbench};

/// The transcript of motions that are refused.
const MOTION: &str = "motion";

const HEAD: &str = "schema = 1\nname = \"x\"\nduration_s = 2.0\nwarm_up_s = 1.0\n";
const CSV: &str = "# A slew.\ntime_s, rate_deg_per_s\n0, 0\n\n0.5, 10\n2.0, -0.1\n";

fn load(folder: &Path, text: &str, sets: &[&str]) -> Result<Vec<Resolved>, Vec<ScenarioError>> {
    let file = folder.join("x.toml");
    fs::write(&file, text).expect("a writable folder");
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    load_suite(&[file], &sets)
}

/// The only complaint about a scenario whose script is the given CSV.
fn complaint(csv: &str) -> String {
    let folder = tempfile::tempdir().expect("a scratch folder");
    fs::write(folder.path().join("motion.csv"), csv).expect("a writable folder");
    let text = format!("{HEAD}[turntable.script]\nfile = \"motion.csv\"\n");
    let errors = load(folder.path(), &text, &[]).expect_err("a wrong script");
    assert_eq!(errors.len(), 1, "{errors:?}");
    errors[0].to_string()
}

fn times_and_rates(run: &Resolved) -> (Vec<f64>, Vec<f64>) {
    let MotionConfig::Script(script) = &run.scenario.turntable.motion else {
        panic!("{:?}", run.scenario.turntable.motion);
    };
    let rates = script.points.rate_deg_per_s.clone();
    (script.points.time_s.clone(), rates.unwrap_or_default())
}

#[test]
fn a_script_is_found_beside_the_file_that_names_it_and_its_digest_is_recorded() {
    let folder = tempfile::tempdir().unwrap();
    let base = folder.path().join("base");
    fs::create_dir(&base).unwrap();
    fs::write(base.join("motion.csv"), CSV).unwrap();
    let script = "[turntable.script]\nfile = \"motion.csv\"\n";
    fs::write(base.join("base.toml"), format!("schema = 1\n{script}")).unwrap();
    let text = format!("extends = \"base/base.toml\"\n{HEAD}");
    let run = load(folder.path(), &text, &[]).unwrap().remove(0);
    let (times, rates) = times_and_rates(&run);
    assert_eq!((times, rates), (vec![0.0, 0.5, 2.0], vec![0.0, 10.0, -0.1]));
    let files: Vec<&str> = run.inputs.iter().map(|input| input.file.as_str()).collect();
    assert_eq!(files, ["base/base.toml", "x.toml", "base/motion.csv"]);
    let digest = blake3::hash(CSV.as_bytes()).to_hex().to_string();
    assert_eq!(run.inputs[2].digest, digest);

    // The manifest repeats the run wherever it lies, without the file.
    let elsewhere = tempfile::tempdir().unwrap();
    let manifest = elsewhere.path().join("manifest.toml");
    fs::write(
        &manifest,
        manifest_toml(&run, env!("CARGO_PKG_VERSION"), "b"),
    )
    .unwrap();
    fs::remove_file(base.join("motion.csv")).unwrap();
    let repeated = load_suite(&[manifest], &[]).unwrap().remove(0);
    assert_eq!(repeated, run);
}

#[test]
fn a_script_of_the_command_line_replaces_the_motion_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let csv = folder.path().join("other.csv");
    fs::write(&csv, CSV).unwrap();
    let set = format!("turntable.script.file={}", csv.display());
    let run = load(folder.path(), HEAD, &[&set]).unwrap().remove(0);
    assert_eq!(times_and_rates(&run).0, [0.0, 0.5, 2.0]);
    assert_eq!(run.inputs.last().unwrap().file, "other.csv");
    assert!(!run.to_toml().contains("turntable.static"));
}

#[test]
fn a_script_saved_by_a_spreadsheet_is_read_as_any_other() {
    let folder = tempfile::tempdir().unwrap();
    let csv = format!("\u{feff}{}", CSV.trim_start_matches("# A slew.\n")).replace('\n', "\r\n");
    fs::write(folder.path().join("motion.csv"), csv).unwrap();
    let text = format!("{HEAD}[turntable.script]\nfile = \"motion.csv\"\n");
    let run = load(folder.path(), &text, &[]).unwrap().remove(0);
    let (times, rates) = times_and_rates(&run);
    assert_eq!((times, rates), (vec![0.0, 0.5, 2.0], vec![0.0, 10.0, -0.1]));
}

#[test]
fn a_wrong_script_is_refused_at_its_line_and_column() {
    let mut transcript =
        Transcript::of(MOTION, "Wrong scripts are refused at their line and column");
    for csv in [
        "",
        "time_s,rate\n",
        "time_s\n0\n",
        "time_s,rate_deg_per_s\n0,1\n2,a\n",
        "time_s,rate_deg_per_s\n0,1,2\n",
        "time_s,rate_deg_per_s\n0,1\n2, 3000\n",
        "time_s,angle_deg\n0,1\n2,inf\n",
        "time_s,angle_deg\n0,1\n1,2\n1,3\n2,0\n",
        "time_s,angle_deg\n0.1,1\n2,3\n",
        "time_s,angle_deg\n0,1\n1.5,3\n",
    ] {
        transcript.case(format!("motion.csv:\n{csv}"), complaint(csv));
    }
    transcript.check();
}

/// All complaints about a head with `text`.
fn refused(folder: &Path, text: &str) -> String {
    let errors = load(folder, &format!("{HEAD}{text}"), &[]).expect_err(text);
    let texts: Vec<String> = errors.iter().map(ToString::to_string).collect();
    texts.join("\n")
}

#[test]
fn scripts_that_are_missing_or_given_twice_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("m.csv"), CSV).unwrap();
    let points = "points = { time_s = [0.0, 2.0], rate_deg_per_s = [0.0, 1.0] }\n";
    let script = "[turntable.script]\n";
    let cases = [
        format!("{script}file = \"none.csv\"\n"),
        format!("{script}file = \"m.csv\"\n{points}"),
        format!("{script}{}", points.replace("[0.0, 1.0]", "[0.0]")),
        format!(
            "{script}{}",
            points.replace(" }", ", angle_deg = [0.0, 1.0] }")
        ),
        format!("[matrix]\n\"turntable.script.file\" = [\"m.csv\"]\n{script}file = \"m.csv\"\n"),
    ];
    said_to_each(
        MOTION,
        "Scripts that are missing or given twice",
        cases,
        |text| refused(folder.path(), text),
    );
}

#[test]
fn profiles_that_the_record_cannot_hold_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let trapezoid = "[turntable.trapezoid]\nrate_deg_per_s = 10.0\nhold_s = 0.5\n";
    let fits = format!("{HEAD}{trapezoid}acceleration_deg_per_s2 = 20.0\n");
    assert!(load(folder.path(), &fits, &[]).is_ok());
    let chirp = |end_hz: f64, sweep_s: f64| {
        format!(
            "[turntable.chirp]\nrate_amplitude_deg_per_s = 0.1\nstart_frequency_hz = 1.0\n\
             end_frequency_hz = {end_hz:?}\nsweep_s = {sweep_s:?}\n"
        )
    };
    let test_signal = |shape: &str, length_s: f64| {
        format!(
            "[turntable.test_signal]\nshape = \"{shape}\"\nrate_amplitude_deg_per_s = 1.0\n\
             length_s = {length_s:?}\n"
        )
    };
    let cases = [
        format!("{trapezoid}acceleration_deg_per_s2 = 20.0\nboth_senses = true\n"),
        format!("{trapezoid}acceleration_deg_per_s2 = 1e5\n"),
        format!("{trapezoid}acceleration_deg_per_s2 = 1.0\n").replace("10.0", "0.0"),
        chirp(999.0, 1.0),
        chirp(10.0, 3.0),
        test_signal("blocks", 3.0),
        test_signal("doppler", 0.1),
    ];
    said_to_each(
        MOTION,
        "Profiles that the record cannot hold",
        cases,
        |text| refused(folder.path(), text),
    );
}

#[test]
fn a_general_motion_has_means_and_tracking_error_and_reasons_for_the_rest() {
    const PERIOD_S: f64 = 0.01;
    let truth: Vec<f64> = (0..4000_i32)
        .map(|k| 100.0 * (0.001 * f64::from(k * k % 977)).sin())
        .collect();
    // A known error: 2 deg/h with 1 deg/h of alternating noise, rms sqrt(5).
    let error = |k: usize| if k.is_multiple_of(2) { 3.0 } else { 1.0 };
    let raw: Vec<f64> = truth
        .iter()
        .enumerate()
        .map(|(k, rate)| rate + error(k))
        .collect();
    let record = Record {
        channel_deg_per_h: &raw,
        raw_deg_per_h: &raw,
        truth_deg_per_h: Rates::Words(&truth),
        response_deg_per_h: &[],
        encoder_rad: None,
        sample_period_s: PERIOD_S,
        first_stamp_s: PERIOD_S,
        drift: None,
    };
    let settings = Settings {
        motion: Motion::General,
        bias_averaging_time_s: 1.0,
        fit_tau_min_s: 0.1,
        allan: AllanOptions::default(),
        bridges: Vec::new(),
    };
    let metrics = measure(&record, &settings, None);
    let value = |name: &str| metrics.metrics[name].estimate.value;
    assert_close(value("mean_error_deg_per_h"), 2.0, 1e-12, 0.0);
    assert_close(
        value("tracking_error_rms_deg_per_h"),
        5.0_f64.sqrt(),
        1e-12,
        0.0,
    );
    // Mean, its error, smallest and largest word, tracking error.
    assert_eq!(metrics.metrics.len(), 5, "{:?}", metrics.metrics.keys());
    for known in known_metrics() {
        let supported = support(known.name, 40.0, PERIOD_S, &Motion::General, false, 1.0).is_ok();
        let is_given = metrics.metrics.contains_key(known.name);
        let is_elsewhere = known.name == "diverged_at_s" || known.applies == Applies::Pipeline;
        assert!(is_elsewhere || supported == is_given, "{}", known.name);
    }
    let mut transcript = Transcript::of("metrics", "Noise during a script");
    let reason = &metrics.unavailable["noise_std_deg_per_h"];
    transcript.case("noise_std_deg_per_h", reason.as_str());
    transcript.check();
}

#[test]
fn the_program_runs_a_script_and_repeats_it_from_its_manifest() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("motion.csv"), CSV).unwrap();
    let text = format!("{HEAD}fidelity = \"rate\"\n[turntable.script]\nfile = \"motion.csv\"\n");
    fs::write(folder.path().join("x.toml"), text).unwrap();
    let run = |input: &str, output: &str| {
        let done = fogbench(folder.path(), &["run", input, "--output", output]);
        assert!(done.status.success(), "{done:?}");
        fs::read(folder.path().join(output).join("x/manifest.toml")).unwrap()
    };
    let first = run("x.toml", "first");
    fs::remove_file(folder.path().join("motion.csv")).unwrap();
    let second = run("first/x/manifest.toml", "second");
    assert_eq!(first, second);
    let summary =
        |output: &str| fs::read(folder.path().join(output).join("x/summary.json")).unwrap();
    assert_eq!(summary("first"), summary("second"));
}
