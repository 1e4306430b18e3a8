//! Hot paths against plain ones in the same run, with limits.
//!
//! `cargo bench --bench ratios` prints the ratio of their times, the least of many short ones in
//! alternation; with `-- --check` a ratio above its limit in `benches/ratios.toml` is a failure.

#[path = "plain_filters.rs"]
mod plain_filters;
#[path = "plain_loop.rs"]
mod plain_loop;
#[path = "../tests/support/reference_gyro.rs"]
mod reference_gyro;

use std::hint::black_box;
use std::process::ExitCode;
use std::time::Instant;

use fogbench::filters::{Filter as _, FrontEndConfig, Rls, RlsConfig};
use fogbench::fpga::engine::Engine as _;
use fogbench::fpga::front_end::{FrontEnd, Pair};
use fogbench::fpga::rls::{self, RlsEngine, RlsSettings};
use fogbench::gyro::LoopModel;
use fogbench::random::Streams;
use fogbench::signal::MotionSegment;
use fogbench::vocabulary::{DesiredSignal, Division, OutputRegister, UpdateSign};

use plain_filters::PlainRls;
use plain_loop::PlainLoop;
use reference_gyro::reference_gyro;

/// Limits by name.
const LIMITS: &str = include_str!("ratios.toml");
/// Words of a gyro in one timing.
const WORDS: u32 = 200;
/// Samples of a filter in one timing.
const SAMPLES: usize = 4096;
/// Initial inverse correlation of a filter.
const DELTA: f64 = 1e4;
/// Timings of each of the two.
const ROUNDS: usize = 400;

/// Least time of one call, in seconds, of the fast and of the plain path, called in alternation.
fn least_times_s(mut fast: impl FnMut() -> f64, mut plain: impl FnMut() -> f64) -> (f64, f64) {
    fn time_s(path: &mut impl FnMut() -> f64) -> f64 {
        let start = Instant::now();
        black_box(path());
        start.elapsed().as_secs_f64()
    }
    (0..ROUNDS).fold((f64::INFINITY, f64::INFINITY), |(a, b), _| {
        (a.min(time_s(&mut fast)), b.min(time_s(&mut plain)))
    })
}

/// A hot path as it was measured.
struct Measured {
    name: &'static str,
    fast_ns: f64,
    plain_ns: f64,
}

fn loop_model(name: &'static str, latency_periods: u32) -> Measured {
    let mut config = reference_gyro();
    config.controller.loop_latency_periods = latency_periods;
    let streams = Streams::new(1, 0);
    let mut model = LoopModel::new(&config, 1.0, &streams).expect("the reference gyro is sound");
    let mut plain = PlainLoop::new(&config, model.controller().gain, &streams);
    let segment = MotionSegment::hermite(1.7e-2, 1e-7, 1.700_01e-2, 1e-7);
    let (fast_s, plain_s) = least_times_s(
        || {
            for _ in 0..WORDS {
                black_box(model.next_word(black_box(&segment)));
            }
            0.0
        },
        || {
            let word = |_| plain.next_word_rad_per_s(black_box(&segment.rate_rad_per_s));
            (0..WORDS).map(word).sum()
        },
    );
    let per_half_period = 1e9 / f64::from(WORDS * config.output.half_periods_per_sample);
    Measured {
        name,
        fast_ns: fast_s * per_half_period,
        plain_ns: plain_s * per_half_period,
    }
}

/// Words of white noise, and the pairs that a predictor of one step makes of them.
fn words_and_pairs() -> (Vec<f64>, Vec<Pair<f64>>) {
    let mut words = vec![0.0; SAMPLES];
    Streams::new(1, 0).stream("words").fill_normal(&mut words);
    let mut front_end = FrontEnd::one_step_predictor();
    let pairs = words.iter().map(|word| front_end.pair(*word)).collect();
    (words, pairs)
}

/// A filter beside the plain recursion on the same samples.
fn beside_plain(name: &'static str, fast: impl FnMut() -> f64, pairs: &[Pair<f64>]) -> Measured {
    let mut plain = PlainRls::new(DELTA);
    let mut outputs = vec![0.0; SAMPLES];
    let (fast_s, plain_s) = least_times_s(fast, || {
        plain.run(black_box(pairs), &mut outputs);
        outputs[SAMPLES - 1]
    });
    let per_sample = 1e9 / pairs.len() as f64;
    Measured {
        name,
        fast_ns: fast_s * per_sample,
        plain_ns: plain_s * per_sample,
    }
}

fn engine() -> Measured {
    let (_, pairs) = words_and_pairs();
    let config = rls::RlsConfig::new(RlsSettings {
        tap_count: 4,
        forgetting_factor: 1.0,
        initial_inverse_correlation: DELTA,
        division: Division::Reciprocal,
        update_sign: UpdateSign::Corrected,
    });
    let mut engine = RlsEngine::new(config.expect("the settings are in range"));
    let mut outputs = Vec::with_capacity(SAMPLES);
    let run = || {
        outputs.clear();
        engine.run(black_box(&pairs), &mut outputs);
        outputs[SAMPLES - 1]
    };
    beside_plain("clockless_rls_4", run, &pairs)
}

fn textbook() -> Measured {
    let (words, pairs) = words_and_pairs();
    let mut filter = Rls::new(&RlsConfig {
        taps: 4,
        forgetting_factor: 1.0,
        initial_inverse_correlation: DELTA,
        update_sign: UpdateSign::Corrected,
        front_end: FrontEndConfig {
            desired: DesiredSignal::Current,
            input_lag_samples: 1,
            output_register: OutputRegister::NextSample,
        },
    });
    let run = || {
        let words = black_box(&words).iter();
        let outputs =
            words.map(|word| filter.step(*word).map_or(f64::NAN, |it| it.value_deg_per_h));
        outputs.sum()
    };
    beside_plain("textbook_rls_4", run, &pairs)
}

fn main() -> ExitCode {
    let limits: toml::Table = LIMITS.parse().expect("the limits are TOML");
    let is_checked = std::env::args().any(|argument| argument == "--check");
    let measured = [
        loop_model("loop_model_latency_1", 1),
        loop_model("loop_model_latency_0", 0),
        engine(),
        textbook(),
    ];
    let mut has_failed = limits.len() != measured.len();
    for Measured {
        name,
        fast_ns,
        plain_ns,
    } in measured
    {
        let limit = limits.get(name).and_then(toml::Value::as_float);
        let limit = limit.unwrap_or_else(|| panic!("benches/ratios.toml has no limit of {name}"));
        let ratio = fast_ns / plain_ns;
        let verdict = if ratio <= limit { "" } else { ", too slow" };
        has_failed |= ratio > limit;
        println!(
            "{name}: {fast_ns:.2} ns, plain {plain_ns:.2} ns, ratio {ratio:.2}, at most {limit}{verdict}"
        );
    }
    if is_checked && has_failed {
        eprintln!("a ratio is above its limit in benches/ratios.toml, or a limit has no bench");
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}
