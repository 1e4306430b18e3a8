//! Whether the intervals of fitted noise coefficients hold the truth as often as they say.

use fogbench::metrics::{
    Estimate, FIT_TAU_PER_RECORD_MAX, FitRange, NoiseCoefficients, Term, fit_noise,
    overlapping_allan,
};
use fogbench::random::Streams;
use rayon::prelude::*;
use realfft::RealFftPlanner;

/// Rates in a record, one a second.
const COUNT: usize = 3000;

/// Records for every mix of noises.
const RUNS: u64 = 500;

/// Flicker noise of bias instability 1 after Kasdin, Proc. IEEE 83 (1995) 802: white noise through
/// `h_0 = 1, h_k = h_(k-1) (k - 1/2) / k`, by a transform four records long; the first record, in
/// which the filter fills, is dropped.
fn flicker(noise: &[f64], count: usize) -> Vec<f64> {
    let length = (4 * count).next_power_of_two();
    let mut planner = RealFftPlanner::<f64>::new();
    let forward = planner.plan_fft_forward(length);
    let transform = |values: &[f64]| {
        let mut input = forward.make_input_vec();
        input[..values.len()].copy_from_slice(values);
        let mut output = forward.make_output_vec();
        forward
            .process(&mut input, &mut output)
            .expect("the buffers are the plan's own");
        output
    };
    let mut response = vec![1.0; 2 * count];
    for k in 1..response.len() {
        response[k] = response[k - 1] * (k as f64 - 0.5) / k as f64;
    }
    let mut product = transform(&noise[..2 * count]);
    for (bin, gain) in product.iter_mut().zip(transform(&response)) {
        *bin *= gain;
    }
    let inverse = planner.plan_fft_inverse(length);
    let mut values = inverse.make_output_vec();
    inverse
        .process(&mut product, &mut values)
        .expect("the buffers are the plan's own");
    values[count..2 * count]
        .iter()
        .map(|value| value / length as f64)
        .collect()
}

/// A record of the five noises from their plain definitions.
fn record(truth: &NoiseCoefficients, seed: u64) -> Vec<f64> {
    let normals = |source: &str, count: usize| {
        let mut values = vec![0.0; count];
        let mut stream = Streams::new(seed, 0).stream(source);
        stream.fill_normal(&mut values);
        values
    };
    let mut values = normals("white", COUNT);
    for value in &mut values {
        *value *= truth.angle_random_walk_deg_per_h_sqrt_s;
    }
    if truth.bias_instability_deg_per_h > 0.0 {
        let slow = flicker(&normals("flicker", 2 * COUNT), COUNT);
        for (value, slow) in values.iter_mut().zip(slow) {
            *value += truth.bias_instability_deg_per_h * slow;
        }
    }
    let mut walk = 0.0;
    let angles = normals("angle", COUNT + 1);
    for (k, step) in normals("walk", COUNT).into_iter().enumerate() {
        values[k] += walk + truth.rate_ramp_deg_per_h_per_s * k as f64;
        values[k] += truth.quantisation_arcsec * (angles[k + 1] - angles[k]);
        walk += truth.rate_random_walk_deg_per_h_per_sqrt_s * step;
    }
    values
}

/// Intervals of one coefficient over many records.
struct Trial {
    /// Records whose interval holds the truth.
    held: usize,
    /// Mean of the estimates, 0 for a term left out.
    mean: f64,
    /// Standard error that the mean width of the intervals stands for.
    standard_error: f64,
}

fn trials(truth: &NoiseCoefficients) -> [Trial; 5] {
    let wanted = [
        truth.angle_random_walk_deg_per_h_sqrt_s,
        truth.bias_instability_deg_per_h,
        truth.rate_random_walk_deg_per_h_per_sqrt_s,
        truth.rate_ramp_deg_per_h_per_s,
        truth.quantisation_arcsec,
    ];
    let range = FitRange {
        tau_min_s: 1.0,
        tau_max_s: COUNT as f64 * FIT_TAU_PER_RECORD_MAX,
    };
    let fits: Vec<[Estimate; 5]> = (0..RUNS)
        .into_par_iter()
        .map(|seed| {
            let points = overlapping_allan(&record(truth, seed), 1.0);
            let fit = fit_noise(&points, range).expect("enough averaging times");
            [
                &fit.angle_random_walk_deg_per_h_sqrt_s,
                &fit.bias_instability_deg_per_h,
                &fit.rate_random_walk_deg_per_h_per_sqrt_s,
                &fit.rate_ramp_deg_per_h_per_s,
                &fit.quantisation_arcsec,
            ]
            .map(Term::estimate)
        })
        .collect();
    std::array::from_fn(|term| {
        let estimates = || fits.iter().map(|fit| fit[term]);
        let holds = |one: &Estimate| one.low <= wanted[term] && wanted[term] <= one.high;
        let mean = |pick: fn(Estimate) -> f64| estimates().map(pick).sum::<f64>() / RUNS as f64;
        Trial {
            held: estimates().filter(holds).count(),
            mean: mean(|one| one.value),
            standard_error: mean(|one| one.high - one.low) / (2.0 * 1.96),
        }
    })
}

/// Mixes of noise, each with the term that it adds, how far its mean estimate may lie off and how wide
/// its interval may be, as a part of the truth.
fn mixes() -> [(NoiseCoefficients, usize, f64, f64); 6] {
    let white = NoiseCoefficients {
        angle_random_walk_deg_per_h_sqrt_s: 1.0,
        ..NoiseCoefficients::default()
    };
    [
        (white, 0, 0.01, 0.05),
        (
            NoiseCoefficients {
                bias_instability_deg_per_h: 0.3,
                ..white
            },
            1,
            0.03,
            0.2,
        ),
        (
            NoiseCoefficients {
                rate_random_walk_deg_per_h_per_sqrt_s: 0.1,
                ..white
            },
            2,
            0.06,
            0.2,
        ),
        (
            NoiseCoefficients {
                rate_ramp_deg_per_h_per_s: 0.003,
                ..white
            },
            3,
            0.03,
            0.2,
        ),
        (
            NoiseCoefficients {
                quantisation_arcsec: 1.8,
                ..white
            },
            4,
            0.01,
            0.05,
        ),
        // A gyro's own slow noise: an hour shows it, barely.
        (
            NoiseCoefficients {
                bias_instability_deg_per_h: 0.125,
                ..white
            },
            1,
            0.1,
            0.5,
        ),
    ]
}

#[test]
fn fitted_coefficients_lie_in_their_intervals_as_often_as_stated() {
    let mut complaints = Vec::new();
    for (truth, term, bias_max, error_max) in mixes() {
        let found = trials(&truth);
        for (index, trial) in found.iter().enumerate() {
            // Binomial standard deviation of 500 at 0.95 is 4.9: three of them below 475.
            if trial.held < 460 {
                complaints.push(format!("{truth:?}: term {index} {} of {RUNS}", trial.held));
            }
        }
        // N of short white records once read 1 % low; a term that is there is not blurred away.
        let wanted = [1.0, truth.bias_instability_deg_per_h, 0.1, 0.003, 1.8][term];
        let trial = &found[term];
        if (trial.mean / wanted - 1.0).abs() > bias_max || trial.standard_error > error_max * wanted
        {
            complaints.push(format!(
                "{truth:?}: mean {} standard error {}",
                trial.mean, trial.standard_error
            ));
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}
