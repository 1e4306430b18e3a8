//! The line enhancer as a pipeline: words, clocks, formats.

use fogbench::filters::FilterConfig;
use fogbench::filters::{Filter, SignLms, SignLmsConfig as Textbook};
use fogbench::fpga::engine::Engine as _;
use fogbench::fpga::float_unit::{FlushToZero, Fp};
use fogbench::fpga::front_end::{FrontEnd, Pair};
use fogbench::fpga::sign_lms::{
    SignLmsConfig, SignLmsEngine, SignLmsPipeline, SignLmsSettings, sign_lms_clocks_per_sample,
    sign_lms_latency_clocks, sign_lms_stalled_clocks,
};
use fogbench::fpga::timing::{Units, measure};
use fogbench::vocabulary::{DesiredSignal, OutputRegister, SignLmsForm};
use proptest::prelude::*;

use crate::support::stimulus::{samples, words};
use crate::support::transcript::Transcript;
use crate::support::{assert_close, code, fogbench, stdout};

const PATENT: SignLmsSettings = SignLmsSettings {
    tap_count: 20,
    delay_samples: 15,
    normalised: false,
    step: 0.005,
    regularisation: 1e-4,
    initial_weight: 0.05,
    guard: None,
    norm_recompute_samples: 0,
};

fn pairs<F: Fp>(words: &[f64], delay: usize) -> Vec<Pair<F>> {
    let mut front_end = FrontEnd::new(DesiredSignal::Current, delay);
    let pair = |word: &f64| front_end.pair(F::from_f64(*word));
    words.iter().map(pair).collect()
}

fn compare<F: Fp>(settings: SignLmsSettings, stimulus: &[f64]) -> Result<(), String> {
    let config = SignLmsConfig::<F>::new(settings).map_err(|error| error.to_string())?;
    let pairs = pairs::<F>(stimulus, settings.delay_samples);
    let (mut pipeline, mut engine) = (SignLmsPipeline::new(config), SignLmsEngine::new(config));
    let (mut by_clock, mut at_once) = (Vec::new(), Vec::new());
    pipeline.run(&pairs, &mut by_clock);
    engine.run(&pairs, &mut at_once);
    let same = words(&by_clock) == words(&at_once)
        && words(pipeline.rama()) == words(&engine.rama())
        && words(pipeline.ramb()) == words(&engine.ramb())
        && pipeline.machine().norm().to_bits() == engine.norm().to_bits();
    if same && by_clock.len() == pairs.len() {
        Ok(())
    } else {
        Err(format!("{settings:?} in {}", F::NAME))
    }
}

#[test]
fn engine_and_pipeline_of_the_line_enhancer_agree_in_every_number_format() {
    for name in ["static", "rocking", "white"] {
        for tap_count in [1, 2, 20, 64] {
            let settings = SignLmsSettings {
                tap_count,
                guard: Some(0.8),
                norm_recompute_samples: 77,
                ..PATENT
            };
            let stimulus = samples(name, 1000);
            compare::<f64>(settings, &stimulus).unwrap();
            compare::<f32>(settings, &stimulus).unwrap();
            compare::<FlushToZero<f64>>(settings, &stimulus).unwrap();
            compare::<FlushToZero<f32>>(settings, &stimulus).unwrap();
        }
    }
    let mut poisoned = samples("white", 300);
    poisoned[100] = f64::NAN;
    compare::<f64>(PATENT, &poisoned).unwrap();
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn engine_pipeline_and_textbook_of_the_line_enhancer_agree_for_random_settings(
        tap_count in 1_usize..=24,
        delay_samples in 1_usize..=20,
        normalised in any::<bool>(),
        step in 1e-4_f64..1.5,
        guard in prop::option::of(0.1_f64..1e3),
        recompute in prop::option::of(0_u32..60),
        starts_at_zero in any::<bool>(),
        stimulus in prop::collection::vec(-1e3_f64..1e3, 1..300),
    ) {
        let count = u32::try_from(tap_count).unwrap();
        let settings = SignLmsSettings {
            tap_count,
            delay_samples,
            normalised,
            step,
            guard,
            norm_recompute_samples: recompute.map_or(0, |more| count + more),
            initial_weight: if starts_at_zero { 0.0 } else { 1.0 / f64::from(count) },
            regularisation: 1e-4,
        };
        let outcome = compare::<f64>(settings, &stimulus);
        prop_assert!(outcome.is_ok(), "{}", outcome.unwrap_err());
        prop_assert_eq!(by_textbook(settings, &stimulus), by_engine(settings, &stimulus));
    }
}

/// Bits, zeros without their sign.
fn bits(words: impl Iterator<Item = f64>) -> Vec<u64> {
    words.map(|word| (word + 0.0).to_bits()).collect()
}

fn by_engine(settings: SignLmsSettings, stimulus: &[f64]) -> Vec<u64> {
    let mut engine = SignLmsEngine::<f64>::new(SignLmsConfig::new(settings).expect("in range"));
    let mut outputs = Vec::new();
    engine.run(&pairs(stimulus, settings.delay_samples), &mut outputs);
    bits(outputs.into_iter().chain(engine.weights().to_vec()))
}

fn by_textbook(settings: SignLmsSettings, stimulus: &[f64]) -> Vec<u64> {
    let mut filter = SignLms::new(&Textbook {
        taps: settings.tap_count,
        delay_samples: settings.delay_samples,
        form: if settings.normalised {
            SignLmsForm::Nlms
        } else {
            SignLmsForm::Sign
        },
        step: settings.step,
        regularisation: settings.regularisation,
        initial_weight: settings.initial_weight,
        guard: settings.guard,
        norm_recompute_samples: u64::from(settings.norm_recompute_samples),
        output_register: OutputRegister::Immediate,
    });
    let outputs: Vec<f64> = stimulus
        .iter()
        .map(|word| filter.step(*word).expect("no divergence").value_deg_per_h)
        .collect();
    bits(outputs.into_iter().chain(filter.weights().to_vec()))
}

#[test]
fn textbook_and_hardware_of_the_line_enhancer_have_the_same_bits_in_the_bench() {
    let text = |pipeline: &str| {
        format!(
            "name = \"f\"\n[sign_lms]\ntaps = 20\ndelay_samples = 15\nform = \"sign\"\n\
             step = 0.005\nregularisation = 0.0001\nunit = \"deg/s\"\n\
             initial_weights = \"mean\"\nguard_deg_per_h = 190.0\nnorm_recompute_samples = 1000\n\
             output_register = \"next-sample\"\npipeline = \"{pipeline}\"\n\
             number_format = \"binary64\"\nclock_mhz = 40.0\n"
        )
    };
    let config: FilterConfig = toml::from_str(&text("fpga")).expect("a filter");
    let settings = config.kind.settings().hardware().expect("a pipeline");
    let mut hardware = settings.filter(0).expect("sound constants");
    let stimulus: Vec<f64> = samples("static", 5000)
        .iter()
        .map(|word| 3600.0 * word)
        .collect();
    let core = SignLmsSettings {
        step: 0.005 * 3600.0,
        regularisation: 0.0001 * 3600.0 * 3600.0,
        guard: Some(190.0),
        norm_recompute_samples: 1000,
        ..PATENT
    };
    let mut want = by_engine(core, &stimulus);
    want.truncate(stimulus.len());
    assert_eq!(want[..], by_textbook(core, &stimulus)[..stimulus.len()]);
    // Weights of the first sample: 1/M each, of sum 1.
    let first = hardware.step(stimulus[0]).expect("finite");
    assert_close(first.weight_sum, 0.0, 0.0, 0.0);
    let second = hardware.step(stimulus[1]).expect("finite");
    assert_close(second.weight_sum, 1.0, 1e-12, 0.0);
    let mut got = vec![second.value_deg_per_h];
    for word in &stimulus[2..] {
        got.push(hardware.step(*word).expect("finite").value_deg_per_h);
    }
    assert_eq!(bits(got.into_iter()), want[..stimulus.len() - 1]);
}

#[test]
fn the_line_enhancer_takes_67_clocks_at_twenty_taps_and_answers_after_25() {
    for tap_count in [1, 2, 5, 20, 64] {
        for normalised in [false, true] {
            for norm_recompute_samples in [0, 64] {
                let config = SignLmsConfig::<f64>::new(SignLmsSettings {
                    tap_count,
                    normalised,
                    norm_recompute_samples,
                    ..PATENT
                })
                .unwrap();
                let used = measure(SignLmsPipeline::new(config));
                let want = (3 * tap_count + 7, tap_count + 5);
                assert_eq!(used.clocks_per_sample, want.0 as u64);
                assert_eq!(used.latency_clocks, want.1 as u64);
                assert_eq!(want.0, sign_lms_clocks_per_sample(tap_count));
                assert_eq!(want.1, sign_lms_latency_clocks(tap_count));
                assert_eq!((used.wake_up_clocks, used.divisions), (1, 1));
                let states = used.states.iter().map(|state| state.clocks);
                assert_eq!(states.sum::<u64>(), used.clocks_per_sample);
                let stalled = sign_lms_stalled_clocks(tap_count, normalised, Units::ONE_CLOCK);
                assert_eq!(stalled.unwrap(), used.clocks_per_sample);
            }
        }
    }
    let folder = tempfile::tempdir().expect("a scratch folder");
    let arguments = ["timing", "--kind", "sign-lms", "--taps", "20"];
    let output = fogbench(folder.path(), &arguments);
    assert_eq!(code(&output), 0);
    let mut transcript = Transcript::of("hardware", "Timing of a sign-LMS pipeline");
    transcript.case(arguments.join(" "), stdout(&output));
    transcript.check();
}

#[test]
fn a_recursive_norm_in_binary32_is_wrong_a_thousandfold_after_a_fast_rotation() {
    fn norm_of<F: Fp>(norm_recompute_samples: u32) -> f64 {
        let mut engine = SignLmsEngine::<F>::new(
            SignLmsConfig::new(SignLmsSettings {
                norm_recompute_samples,
                ..PATENT
            })
            .expect("in range"),
        );
        let noise = samples("white", 200_000);
        let stimulus: Vec<f64> = noise
            .iter()
            .enumerate()
            .map(|(n, draw)| if n < 100_000 { 50.0 } else { 0.0 } + 0.003 * draw)
            .collect();
        engine.run(&pairs(&stimulus, 15), &mut Vec::new());
        engine.norm().to_f64()
    }
    let (exact, recursive) = (norm_of::<f64>(1000), norm_of::<f32>(0));
    assert!(
        recursive > 100.0 * exact || recursive < 0.01 * exact,
        "{recursive} {exact}"
    );
    assert_close(norm_of::<f32>(1000), exact, 1e-4, 0.0);
    assert_close(norm_of::<f64>(0), exact, 1e-4, 0.0);
}

#[test]
fn constants_of_the_line_enhancer_out_of_range_are_refused() {
    let refuse = |settings: SignLmsSettings| SignLmsConfig::<f32>::new(settings).is_err();
    assert!(!refuse(PATENT));
    for wrong in [
        SignLmsSettings {
            tap_count: 65,
            ..PATENT
        },
        SignLmsSettings {
            delay_samples: 0,
            ..PATENT
        },
        SignLmsSettings {
            step: 0.0,
            ..PATENT
        },
        SignLmsSettings {
            regularisation: 1e-50,
            ..PATENT
        },
        SignLmsSettings {
            guard: Some(f64::NAN),
            ..PATENT
        },
        SignLmsSettings {
            initial_weight: f64::INFINITY,
            ..PATENT
        },
        SignLmsSettings {
            norm_recompute_samples: 19,
            ..PATENT
        },
        SignLmsSettings {
            norm_recompute_samples: 1_000_001,
            ..PATENT
        },
    ] {
        assert!(refuse(wrong), "{wrong:?}");
    }
}
