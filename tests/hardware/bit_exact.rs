//! The pipelines, their clock-less engines and the exported RTL give the same words.

use fogbench::fpga::engine::Engine as _;
use fogbench::fpga::float_unit::{FlushToZero, Fp};
use fogbench::fpga::front_end::Pair;
use fogbench::fpga::lms::{DesiredSource, LmsConfig, LmsEngine, LmsPipeline, LmsSettings};
use fogbench::fpga::rls::{RlsConfig, RlsEngine, RlsPipeline, RlsSettings};
use fogbench::vocabulary::{Division, UpdateOrder, UpdateSign};
use proptest::prelude::*;

use crate::support::stimulus::{SETUPS, Setup, predictor_pairs, words};

const SELF_CHECK_PAIRS: [(f64, f64); 7] = [
    (0.1, -0.7),
    (-0.7, 0.3),
    (0.3, 1.1),
    (1.1, -0.9),
    (-0.9, 0.2),
    (0.2, 0.6),
    (0.6, -0.4),
];

fn settings(tap_count: usize, alpha: f64, division: Division) -> RlsSettings {
    RlsSettings {
        tap_count,
        forgetting_factor: alpha,
        initial_inverse_correlation: 1e4,
        division,
        update_sign: UpdateSign::Corrected,
    }
}

fn config<F: Fp>(tap_count: usize, alpha: f64, division: Division) -> RlsConfig<F> {
    RlsConfig::new(settings(tap_count, alpha, division)).expect("settings are in range")
}

#[test]
fn golden_self_check_words_are_reproduced() {
    // Words of an independent RTL run (p = 4, delta = 1e4): y0 y1 y2 y3 y6, W0 W3, R01 R33.
    #[rustfmt::skip]
    let golden: [(f64, Division, [u64; 9]); 3] = [
        (1.0, Division::Reciprocal, [
            0x0000_0000_0000_0000, 0x4013_67eb_b907_9a8b, 0x4033_dce8_8550_8a21,
            0x4018_d0f7_ce81_817e, 0xc007_e289_d11f_17a4, 0xbfe4_258f_b4ac_ab59,
            0xbfc0_fd5c_a09c_9e60, 0x3fe1_7e01_43da_583d, 0x3ff4_28b0_02d1_db0c]),
        (0.99, Division::Reciprocal, [
            0x0000_0000_0000_0000, 0x4013_6869_a7a2_1b69, 0x4033_eeb3_00e9_57f9,
            0x4019_22f5_0fd4_3fbd, 0xc007_e8b1_0bd3_4b26, 0xbfe4_17db_7b84_2d0e,
            0xbfbf_4d07_6b68_eae0, 0x3fe2_1147_bdd8_67d4, 0x3ff4_5d05_5fae_595d]),
        (0.99, Division::Elementwise, [
            0x0000_0000_0000_0000, 0x4013_6869_a7a2_1b69, 0x4033_eeb3_00e9_582c,
            0x4019_22f5_0fd4_38fa, 0xc007_e8b1_0bd3_6e54, 0xbfe4_17db_7b84_26cd,
            0xbfbf_4d07_6b69_a0a0, 0x3fe2_1147_bdd8_6a67, 0x3ff4_5d05_5fae_58bb]),
    ];
    let pairs = SELF_CHECK_PAIRS.map(|(x, d)| Pair::from_f64(x, d));
    for (alpha, division, want) in golden {
        let mut pipeline = RlsPipeline::<f64>::new(config(4, alpha, division));
        let mut y = Vec::new();
        pipeline.run(&pairs, &mut y);
        let b = pipeline.ramb();
        let got = [
            y[0],
            y[1],
            y[2],
            y[3],
            y[6],
            b[0],
            b[3],
            b[8 + 1],
            b[8 + 15],
        ]
        .map(Fp::to_bits);
        assert_eq!(got, want, "alpha {alpha}, {division:?}");
    }
}

/// Runs pipeline and engine over the same pairs and compares outputs and memories.
fn compare_rls<F: Fp>(config: RlsConfig<F>, pairs: &[Pair<F>]) -> Result<(), String> {
    let mut pipeline = RlsPipeline::new(config);
    let mut engine = RlsEngine::new(config);
    let (mut by_clock, mut at_once) = (Vec::new(), Vec::new());
    pipeline.run(pairs, &mut by_clock);
    engine.run(pairs, &mut at_once);
    for (k, (a, b)) in words(&by_clock).iter().zip(words(&at_once)).enumerate() {
        if *a != b {
            return Err(format!(
                "{config:?}: sample {k}: {a:016x} by clock, {b:016x} at once"
            ));
        }
    }
    if words(&by_clock).len() != pairs.len() {
        return Err(format!(
            "{} outputs for {} pairs",
            by_clock.len(),
            pairs.len()
        ));
    }
    if words(pipeline.rama()) != words(&engine.rama()) {
        return Err(format!("{config:?}: RAMA differs"));
    }
    if words(pipeline.ramb()) != words(&engine.ramb()) {
        return Err(format!("{config:?}: RAMB differs"));
    }
    Ok(())
}

#[test]
fn engine_and_pipeline_agree_on_ten_thousand_samples_of_every_setup() {
    for Setup {
        name,
        alpha,
        division,
        ..
    } in SETUPS
    {
        for tap_count in [1, 2, 3, 4, 5, 8] {
            let pairs = predictor_pairs::<f64>(name, 10_000);
            compare_rls(config(tap_count, alpha, division), &pairs).unwrap();
        }
    }
}

#[test]
fn engine_and_pipeline_agree_in_every_number_format() {
    fn check<F: Fp>() {
        for Setup {
            name,
            alpha,
            division,
            ..
        } in SETUPS
        {
            for tap_count in [1, 4, 6] {
                let pairs = predictor_pairs::<F>(name, 1000);
                compare_rls(config::<F>(tap_count, alpha, division), &pairs).unwrap();
            }
        }
    }
    check::<f32>();
    check::<FlushToZero<f32>>();
    check::<FlushToZero<f64>>();
}

#[test]
fn flushing_changes_words_only_where_subnormals_arise() {
    fn outputs<F: Fp>() -> Vec<u64> {
        let mut pairs = predictor_pairs::<F>("white", 40);
        for pair in &mut pairs {
            pair.desired = F::from_f64(pair.desired.to_f64() * 1e-310);
        }
        let mut y = Vec::new();
        RlsEngine::new(config(4, 1.0, Division::Reciprocal)).run(&pairs, &mut y);
        words(&y)
    }
    assert_ne!(outputs::<FlushToZero<f64>>(), outputs::<f64>());
    let zeros = outputs::<FlushToZero<f64>>();
    assert!(zeros.iter().all(|word| word << 1 == 0), "{zeros:016x?}");
    // On ordinary data the two formats are the same words.
    let pairs = predictor_pairs::<f64>("rocking", 2000);
    let flushed = predictor_pairs::<FlushToZero<f64>>("rocking", 2000);
    let (mut a, mut b) = (Vec::new(), Vec::new());
    RlsEngine::new(config(4, 0.99, Division::Reciprocal)).run(&pairs, &mut a);
    RlsEngine::new(config(4, 0.99, Division::Reciprocal)).run(&flushed, &mut b);
    assert_eq!(words(&a), words(&b));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn engine_and_pipeline_agree_for_random_settings(
        tap_count in 1_usize..=12,
        alpha in 0.5_f64..=1.0,
        delta_exponent in -8.0_f64..12.0,
        element in any::<bool>(),
        printed_sign in any::<bool>(),
        samples in prop::collection::vec((-1e3_f64..1e3, -1e3_f64..1e3), 1..60),
    ) {
        let mut settings = settings(
            tap_count, alpha, if element { Division::Elementwise } else { Division::Reciprocal });
        settings.initial_inverse_correlation = 10_f64.powf(delta_exponent);
        if printed_sign {
            settings.update_sign = UpdateSign::AsPrinted;
        }
        let pairs: Vec<_> = samples.iter().map(|(x, d)| Pair::from_f64(*x, *d)).collect();
        let outcome = compare_rls::<f64>(RlsConfig::new(settings).unwrap(), &pairs);
        prop_assert!(outcome.is_ok(), "{}", outcome.unwrap_err());
    }
}

#[test]
fn every_single_tap_count_agrees_up_to_the_largest() {
    for tap_count in 1..=64 {
        let pairs = predictor_pairs::<f64>("white", 80);
        compare_rls(config(tap_count, 0.98, Division::Reciprocal), &pairs).unwrap();
    }
}

#[test]
fn another_order_of_operations_is_noticed() {
    // The comparison can fail: gain-first differs from the schedule within 10,000 samples.
    let pairs = predictor_pairs::<f64>("rocking", 10_000);
    let config = config(4, 0.99, Division::Reciprocal);
    let (mut schedule, mut gain_first) = (Vec::new(), Vec::new());
    RlsEngine::new(config).run(&pairs, &mut schedule);
    RlsEngine::with_order(config, UpdateOrder::GainFirst).run(&pairs, &mut gain_first);
    let differing = words(&schedule)
        .iter()
        .zip(words(&gain_first))
        .filter(|(a, b)| **a != *b)
        .count();
    assert!(differing > 9_000, "{differing} of 10,000 words differ");
}

#[test]
fn the_schedule_keeps_the_inverse_symmetric_to_the_bit() {
    for tap_count in [4, 5] {
        let pairs = predictor_pairs::<f64>("rocking", 10_000);
        let mut engine = RlsEngine::new(config(tap_count, 0.99, Division::Reciprocal));
        engine.run(&pairs, &mut Vec::new());
        let r = words(engine.inverse_correlation().unwrap().matrix);
        for i in 0..tap_count {
            for j in 0..i {
                assert_eq!(r[i * tap_count + j], r[j * tap_count + i]);
            }
        }
    }
}

#[test]
fn a_nan_sample_poisons_engine_and_pipeline_alike_and_for_good() {
    let mut pairs = predictor_pairs::<f64>("white", 40);
    pairs[10].input = f64::NAN;
    let config = config(4, 1.0, Division::Reciprocal);
    compare_rls(config, &pairs).unwrap();
    let mut y = Vec::new();
    RlsEngine::new(config).run(&pairs, &mut y);
    assert!(y[..10].iter().all(|word| word.is_finite()));
    assert!(y[10..].iter().all(|word| word.is_nan()));
}

fn lms_settings(regularisation: Option<f64>) -> LmsSettings {
    LmsSettings {
        tap_count: 10,
        step_size: if regularisation.is_some() { 0.8 } else { 0.02 },
        regularisation,
        desired: DesiredSource::MeanOfTwoNewest,
        update_sign: UpdateSign::Corrected,
    }
}

#[test]
fn lms_engine_and_pipeline_agree_in_every_form() {
    for regularisation in [None, Some(1e-3)] {
        for desired in [DesiredSource::MeanOfTwoNewest, DesiredSource::Port] {
            for tap_count in [1, 2, 3, 10, 64] {
                for name in ["static", "rocking", "white"] {
                    let config = LmsConfig::<f64>::new(LmsSettings {
                        tap_count,
                        desired,
                        ..lms_settings(regularisation)
                    })
                    .unwrap();
                    let pairs = predictor_pairs::<f64>(name, 1000);
                    let mut pipeline = LmsPipeline::new(config);
                    let mut engine = LmsEngine::new(config);
                    let (mut a, mut b) = (Vec::new(), Vec::new());
                    pipeline.run(&pairs, &mut a);
                    engine.run(&pairs, &mut b);
                    assert_eq!(words(&a), words(&b), "{config:?} {name}");
                    assert_eq!(words(pipeline.rama()), words(&engine.rama()));
                    assert_eq!(words(pipeline.ramb()), words(&engine.ramb()));
                }
            }
        }
    }
}

#[test]
fn lms_learns_the_mean_of_two_from_white_input() {
    // With d = (x_k + x_{k-1})/2 the exact solution is W = [0.5, 0.5, 0, ...]: no noise is left,
    // so NLMS converges to it geometrically.
    let mut engine = LmsEngine::<f64>::new(LmsConfig::new(lms_settings(Some(1e-3))).unwrap());
    let pairs: Vec<_> = predictor_pairs::<f64>("white", 5000)
        .iter()
        .map(|pair| Pair {
            input: pair.desired,
            desired: 0.0,
        })
        .collect();
    engine.run(&pairs, &mut Vec::new());
    for (j, weight) in engine.weights().iter().enumerate() {
        let want = if j < 2 { 0.5 } else { 0.0 };
        crate::support::assert_close(*weight, want, 0.0, 1e-9);
    }
}
