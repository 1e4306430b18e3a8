//! Speed of the overlapping Allan deviation beside allantools, and the memory of the streaming form.
//!
//! `cargo bench --bench allan`: 1e7 samples at octave averaging times, and 1e9 streamed samples; with
//! `-- batch` only the former.
//! allantools runs in the same go if `python3` can import it (`pip install allantools`); else it is
//! skipped with a message.

use std::fs;
use std::hint::black_box;
use std::process::Command;
use std::time::{Duration, Instant};

use fogbench::metrics::{AllanOptions, AllanStream, allan_variant, overlapping_allan_at};
use fogbench::random::Streams;
use fogbench::vocabulary::AveragingTimes;

const BATCH_SAMPLES: usize = 10_000_000;
const STREAM_SAMPLES: usize = 1_000_000_000;
const PIECE: usize = 1 << 16;

/// Prints the best of three runs of allantools on the same samples and averaging times, and its first
/// and last answer.
const SCRIPT: &str = r#"
import time, numpy, allantools
n = 10_000_000
k = numpy.arange(n, dtype=numpy.uint64)
y = ((k * k) % numpy.uint64(1013)).astype(float)
taus = [2**p for p in range(22)]
best = 1e9
for _ in range(3):
    start = time.perf_counter()
    t, d, e, c = allantools.oadev(y, rate=1.0, data_type="freq", taus=taus)
    best = min(best, time.perf_counter() - start)
print(best, d[0], d[-1])
"#;

fn best_of_three<T>(mut run: impl FnMut() -> T) -> Duration {
    let timed = |run: &mut dyn FnMut() -> T| {
        let start = Instant::now();
        black_box(run());
        start.elapsed()
    };
    (0..3)
        .map(|_| timed(&mut run))
        .min()
        .expect("three runs have a best")
}

fn sawtooth() -> Vec<f64> {
    (0..BATCH_SAMPLES)
        .map(|k| ((k * k) % 1013) as f64)
        .collect()
}

fn beside_allantools() {
    let values = sawtooth();
    let factors = AveragingTimes::Octave.averaging_factors(BATCH_SAMPLES / 4);
    let points = overlapping_allan_at(&values, 1.0, &factors);
    let own = best_of_three(|| overlapping_allan_at(&values, 1.0, &factors)).as_secs_f64();
    println!(
        "overlapping, {BATCH_SAMPLES} samples, {} tau: {own:.3} s; first {:.12} last {:.12}",
        factors.len(),
        points[0].deviation_deg_per_h.value,
        points[points.len() - 1].deviation_deg_per_h.value,
    );
    let options = AllanOptions::default();
    let identified = best_of_three(|| allan_variant(&values, 1.0, &options)).as_secs_f64();
    println!("the same with noise identified at every tau: {identified:.3} s");
    match Command::new("python3").args(["-c", SCRIPT]).output() {
        Ok(output) if output.status.success() => {
            let text = String::from_utf8_lossy(&output.stdout);
            let numbers: Vec<f64> = text
                .split_whitespace()
                .filter_map(|word| word.parse().ok())
                .collect();
            println!(
                "allantools: {:.3} s; first {:.12} last {:.12}; {:.1} times as long",
                numbers[0],
                numbers[1],
                numbers[2],
                numbers[0] / own
            );
        }
        _ => println!("allantools: skipped, python3 cannot import it (pip install allantools)"),
    }
}

/// Largest resident memory of this process so far, MB; Linux keeps it in `/proc`.
fn peak_memory_mb() -> Option<f64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kilobytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes / 1024.0)
}

fn streaming() {
    let mut noise = vec![0.0; PIECE];
    Streams::new(1, 0).stream("bench").fill_normal(&mut noise);
    let mut stream = AllanStream::new(1e-3);
    let start = Instant::now();
    while stream.samples() < STREAM_SAMPLES {
        stream.extend(&noise[..PIECE.min(STREAM_SAMPLES - stream.samples())]);
    }
    let points = stream.points();
    println!(
        "streaming, {STREAM_SAMPLES} samples, {} tau: {:.1} s, peak memory {}",
        points.len(),
        start.elapsed().as_secs_f64(),
        peak_memory_mb().map_or("unknown here".to_owned(), |mb| format!("{mb:.0} MB")),
    );
}

fn main() {
    // First, so that the peak is its own.
    if !std::env::args().any(|argument| argument == "batch") {
        streaming();
    }
    beside_allantools();
}
