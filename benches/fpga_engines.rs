//! Pipelines against plain code: nanoseconds per sample without clocks, simulated clocks per
//! second with them.
//!
//! `plain_loop` is the recursion as one would write it in C (`plain_filters.rs`). The clock-less engine is to stay within 1.2 times of it.
//!
//! The last part simulates the exported RTL under Icarus Verilog (with its testbench) and
//! Verilator (bare, driven from C++) and prints clock rates as ratios. Without the simulators it
//! says so.

#[path = "plain_filters.rs"]
mod plain_filters;

use std::hint::black_box;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use fogbench::fpga::engine::Engine as _;
use fogbench::fpga::export::{ExportSettings, PipelineConfig, write_rtl};
use fogbench::fpga::front_end::{FrontEnd, Pair};
use fogbench::fpga::rls::{RlsConfig, RlsEngine, RlsPipeline, RlsSettings, rls_clocks_per_sample};
use fogbench::vocabulary::{Division, UpdateSign};

use plain_filters::PlainRls;

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

fn clock_less(criterion: &mut Criterion) {
    let pairs = pairs();
    let mut group = criterion.benchmark_group("rls_4_taps_per_sample");
    group.throughput(Throughput::Elements(SAMPLES as u64));
    group.bench_function("plain_loop", |bencher| {
        let mut state = PlainRls::new(1e4);
        let mut outputs = vec![0.0; SAMPLES];
        bencher.iter(|| {
            state.run(black_box(&pairs), &mut outputs);
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

const BENCH_TOP: &str = r#"`include "params.vh"
module bench_top(
    input clk, input rst, input in_valid, output in_ready, input [63:0] x, input [63:0] d,
    output out_valid, output [63:0] y
);
    rls_core #(.P(`VEC_TAPS), .ALPHA(`VEC_ALPHA), .IALPHA(`VEC_IALPHA), .DELTA(`VEC_DELTA),
        .DIV_ELEM(`VEC_DIV_ELEM)) core (.*);
endmodule
"#;

const BENCH_MAIN: &str = r#"#include "Vbench_top.h"
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
int main() {
    Vbench_top top;
    auto clock = [&] { top.clk = 1; top.eval(); top.clk = 0; top.eval(); };
    top.rst = 1; top.in_valid = 0; top.clk = 0; top.eval(); clock();
    top.rst = 0; top.in_valid = 1;
    uint64_t state = 1, folded = 0;
    const long clocks = 20000000;
    auto start = std::chrono::steady_clock::now();
    for (long k = 0; k < clocks; k++) {
        if (top.in_ready) {
            state = state * 6364136223846793005u + 1442695040888963407u;
            uint64_t bits = (state >> 12) | 0x3ff0000000000000u;
            double word; std::memcpy(&word, &bits, 8);
            word -= 1.5; top.x = top.d; std::memcpy(&bits, &word, 8); top.d = bits;
        }
        clock();
        if (top.out_valid) folded ^= top.y;
    }
    std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    std::fprintf(stderr, "%016lx\n", (unsigned long)folded);
    std::printf("%f\n", clocks / time.count());
}
"#;

/// Output of a command, or `None` with a word on stdout if it cannot run.
fn output_of(command: &mut Command) -> Option<String> {
    match command.output() {
        Ok(output) if output.status.success() => {
            Some(String::from_utf8_lossy(&output.stdout).into_owned())
        }
        Ok(output) => {
            println!("failed: {}", String::from_utf8_lossy(&output.stderr));
            None
        }
        Err(cause) => {
            println!("skipped: {command:?}: {cause}");
            None
        }
    }
}

/// Clocks per second of the testbench under Icarus, compilation left out.
fn icarus_rate(dir: &Path, clocks: f64) -> Option<f64> {
    output_of(
        Command::new("iverilog")
            .args(["-g2012", "-Wno-timescale", "-s", "tb_rls", "-o", "tb.vvp"])
            .args([
                "tb_rls.v",
                "rls_core.v",
                "rls_ctrl.v",
                "sp_ram.v",
                "fp_sim.v",
            ])
            .current_dir(dir),
    )?;
    let start = Instant::now();
    output_of(Command::new("vvp").args(["-n", "tb.vvp"]).current_dir(dir))?;
    Some(clocks / start.elapsed().as_secs_f64())
}

/// Clocks per second of the core alone under Verilator.
fn verilator_rate(dir: &Path) -> Option<f64> {
    std::fs::write(dir.join("bench_top.v"), BENCH_TOP).expect("the folder is writable");
    std::fs::write(dir.join("main.cpp"), BENCH_MAIN).expect("the folder is writable");
    output_of(
        Command::new("verilator")
            .args([
                "--cc",
                "--exe",
                "--build",
                "-O3",
                "-Wno-fatal",
                "-Wno-lint",
                "-Wno-style",
            ])
            .args([
                "-CFLAGS",
                "-O3 -ffp-contract=off",
                "--top-module",
                "bench_top",
            ])
            .args([
                "bench_top.v",
                "rls_core.v",
                "rls_ctrl.v",
                "sp_ram.v",
                "fp_sim.v",
                "main.cpp",
            ])
            .current_dir(dir),
    )?;
    let printed = output_of(&mut Command::new(dir.join("obj_dir/Vbench_top")))?;
    printed.trim().parse().ok()
}

/// Clocks per second of the model over about twenty million clocks.
fn model_rate(pairs: &[Pair<f64>]) -> f64 {
    let mut pipeline = RlsPipeline::new(config(4));
    let mut outputs = Vec::with_capacity(pairs.len());
    let rounds = 45;
    let start = Instant::now();
    for _ in 0..rounds {
        outputs.clear();
        pipeline.run(black_box(pairs), &mut outputs);
        black_box(&outputs);
    }
    let clocks = rounds * pairs.len() * rls_clocks_per_sample(4);
    clocks as f64 / start.elapsed().as_secs_f64()
}

fn against_rtl(_: &mut Criterion) {
    let pairs = pairs();
    let model = model_rate(&pairs);
    println!("rls_4_taps clocks per second: model {:.1} M", model / 1e6);
    let dir = tempfile::tempdir().expect("a temporary folder");
    let settings = ExportSettings {
        pipeline: PipelineConfig::Rls(config(4)),
        clock_mhz: 40.0,
        front_end: "one-step predictor".to_string(),
        trace_samples: 0,
        codes: None,
        top: None,
    };
    write_rtl(dir.path(), &settings, &pairs[..2000]).expect("the folder is writable");
    let clocks = (1 + 2000 * rls_clocks_per_sample(4)) as f64;
    for (name, rate) in [
        ("icarus", icarus_rate(dir.path(), clocks)),
        ("verilator", verilator_rate(dir.path())),
    ] {
        if let Some(rate) = rate {
            let ratio = model / rate;
            println!(
                "    {name} {:.3} M; the model is {ratio:.1} times as fast",
                rate / 1e6
            );
        }
    }
}

criterion_group!(benches, clock_less, by_clock, against_rtl);
criterion_main!(benches);
