//! The two ways a covariance-form RLS dies, shown and timed: gain-first order and wind-up.

use fogbench::fpga::engine::Engine as _;
use fogbench::fpga::float_unit::Fp;
use fogbench::fpga::front_end::FrontEnd;
use fogbench::fpga::health::{HealthMonitor, gain_first_failure_samples, wind_up_warning};
use fogbench::fpga::rls::{RlsConfig, RlsEngine, RlsSettings};
use fogbench::vocabulary::{Division, UpdateOrder, UpdateSign};

use crate::support::stimulus::samples;

/// Runs `signal` through a four-tap engine, looking at the matrix every tenth sample.
fn watch<F: Fp>(signal: &[f64], alpha: f64, order: UpdateOrder) -> HealthMonitor {
    let config = RlsConfig::<F>::new(RlsSettings {
        tap_count: 4,
        forgetting_factor: alpha,
        initial_inverse_correlation: 1e4,
        division: Division::Reciprocal,
        update_sign: UpdateSign::Corrected,
    })
    .expect("settings are in range");
    let mut engine = RlsEngine::with_order(config, order);
    let mut front_end = FrontEnd::one_step_predictor();
    let mut monitor = HealthMonitor::new(1000.0);
    for (k, sample) in signal.iter().enumerate() {
        let pair = front_end.pair(F::from_f64(*sample));
        let output = engine.process(pair);
        monitor.sample(pair.input, pair.desired, output);
        if k % 10 == 9 {
            monitor.matrix(
                engine
                    .inverse_correlation()
                    .expect("the RLS has one")
                    .matrix,
                4,
                config.delta(),
            );
        }
    }
    monitor
}

#[test]
fn gain_first_order_fails_when_theory_says_and_the_schedule_does_not() {
    let signal = samples("rocking", 40_000);
    let failed = watch::<f64>(&signal, 0.99, UpdateOrder::GainFirst);
    let theory = gain_first_failure_samples::<f64>(0.99).unwrap();
    let observed = failed.first_failures().asymmetry.unwrap() as f64;
    // The starting error is a few roundings, not one: within 15 % of ln(0.01/eps)/(1-alpha).
    crate::support::assert_close(observed, theory, 0.15, 0.0);
    assert!(failed.first_failures().diverged_at().is_some());

    let failed = watch::<f32>(&signal[..10_000], 0.99, UpdateOrder::GainFirst);
    let theory = gain_first_failure_samples::<f32>(0.99).unwrap();
    let observed = failed.first_failures().asymmetry.unwrap() as f64;
    crate::support::assert_close(observed, theory, 0.25, 0.0);

    let sound = watch::<f64>(&signal, 0.99, UpdateOrder::Schedule);
    assert_eq!(*sound.first_failures(), Default::default());
    assert!(sound.latest().unwrap().is_sound());
    let sound = watch::<f64>(&signal, 1.0, UpdateOrder::GainFirst);
    assert_eq!(*sound.first_failures(), Default::default());
}

#[test]
fn constant_input_winds_up_under_forgetting_only() {
    let constant = vec![0.002; 45_000];
    let wound = watch::<f64>(&constant, 0.99, UpdateOrder::Schedule);
    let first = wound.first_failures();
    // The silent directions grow as alpha^-k; definiteness goes near ln(1/eps)/(1-alpha) = 3600.
    let definiteness = first.definiteness.unwrap();
    assert!((2500..4500).contains(&definiteness), "{definiteness}");
    assert!(first.wind_up.unwrap() < 100, "{first:?}");
    let early = watch::<f64>(&constant[..1000], 0.99, UpdateOrder::Schedule);
    assert!(wind_up_warning(early.latest().unwrap(), 0.99).is_some());

    let steady = watch::<f64>(&constant, 1.0, UpdateOrder::Schedule);
    assert_eq!(*steady.first_failures(), Default::default());
    assert!(wind_up_warning(steady.latest().unwrap(), 1.0).is_none());
}

#[test]
fn a_nan_is_reported_with_its_sample() {
    let mut signal = samples("white", 100);
    signal[42] = f64::NAN;
    let poisoned = watch::<f64>(&signal, 1.0, UpdateOrder::Schedule);
    let first = poisoned.first_failures();
    assert_eq!(first.non_finite_input, Some(42));
    // The desired word is bad at once, the weights with it, the output one sample later.
    assert_eq!(first.non_finite_output, Some(43));
    assert!(!poisoned.latest().unwrap().is_finite);
}
