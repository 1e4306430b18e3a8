//! Repeatable inputs for the pipelines: the signals of a static and of a rocking gyro.

use fogbench::fpga::float_unit::Fp;
use fogbench::fpga::front_end::{FrontEnd, Pair};
use fogbench::vocabulary::Division;

/// One set-up of the bit comparisons.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Setup {
    pub(crate) name: &'static str,
    pub(crate) alpha: f64,
    pub(crate) division: Division,
}

/// The four set-ups every comparison runs.
pub(crate) const SETUPS: [Setup; 4] = [
    Setup {
        name: "white",
        alpha: 1.0,
        division: Division::Reciprocal,
    },
    Setup {
        name: "static",
        alpha: 1.0,
        division: Division::Elementwise,
    },
    Setup {
        name: "rocking",
        alpha: 0.99,
        division: Division::Reciprocal,
    },
    Setup {
        name: "white-forgetting",
        alpha: 0.98,
        division: Division::Elementwise,
    },
];

/// Samples in deg/s at 4 kHz: noise of about 17 deg/h rms on 7 deg/h, or on a 1 deg/s, 10 Hz
/// swing; or white noise of about unit power.
pub(crate) fn samples(name: &str, count: usize) -> Vec<f64> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut noise = || {
        // Sum of four uniform words from a 64-bit LCG (Knuth's constants): near enough normal.
        let mut sum = 0.0;
        for _ in 0..4 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            sum += (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
        }
        sum * 3.0_f64.sqrt()
    };
    (0..count)
        .map(|k| {
            let angle = std::f64::consts::TAU * 10.0 * k as f64 / 4000.0;
            match name {
                "static" => (7.0 + 17.0 * noise()) / 3600.0,
                "rocking" => angle.sin() + (7.0 + 17.0 * noise()) / 3600.0,
                _ => noise(),
            }
        })
        .collect()
}

/// The samples through the one-step predictor's front end.
pub(crate) fn predictor_pairs<F: Fp>(name: &str, count: usize) -> Vec<Pair<F>> {
    let mut front_end = FrontEnd::one_step_predictor();
    samples(name, count)
        .iter()
        .map(|sample| front_end.pair(F::from_f64(*sample)))
        .collect()
}

/// The bits of each word.
pub(crate) fn words<F: Fp>(values: &[F]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}
