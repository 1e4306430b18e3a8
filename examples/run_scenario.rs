//! Runs a scenario in memory and asks what a filter did to the gyro's noise.
//!
//! ```text
//!  turntable ──truth──> gyro ──raw──> RLS, LMS ──> metrics ──> gates
//!   at rest                 │           │
//!                           └─ samples ─┴──> slices
//! ```
//!
//! `cargo run --release --example run_scenario -- out` writes the files of `fogbench run` as well.

use std::error::Error;

use fogbench::Scenario;
use fogbench::metrics::catalogue::{BIAS_STABILITY_1S, DC_GAIN};

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenarios/quick/static.toml");

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let run = Scenario::from_file(FILE)?
        .set("duration_s", 20.0)?
        .set("warm_up_s", 2.0)?
        .set("filter.rls.taps", 8)?
        .run()?;

    println!("channel        bias stability at 1 s, deg/h");
    for (name, channel) in run.channels() {
        println!("{name:<14} {}", channel.metric(&BIAS_STABILITY_1S)?);
    }
    for verdict in run.verdicts() {
        println!("{:?}: {}", verdict.kind, verdict.reason);
    }

    // The quieter channel is the one that shrinks the rate itself.
    let dc_gain = run["rls"].metric(&DC_GAIN)?;
    println!("DC gain of rls {dc_gain}");
    assert!(dc_gain.value < 0.8, "a predictor learns to shrink");
    assert!(
        run["raw"].metric(&DC_GAIN).is_err(),
        "only filters have one"
    );

    let words = run.samples("rls")?;
    let truth = run.samples("truth")?;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    println!(
        "{} samples at {:.1} Hz: mean {:.3} {}, true rate {:.3} {}",
        words.measured().len(),
        words.period_s.recip(),
        mean(words.measured()),
        words.unit,
        mean(truth.measured()),
        truth.unit
    );
    assert!(mean(words.measured()) < 0.8 * mean(truth.measured()));

    if let Some(folder) = std::env::args().nth(1).filter(|_| is_program()) {
        run.write(&folder)?;
        println!("results in {folder}");
    }
    Ok(())
}

/// Whether the arguments are this example's, not those of a test that runs it.
fn is_program() -> bool {
    std::env::args()
        .next()
        .is_some_and(|path| path.contains("run_scenario"))
}
