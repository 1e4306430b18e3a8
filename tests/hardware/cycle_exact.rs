//! Clocks are counted, never computed: periods, latencies, time per state, port use.

use fogbench::fpga::FpgaError;
use fogbench::fpga::front_end::Pair;
use fogbench::fpga::lms::{
    DesiredSource, LmsConfig, LmsPipeline, LmsSettings, lms_clocks_per_sample, lms_latency_clocks,
};
use fogbench::fpga::rls::{
    RlsConfig, RlsPipeline, RlsSettings, rls_clocks_per_sample, rls_latency_clocks,
};
use fogbench::vocabulary::{Division, UpdateSign};

use crate::support::assert_close;
use crate::support::transcript::Transcript;

fn rls(tap_count: usize) -> RlsPipeline<f64> {
    RlsPipeline::new(
        RlsConfig::new(RlsSettings {
            tap_count,
            forgetting_factor: 1.0,
            initial_inverse_correlation: 1e4,
            division: Division::Reciprocal,
            update_sign: UpdateSign::Corrected,
        })
        .expect("settings are in range"),
    )
}

fn lms(tap_count: usize, normalised: bool) -> LmsPipeline<f64> {
    LmsPipeline::new(
        LmsConfig::new(LmsSettings {
            tap_count,
            step_size: 0.1,
            regularisation: normalised.then_some(1.0),
            desired: DesiredSource::MeanOfTwoNewest,
            update_sign: UpdateSign::Corrected,
        })
        .expect("settings are in range"),
    )
}

/// Clocks in which samples were accepted and results were strobed out, the strobe of sample k
/// being raised in clock `offers[k]` at the earliest.
fn observe(
    mut tick: impl FnMut(Option<Pair<f64>>) -> (bool, bool),
    offers: &[usize],
) -> (Vec<usize>, Vec<usize>) {
    let (mut accepted, mut finished) = (Vec::new(), Vec::new());
    let mut clock = 0;
    while finished.len() < offers.len() {
        let next = accepted.len();
        let offered = offers.get(next).is_some_and(|from| clock >= *from);
        let (taken, done) = tick(offered.then(|| Pair::from_f64(0.25, 0.5)));
        if taken {
            accepted.push(clock);
        }
        if done {
            finished.push(clock);
        }
        clock += 1;
    }
    (accepted, finished)
}

fn observe_rls(tap_count: usize, offers: &[usize]) -> (Vec<usize>, Vec<usize>) {
    let mut pipeline = rls(tap_count);
    observe(
        |input| {
            let tick = pipeline.tick(input);
            (tick.accepted, tick.output.is_some())
        },
        offers,
    )
}

fn observe_lms(tap_count: usize, normalised: bool) -> (Vec<usize>, Vec<usize>) {
    let mut pipeline = lms(tap_count, normalised);
    observe(
        |input| {
            let tick = pipeline.tick(input);
            (tick.accepted, tick.output.is_some())
        },
        &[0; 5],
    )
}

#[test]
fn four_taps_at_forty_megahertz_take_108_clocks_and_answer_after_99() {
    let (accepted, finished) = observe_rls(4, &[0; 6]);
    let period = accepted[1] - accepted[0];
    let latency = finished[0] - accepted[0];
    assert_eq!((period, latency), (108, 99));
    let clock_mhz = 40.0;
    assert_close(period as f64 / clock_mhz, 2.70, 1e-12, 0.0);
    assert_close(clock_mhz * 1e3 / period as f64, 370.370_370, 1e-8, 0.0);
    assert_close(latency as f64 / clock_mhz, 2.475, 1e-12, 0.0);
}

#[test]
fn counted_periods_and_latencies_equal_the_formulas_for_1_to_16_taps() {
    for tap_count in 1..=16 {
        let (accepted, finished) = observe_rls(tap_count, &[0; 4]);
        for pair in accepted.windows(2) {
            assert_eq!(
                pair[1] - pair[0],
                4 + 6 * tap_count + 5 * tap_count * tap_count
            );
            assert_eq!(pair[1] - pair[0], rls_clocks_per_sample(tap_count));
        }
        for (start, end) in accepted.iter().zip(&finished) {
            assert_eq!(end - start, rls_latency_clocks(tap_count));
        }
    }
}

#[test]
fn waking_from_idle_costs_one_clock() {
    // Offered at clock 0 from reset and at 500 from idle: accepted one clock later each.
    let (accepted, _) = observe_rls(4, &[0, 500]);
    assert_eq!(accepted, [1, 501]);
    // Offered while busy, even in its last clock: no idle clock in between.
    let (accepted, _) = observe_rls(4, &[0, 108]);
    assert_eq!(accepted, [1, 109]);
    // One clock later the machine has gone idle.
    let (accepted, _) = observe_rls(4, &[0, 109]);
    assert_eq!(accepted, [1, 110]);
}

#[test]
fn a_withdrawn_strobe_is_not_taken() {
    let mut pipeline = rls(2);
    let before = pipeline.rama().to_vec();
    assert!(!pipeline.tick(Some(Pair::from_f64(1.0, 1.0))).accepted);
    assert!(!pipeline.tick(None).accepted);
    for _ in 0..100 {
        assert_eq!(pipeline.tick(None).output, None);
    }
    assert_eq!(pipeline.rama(), before);
}

#[test]
fn lms_takes_3n_plus_4_and_nlms_4n_plus_5_clocks() {
    for tap_count in [1, 2, 5, 10, 64] {
        for (normalised, want) in [(false, 3 * tap_count + 4), (true, 4 * tap_count + 5)] {
            let (accepted, finished) = observe_lms(tap_count, normalised);
            for pair in accepted.windows(2) {
                assert_eq!(pair[1] - pair[0], want);
                assert_eq!(
                    pair[1] - pair[0],
                    lms_clocks_per_sample(tap_count, normalised)
                );
            }
            for (start, end) in accepted.iter().zip(&finished) {
                assert_eq!(end - start, lms_latency_clocks(tap_count, normalised));
            }
        }
    }
    assert_eq!(
        (lms_latency_clocks(10, false), lms_latency_clocks(10, true)),
        (12, 23)
    );
}

#[test]
fn parameters_out_of_range_are_refused_with_value_and_range() {
    let good = RlsSettings {
        tap_count: 4,
        forgetting_factor: 1.0,
        initial_inverse_correlation: 1e4,
        division: Division::Reciprocal,
        update_sign: UpdateSign::Corrected,
    };
    let refuse = |settings: RlsSettings| RlsConfig::<f64>::new(settings).unwrap_err().to_string();
    let mut transcript = Transcript::of("hardware", "Parameters of an RLS pipeline that cannot be");
    for tap_count in [0, 65] {
        let said = refuse(RlsSettings { tap_count, ..good });
        transcript.case(format!("{tap_count} taps"), said);
    }
    for forgetting_factor in [0.0, -0.5, 1.000_001, f64::NAN, f64::INFINITY, 5e-324] {
        let settings = RlsSettings {
            forgetting_factor,
            ..good
        };
        transcript.case(format!("alpha = {forgetting_factor:e}"), refuse(settings));
    }
    for initial_inverse_correlation in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let settings = RlsSettings {
            initial_inverse_correlation,
            ..good
        };
        transcript.case(
            format!("delta = {initial_inverse_correlation}"),
            refuse(settings),
        );
    }
    transcript.check();
    // Rounded to binary32 this delta is infinite.
    let large = RlsSettings {
        initial_inverse_correlation: 1e39,
        ..good
    };
    assert!(RlsConfig::<f64>::new(large).is_ok());
    assert!(matches!(
        RlsConfig::<f32>::new(large),
        Err(FpgaError::OutOfRange {
            format: "binary32",
            ..
        })
    ));
    let lms = LmsSettings {
        tap_count: 10,
        step_size: 0.8,
        regularisation: None,
        desired: DesiredSource::Port,
        update_sign: UpdateSign::Corrected,
    };
    assert!(LmsConfig::<f64>::new(lms).is_ok());
    assert!(
        LmsConfig::<f64>::new(LmsSettings {
            step_size: 0.0,
            ..lms
        })
        .is_err()
    );
    assert!(
        LmsConfig::<f64>::new(LmsSettings {
            regularisation: Some(-1.0),
            ..lms
        })
        .is_err()
    );
}
