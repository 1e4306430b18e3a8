//! The textbook filters against batch solutions, closed forms and published words.

use std::f64::consts::TAU;

use fogbench::Scenario;
use fogbench::filters::{
    Core, DivergenceKind, ExpectedWords, Filter, FilterKind, FrontEndConfig, Lms, LmsConfig,
    Normalisation, Rls, RlsConfig, RlsCore, adaptive_rule, conditional_keys,
    constant_eigenvalue_max, covariance_digits_warning, least_squares_rule, lms_step_bound,
    sine_eigenvalue_max,
};
use fogbench::random::Streams;
use fogbench::vocabulary::{DesiredSignal, OutputRegister, UpdateSign};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::{ProptestConfig, prop_assert, proptest};

use crate::support::{assert_close, kinds_of_the_bench, repository};

const PERIOD_S: f64 = 0.000_25;

fn white(name: &str, count: usize) -> Vec<f64> {
    let mut noise = vec![0.0; count];
    Streams::new(20_220_411, 0)
        .stream(name)
        .fill_normal(&mut noise);
    noise
}

/// A swing of `amplitude` in white noise of standard deviation `noise_std`, both in one unit.
fn swing(amplitude: f64, frequency_hz: f64, noise_std: f64, count: usize) -> Vec<f64> {
    let noise = white("swing", count);
    let sample = |(index, noise): (usize, &f64)| {
        amplitude * (TAU * frequency_hz * PERIOD_S * (index + 1) as f64).sin() + noise_std * noise
    };
    noise.iter().enumerate().map(sample).collect()
}

/// Constant plus white noise.
fn constant(mean: f64, noise_std: f64, count: usize) -> Vec<f64> {
    let noise = white("constant", count);
    noise.iter().map(|draw| mean + noise_std * draw).collect()
}

/// The defaults of recursive least squares: a one-step predictor of four taps.
fn predictor(forgetting_factor: f64, initial_inverse_correlation: f64) -> RlsConfig {
    RlsConfig {
        taps: 4,
        forgetting_factor,
        initial_inverse_correlation,
        update_sign: UpdateSign::Corrected,
        front_end: FrontEndConfig {
            desired: DesiredSignal::Current,
            input_lag_samples: 1,
            output_register: OutputRegister::NextSample,
        },
    }
}

/// Ten taps that aim at the mean of the newest two samples, which are among their regressors.
fn lms(step_size: f64, normalisation: Normalisation) -> LmsConfig {
    LmsConfig {
        taps: 10,
        step_size,
        normalisation,
        update_sign: UpdateSign::Corrected,
        front_end: FrontEndConfig {
            desired: DesiredSignal::TwoSampleMean,
            input_lag_samples: 0,
            output_register: OutputRegister::NextSample,
        },
    }
}

const ENERGY: Normalisation = Normalisation::Energy {
    regularisation_deg2_per_h2: 1.0,
};

/// Outputs, up to the first divergence if there is one.
fn run(filter: &mut dyn Filter, input: &[f64]) -> (Vec<f64>, Option<(u64, DivergenceKind)>) {
    let mut output = Vec::with_capacity(input.len());
    for sample in input {
        match filter.step(*sample) {
            Ok(word) => output.push(word.value_deg_per_h),
            Err(divergence) => return (output, Some((divergence.sample, divergence.kind))),
        }
    }
    (output, None)
}

/// Minimiser of `lambda^n |w|^2 / delta + sum lambda^(n-i) (d_i - w'L_i)^2`, by Cholesky.
fn batch_least_squares(input: &[f64], config: &RlsConfig) -> DVector<f64> {
    let taps = config.taps;
    let mut normal = DMatrix::<f64>::zeros(taps, taps);
    let mut right = DVector::<f64>::zeros(taps);
    for index in 0..input.len() {
        let age = i32::try_from(input.len() - 1 - index).expect("a short record");
        let weight = config.forgetting_factor.powi(age);
        let tap = |tap: usize| (index > tap).then(|| input[index - 1 - tap]);
        let regressors = DVector::from_fn(taps, |row, _| tap(row).unwrap_or(0.0));
        normal += weight * &regressors * regressors.transpose();
        right += weight * input[index] * regressors;
    }
    let count = i32::try_from(input.len()).expect("a short record");
    let prior = config.forgetting_factor.powi(count) / config.initial_inverse_correlation;
    normal += DMatrix::<f64>::identity(taps, taps) * prior;
    let factor = normal.cholesky().expect("the prior makes it definite");
    factor.solve(&right)
}

#[test]
fn recursive_least_squares_equals_regularised_batch_least_squares() {
    // Coloured by a first-order low pass, on a swing: the correlation matrix is far from diagonal.
    let mut coloured = 0.0;
    let input: Vec<_> = swing(3.0, 10.0, 1.0, 5000)
        .iter()
        .zip(white("colour", 5000))
        .map(|(swing, white)| {
            coloured = 0.7 * coloured + white;
            swing + coloured
        })
        .collect();
    for forgetting_factor in [1.0, 0.999] {
        // A weak prior and one that still shows in the weights after 5000 samples.
        for delta in [1e4, 1e-3] {
            let config = predictor(forgetting_factor, delta);
            let mut filter = Rls::new(&config);
            for (index, sample) in input.iter().enumerate() {
                filter.step(*sample).unwrap();
                let count = index + 1;
                if count % 1000 == 0 {
                    let batch = batch_least_squares(&input[..count], &config);
                    for (got, want) in filter.weights().iter().zip(batch.iter()) {
                        assert_close(*got, *want, 0.0, 1e-9);
                    }
                }
            }
            // The strong prior matters: a filter that forgot it would have been caught.
            if delta < 1.0 {
                let other = batch_least_squares(&input, &predictor(forgetting_factor, 1e4));
                let batch = batch_least_squares(&input, &config);
                assert!((other - batch).norm() > 1e-6);
            }
        }
    }
}

/// Seven updates with delta = 1e4 from p = 4 zero weights: y0 y1 y2 y3 y6 W0 W3 P01 P33.
struct Golden {
    forgetting_factor: f64,
    /// The recursion in exact rational arithmetic, rounded once.
    exact: [f64; 9],
    /// Words of an independent implementation of the hardware schedule, in Verilog and Python.
    words: [u64; 9],
}

const GOLDEN: [Golden; 2] = [
    Golden {
        forgetting_factor: 1.0,
        exact: [
            0.0,
            4.8514851485148505,
            19.86292298523276,
            6.204070307403896,
            -2.9856144273377034,
            -0.6295851258114143,
            -0.13273198930866423,
            0.5466314625982015,
            1.2599334821841577,
        ],
        words: [
            0x0000_0000_0000_0000,
            0x4013_67eb_b907_9a8b,
            0x4033_dce8_8550_8a21,
            0x4018_d0f7_ce81_817e,
            0xc007_e289_d11f_17a4,
            0xbfe4_258f_b4ac_ab59,
            0xbfc0_fd5c_a09c_9e60,
            0x3fe1_7e01_43da_583d,
            0x3ff4_28b0_02d1_db0c,
        ],
    },
    Golden {
        forgetting_factor: 0.99,
        exact: [
            0.0,
            4.851965541142686,
            19.932418877572214,
            6.284137961704222,
            -2.9886189388215634,
            -0.6279122745940134,
            -0.12226911899873358,
            0.564609404365394,
            1.2727102029362656,
        ],
        words: [
            0x0000_0000_0000_0000,
            0x4013_6869_a7a2_1b69,
            0x4033_eeb3_00e9_57f9,
            0x4019_22f5_0fd4_3fbd,
            0xc007_e8b1_0bd3_4b26,
            0xbfe4_17db_7b84_2d0e,
            0xbfbf_4d07_6b68_eae0,
            0x3fe2_1147_bdd8_67d4,
            0x3ff4_5d05_5fae_595d,
        ],
    },
];

#[test]
fn golden_words_of_the_hardware_schedule_agree_to_rounding() {
    let samples = [0.1, -0.7, 0.3, 1.1, -0.9, 0.2, 0.6, -0.4];
    for golden in GOLDEN {
        let mut core = RlsCore::new(&predictor(golden.forgetting_factor, 1e4));
        let mut regressors = [0.0; 4];
        let mut outputs = Vec::new();
        for pair in samples.windows(2) {
            regressors.rotate_right(1);
            regressors[0] = pair[0];
            outputs.push(core.update(&regressors, pair[1]).unwrap().value_deg_per_h);
        }
        let got = [
            outputs[0],
            outputs[1],
            outputs[2],
            outputs[3],
            outputs[6],
            core.weights()[0],
            core.weights()[3],
            core.inverse_correlation()[1],
            core.inverse_correlation()[15],
        ];
        let wanted = golden.exact.into_iter().zip(golden.words);
        for (got, (exact, word)) in got.into_iter().zip(wanted) {
            // The first updates cancel all but 1 / (delta |L|^2) of P, which magnifies rounding to
            // 1e4 x 2.2e-16 x |L|^2 = 4e-12; the hardware's longer chain ends 1.7e-11 off.
            assert_close(got, exact, 5e-12, 0.0);
            assert_close(got, f64::from_bits(word), 2e-11, 0.0);
        }
    }
}

#[test]
fn inverse_correlation_stays_symmetric_and_definite() {
    let mut filter = Rls::new(&predictor(0.99, 1e4));
    let (_, divergence) = run(&mut filter, &swing(1.0, 10.0, 0.005, 100_000));
    assert_eq!(divergence, None);
    let p = DMatrix::from_row_slice(4, 4, filter.core().inverse_correlation());
    assert_eq!(p, p.transpose());
    assert!(p.cholesky().is_some());
}

#[test]
fn a_one_step_predictor_of_white_noise_on_a_mean_has_the_gain_of_theory() {
    // The Earth rate at 34.27 deg in the noise of a 4 kHz gyro of 0.006 deg/sqrt(h).
    const COUNT: usize = 1_000_000;
    let (mean, noise_std) = (8.47, 22.8);
    let mut filter = Rls::new(&predictor(1.0, 7.716e-4));
    let mut last = 0.0;
    for sample in constant(mean, noise_std, COUNT) {
        last = filter.step(sample).unwrap().weight_sum;
    }
    let energy = noise_std * noise_std + 4.0 * mean * mean;
    let gain = 4.0 * mean * mean / energy;
    // Standard error of the weight sum: error variance x 1'R^-1 1 / n.
    let residual = noise_std * noise_std * (1.0 + gain * gain / 4.0)
        + mean * mean * (1.0 - gain) * (1.0 - gain);
    let standard_error = (residual * 4.0 / energy / COUNT as f64).sqrt();
    assert_close(last, gain, 0.0, 5.0 * standard_error);
    assert!(5.0 * standard_error < 0.03 * gain);
}

#[test]
fn normalised_lms_learns_the_mean_of_two_samples() {
    let mut filter = Lms::new(&lms(0.8, ENERGY));
    let (_, divergence) = run(&mut filter, &constant(0.0, 20.0, 5000));
    assert_eq!(divergence, None);
    for (tap, weight) in filter.weights().iter().enumerate() {
        assert_close(*weight, if tap < 2 { 0.5 } else { 0.0 }, 0.0, 1e-9);
    }
}

#[test]
fn published_identity_channel_is_learned() {
    // Adaptive filters that see the sample they aim at must find the unit impulse.
    let mut rls = predictor(1.0, 1e6);
    rls.front_end.input_lag_samples = 0;
    let mut lms = lms(0.8, ENERGY);
    lms.front_end.desired = DesiredSignal::Current;
    lms.taps = 4;
    let input = constant(0.0, 20.0, 2000);
    let mut filters: [Box<dyn Filter>; 2] = [Box::new(Rls::new(&rls)), Box::new(Lms::new(&lms))];
    for filter in &mut filters {
        run(filter.as_mut(), &input);
        for (weight, want) in filter.weights().iter().zip([1.0, 0.0, 0.0, 0.0]) {
            assert_close(*weight, want, 0.0, 1e-8);
        }
    }
}

#[test]
fn the_sign_as_printed_diverges_and_stays_diverged() {
    let rocking = swing(1.0, 10.0, 0.005, 400_000);
    let resting = constant(0.0024, 0.005, 400_000);
    for forgetting_factor in [1.0, 0.99] {
        for input in [&rocking, &resting] {
            let mut config = predictor(forgetting_factor, 1e4);
            let (_, sound) = run(&mut Rls::new(&config), input);
            assert_eq!(sound, None);
            config.update_sign = UpdateSign::AsPrinted;
            assert_diverges(&mut Rls::new(&config), input);
        }
    }
    for input in [&rocking, &resting] {
        let mut config = lms(
            0.8,
            Normalisation::Energy {
                regularisation_deg2_per_h2: 1e-9,
            },
        );
        let (_, sound) = run(&mut Lms::new(&config), input);
        assert_eq!(sound, None);
        config.update_sign = UpdateSign::AsPrinted;
        assert_diverges(&mut Lms::new(&config), input);
    }
}

fn assert_diverges(filter: &mut dyn Filter, input: &[f64]) {
    let (output, divergence) = run(filter, input);
    let (sample, kind) = divergence.expect("the minus sign diverges");
    assert_eq!(kind, DivergenceKind::Overflow);
    assert_eq!(output.len() as u64, sample);
    let later = filter.step(0.0).expect_err("diverged for good");
    assert_eq!((later.sample, later.kind), (sample, kind));
}

#[test]
fn plain_lms_with_step_0_8_runs_away_on_1_deg_per_s_and_holds_on_half_of_it() {
    // Words in deg/s. N A^2 / 2 = 5 against 1.25: bounds 0.4 and 1.6 about the step 0.8.
    let eigenvalue = |amplitude| sine_eigenvalue_max(10, amplitude, TAU * 10.0 * PERIOD_S, 0.005);
    assert_close(lms_step_bound(eigenvalue(1.0)), 0.4, 5e-3, 0.0);
    assert_close(lms_step_bound(eigenvalue(0.5)), 1.6, 5e-3, 0.0);
    let plain = lms(0.8, Normalisation::None);
    let (_, divergence) = run(&mut Lms::new(&plain), &swing(1.0, 10.0, 0.005, 40_000));
    assert!(matches!(divergence, Some((_, DivergenceKind::Overflow))));
    let mut filter = Lms::new(&plain);
    let input = swing(0.5, 10.0, 0.005, 40_000);
    let (output, divergence) = run(&mut filter, &input);
    assert_eq!(divergence, None);
    // One sample of register after the mean of two: the output is late by 1.5 samples.
    for index in 30_000..40_000 {
        let mean = 0.5 * (input[index - 1] + input[index - 2]);
        assert_close(output[index], mean, 0.0, 0.02);
    }
}

#[test]
fn eigenvalues_of_the_closed_forms_are_those_of_the_matrices() {
    let (amplitude, noise_std, mean) = (3.0_f64, 0.7, 2.0);
    for phase_step in [0.0, 0.0157, 0.3, 1.4] {
        let sine = DMatrix::<f64>::from_fn(10, 10, |row, column| {
            let lag = row as f64 - column as f64;
            let noise = if row == column {
                noise_std * noise_std
            } else {
                0.0
            };
            amplitude * amplitude / 2.0 * (lag * phase_step).cos() + noise
        });
        let want = sine.symmetric_eigenvalues().max();
        let got = sine_eigenvalue_max(10, amplitude, phase_step, noise_std);
        assert_close(got, want, 1e-12, 0.0);
    }
    let flat = DMatrix::<f64>::from_fn(10, 10, |row, column| {
        mean * mean
            + if row == column {
                noise_std * noise_std
            } else {
                0.0
            }
    });
    let want = flat.symmetric_eigenvalues().max();
    assert_close(
        constant_eigenvalue_max(10, mean, noise_std),
        want,
        1e-12,
        0.0,
    );
}

#[test]
fn covariance_warning_depends_on_delta_taps_and_rate() {
    // 1e4 (deg/s)^-2 is harmless up to hundreds of deg/s, the same number in (deg/h)^-2 is not.
    assert_eq!(covariance_digits_warning(7.716e-4, 4, 3600.0), None);
    let text = covariance_digits_warning(1e4, 4, 3600.0).unwrap();
    assert!(text.contains("5.2e11"), "{text}");
    assert_eq!(covariance_digits_warning(1e4, 4, 499.9), None);
    assert!(covariance_digits_warning(1e4, 4, 500.1).is_some());
}

#[test]
fn a_word_that_is_not_a_number_is_reported_at_its_sample() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut input = constant(8.0, 20.0, 100);
        input[37] = bad;
        let mut filters: [Box<dyn Filter>; 2] = [
            Box::new(Rls::new(&predictor(1.0, 7.716e-4))),
            Box::new(Lms::new(&lms(0.8, ENERGY))),
        ];
        for filter in &mut filters {
            let (_, divergence) = run(filter.as_mut(), &input);
            assert_eq!(divergence, Some((37, DivergenceKind::NotFinite)));
            assert!(filter.step(1.0).is_err());
        }
    }
}

#[test]
fn wind_up_on_a_silent_input_is_reported() {
    // P doubles every sample at a forgetting factor of one half: 2^1024 is infinite.
    let (_, divergence) = run(&mut Rls::new(&predictor(0.5, 1.0)), &[0.0; 2000]);
    assert_eq!(divergence, Some((1023, DivergenceKind::NotFinite)));
    // Without forgetting nothing happens.
    let (output, divergence) = run(&mut Rls::new(&predictor(1.0, 1.0)), &[0.0; 2000]);
    assert_eq!(divergence, None);
    assert!(output.iter().all(|word| *word == 0.0));
}

#[test]
fn an_exhausted_matrix_is_reported_as_no_longer_definite() {
    // Words far beyond what delta leaves digits for: P collapses onto its rounding errors.
    let input = swing(3.6e9, 10.0, 1e-3, 20_000);
    let (_, divergence) = run(&mut Rls::new(&predictor(1.0, 1e20)), &input);
    assert!(
        divergence.is_some_and(|(_, kind)| { kind == DivergenceKind::LostPositiveDefiniteness })
    );
}

#[test]
fn a_start_up_transient_is_no_divergence() {
    // The first regressor is a thousandth of what it must predict: a weight of 1000 for a while.
    let mut input = constant(1.0, 0.01, 20_000);
    input[0] = 1e-3;
    let (output, divergence) = run(&mut Rls::new(&predictor(1.0, 1e12)), &input);
    assert_eq!(divergence, None);
    let peak = output.iter().fold(0.0_f64, |max, word| max.max(word.abs()));
    assert!(peak > 500.0, "the transient of {peak} is no challenge");
}

#[test]
fn the_output_register_delays_by_exactly_one_sample() {
    let input = swing(1.0, 10.0, 0.005, 1000);
    let mut config = predictor(1.0, 1e4);
    let (late, _) = run(&mut Rls::new(&config), &input);
    config.front_end.output_register = OutputRegister::Immediate;
    let (prompt, _) = run(&mut Rls::new(&config), &input);
    assert_eq!(late[0].to_bits(), 0.0_f64.to_bits());
    assert_eq!(late[1..], prompt[..999]);
    assert_ne!(late, prompt);
}

#[test]
fn shapes_tell_the_age_of_the_newest_weighed_sample() {
    let shape = Rls::new(&predictor(1.0, 1e4)).shape();
    assert_eq!(
        (shape.taps, shape.newest_age_samples, shape.register_samples),
        (Some(4), 2, 1)
    );
    assert_eq!(shape.rule, least_squares_rule(DesiredSignal::Current, 1.0));
    let shape = Lms::new(&lms(0.8, ENERGY)).shape();
    assert_eq!(
        (shape.taps, shape.newest_age_samples, shape.register_samples),
        (Some(10), 1, 1)
    );
    assert_eq!(shape.rule, adaptive_rule(DesiredSignal::TwoSampleMean));
    // The filter does as its shape says: a sample first shows in the output at its age.
    let mut filter = Lms::new(&lms(0.8, ENERGY));
    let mut input = constant(0.0, 20.0, 500);
    run(&mut filter, &input);
    let mut other = filter.clone();
    input[0] += 1.0;
    let with = other.step(input[0]).unwrap();
    let without = filter.step(input[0] - 1.0).unwrap();
    assert_eq!(with, without);
    let (with, without) = (other.step(0.0).unwrap(), filter.step(0.0).unwrap());
    assert_close(
        with.value_deg_per_h - without.value_deg_per_h,
        0.5,
        1e-6,
        0.0,
    );
    assert_close(with.weight_sum, 1.0, 1e-6, 0.0);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn recursive_least_squares_does_not_know_the_unit(
        scale in 1e-3..1e4_f64,
        forgetting_factor in 0.95..1.0_f64,
        mean in -10.0..10.0_f64,
    ) {
        // Words times c and delta over c^2 give outputs times c.
        let input = constant(mean, 5.0, 300);
        let scaled: Vec<_> = input.iter().map(|sample| scale * sample).collect();
        let (base, _) = run(&mut Rls::new(&predictor(forgetting_factor, 1.0)), &input);
        let config = predictor(forgetting_factor, 1.0 / (scale * scale));
        let (other, _) = run(&mut Rls::new(&config), &scaled);
        for (base, other) in base.iter().zip(&other) {
            prop_assert!((other / scale - base).abs() < 1e-9 * (1.0 + base.abs()));
        }
    }
}

/// Names of every kind of filter.
fn kinds() -> &'static [&'static str] {
    FilterKind::TABLE
        .group
        .expect("a filter has one kind")
        .alternatives
}

#[test]
fn every_kind_is_read_built_and_run_with_its_defaults_and_stands_in_the_page_of_filters() {
    let page =
        std::fs::read_to_string(repository("docs/filters.md")).expect("the page is readable");
    for kind in kinds() {
        assert!(
            page.contains(&format!("`{kind}`")),
            "docs/filters.md lacks `{kind}`"
        );
    }
    for kind in &kinds_of_the_bench() {
        let text = format!(
            "schema = 1\nname = \"one\"\nduration_s = 1.0\n[[filter]]\nname = \"f\"\n[filter.{kind}]\n"
        );
        let scenario = Scenario::from_toml(&text).unwrap_or_else(|error| panic!("{kind}: {error}"));
        let plans = scenario
            .points()
            .unwrap_or_else(|error| panic!("{kind}: {error}"));
        let filter = &plans[0].resolved().scenario.filters[0];
        assert_eq!(filter.kind.name(), *kind);
        let words = ExpectedWords {
            sample_rate_hz: 1.0 / PERIOD_S,
            peak_deg_per_h: 20.0,
            run: None,
        };
        assert_eq!(filter.check(0), []);
        assert_eq!(filter.check_on(0, &words), []);
        // A word enters the output and is forgotten, or is the rate that was always there.
        let built = filter.kind.settings().build(PERIOD_S);
        let mut built = built.expect("a filter of the bench");
        let noise = white(kind, 2000);
        let outputs: Vec<f64> = noise
            .iter()
            .map(|word| {
                built
                    .step(15.0 + word)
                    .expect("no divergence")
                    .value_deg_per_h
            })
            .collect();
        let last = outputs[1999];
        assert!(
            last.is_finite()
                && outputs[1000..]
                    .iter()
                    .any(|word| word.to_bits() != last.to_bits()),
            "{kind}"
        );
        let shape = built.shape();
        assert!(shape.newest_age_samples >= shape.register_samples, "{kind}");
    }
    for key in conditional_keys() {
        assert!(
            kinds().contains(&key.kind) && !key.needs.is_empty(),
            "{key:?}"
        );
    }
}
