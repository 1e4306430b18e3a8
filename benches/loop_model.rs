//! Nanoseconds per half modulation period: the loop model against the plain loop.
//!
//! Both run in the same process, in alternation, with the same quantisers, generator and draws;
//! the ratio is what counts. `cargo bench --bench loop_model -- none` prints it alone. Wanted: at most
//! 1.0.

#[path = "plain_loop.rs"]
mod plain_loop;
#[path = "../tests/support/reference_gyro.rs"]
mod reference_gyro;

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fogbench::gyro::{LoopModel, RateModel};
use fogbench::random::Streams;
use fogbench::signal::MotionSegment;

use plain_loop::PlainLoop;
use reference_gyro::reference_gyro;

/// Words per timing; 64 half periods each.
const WORDS: u32 = 2000;
/// Alternating timings of the ratio.
const ROUNDS: usize = 21;

fn moving() -> MotionSegment {
    MotionSegment::hermite(1.7e-2, 1e-7, 1.700_01e-2, 1e-7)
}

fn time(mut word: impl FnMut() -> f64) -> Duration {
    let start = Instant::now();
    for _ in 0..WORDS {
        black_box(word());
    }
    start.elapsed()
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn ratio_against_plain_loop() {
    for latency in [1, 0] {
        let mut config = reference_gyro();
        config.controller.loop_latency_periods = latency;
        let streams = Streams::new(1, 0);
        let mut model =
            LoopModel::new(&config, 1.0, &streams).expect("the reference gyro is sound");
        let mut plain = PlainLoop::new(&config, model.controller().gain, &streams);
        let segment = moving();
        let (mut fast, mut slow, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..ROUNDS {
            let model_s = time(|| model.next_word(black_box(&segment))).as_secs_f64();
            let plain_s = time(|| plain.next_word_rad_per_s(black_box(&segment.rate_rad_per_s)))
                .as_secs_f64();
            fast.push(model_s);
            slow.push(plain_s);
            ratios.push(model_s / plain_s);
        }
        let half_periods = f64::from(WORDS * config.output.half_periods_per_sample);
        println!(
            "latency {latency}: loop model {:.2} ns, plain loop {:.2} ns per half period, ratio {:.3}",
            median(fast) / half_periods * 1e9,
            median(slow) / half_periods * 1e9,
            median(ratios),
        );
    }
}

fn benches(criterion: &mut Criterion) {
    ratio_against_plain_loop();
    let config = reference_gyro();
    let streams = Streams::new(1, 0);
    let segment = moving();
    let mut group = criterion.benchmark_group("gyro");
    group
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1))
        .throughput(Throughput::Elements(u64::from(
            config.output.half_periods_per_sample,
        )));
    let mut model = LoopModel::new(&config, 1.0, &streams).expect("the reference gyro is sound");
    group.bench_function("loop_model", |bencher| {
        bencher.iter(|| model.next_word(black_box(&segment)));
    });
    let mut plain = PlainLoop::new(&config, model.controller().gain, &streams);
    group.bench_function("plain_loop", |bencher| {
        bencher.iter(|| plain.next_word_rad_per_s(black_box(&segment.rate_rad_per_s)));
    });
    let mut rate = RateModel::new(&config, 1.0, &streams).expect("the reference gyro is sound");
    group.bench_function("rate_model", |bencher| {
        bencher.iter(|| rate.next_word(black_box(&segment)));
    });
    group.finish();
}

criterion_group!(loop_model, benches);
criterion_main!(loop_model);
