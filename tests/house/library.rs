//! The library as its users see it: scenarios in memory, stages alone, and the examples.

use std::error::Error;

use fogbench::experiment::{RunError, SuiteOptions, write_runs};
use fogbench::gyro::{self, CoilConfig, Fidelity, Gyro, GyroConfig};
use fogbench::metrics::catalogue::{
    AMPLITUDE_RATIO, ANGLE_RANDOM_WALK, DC_GAIN, DELAY_VS_RAW, MEAN,
};
use fogbench::random::Streams;
use fogbench::signal::MotionSegment;
use fogbench::units::deg_per_h_to_rad_per_s;
use fogbench::{Run, Scenario};

use crate::support::{code, fogbench, stderr, tree, write};

#[path = "../../examples/allan_of_a_log.rs"]
mod allan_of_a_log;
#[path = "../../examples/one_filter.rs"]
mod one_filter;
#[path = "../../examples/one_gyro.rs"]
mod one_gyro;
#[path = "../../examples/pipeline_bits.rs"]
mod pipeline_bits;
#[path = "../../examples/run_scenario.rs"]
mod run_scenario;

const AT_REST: &str = r#"
schema = 1
name = "at-rest"
duration_s = 3.0
warm_up_s = 0.5

[[filter]]
name = "rls"
[filter.rls]

[[gate]]
metric = "rls.dc_gain"
max = 0.9
decide = "value"
"#;

fn at_rest() -> Scenario {
    Scenario::from_toml(AT_REST).expect("a sound text")
}

#[test]
fn the_examples_run() -> Result<(), Box<dyn Error>> {
    allan_of_a_log::main()?;
    one_filter::main()?;
    one_gyro::main()?;
    pipeline_bits::main()?;
    run_scenario::main()
}

#[test]
fn a_scenario_runs_in_memory_and_writes_no_file() -> Result<(), Box<dyn Error>> {
    let run = at_rest().set("filter[0].rls.taps", 8)?.run()?;
    let names: Vec<&str> = run.channels().map(|(name, _)| name).collect();
    assert_eq!(names, ["raw", "rls"]);
    let eight = run["rls"].metric(&DC_GAIN)?;
    let four = at_rest().run()?["rls"].metric(&DC_GAIN)?;
    assert!(eight.value > four.value, "{eight} of 8, {four} of 4 taps");
    assert!(run.is_accepted());
    assert_eq!(run.verdicts().len(), 1);
    assert!(run.theory().is_empty() && run.encoder().is_none() && run.calibration().is_none());
    Ok(())
}

#[test]
fn a_gate_that_fails_is_not_accepted() -> Result<(), Box<dyn Error>> {
    let run = at_rest().set("gate[0].max", 0.001)?.run()?;
    assert!(!run.is_accepted());
    Ok(())
}

#[test]
fn a_channel_that_fails_is_accepted_only_if_a_gate_expects_it() -> Result<(), Box<dyn Error>> {
    let text = |gate: &str| {
        format!(
            "schema = 1\nname = \"a\"\nduration_s = 2.0\nwarm_up_s = 1.0\n\
             fidelity = \"rate\"\n{gate}\
             [[filter]]\nname = \"f\"\n[filter.rls]\nupdate_sign = \"as-printed\"\n"
        )
    };
    let gate = "[[gate]]\nmetric = \"f.diverged_at_s\"\nmax = 10.0\n";
    let unexpected = Scenario::from_toml(&text(""))?.run()?;
    assert!(unexpected["f"].error.is_some());
    assert!(!unexpected.is_accepted());
    assert!(Scenario::from_toml(&text(gate))?.run()?.is_accepted());
    assert!(unexpected.samples("f").is_err());
    let missing = unexpected["f"].metric(&DC_GAIN).unwrap_err();
    let failure = unexpected["f"].error.as_ref().expect("seen above");
    assert_eq!(missing.reason.as_str(), failure.message);
    Ok(())
}

#[test]
fn a_missing_metric_says_why() -> Result<(), Box<dyn Error>> {
    let run = at_rest().set("duration_s", 0.01)?.run()?;
    let missing = run["raw"].metric(&ANGLE_RANDOM_WALK).unwrap_err();
    assert_eq!(missing.metric, ANGLE_RANDOM_WALK.name);
    let reason = run["raw"].why_unavailable(&ANGLE_RANDOM_WALK);
    assert_eq!(Some(missing.reason.as_str()), reason);
    let other = run["raw"].metric(&DELAY_VS_RAW).unwrap_err();
    assert!(!other.reason.as_str().is_empty());
    Ok(())
}

#[test]
fn samples_come_with_period_unit_and_warm_up() -> Result<(), Box<dyn Error>> {
    let run = at_rest()
        .set("turntable.encoder.resolution_arcsec", 1.0)?
        .run()?;
    let (raw, truth) = (run.samples("raw")?, run.samples("truth")?);
    assert_eq!((raw.unit, truth.unit), ("deg/h", "deg/h"));
    assert_eq!(raw.values.len(), truth.values.len());
    assert_eq!(raw.values.len(), raw.warm_up + raw.measured().len());
    let measured = raw.measured();
    let mean = measured.iter().sum::<f64>() / measured.len() as f64;
    let metric = run["raw"].metric(&MEAN)?;
    assert!((mean - metric.value).abs() < 1e-9, "{mean} {metric}");
    // The record begins with the first stamp that does not lie before the end of the warm-up.
    assert!(raw.time_s(raw.warm_up) >= 0.5 && raw.time_s(raw.warm_up - 1) < 0.5 + raw.period_s);
    let encoder = run.encoder().expect("the table has one");
    assert_eq!(
        (encoder.unit, encoder.values.len()),
        ("rad", raw.values.len())
    );
    Ok(())
}

#[test]
fn an_unknown_channel_or_record_names_the_known_ones() -> Result<(), Box<dyn Error>> {
    let run = at_rest().run()?;
    let unknown = run.channel("lms").unwrap_err();
    assert_eq!(
        unknown.to_string(),
        "there is no channel `lms`: there are raw, rls"
    );
    let unknown = run.samples("x_truth").unwrap_err();
    assert_eq!(unknown.known, ["raw", "rls", "truth"]);
    Ok(())
}

#[test]
#[should_panic(expected = "there is no channel `lms`: there are raw, rls")]
fn indexing_with_an_unknown_channel_panics_with_the_known_ones() {
    let run: Run = at_rest().run().expect("a sound scenario");
    let _ = &run["lms"];
}

#[test]
fn complaints_come_as_one_error_with_every_place() {
    let unknown = at_rest().set("filter[0].rls.tabs", 8).unwrap_err();
    assert_eq!(unknown.complaints().len(), 1);
    let text = unknown.to_string();
    assert!(text.starts_with("--set filter[0].rls.tabs=8: "), "{text}");
    let bad = AT_REST.replace("duration_s = 3.0", "duration_s = -3.0\nsede = 1");
    let scenario = Scenario::from_toml(&bad).expect("values are checked when it runs");
    let Err(RunError::Scenario(errors)) = scenario.run() else {
        panic!("two faults");
    };
    let places: Vec<String> = errors
        .complaints()
        .iter()
        .map(|complaint| complaint.location.to_string())
        .collect();
    assert_eq!(places, ["<text>:4:1", "<text>:5:1"]);
    assert_eq!(errors.to_string().lines().count(), 2);
    let broken = Scenario::from_toml("schema = ").unwrap_err();
    assert!(broken.to_string().starts_with("<text>:1:"), "{broken}");
    assert!(Scenario::from_file("nowhere.toml").is_err());
}

const SWEEP: &str = "schema = 1\nname = \"sweep\"\nduration_s = 1.0\nwarm_up_s = 0.5\n\
                     fidelity = \"rate\"\n[matrix]\nseed = [1, 2]\n";

#[test]
fn a_sweep_is_refused_whole_and_runs_point_by_point() -> Result<(), Box<dyn Error>> {
    let sweep: Scenario = SWEEP.parse()?;
    let refused = sweep.run().err().expect("two points");
    assert!(matches!(refused, RunError::SeveralPoints(2)), "{refused}");
    let points = sweep.points()?;
    let means = points
        .iter()
        .map(|point| Ok(point.run()?["raw"].metric(&MEAN)?.value));
    let means = means.collect::<Result<Vec<f64>, Box<dyn Error>>>()?;
    assert_eq!(means.len(), 2);
    assert_ne!(means[0].to_bits(), means[1].to_bits());
    Ok(())
}

/// Files of two folders by path, the lock and journals of the writer aside.
fn assert_same_files(one: &std::path::Path, other: &std::path::Path) {
    let files = |folder| {
        let mut files = tree(folder);
        files.retain(|(path, _)| !path.starts_with(".fogbench"));
        files
    };
    let (one, other) = (files(one), files(other));
    let names = |files: &[(std::path::PathBuf, Vec<u8>)]| -> Vec<std::path::PathBuf> {
        files.iter().map(|(path, _)| path.clone()).collect()
    };
    assert!(one.len() > 8, "{} files", one.len());
    assert_eq!(names(&one), names(&other));
    for ((path, first), (_, second)) in one.iter().zip(&other) {
        assert!(first == second, "{} differs", path.display());
    }
}

#[test]
fn written_runs_are_those_of_the_command_line_to_the_byte() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let at = folder.path();
    let samples = format!("{AT_REST}[output]\nsamples = \"npy\"\n");
    let file = write(at, "at-rest.toml", &samples);
    let set = ["run", "at-rest.toml", "--set", "seed=3", "-o", "command"];
    let output = fogbench(at, &set);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let run = Scenario::from_file(&file)?.set("seed", 3)?.run()?;
    run.write(at.join("library"))?;
    assert_same_files(&at.join("command"), &at.join("library"));

    let sweep = write(at, "sweep.toml", SWEEP);
    let output = fogbench(at, &["run", "sweep.toml", "-o", "points"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let points = Scenario::from_file(&sweep)?.points()?;
    let runs = points.iter().map(fogbench::Plan::run);
    let runs = runs.collect::<Result<Vec<Run>, RunError>>()?;
    write_runs(&runs, &SuiteOptions::new(at.join("written")))?;
    assert_same_files(&at.join("points"), &at.join("written"));
    Ok(())
}

#[test]
fn a_written_text_runs_again_from_its_manifest() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    at_rest().run()?.write(folder.path().join("out"))?;
    let manifest = folder.path().join("out/at-rest/manifest.toml");
    let again = Scenario::from_file(&manifest)?.run()?;
    let once = at_rest().run()?;
    assert_eq!(again.samples("rls")?.values, once.samples("rls")?.values);
    assert_eq!(
        again.plan().resolved().digest,
        once.plan().resolved().digest
    );
    Ok(())
}

#[test]
fn settings_of_every_type_are_taken() -> Result<(), Box<dyn Error>> {
    let text = "schema = 1\nname = \"a\"\nduration_s = 2.0\nwarm_up_s = 1.0\n\
                [turntable.swing]\nrate_amplitude_deg_per_s = 1.0\nfrequency_hz = 2.0\n\
                [[filter]]\nname = \"mean\"\n[filter.moving_average]\ntaps = 4\n";
    let run = Scenario::from_toml(text)?
        .set("fidelity", "rate")?
        .set("seed", 9_u32)?
        .set("turntable.swing.frequency_hz", 5.0)?
        .set("turntable.swing.from_rest", false)?
        .set("filter.mean.moving_average.taps", 40_usize)
        .or_else(|_| Scenario::from_toml(text)?.set("filter[0].moving_average.taps", 40_usize))?
        .run()?;
    let ratio = run["mean"].metric(&AMPLITUDE_RATIO)?;
    assert!(ratio.value > 0.9 && ratio.value < 1.0, "{ratio}");
    let array =
        Scenario::from_toml(SWEEP)?.set("turntable.multi_sine.frequencies_hz", vec![1.0, 3.0]);
    assert!(array.is_ok());
    Ok(())
}

#[test]
fn the_gyro_runs_alone() -> Result<(), Box<dyn Error>> {
    let reference = GyroConfig::reference();
    let coil = CoilConfig {
        length_m: 2.0 * reference.coil.length_m,
        ..reference.coil
    };
    let scale_factor_s = gyro::facts(&reference)?.scale_factor_s;
    let config = GyroConfig { coil, ..reference };
    let twice = gyro::facts(&config)?.scale_factor_s / scale_factor_s;
    assert!((twice - 2.0).abs() < 1e-12, "{twice}");
    let rate = deg_per_h_to_rad_per_s(3600.0);
    let mut gyro = Gyro::new(&config, Fidelity::Loop, 1.0, &Streams::new(1, 0))?;
    let words: Vec<f64> = (0..400)
        .map(|_| gyro.next_word(&MotionSegment::constant(rate)))
        .collect();
    let settled = &words[100..];
    let mean = settled.iter().sum::<f64>() / settled.len() as f64;
    assert!((mean - 3600.0).abs() < 5.0, "{mean}");
    Ok(())
}
