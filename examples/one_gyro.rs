//! A gyro alone, made in Rust: its words at rest against what its noise budget promises.
//!
//! ```text
//!  constant rate ──> Sagnac phase ──> detector, noise ──> loop ──rate words──> Allan deviation
//! ```

use std::error::Error;

use fogbench::gyro::{self, Fidelity, Gyro, GyroConfig, SourceConfig};
use fogbench::metrics::overlapping_allan;
use fogbench::random::Streams;
use fogbench::signal::MotionSegment;
use fogbench::units::{deg_per_h_sqrt_s_to_deg_per_sqrt_h, deg_per_h_to_rad_per_s};

const SAMPLES: usize = 60_000;

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    // Twice the light of the reference.
    let reference = GyroConfig::reference();
    let source = SourceConfig {
        power_uw: 2.0 * reference.source.power_uw,
        ..reference.source
    };
    let config = GyroConfig {
        source,
        ..reference
    };
    let facts = gyro::facts(&config)?;
    let budget = &facts.angle_random_walk_budget_deg_per_sqrt_h;
    for (source, walk) in budget {
        println!("{source:<10} {walk:.6} deg/sqrt(h)");
    }

    let mut gyro = Gyro::new(&config, Fidelity::Rate, 30.0, &Streams::new(1, 0))?;
    let turning = MotionSegment::constant(deg_per_h_to_rad_per_s(10.0));
    let words: Vec<f64> = (0..SAMPLES).map(|_| gyro.next_word(&turning)).collect();

    // White noise: sigma(tau) = N / sqrt(tau). A tenth of a second is long against the loop.
    let points = overlapping_allan(&words, gyro.sample_period_s());
    let point = points
        .iter()
        .find(|point| point.tau_s > 0.1)
        .ok_or("a longer record")?;
    let walk = point.deviation_deg_per_h.scaled(point.tau_s.sqrt());
    let walk = walk.scaled(deg_per_h_sqrt_s_to_deg_per_sqrt_h(1.0));
    println!("measured   {walk} deg/sqrt(h)");
    let (_, promised) = budget.last().ok_or("a budget has a total")?;
    assert!((walk.value / promised - 1.0).abs() < 0.15);
    Ok(())
}
