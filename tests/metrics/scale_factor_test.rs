//! The scale factor test: its rates, its zeros, its noise floor and its report.

use fogbench::metrics::{
    Dwell, Motion, RatePoint, Staircase, StaticZero, expected_largest, fit_scale_factor, measure,
};
use fogbench::scenario::{PreferredSeries, ScaleFactorTestConfig, Stairs};
use serde_json::Value;

use crate::support::records::{
    PERIOD_S, every_metric_is_answered, raw_record, settings, value, white,
};
use crate::support::transcript::{Transcript, said_to_each};
use crate::support::{assert_close, code, field, fogbench, repository, stderr, stdout, summary};

fn test() -> ScaleFactorTestConfig {
    ScaleFactorTestConfig {
        preferred_series: PreferredSeries::R5,
        from_deg_per_s: 0.63,
        to_deg_per_s: 90.0,
        dwell_s: 4.0,
        dwell_max_s: Some(9.0),
        static_s: 3.0,
        settle_s: 0.5,
        ..ScaleFactorTestConfig::reference()
    }
}

#[test]
fn the_rates_of_a_sense_are_the_preferred_numbers_and_the_largest_rate() {
    let expected = [
        0.63, 1.0, 1.6, 2.5, 4.0, 6.3, 10.0, 16.0, 25.0, 40.0, 63.0, 90.0,
    ];
    assert_eq!(test().rates_deg_per_s(), expected);
    let finer = ScaleFactorTestConfig {
        preferred_series: PreferredSeries::R10,
        from_deg_per_s: 20.0,
        ..test()
    };
    let expected = [20.0, 25.0, 31.5, 40.0, 50.0, 63.0, 80.0, 90.0];
    assert_eq!(finer.rates_deg_per_s(), expected);
}

#[test]
fn a_dwell_is_stretched_to_whole_turns_where_its_longest_allows() {
    // 40 deg/s turn once in 9 s, 90 deg/s in 4 s, 63 deg/s in 5.714 s; 25 deg/s take 14.4 s.
    for (rate, measured_s) in [(40.0, 9.0), (90.0, 4.0), (63.0, 360.0 / 63.0), (25.0, 4.0)] {
        assert_close(test().measured_s(rate), measured_s, 1e-12, 0.0);
    }
    let unstretched = ScaleFactorTestConfig {
        dwell_max_s: None,
        ..test()
    };
    assert_close(unstretched.measured_s(40.0), 4.0, 1e-12, 0.0);
}

#[test]
fn the_table_rests_goes_up_in_one_sense_then_in_the_other_and_rests() {
    let stairs = Stairs::from(&test());
    assert_eq!(stairs.rates_deg_per_s.len(), 26);
    assert!(stairs.has_static_zeros);
    let at = |index: usize| stairs.rates_deg_per_s[index];
    let bits = [at(0), at(1), at(12), at(13), at(24), at(25)].map(f64::to_bits);
    assert_eq!(bits, [0.0, 0.63, 90.0, -0.63, -90.0, 0.0].map(f64::to_bits));
    assert_close(stairs.ends_s[0], 3.5, 1e-12, 0.0);
    let measured: f64 = test()
        .rates_deg_per_s()
        .iter()
        .map(|rate| test().measured_s(*rate))
        .sum();
    assert_close(
        stairs.length_s(),
        2.0 * (3.0 + measured) + 26.0 * 0.5,
        1e-12,
        0.0,
    );
}

#[test]
fn what_a_test_cannot_be_is_refused() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let check = |more: &str| {
        let text = format!(
            "schema = 1\nname = \"x\"\nduration_s = 60.0\nwarm_up_s = 1.0\n{more}\n\
             [turntable.scale_factor_test]\nto_deg_per_s = 100.0\nstatic_s = 1.0\n"
        );
        move |keys: &str| {
            crate::support::write(folder.path(), "x.toml", &format!("{text}{keys}"));
            let output = fogbench(folder.path(), &["check", "x.toml"]);
            (code(&output), stderr(&output))
        }
    };
    let keys = check("");
    assert_eq!(keys("from_deg_per_s = 1.0\ndwell_s = 1.0\n").0, 0);
    let wrong = [
        "from_deg_per_s = 1.6\ndwell_s = 1.0\n",
        "from_deg_per_s = 1.0\ndwell_s = 3.0\n",
        "from_deg_per_s = 1.0\ndwell_s = 1.0\ndwell_max_s = 0.5\n",
    ];
    said_to_each(
        "motion",
        "Scale-factor tests that cannot be",
        wrong,
        |given| keys(given).1,
    );
}

#[test]
fn filters_are_reset_only_between_rates() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let text = "schema = 1\nname = \"x\"\nduration_s = 2.0\nwarm_up_s = 1.0\n\
                [trial]\nfilter_state = \"reset\"\n";
    crate::support::write(folder.path(), "x.toml", text);
    let output = fogbench(folder.path(), &["check", "x.toml"]);
    let mut transcript = Transcript::of("motion", "Filters are reset only between rates");
    transcript.case("filter_state = \"reset\" at rest", stderr(&output));
    transcript.check();
}

#[test]
fn the_noise_floor_is_the_mean_of_the_largest_residual_of_noise() {
    let count = 22_u32;
    let inputs: Vec<f64> = (0..count).map(|i| 1000.0 * (f64::from(i) - 10.5)).collect();
    let trials = 400_u32;
    let (mut total, mut floor) = (0.0, 0.0);
    for trial in 0..trials {
        let points: Vec<RatePoint> = inputs
            .iter()
            .zip(white(u64::from(trial), inputs.len(), 2.0))
            .map(|(input, noise)| RatePoint {
                input_deg_per_h: *input,
                output_deg_per_h: input + noise,
                deviation_deg_per_h: 2.0,
                degrees_of_freedom: 9.0,
            })
            .collect();
        let fit = fit_scale_factor(&points, StaticZero::default()).expect("22 rates");
        total += fit.nonlinearity.value.value;
        floor += fit.nonlinearity.noise_floor;
    }
    // The mean of 400 largest of 22 is known to 1 %.
    assert_close(total / floor, 1.0, 0.04, 0.0);
    assert_close(expected_largest(&[2.0; 22]), 2.0 * 2.2, 0.03, 0.0);
}

#[test]
fn nonlinearity_of_reading_is_that_of_the_smallest_rate_that_is_off() {
    // Two points of a symmetric set, off by as much each way round: the line stays where it is.
    let point = |input: f64, output: f64| RatePoint {
        input_deg_per_h: input,
        output_deg_per_h: output,
        deviation_deg_per_h: 0.0,
        degrees_of_freedom: 9.0,
    };
    let points = [
        point(-100.0, -100.0),
        point(-1.0, -0.9),
        point(0.0, -0.2),
        point(1.0, 1.1),
        point(100.0, 100.0),
    ];
    let fit = fit_scale_factor(&points, StaticZero::default()).expect("five rates");
    assert_close(fit.nonlinearity.value.value, 0.2 / 100.0, 1e-3, 0.0);
    assert_close(fit.nonlinearity_of_reading.value.value, 0.1, 1e-3, 0.0);
    assert!(fit.nonlinearity.noise_floor.abs() < f64::MIN_POSITIVE);
}

#[test]
fn static_zeros_take_the_bias_out_of_the_offset() {
    let rates = [0.0, 1.0, 2.0, -1.0, -2.0, 0.0].map(|step: f64| 3600.0 * step + 8.0);
    let dwells = rates.iter().zip((0..).step_by(1000));
    let staircase = Staircase {
        dwells: dwells
            .map(|(rate, start)| Dwell {
                samples: start + 100..start + 1000,
                rate_deg_per_h: *rate,
            })
            .collect(),
        settle_s: 100.0 * PERIOD_S,
        rest_deg_per_h: 8.0,
        has_static_zeros: true,
        is_found: false,
    };
    let motion = Motion::Steps {
        last_step_index: 5000,
        step_deg_per_h: 7200.0,
        staircase,
    };
    let truth: Vec<f64> = rates.iter().flat_map(|rate| vec![*rate; 1000]).collect();
    let raw: Vec<f64> = truth
        .iter()
        .zip(white(5, 6000, 0.5))
        .map(|(rate, noise)| 1.000_1 * rate + 40.0 + noise)
        .collect();
    let metrics = measure(&raw_record(&raw, &truth), &settings(motion), None);
    every_metric_is_answered(&metrics);
    let factor = &metrics.metrics["scale_factor_error_ppm"];
    assert_close(factor.estimate.value, 100.0, 0.0, 8.0);
    assert!(factor.fields["offset_deg_per_h"].abs() < 0.1, "{factor:?}");
    assert_eq!(factor.fields["count"].to_bits(), 4.0_f64.to_bits());
    let table = &metrics.curves["scale_factor"];
    assert_eq!(table["input_deg_per_h"].len(), 4);
    assert_close(table["input_deg_per_h"][3], -7200.0, 1e-9, 0.0);
    assert_close(
        table["mean_output_deg_per_h"][0],
        1.000_1 * 3608.0 + 40.0,
        0.0,
        0.1,
    );
    assert_close(table["output_deg_per_h"][0], 1.000_1 * 3600.0, 0.0, 0.1);
    let floor = factor_floor(&metrics);
    // 0.5 / sqrt(900) on each mean; the largest of four residuals with two parameters gone.
    let sigma_ppm = 1e6 * 0.5 / 30.0 / 7200.0;
    assert!(
        (0.4 * sigma_ppm..2.0 * sigma_ppm).contains(&floor),
        "{floor}"
    );
    assert!(value(&metrics, "scale_factor_nonlinearity_ppm") < 5.0 * sigma_ppm);
}

fn factor_floor(metrics: &fogbench::metrics::ChannelMetrics) -> f64 {
    metrics.metrics["scale_factor_nonlinearity_ppm"].fields["noise_floor_ppm"]
}

/// The paper's test at 25 C with an override; summary, text and names of the files.
fn run(sets: &[&str]) -> (Value, String, Vec<String>) {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = repository("scenarios/paper/scale-factor-25c.toml");
    let path = path.to_string_lossy().into_owned();
    let mut arguments = vec!["run", path.as_str(), "-o", "out"];
    arguments.extend(sets.iter().flat_map(|set| ["--set", set]));
    let output = fogbench(folder.path(), &arguments);
    let out = folder.path().join("out");
    let files = std::fs::read_dir(out.join("scale-factor-25c")).expect("a folder of results");
    let files = files
        .filter_map(|entry| Some(entry.ok()?.file_name().to_string_lossy().into_owned()))
        .collect();
    (summary(&out, "scale-factor-25c"), stdout(&output), files)
}

#[test]
fn the_papers_test_names_filter_state_and_noise_floor_and_passes() {
    let (found, text, files) = run(&[]);
    assert!(text.contains("PASS  1 run"), "{text}");
    assert!(
        text.contains("filter state: carried; 0.25 s of settling"),
        "{text}"
    );
    assert_eq!(found["scenario"]["filter_state"], "carried");
    for name in ["scale-factor.csv", "scale-factor.svg"] {
        assert!(files.iter().any(|file| file == name), "{files:?}");
    }
    let table = &found["channels"]["raw"]["curves"]["scale_factor"];
    let whole = table["whole_turns"].as_array().expect("a column");
    let whole = whole
        .iter()
        .filter(|entry| entry.as_f64() > Some(0.5))
        .count();
    assert_eq!(
        (table["turns"].as_array().map(Vec::len), whole),
        (Some(32), 6)
    );
    let floor = field(
        &found,
        "raw.scale_factor_nonlinearity_ppm",
        "noise_floor_ppm",
    );
    assert!((0.9..1.8).contains(&floor), "{floor}");
    // The filter that forgets nothing meets the second sense with what it learnt in the first.
    let asymmetry = field(&found, "rls.scale_factor_asymmetry_ppm", "low");
    assert!(asymmetry > 5.0, "{asymmetry}");
}

#[test]
fn filters_that_start_afresh_at_each_rate_treat_both_senses_alike() {
    let (found, text, _) = run(&["trial.filter_state=\"reset\""]);
    assert!(text.contains("filter state: reset"), "{text}");
    let asymmetry = field(&found, "rls.scale_factor_asymmetry_ppm", "value");
    assert!(asymmetry < 3.0, "{asymmetry}");
}
