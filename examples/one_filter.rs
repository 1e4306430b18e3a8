//! One adaptive filter alone, on words made here: what a quiet output costs.
//!
//! ```text
//!  10 deg/h + white noise ──x[k]──┬──> delay 1 ──> weights W ──> y[k]
//!                                 └──d──> e = d - y ──> update of W
//! ```

use std::error::Error;

use fogbench::filters::{Filter, FrontEndConfig, Rls, RlsConfig};
use fogbench::random::Streams;
use fogbench::vocabulary::{DesiredSignal, OutputRegister, UpdateSign};

const RATE_DEG_PER_H: f64 = 10.0;
const NOISE_DEG_PER_H: f64 = 20.0;
const SAMPLES: usize = 40_000;

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let mut noise = vec![0.0; SAMPLES];
    Streams::new(1, 0).stream("example").fill_normal(&mut noise);

    let mut filter = Rls::new(&RlsConfig {
        taps: 4,
        forgetting_factor: 1.0,
        initial_inverse_correlation: 1.0,
        update_sign: UpdateSign::Corrected,
        front_end: FrontEndConfig {
            desired: DesiredSignal::Current,
            input_lag_samples: 1,
            output_register: OutputRegister::Immediate,
        },
    });
    let mut last_sum = 0.0;
    for normal in &noise {
        let output = filter.step(RATE_DEG_PER_H + NOISE_DEG_PER_H * normal)?;
        last_sum = output.weight_sum;
    }

    // Wiener: p weights on a constant of power r^2 in white noise of variance s^2 sum to
    // p r^2 / (p r^2 + s^2).
    let signal = 4.0 * RATE_DEG_PER_H * RATE_DEG_PER_H;
    let expected = signal / (signal + NOISE_DEG_PER_H * NOISE_DEG_PER_H);
    println!("weights  {:.3?}", filter.weights());
    println!("DC gain  {last_sum:.3}, by theory {expected:.3}");
    assert!((last_sum - expected).abs() < 0.03);
    Ok(())
}
