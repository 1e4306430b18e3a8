//! A reset in any clock rebuilds every word: the pipeline is as new, whatever was in it.

use fogbench::fpga::float_unit::Fp;
use fogbench::fpga::front_end::Pair;
use fogbench::fpga::lms::{DesiredSource, LmsConfig, LmsPipeline, LmsSettings};
use fogbench::fpga::machine::{Machine, Sequencer};
use fogbench::fpga::registers::ControlState as _;
use fogbench::fpga::rls::{RlsConfig, RlsPipeline, RlsSettings};
use fogbench::fpga::sign_lms::{SignLmsConfig, SignLmsPipeline, SignLmsSettings};
use fogbench::vocabulary::{Division, UpdateSign};

use crate::support::stimulus::predictor_pairs;

fn rls(tap_count: usize) -> RlsPipeline<f64> {
    let settings = RlsSettings {
        tap_count,
        forgetting_factor: 0.99,
        initial_inverse_correlation: 1e4,
        division: Division::Reciprocal,
        update_sign: UpdateSign::Corrected,
    };
    RlsPipeline::new(RlsConfig::new(settings).expect("settings are in range"))
}

fn lms(tap_count: usize) -> LmsPipeline<f64> {
    let settings = LmsSettings {
        tap_count,
        step_size: 0.5,
        regularisation: Some(1.0),
        desired: DesiredSource::MeanOfTwoNewest,
        update_sign: UpdateSign::Corrected,
    };
    LmsPipeline::new(LmsConfig::new(settings).expect("settings are in range"))
}

fn sign_lms(tap_count: usize) -> SignLmsPipeline<f64> {
    let settings = SignLmsSettings {
        tap_count,
        delay_samples: 2,
        normalised: false,
        step: 0.01,
        regularisation: 1e-4,
        initial_weight: 0.25,
        guard: Some(6.0),
        norm_recompute_samples: 7,
    };
    SignLmsPipeline::new(SignLmsConfig::new(settings).expect("settings are in range"))
}

fn bits<F: Fp>(words: &[F]) -> Vec<u64> {
    words.iter().map(|word| word.to_bits()).collect()
}

fn memories<M: Machine>(pipeline: &Sequencer<M>) -> [Vec<u64>; 2] {
    [bits(pipeline.rama()), bits(pipeline.ramb())]
}

/// Clocks until the machine waits for a sample; no sample may be taken meanwhile.
fn clear<M: Machine>(pipeline: &mut Sequencer<M>, offered: Option<Pair<M::Word>>) -> usize {
    let mut clocks = 0;
    while pipeline.registers().state != M::State::IDLE {
        let tick = pipeline.tick(offered);
        assert!(!tick.accepted && tick.output.is_none());
        clocks += 1;
    }
    clocks
}

/// Resets in each of the first clocks, the memories full of words or of NaN, and compares with a
/// pipeline that was never used.
fn check<M: Machine<Word = f64> + Clone>(fresh: &Sequencer<M>, clocks: usize, wanted: usize) {
    let pairs = predictor_pairs::<f64>("white", 6);
    let mut words = Vec::new();
    fresh.clone().run(&pairs, &mut words);
    for clock in 0..clocks {
        for input in [
            Pair::from_f64(0.7, -0.4),
            Pair::from_f64(f64::NAN, f64::NAN),
        ] {
            let mut pipeline = fresh.clone();
            for _ in 0..clock {
                pipeline.tick(Some(input));
            }
            pipeline.reset();
            // A second reset while the first one clears begins again.
            for _ in 0..clock % wanted {
                pipeline.tick(Some(input));
            }
            pipeline.reset();
            assert_eq!(clear(&mut pipeline, Some(input)), wanted, "clock {clock}");
            assert_eq!(memories(&pipeline), memories(fresh), "clock {clock}");
            assert!(pipeline.registers() == fresh.registers(), "clock {clock}");
            let mut again = Vec::new();
            pipeline.run(&pairs, &mut again);
            assert_eq!(bits(&again), bits(&words), "clock {clock}");
        }
    }
}

#[test]
fn a_reset_in_any_clock_leaves_nothing_of_the_past() {
    for tap_count in [1, 2, 4] {
        let period = 4 + 6 * tap_count + 5 * tap_count * tap_count;
        let clears = tap_count * tap_count + 2 * tap_count;
        check(&rls(tap_count), 2 * period + 3, clears);
        check(&lms(tap_count), 2 * (4 * tap_count + 5) + 3, tap_count);
        check(&sign_lms(tap_count), 9 * (3 * tap_count + 7) + 3, tap_count);
    }
}

#[test]
fn a_run_straight_after_a_reset_waits_for_the_clearing() {
    let pairs = predictor_pairs::<f64>("rocking", 20);
    let mut pipeline = rls(4);
    let (mut words, mut again) = (Vec::new(), Vec::new());
    pipeline.run(&pairs, &mut words);
    pipeline.reset();
    pipeline.run(&pairs, &mut again);
    assert_eq!(bits(&words), bits(&again));
    assert!(bits(&words).iter().any(|word| *word != words[0].to_bits()));
}
