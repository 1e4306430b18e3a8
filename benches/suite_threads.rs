//! A whole suite with two threads against one, in the same run.
//!
//! `cargo bench --bench suite_threads` runs two suites alternately, once per thread count, and
//! prints the ratio of their median wall times: four loop-model swings (independent runs), and
//! the rate model of the paper's hour (one run, whose filters and measurements share the threads).
//! Wanted: at least 1.7 for the first.

use std::path::{Path, PathBuf};
use std::time::Instant;

use fogbench::experiment::{Plan, SuiteOptions, plan_suite, run_suite};

/// Runs of each thread count.
const ROUNDS: usize = 5;

fn plans(files: &[&str], sets: &[&str]) -> Vec<Plan> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/paper");
    let paths: Vec<PathBuf> = files.iter().map(|file| folder.join(file)).collect();
    let sets: Vec<String> = sets.iter().map(|&set| set.to_owned()).collect();
    plan_suite(&paths, &sets).expect("the shipped scenarios are sound")
}

fn wall_s(plans: &[Plan], threads: usize) -> f64 {
    let output = std::env::temp_dir().join(format!("fogbench-bench-{}", std::process::id()));
    let options = SuiteOptions {
        threads,
        ..SuiteOptions::new(output)
    };
    let start = Instant::now();
    run_suite(plans, &options, &()).expect("the scratch folder is writable");
    let elapsed = start.elapsed().as_secs_f64();
    drop(std::fs::remove_dir_all(&options.output));
    elapsed
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn compare(name: &str, plans: &[Plan]) {
    let (mut one, mut two) = (Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        one.push(wall_s(plans, 1));
        two.push(wall_s(plans, 2));
    }
    let (one, two) = (median(one), median(two));
    println!(
        "{name}: -j 1 {one:.2} s, -j 2 {two:.2} s, ratio {:.2}",
        one / two
    );
}

fn main() {
    let swings = [
        "swing-5hz.toml",
        "swing-10hz.toml",
        "swing-5hz-1deg.toml",
        "swing-10hz-1deg.toml",
    ];
    compare(
        "four swings, loop model",
        &plans(&swings, &["duration_s=100"]),
    );
    compare(
        "one hour, rate model",
        &plans(&["static-25c.toml"], &["fidelity=rate"]),
    );
}
