//! A hardware pipeline clock by clock, beside its engine without clocks: the same bits.
//!
//! ```text
//!            ┌──> pipeline: RAMA, RAMB, one x, one +, one / ──y──┐
//!  x, d ─────┤                                                    ├──> equal to the last bit
//!            └──> engine: the same operations, no clock ─────y──┘
//! ```

use std::error::Error;

use fogbench::fpga::engine::Engine as _;
use fogbench::fpga::front_end::Pair;
use fogbench::fpga::rls::{RlsConfig, RlsEngine, RlsPipeline, RlsSettings};
use fogbench::vocabulary::{Division, UpdateSign};

const CLOCK_MHZ: f64 = 40.0;

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let config = RlsConfig::<f64>::new(RlsSettings {
        tap_count: 4,
        forgetting_factor: 1.0,
        initial_inverse_correlation: 1e4,
        division: Division::Reciprocal,
        update_sign: UpdateSign::Corrected,
    })?;
    // A one-step predictor: each word is predicted from those before it.
    let words = [0.1, -0.7, 0.3, 1.1, -0.9, 0.2, 0.6, -0.4];
    let pairs: Vec<Pair<f64>> = words
        .windows(2)
        .map(|pair| Pair::from_f64(pair[0], pair[1]))
        .collect();

    let mut pipeline = RlsPipeline::new(config);
    let mut engine = RlsEngine::new(config);
    let (mut accepted, mut finished) = (Vec::new(), Vec::new());
    println!("clock  word              bits");
    let mut clock: u32 = 0;
    while finished.len() < pairs.len() {
        // The strobe is held until the sample is taken.
        let tick = pipeline.tick(pairs.get(accepted.len()).copied());
        if let Some(word) = tick.output {
            println!("{clock:>5}  {word:<16.12}  {:016x}", word.to_bits());
            let twin = engine.process(pairs[finished.len()]);
            assert_eq!(word.to_bits(), twin.to_bits());
            finished.push(clock);
        }
        accepted.extend(tick.accepted.then_some(clock));
        clock += 1;
    }
    let (period, latency) = (accepted[1] - accepted[0], finished[0] - accepted[0]);
    assert_eq!((period, latency), (108, 99));
    println!(
        "{period} clocks a sample, {latency} to the result: {:.1} kHz at {CLOCK_MHZ} MHz",
        1e3 * CLOCK_MHZ / f64::from(period)
    );
    Ok(())
}
