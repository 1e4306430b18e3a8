//! Reading and checking of long suites: 10 000 points of a sweep, 10 000 files, 20 000 wrong keys.
//!
//! Recipe: `cargo bench --bench check_matrix` on a quiet machine. Bounds asked for: 3 s for the
//! points and the files, 1 s for the keys; the tests hold growth and memory.

use std::fmt::Write as _;
use std::fs;
use std::hint::black_box;
use std::path::PathBuf;

use criterion::{Criterion, criterion_group, criterion_main};
use fogbench::experiment::check_suite;

const HEAD: &str = "schema = 1\nduration_s = 10.0\n";

fn suites(criterion: &mut Criterion) {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = |name: &str| -> Vec<PathBuf> { vec![folder.path().join(name)] };
    let powers: Vec<String> = (0..1000).map(|index| format!("1.{index:04}")).collect();
    let sweep = format!(
        "{HEAD}name = \"m\"\n[[filter]]\nname = \"f\"\n[filter.rls]\n[matrix]\nseed = [1, 2, 3, 4, 5, \
         6, 7, 8, 9, 10]\n\"gyro.source.power_uw\" = [{}]\n",
        powers.join(", ")
    );
    fs::write(folder.path().join("sweep.toml"), sweep).expect("writable");
    fs::create_dir(folder.path().join("files")).expect("writable");
    for index in 0..10_000 {
        let file = folder.path().join(format!("files/s{index}.toml"));
        fs::write(file, format!("{HEAD}name = \"s{index}\"\n")).expect("writable");
    }
    let mut keys = format!("{HEAD}name = \"k\"\n[gyro]\n");
    for index in 0..20_000 {
        // Writing to a string cannot fail.
        let _ = writeln!(keys, "k{index} = 1");
    }
    fs::write(folder.path().join("keys.toml"), keys).expect("writable");
    let mut group = criterion.benchmark_group("check");
    group.sample_size(10);
    for (name, input) in [
        ("10000-points", "sweep.toml"),
        ("10000-files", "files"),
        ("20000-unknown-keys", "keys.toml"),
    ] {
        let paths = path(input);
        group.bench_function(name, |bencher| {
            bencher.iter(|| black_box(check_suite(&paths, &[]).map(|runs| runs.len())));
        });
    }
    group.finish();
}

criterion_group!(benches, suites);
criterion_main!(benches);
