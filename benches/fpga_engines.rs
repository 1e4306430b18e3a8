//! Pipelines against plain code: nanoseconds per sample without clocks, simulated clocks per
//! second with them.
//!
//! `plain_loop` is the recursion as one would write it in C: fixed arrays, nothing generic, the
//! same order of operations. The clock-less engine is to stay within 1.2 times of it.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fogbench::fpga::front_end::{FrontEnd, Pair, UpdateSign};
use fogbench::fpga::rls::{
    Division, RlsConfig, RlsEngine, RlsPipeline, RlsSettings, rls_clocks_per_sample,
};

const SAMPLES: usize = 4096;

fn config(tap_count: usize) -> RlsConfig<f64> {
    RlsConfig::new(RlsSettings {
        tap_count,
        forgetting_factor: 1.0,
        initial_inverse_correlation: 1e4,
        division: Division::Reciprocal,
        update_sign: UpdateSign::Corrected,
    })
    .expect("settings are in range")
}

fn pairs() -> Vec<Pair<f64>> {
    let mut state = 1_u64;
    let mut front_end = FrontEnd::one_step_predictor();
    (0..SAMPLES)
        .map(|_| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let bits = (state >> 12) | 0x3ff0_0000_0000_0000;
            front_end.pair(f64::from_bits(bits) - 1.5)
        })
        .collect()
}

/// State of the hand-written loop.
struct Plain {
    l: [f64; 4],
    w: [f64; 4],
    r: [[f64; 4]; 4],
}

#[inline(never)]
fn plain_loop(state: &mut Plain, pairs: &[Pair<f64>], outputs: &mut [f64]) {
    let Plain { l, w, r } = state;
    for (pair, output) in pairs.iter().zip(outputs) {
        *l = [pair.input, l[0], l[1], l[2]];
        let mut t = [0.0; 4];
        for i in 0..4 {
            for j in 0..4 {
                t[i] += l[j] * r[i][j];
            }
        }
        let mut den = 1.0;
        for j in 0..4 {
            den += l[j] * t[j];
        }
        let rcp = 1.0 / den;
        for i in 0..4 {
            for j in 0..4 {
                r[i][j] -= (t[i] * t[j]) * rcp;
            }
        }
        let mut y = 0.0;
        for j in 0..4 {
            y += l[j] * w[j];
        }
        let e = pair.desired - y;
        for i in 0..4 {
            let mut m = 0.0;
            for j in 0..4 {
                m += l[j] * r[i][j];
            }
            w[i] += m * e;
        }
        *output = y;
    }
}

fn clock_less(criterion: &mut Criterion) {
    let pairs = pairs();
    let mut group = criterion.benchmark_group("rls_4_taps_per_sample");
    group.throughput(Throughput::Elements(SAMPLES as u64));
    group.bench_function("plain_loop", |bencher| {
        let mut state = Plain {
            l: [0.0; 4],
            w: [0.0; 4],
            r: [[0.0; 4]; 4],
        };
        for i in 0..4 {
            state.r[i][i] = 1e4;
        }
        let mut outputs = vec![0.0; SAMPLES];
        bencher.iter(|| {
            plain_loop(&mut state, black_box(&pairs), &mut outputs);
            black_box(outputs[SAMPLES - 1])
        });
    });
    group.bench_function("clock_less_engine", |bencher| {
        let mut engine = RlsEngine::new(config(4));
        let mut outputs = Vec::with_capacity(SAMPLES);
        bencher.iter(|| {
            outputs.clear();
            engine.run(black_box(&pairs), &mut outputs);
            black_box(outputs[SAMPLES - 1])
        });
    });
    group.bench_function("clock_less_engine_one_by_one", |bencher| {
        let mut engine = RlsEngine::new(config(4));
        bencher.iter(|| {
            let mut last = 0.0;
            for pair in black_box(&pairs) {
                last = engine.process(*pair);
            }
            black_box(last)
        });
    });
    group.finish();
}

fn by_clock(criterion: &mut Criterion) {
    let pairs = &pairs()[..256];
    let mut group = criterion.benchmark_group("rls_pipeline_per_clock");
    for tap_count in [4, 8] {
        let clocks = pairs.len() * rls_clocks_per_sample(tap_count);
        group.throughput(Throughput::Elements(clocks as u64));
        group.bench_function(format!("{tap_count}_taps"), |bencher| {
            let mut pipeline = RlsPipeline::new(config(tap_count));
            let mut outputs = Vec::with_capacity(pairs.len());
            bencher.iter(|| {
                outputs.clear();
                pipeline.run(black_box(pairs), &mut outputs);
                black_box(outputs[0])
            });
        });
    }
    group.finish();
}

criterion_group!(benches, clock_less, by_clock);
criterion_main!(benches);
