//! Allan deviation and noise coefficients of a recorded log.
//!
//! ```text
//!  log.csv ──> recording ──rate words──> overlapping Allan ──> fit ──> N, B, K, R, Q
//! ```
//!
//! `cargo run --release --example allan_of_a_log -- log.csv 100` takes a log of one column in deg/h
//! at 100 Hz; without arguments it makes one of known angle random walk.

use std::error::Error;
use std::path::Path;

use fogbench::metrics::{AllanPoint, FitRange, NoiseFit, fit_noise, overlapping_allan};
use fogbench::random::Streams;
use fogbench::recording::{LogFormat, RateUnit, csv_text, read_log};

const SAMPLE_RATE_HZ: f64 = 100.0;
const SAMPLES: usize = 60_000;
const NOISE_DEG_PER_H: f64 = 3.0;

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [file, rate] = &arguments[..]
        && let Ok(sample_rate_hz) = rate.parse()
    {
        print(&analyze(Path::new(file), Some(sample_rate_hz))?);
        return Ok(());
    }
    let folder = std::env::temp_dir().join(format!("fogbench-allan-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let file = folder.join("log.csv");
    let mut words = vec![0.0; SAMPLES];
    Streams::new(7, 0).stream("example").fill_normal(&mut words);
    for word in &mut words {
        *word *= NOISE_DEG_PER_H;
    }
    std::fs::write(&file, csv_text(&words, SAMPLE_RATE_HZ.recip()))?;
    // Its time column tells the sample rate.
    let (points, fit) = analyze(&file, None)?;
    std::fs::remove_dir_all(&folder)?;
    print(&(points, fit.clone()));

    // White noise of sigma per word at a period T has N = sigma sqrt(T).
    let known = NOISE_DEG_PER_H * SAMPLE_RATE_HZ.recip().sqrt();
    let found = fit.angle_random_walk_deg_per_h_sqrt_s.estimate();
    println!("known: {known:.4} (deg/h) sqrt(s)");
    assert!(found.low < known && known < found.high);
    Ok(())
}

fn analyze(
    file: &Path,
    sample_rate_hz: Option<f64>,
) -> Result<(Vec<AllanPoint>, NoiseFit), Box<dyn Error>> {
    let log = read_log(
        file,
        &LogFormat {
            rate_hz: sample_rate_hz,
            unit: Some(RateUnit::DEG_PER_H.into()),
            ..LogFormat::default()
        },
    )?;
    let points = overlapping_allan(&log.rate_deg_per_h, log.sample_period_s());
    let range = FitRange {
        tau_min_s: log.sample_period_s(),
        tau_max_s: log.rate_deg_per_h.len() as f64 * log.sample_period_s() / 9.0,
    };
    let fit = fit_noise(&points, range)?;
    Ok((points, fit))
}

fn print((points, fit): &(Vec<AllanPoint>, NoiseFit)) {
    println!("tau, s      deviation, deg/h");
    for point in points.iter().step_by(6) {
        println!("{:<11.3} {}", point.tau_s, point.deviation_deg_per_h);
    }
    let walk = fit.angle_random_walk_deg_per_h_sqrt_s.estimate();
    println!("angle random walk N: {walk} (deg/h) sqrt(s)");
}
