//! Known answers of the scale factor test.

use fogbench::metrics::{
    Dwell, Estimate, Motion, RatePoint, Staircase, StaticZero, fit_scale_factor, measure,
    scale_factor_repeatability, scale_factor_temperature_sensitivity, support,
};

use crate::support::assert_close;
use crate::support::records::{
    PERIOD_S, every_metric_is_answered, raw_record, settings, value, white,
};
use crate::support::transcript::Transcript;
use crate::support::{code, field, fogbench, repository, stderr, stdout, summary};

fn point(input: f64, output: f64) -> RatePoint {
    RatePoint {
        input_deg_per_h: input,
        output_deg_per_h: output,
        deviation_deg_per_h: 0.0,
        degrees_of_freedom: 1.0,
    }
}

/// `y(x)` at `x = +-i / n`, i = 1..n.
fn both_senses(n: u32, y: impl Fn(f64) -> f64) -> Vec<RatePoint> {
    (1..=n)
        .flat_map(|i| [1.0, -1.0].map(|sense| sense * f64::from(i) / f64::from(n)))
        .map(|x| point(x, y(x)))
        .collect()
}

#[test]
fn known_answer_k27_an_exact_line_has_its_slope_and_offset_and_nothing_else() {
    for (factor, offset) in [(1.0, 0.0), (1.000_25, 3.5), (0.7, -100.0)] {
        for scale in [1.0, 1.0e6] {
            let points: Vec<RatePoint> = both_senses(11, |x| x)
                .iter()
                .map(|at| scale * at.input_deg_per_h)
                .map(|x| point(x, factor * x + offset))
                .collect();
            let fit = fit_scale_factor(&points, StaticZero::default()).unwrap();
            assert_close(fit.factor.value, factor, 1e-12, 0.0);
            assert_close(
                fit.offset_deg_per_h,
                offset,
                0.0,
                1e-12 * (scale + offset.abs()),
            );
            assert!(fit.nonlinearity.value.value < 1e-12);
            let asymmetry = fit.asymmetry.unwrap();
            assert!(asymmetry.value.value < 1e-12);
            assert_close(asymmetry.positive, factor, 1e-12, 0.0);
        }
    }
}

#[test]
fn known_answer_k27_a_square_law_has_the_closed_form_of_asymmetry_and_nonlinearity() {
    // Of x + q x^2 on i / n, i = 1..n, the slope of i^2 on i is n + 1: K+- = 1 +- q (n + 1) / n.
    // Over both senses x is orthogonal to x^2, K = 1, F0 = q mean(x^2), and the largest residual is
    // at the ends.
    for n in [2_u32, 3, 11, 40] {
        for q in [1e-4, -0.02] {
            let fit = fit_scale_factor(&both_senses(n, |x| x + q * x * x), StaticZero::default())
                .unwrap();
            let count = f64::from(n);
            let asymmetry = fit.asymmetry.unwrap();
            let expected = 2.0 * q.abs() * (count + 1.0) / count;
            assert_close(asymmetry.value.value, expected, 1e-9, 0.0);
            assert_close(
                asymmetry.positive,
                1.0 + q * (count + 1.0) / count,
                1e-9,
                0.0,
            );
            assert_close(fit.factor.value, 1.0, 1e-12, 0.0);
            let mean_square = (count + 1.0) * (2.0 * count + 1.0) / (6.0 * count * count);
            assert_close(fit.offset_deg_per_h, q * mean_square, 1e-9, 0.0);
            let at_zero = mean_square - 1.0 / (count * count);
            let largest = q.abs() * (1.0 - mean_square).max(at_zero);
            assert_close(
                fit.nonlinearity.value.value,
                largest / (1.0 + q.abs()),
                1e-9,
                0.0,
            );
        }
    }
}

#[test]
fn the_reading_at_rest_is_subtracted_from_inputs_and_outputs() {
    let zero = StaticZero {
        input_deg_per_h: 8.47,
        output_deg_per_h: 9.0,
    };
    let points: Vec<RatePoint> = both_senses(5, |x| x)
        .iter()
        .map(|at| point(at.input_deg_per_h + 8.47, 1.5 * at.input_deg_per_h + 9.0))
        .collect();
    let fit = fit_scale_factor(&points, zero).unwrap();
    assert_close(fit.factor.value, 1.5, 1e-12, 0.0);
    assert_close(fit.offset_deg_per_h, 0.0, 0.0, 1e-12);
    // Both senses are there although every input is positive.
    assert!(fit.asymmetry.is_some());
}

#[test]
fn three_rates_make_a_scale_factor_and_two_of_each_sense_an_asymmetry() {
    let fit = |inputs: &[f64]| {
        let points: Vec<RatePoint> = inputs.iter().map(|x| point(*x, *x)).collect();
        fit_scale_factor(&points, StaticZero::default())
    };
    assert!(fit(&[]).is_err());
    let mut transcript = Transcript::of("metrics", "Rates too few for a scale factor");
    transcript.case(
        "four dwells at two rates",
        fit(&[1.0, 2.0, 1.0, 2.0]).unwrap_err(),
    );
    transcript.check();
    assert!(fit(&[1.0, 2.0, 3.0]).unwrap().asymmetry.is_none());
    // A table at rest belongs to neither sense.
    assert!(fit(&[-1.0, 0.0, 1.0, 2.0]).unwrap().asymmetry.is_none());
    assert!(fit(&[-2.0, -1.0, 1.0, 2.0]).unwrap().asymmetry.is_some());
}

#[test]
fn intervals_cover_the_truth() {
    const RUNS: u64 = 1000;
    let noise = 1e-3;
    let mut found: Vec<[Estimate; 3]> = Vec::new();
    for seed in 0..RUNS {
        let errors = white(9_000 + seed, 22, noise);
        let points: Vec<RatePoint> = both_senses(11, |x| x)
            .iter()
            .zip(&errors)
            .map(|(at, error)| RatePoint {
                output_deg_per_h: at.input_deg_per_h + error,
                deviation_deg_per_h: noise,
                degrees_of_freedom: 1e6,
                ..*at
            })
            .collect();
        let fit = fit_scale_factor(&points, StaticZero::default()).unwrap();
        let asymmetry = fit.asymmetry.unwrap().value;
        found.push([fit.factor, fit.nonlinearity.value, asymmetry]);
    }
    // The mean over records: of the largest of residuals and of a magnitude that is what noise makes.
    for metric in 0..3 {
        let mean = found.iter().map(|of| of[metric].value).sum::<f64>() / RUNS as f64;
        let holds = found
            .iter()
            .filter(|of| of[metric].low <= mean && mean <= of[metric].high);
        // 950 of 1000, binomial standard deviation 6.9.
        let covered = holds.count();
        assert!((922..=978).contains(&covered), "{metric}: {covered}");
    }
}

#[test]
fn repeatability_and_temperature_sensitivity_are_their_definitions() {
    let factors = [1.0, 1.000_001, 0.999_999, 1.000_002, 0.999_998, 1.0];
    // Squares of the deviations: 0 + 1 + 1 + 4 + 4 + 0 = 10 times 1e-12, over 5.
    let expected = 2.0_f64.sqrt() * 1e-6;
    let found = scale_factor_repeatability(&factors).unwrap();
    assert_close(found, expected, 1e-9, 0.0);
    assert_eq!(scale_factor_repeatability(&[1.0]), None);

    let tests = [(-40.0, 0.999_35), (25.0, 1.0), (60.0, 1.000_7)];
    let found = scale_factor_temperature_sensitivity((25.0, 1.0), &tests).unwrap();
    assert_close(found, 20e-6, 1e-9, 0.0);
    assert_eq!(
        scale_factor_temperature_sensitivity((25.0, 1.0), &[(25.0, 1.1)]),
        None
    );
}

/// Five dwells of 1000 samples at -2, -1, 0, 1, 2 times 3600 deg/h on 8 deg/h of Earth rate.
fn staircase() -> (Motion, Vec<f64>) {
    let rates = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|step: f64| 3600.0 * step + 8.0);
    let dwells = rates.iter().zip([0, 1000, 2000, 3000, 4000]);
    let staircase = Staircase {
        dwells: dwells
            .map(|(rate, start)| Dwell {
                samples: start + 100..start + 1000,
                rate_deg_per_h: *rate,
            })
            .collect(),
        settle_s: 100.0 * PERIOD_S,
        rest_deg_per_h: 8.0,
        has_static_zeros: false,
        is_found: false,
    };
    let motion = Motion::Steps {
        last_step_index: 4000,
        step_deg_per_h: 3600.0,
        staircase,
    };
    let truth = rates.iter().flat_map(|rate| vec![*rate; 1000]).collect();
    (motion, truth)
}

#[test]
fn a_staircase_gives_its_scale_factor_and_leaves_the_settling_out() {
    let (motion, truth) = staircase();
    let mut raw = white(3, 5000, 5.0);
    for (index, (word, rate)) in raw.iter_mut().zip(&truth).enumerate() {
        // 200 ppm too much, 4 deg/h of bias, and nonsense while it settles.
        *word += 1.000_2 * rate + 4.0 + if index % 1000 < 100 { 1e4 } else { 0.0 };
    }
    let record = raw_record(&raw, &truth);
    let metrics = measure(&record, &settings(motion), None);
    every_metric_is_answered(&metrics);
    let factor = &metrics.metrics["scale_factor_error_ppm"];
    // 5 / sqrt(900) on each mean, over the root sum of squares 3600 sqrt(10): 14.6 ppm.
    let sigma_ppm = 1e6 * 5.0 / 30.0 / (3600.0 * 10.0_f64.sqrt());
    assert_close(factor.estimate.value, 200.0, 0.0, 4.0 * sigma_ppm);
    let half_width = factor.estimate.high - factor.estimate.value;
    assert!(
        (1.2 * sigma_ppm..3.5 * sigma_ppm).contains(&half_width),
        "{factor:?}"
    );
    assert_close(factor.fields["offset_deg_per_h"], 4.0, 0.0, 0.4);
    assert_eq!(factor.fields["count"].to_bits(), 5.0_f64.to_bits());
    assert!(value(&metrics, "scale_factor_nonlinearity_ppm") < 100.0);
    assert!(value(&metrics, "scale_factor_asymmetry_ppm") < 200.0);
    let response = &metrics.curves["response"];
    assert_eq!(response["input_deg_per_h"].len(), 5);
    for (error, input) in response["error_deg_per_h"]
        .iter()
        .zip(&response["input_deg_per_h"])
    {
        assert_close(*error, 4.0 + 2e-4 * input, 0.0, 4.0 * 5.0 / 30.0);
    }
}

#[test]
fn a_staircase_of_too_few_rates_says_so_before_it_runs() {
    let (motion, _) = staircase();
    let ask = |metric: &str, samples: f64| {
        support(metric, samples * PERIOD_S, PERIOD_S, &motion, false, 100.0)
    };
    assert!(ask("scale_factor_asymmetry_ppm", 5000.0).is_ok());
    assert!(ask("scale_factor_nonlinearity_ppm", 4050.0).is_ok());
    let mut transcript = Transcript::of("metrics", "Staircases of too few rates");
    for (metric, samples) in [
        ("scale_factor_asymmetry_ppm", 4050.0),
        ("scale_factor_error_ppm", 2050.0),
    ] {
        transcript.case(metric, ask(metric, samples).unwrap_err());
    }
    transcript.check();
}

#[test]
fn a_settling_time_that_leaves_nothing_of_a_dwell_is_refused_if_it_was_asked_for() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let steps = |more: &str| {
        let text = format!(
            "schema = 1\nname = \"x\"\nduration_s = 2.0\nwarm_up_s = 1.0\n[turntable.steps]\n\
             rates_deg_per_s = [0.0, 1.0]\ndwell_s = 0.05\n{more}"
        );
        crate::support::write(folder.path(), "x.toml", &text);
        fogbench(folder.path(), &["check", "x.toml"])
    };
    let asked = steps("settle_s = 0.05\n");
    let mut transcript = Transcript::of("motion", "A settling time that leaves nothing of a dwell");
    transcript.case("settle_s = 0.05, dwell_s = 0.05", stderr(&asked));
    transcript.check();
    // The default alone is no reason to refuse a staircase of short dwells.
    assert_eq!(code(&steps("")), 0);
}

#[test]
fn the_shipped_scale_factor_test_passes_and_draws_its_response() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = repository("scenarios/audit/scale-factor.toml");
    let path = path.to_string_lossy().into_owned();
    let output = fogbench(folder.path(), &["run", path.as_str(), "-o", "out"]);
    assert_eq!(code(&output), 0, "{}{}", stdout(&output), stderr(&output));
    let out = folder.path().join("out");
    let run = summary(&out, "scale-factor");
    assert_close(
        field(&run, "raw.scale_factor_error_ppm", "settle_s"),
        0.1,
        0.0,
        1e-12,
    );
    assert_close(
        field(&run, "raw.scale_factor_error_ppm", "count"),
        23.0,
        0.0,
        1e-12,
    );
    assert!(out.join("scale-factor/response.svg").exists());
}
