//! Known answers of the slow noise: flicker, rate random walk and ramp.

use fogbench::gyro::{RateModel, SlowNoise};
use fogbench::metrics::{NoiseCoefficients, expected_bias_stability};
use fogbench::random::Streams;
use fogbench::signal::MotionSegment;
use fogbench::units::rad_per_s_to_deg_per_h;
use std::f64::consts::PI;

use crate::support::assert_close;
use crate::support::gyro_cases::{allan_deviation, budget_of};
use crate::support::reference_gyro::reference_gyro;

/// Slow noise alone, deg/h, at a sample period.
fn slow_noise(coefficients: [f64; 3], sample_period_s: f64, count: usize, seed: u64) -> Vec<f64> {
    let mut config = reference_gyro().slow_noise;
    [
        config.bias_instability_deg_per_h,
        config.rate_random_walk_deg_per_h_per_sqrt_h,
        config.rate_ramp_deg_per_h_per_h,
    ] = coefficients;
    let time_s = count as f64 * sample_period_s;
    let mut noise = SlowNoise::new(&config, sample_period_s, time_s, &Streams::new(seed, 0));
    (0..count)
        .map(|_| rad_per_s_to_deg_per_h(noise.next_rate_rad_per_s()))
        .collect()
}

#[test]
fn known_answer_k19_flicker_has_a_flat_allan_deviation() {
    const COUNT: usize = 1 << 17;
    let runs: Vec<Vec<f64>> = (0..20)
        .map(|seed| slow_noise([1.0, 0.0, 0.0], 0.01, COUNT, seed))
        .collect();
    let flat = (2.0 * 2.0_f64.ln() / PI).sqrt();
    let mean_at = |factor: usize| {
        let variance = runs
            .iter()
            .map(|run| allan_deviation(run, factor).powi(2))
            .sum::<f64>();
        (variance / 20.0).sqrt()
    };
    // Degrees of freedom of flicker are near those of white noise: 20 runs of 2^17 / m clusters
    // give 0.2 % at m = 16 and 1.6 % at m = 1024.
    for factor in [16, 32, 64, 128, 256, 512, 1024] {
        assert_close(mean_at(factor), flat, 0.03, 0.0);
    }
    // Down to four updates no white residue stands beside it.
    assert_close(mean_at(4), flat, 0.03, 0.0);
}

/// Root mean square over `runs` runs of the Allan deviation over B, at the output rate.
fn flicker_at_the_output_rate(runs: u64, count: usize, factors: &[usize]) -> Vec<f64> {
    let words: Vec<Vec<f64>> = (0..runs)
        .map(|seed| slow_noise([1.0, 0.0, 0.0], 2.506_6e-4, count, 100 + seed))
        .collect();
    let mean = |factor: &usize| {
        let variances = words
            .iter()
            .map(|run| allan_deviation(run, *factor).powi(2));
        (variances.sum::<f64>() / runs as f64).sqrt()
    };
    factors.iter().map(mean).collect()
}

#[test]
fn known_answer_k19_flicker_is_flat_from_sixteen_words_on_at_the_output_rate() {
    let flat = (2.0 * 2.0_f64.ln() / PI).sqrt();
    // 3989 Hz: four samples per update. edf near 1.5 x 20 x 2^17 / m: 1.3 % at m = 1024.
    let factors = [16, 32, 64, 128, 256, 512, 1024];
    let deviations = flicker_at_the_output_rate(20, 1 << 17, &factors);
    for deviation in &deviations {
        assert_close(*deviation, flat, 0.03, 0.0);
    }
    let mean = deviations.iter().sum::<f64>() / factors.len() as f64;
    assert_close(mean, flat, 0.02, 0.0);
    // The check can fail: within one update there is nothing but the hold.
    let held = flicker_at_the_output_rate(2, 1 << 17, &[1]);
    assert!(held[0] < 0.6 * flat, "{held:?}");
}

#[test]
fn flicker_stays_flat_over_the_record_at_the_output_rate() {
    // Decades from 60 ms to 60 s; the last processes are redrawn every 256 updates.
    let flat = (2.0 * 2.0_f64.ln() / PI).sqrt();
    for deviation in flicker_at_the_output_rate(6, 1 << 21, &[256, 2048, 16_384]) {
        // edf 1.5 x 6 x 128 at the longest: 2.1 %.
        assert_close(deviation, flat, 0.05, 0.0);
    }
}

/// Root mean square over `runs` of the standard deviation of 36 means of 32 samples each.
fn block_deviation(coefficients: [f64; 3], runs: u64) -> f64 {
    const BLOCKS: usize = 36;
    let sum: f64 = (0..runs)
        .map(|seed| {
            let words = slow_noise(coefficients, BLOCK_S / 32.0, BLOCKS * 32, 5000 + seed);
            let means: Vec<f64> = words
                .chunks_exact(32)
                .map(|block| block.iter().sum::<f64>() / 32.0)
                .collect();
            let mean = means.iter().sum::<f64>() / BLOCKS as f64;
            let power: f64 = means.iter().map(|block| (block - mean).powi(2)).sum();
            power / (BLOCKS - 1) as f64
        })
        .sum();
    (sum / runs as f64).sqrt()
}

/// Length of a block of [`block_deviation`], s.
const BLOCK_S: f64 = 0.32;

#[test]
fn known_answer_k21_block_means_of_slow_noise_scatter_as_predicted() {
    // Flicker: B sqrt(n ln n / (pi (n - 1))) = 1.083 B for n = 36 (Barnes). Some 20 degrees of
    // freedom a run: 0.4 % after 2000.
    let flicker = NoiseCoefficients {
        bias_instability_deg_per_h: 1.0,
        ..NoiseCoefficients::default()
    };
    let want = expected_bias_stability(&flicker, BLOCK_S, 36);
    assert_close(want, 1.083, 0.0, 5e-4);
    assert_close(block_deviation([1.0, 0.0, 0.0], 2000), want, 0.03, 0.0);
    // Walk: n / 2 = 18 times the Allan variance K^2 t / 3. Its lowest mode has three fifths of the
    // power, two to three degrees of freedom a run: 0.7 % after 4000.
    let walk = NoiseCoefficients {
        rate_random_walk_deg_per_h_per_sqrt_s: 0.1,
        ..NoiseCoefficients::default()
    };
    let want = expected_bias_stability(&walk, BLOCK_S, 36);
    assert_close(want * want, 18.0 * 0.01 * BLOCK_S / 3.0, 1e-12, 0.0);
    assert_close(block_deviation([0.0, 6.0, 0.0], 4000), want, 0.03, 0.0);
}

#[test]
fn known_answer_k20_walk_and_ramp_have_their_allan_slopes() {
    let coefficient = 6.0;
    let count = 1 << 16;
    let factor = 64;
    let runs = 10;
    // Walk: AVAR = K^2 tau / 3, K in (deg/h)/sqrt(s) = 6 / 60.
    let variance: f64 = (0..runs)
        .map(|seed| {
            let words = slow_noise([0.0, coefficient, 0.0], 0.01, count, seed);
            allan_deviation(&words, factor).powi(2)
        })
        .sum::<f64>()
        / f64::from(10_u32);
    let want = (coefficient / 60.0_f64).powi(2) * 0.64 / 3.0;
    // Ten runs of 1024 clusters: 1.4 % of the variance; 4 of them.
    assert_close(variance, want, 0.06, 0.0);
    // Ramp: ADEV = R tau / sqrt(2), R in (deg/h)/s.
    let words = slow_noise([0.0, 0.0, 3600.0], 0.01, 4096, 1);
    assert_close(
        allan_deviation(&words, factor),
        0.64 / 2.0_f64.sqrt(),
        1e-9,
        0.0,
    );
    assert_close(words[99], 0.995, 1e-9, 0.0);
}

#[test]
fn bias_stability_of_the_default_mix_is_the_sum_of_its_parts() {
    // 36 means of 100 s: white noise N / sqrt(100 s) and flicker 1.083 B, in quadrature.
    let mut config = reference_gyro();
    config.slow_noise.bias_instability_deg_per_h = 0.045;
    config.slow_noise.rate_random_walk_deg_per_h_per_sqrt_h = 0.005;
    config.output.half_periods_per_sample = 1 << 14;
    let per_block = 1558; // 99.98 s
    let repeats = 200;
    let mut sum = 0.0;
    for repeat in 0..repeats {
        let streams = Streams::new(9, repeat);
        let mut model = RateModel::new(&config, 3600.0, &streams).unwrap();
        let rest = MotionSegment::constant(0.0);
        let means: Vec<f64> = (0..36)
            .map(|_| {
                (0..per_block).map(|_| model.next_word(&rest)).sum::<f64>() / f64::from(per_block)
            })
            .collect();
        let mean = means.iter().sum::<f64>() / 36.0;
        sum += means
            .iter()
            .map(|value| (value - mean).powi(2))
            .sum::<f64>()
            / 35.0;
    }
    let white = budget_of(&config, "total") * 6.0;
    let want = white.hypot(1.083 * 0.045);
    assert_close(want, 0.0606, 0.0, 1e-4);
    // White means alone would err by sqrt(1 / 2 / 35 / 200) = 0.85 %; flicker's few slow modes double it.
    assert_close((sum / 200.0).sqrt(), want, 0.04, 0.0);
}

/// Exponentially correlated noise of 1 deg/h and 1 s, deg/h, beside other slow noise.
fn gauss_markov(instability: f64, deviation: f64, period_s: f64, seed: u64) -> Vec<f64> {
    const COUNT: usize = 1 << 16;
    let mut config = reference_gyro().slow_noise;
    config.bias_instability_deg_per_h = instability;
    config.gauss_markov_deg_per_h = deviation;
    config.gauss_markov_correlation_time_s = 1.0;
    let mut noise = SlowNoise::new(&config, period_s, 1e3, &Streams::new(seed, 0));
    (0..COUNT)
        .map(|_| rad_per_s_to_deg_per_h(noise.next_rate_rad_per_s()))
        .collect()
}

#[test]
fn gauss_markov_noise_has_the_allan_variance_of_its_closed_form() {
    const RUNS: u64 = 80;
    let period_s = 0.01;
    let runs: Vec<_> = (0..RUNS)
        .map(|seed| gauss_markov(0.0, 1.0, period_s, seed))
        .collect();
    // At 1.89 correlation times the deviation is greatest: 0.437 q sqrt(Tc) with q^2 Tc = 2 s^2.
    let mut greatest = 0.0_f64;
    for factor in [10_usize, 30, 100, 189, 400, 1000] {
        let tau = factor as f64 * period_s;
        let bracket = 1.0 - (3.0 - 4.0 * (-tau).exp() + (-2.0 * tau).exp()) / (2.0 * tau);
        let want = 2.0 / tau * bracket;
        let got = runs
            .iter()
            .map(|run| allan_deviation(run, factor).powi(2))
            .sum::<f64>()
            / RUNS as f64;
        // Differences further apart than two averages and a correlation time are independent.
        let independent = RUNS as f64 * (runs[0].len() as f64 * period_s) / (2.0 * tau + 1.0);
        let error = (2.0 / independent).sqrt();
        assert!(error < 0.03, "{error}");
        assert_close(got, want, 4.0 * error, 0.0);
        greatest = greatest.max(want.sqrt());
    }
    assert_close(greatest, 0.437 * 2.0_f64.sqrt(), 2e-3, 0.0);
}

#[test]
fn gauss_markov_noise_is_averaged_over_any_sample_period_and_has_a_stream_of_its_own() {
    // A correlation time per sample: the mean over it has the variance 2 (a - 1 + exp(-a)) / a^2 =
    // 0.736 and the covariance (1 - exp(-1))^2 = 0.400 with its neighbour, from the first sample on.
    let words = gauss_markov(0.0, 1.0, 1.0, 7);
    let count = words.len() as f64;
    let products = |lag: usize| {
        let pairs = words.iter().zip(&words[lag..]);
        pairs.map(|(a, b)| a * b).sum::<f64>() / count
    };
    let error = (2.0 / count * (1.0 + 2.0 / (2.0_f64.exp() - 1.0))).sqrt();
    let end = (-1.0_f64).exp();
    assert_close(products(0), 2.0 * end, 0.0, 4.0 * error);
    assert_close(products(1), (1.0 - end).powi(2), 0.0, 4.0 * error);
    assert_close(products(2), end * (1.0 - end).powi(2), 0.0, 4.0 * error);
    let first = (0..2000).map(|seed| gauss_markov_first(seed).powi(2));
    assert_close(
        first.sum::<f64>() / 2000.0,
        1.0,
        0.0,
        4.0 * (2.0_f64 / 2000.0).sqrt(),
    );
    let flicker = gauss_markov(1.0, 0.0, 1.0, 7);
    let both = gauss_markov(1.0, 1.0, 1.0, 7);
    // The first values share the stream of starts.
    let later = both.iter().zip(&flicker).zip(&words).skip(2000);
    for ((sum, flicker), correlated) in later {
        assert_close(*sum, flicker + correlated, 0.0, 1e-9);
    }
}

#[test]
fn gauss_markov_noise_far_faster_than_a_word_is_what_its_density_leaves_of_it() {
    // A hundredth of a word: the mean over a word scatters by sqrt(2 Tc / T) of the deviation (it
    // scattered by all of it while it was drawn at the stamp).
    let words = gauss_markov(0.0, 1.0, 100.0, 3);
    let variance = words.iter().map(|word| word * word).sum::<f64>() / words.len() as f64;
    assert_close(variance, 2.0 * (100.0 - 1.0) / 1e4, 0.03, 0.0);
}

#[test]
fn flicker_and_walk_of_long_words_are_means_over_them() {
    const RUNS: u64 = 20;
    // Words of 10 ms: from the first averaging time on flicker is flat (1.3 % low at one word) ...
    let variance_at = |coefficients: [f64; 3], factor: usize| {
        let runs = (0..RUNS).map(|seed| slow_noise(coefficients, 0.01, 1 << 15, 400 + seed));
        let variances = runs.map(|run| allan_deviation(&run, factor).powi(2));
        variances.sum::<f64>() / RUNS as f64
    };
    let flat = (2.0 * 2.0_f64.ln() / PI).sqrt();
    for factor in [1, 2, 3] {
        assert_close(variance_at([1.0, 0.0, 0.0], factor).sqrt(), flat, 0.02, 0.0);
    }
    // ... and the Allan variance of the walk is K^2 tau / 3, where values at the stamps give a half.
    for factor in [1, 2, 4] {
        let want = 0.1_f64.powi(2) * 0.01 * factor as f64 / 3.0;
        assert_close(variance_at([0.0, 6.0, 0.0], factor), want, 0.03, 0.0);
    }
}

fn gauss_markov_first(seed: u64) -> f64 {
    let mut config = reference_gyro().slow_noise;
    config.gauss_markov_deg_per_h = 1.0;
    config.gauss_markov_correlation_time_s = 1e6;
    let mut noise = SlowNoise::new(&config, 1e-3, 1.0, &Streams::new(seed, 0));
    rad_per_s_to_deg_per_h(noise.next_rate_rad_per_s())
}
