//! Closed-form and published answers for the Allan variance, its fit and the spectrum.

use fogbench::metrics::{
    AllanOptions, FitRange, Motion, NoiseCoefficients, Record, Settings, aggregate, block_means,
    expected_bias_stability, fit_noise, fit_pooled_noise, measure, overlapping_allan,
    overlapping_allan_at, welch,
};
use fogbench::signal::Rates;
use fogbench::units;

use crate::support::assert_close;
use crate::support::records::{PERIOD_S, value, white};

fn overlapping(values: &[f64], factor: usize) -> f64 {
    overlapping_allan_at(values, 1.0, &[factor])[0]
        .deviation_deg_per_h
        .value
}

/// Allan deviation without overlap, from the definition: the twin the fast one is held to.
fn non_overlapping(values: &[f64], factor: usize) -> f64 {
    let means = block_means(values, factor);
    let sum: f64 = means.windows(2).map(|two| (two[1] - two[0]).powi(2)).sum();
    (sum / (2.0 * (means.len() - 1) as f64)).sqrt()
}

#[test]
fn known_answer_k17_allan_deviation_of_the_nbs_nine_point_set() {
    // NIST SP 1065 table 30 (NBS Monograph 140, annex 8.E).
    let values = [
        892.0, 809.0, 823.0, 798.0, 671.0, 644.0, 883.0, 903.0, 677.0,
    ];
    assert_close(overlapping(&values, 1), 91.229_45, 1e-6, 0.0);
    assert_close(overlapping(&values, 2), 85.952_87, 1e-6, 0.0);
    assert_close(non_overlapping(&values, 1), 91.229_45, 1e-6, 0.0);
    assert_close(non_overlapping(&values, 2), 115.808_2, 1e-6, 0.0);
    // The check can fail: without overlap the second figure is another one.
    assert!((non_overlapping(&values, 2) / 85.952_87 - 1.0).abs() > 0.3);
}

#[test]
fn known_answer_k18_allan_deviation_of_the_nist_thousand_point_set() {
    // NIST SP 1065 section 12.4: n' = 16807 n mod (2^31 - 1), table 31.
    let mut state = 1_234_567_890_u64;
    let values: Vec<f64> = (0..1000)
        .map(|_| {
            let value = state as f64 / 2_147_483_647.0;
            state = 16_807 * state % 2_147_483_647;
            value
        })
        .collect();
    let mean = values.iter().sum::<f64>() / 1000.0;
    assert_close(mean, 0.489_774_5, 1e-6, 0.0);
    for (factor, wanted) in [(1, 2.922_319e-1), (10, 9.159_953e-2), (100, 3.241_343e-2)] {
        assert_close(overlapping(&values, factor), wanted, 1e-6, 0.0);
    }
    for (factor, wanted) in [(1, 2.922_319e-1), (10, 9.965_736e-2), (100, 3.897_804e-2)] {
        assert_close(non_overlapping(&values, factor), wanted, 1e-6, 0.0);
    }
}

#[test]
fn known_answer_k31_a_white_sequence_of_0_36_deg_per_h_at_1_hz_is_0_006_deg_per_sqrt_h() {
    let in_deg_per_sqrt_h = units::deg_per_h_sqrt_s_to_deg_per_sqrt_h(0.36 * 1.0_f64.sqrt());
    assert_close(in_deg_per_sqrt_h, 0.006, 1e-12, 0.0);
    assert_close(
        units::rad_per_sqrt_s_to_deg_per_sqrt_h(1.0),
        3437.747,
        1e-6,
        0.0,
    );
    let values = white(31, 40_000, 0.36);
    let fit = fit_noise(
        &overlapping_allan(&values, 1.0),
        FitRange {
            tau_min_s: 1.0,
            tau_max_s: 40_000.0 / 9.0,
        },
    )
    .unwrap();
    let found = fit.angle_random_walk_deg_per_h_sqrt_s.value();
    // The variance of 40 000 white samples has a standard error of 0.7 %; the free 1/tau^2 term
    // about doubles that: 4 x 0.7 %.
    assert_close(
        units::deg_per_h_sqrt_s_to_deg_per_sqrt_h(found),
        0.006,
        0.028,
        0.0,
    );
}

#[test]
fn fitted_angle_random_walk_interval_covers_the_truth_as_often_as_it_says() {
    const RUNS: u64 = 400;
    let truth = 2.0 * 0.01_f64.sqrt();
    let (mut covered, mut covered_by_half, mut sum, mut width) = (0, 0, 0.0, 0.0);
    for seed in 0..RUNS {
        let values = white(1000 + seed, 12_000, 2.0);
        let range = FitRange {
            tau_min_s: 0.1,
            tau_max_s: 120.0 / 9.0,
        };
        let fit = fit_noise(&overlapping_allan(&values, 0.01), range).unwrap();
        let estimate = fit.angle_random_walk_deg_per_h_sqrt_s.estimate();
        sum += estimate.value / truth;
        width += (estimate.high - estimate.low) / truth;
        covered += i32::from(estimate.low <= truth && truth <= estimate.high);
        let half = (estimate.high - estimate.low) / 4.0;
        covered_by_half += i32::from((estimate.value - truth).abs() <= half);
    }
    // Binomial standard deviation of 400 at 0.95 is 4.36: 380 - 3.5 x 4.36. White noise is the
    // cautious case, since the interval allows for an unseen flicker floor.
    assert!(covered >= 365, "{covered} of {RUNS}");
    assert!(
        covered <= 399,
        "{covered} of {RUNS}: the interval is too wide to be honest"
    );
    // A floor that cannot be negative takes 0.4 standard errors (the mean of a half normal) away
    // from N, times their correlation; 4 / sqrt(400) is chance.
    let standard_error = width / (2.0 * 1.96) / RUNS as f64;
    let mean = sum / RUNS as f64;
    assert_close(mean, 1.0, 0.0, (0.4 + 0.2) * standard_error);
    // Half the interval would not do.
    assert!(covered_by_half <= 320, "{covered_by_half} of {RUNS}");
}

#[test]
fn fitted_angle_random_walk_is_not_biased_by_the_bandwidth_of_the_channel() {
    // Samples x_k = n_k + a n_(k-1): N^2 = s^2 (1+a)^2 T, correlated over one sample.
    let (a, runs) = (0.4, 40);
    let truth = 1.4;
    let (mut signed, mut plain) = (0.0, 0.0);
    for seed in 0..runs {
        let noise = white(5000 + seed, 100_001, 1.0);
        let values: Vec<f64> = noise.windows(2).map(|two| two[1] + a * two[0]).collect();
        let points = overlapping_allan(&values, 1.0);
        let range = FitRange {
            tau_min_s: 5.0,
            tau_max_s: 1e5 / 9.0,
        };
        let fit = fit_noise(&points, range).unwrap();
        signed += fit.angle_random_walk_deg_per_h_sqrt_s.value() / truth / runs as f64;
        let first = points.iter().find(|point| point.tau_s >= 5.0).unwrap();
        plain += first.variance().sqrt() * first.tau_s.sqrt() / truth / runs as f64;
    }
    // One fit of 1e5 samples from tau = 5 on has a standard error near 1 %; of 40 fits 0.16 %.
    assert_close(signed, 1.0, 4.0 * 0.0016, 0.0);
    // The check can fail: reading N off the shortest tau is 3 sum k R(k) / 2 N^2 tau = 6 % low.
    assert!(plain < 0.95, "{plain}");
}

#[test]
fn fit_finds_the_coefficients_of_an_exact_curve() {
    let truth = NoiseCoefficients {
        quantisation_arcsec: 0.05,
        angle_random_walk_deg_per_h_sqrt_s: 0.36,
        bias_instability_deg_per_h: 0.2,
        rate_random_walk_deg_per_h_per_sqrt_s: 0.004,
        rate_ramp_deg_per_h_per_s: 2e-4,
    };
    let mut points = overlapping_allan(&white(3, 200_000, 1.0), 0.1);
    for point in &mut points {
        point.deviation_deg_per_h.value = truth.allan_variance(point.tau_s).sqrt();
        *point = point.with_degrees_of_freedom(1e8 / point.tau_s);
    }
    let range = FitRange {
        tau_min_s: 0.1,
        tau_max_s: 20_000.0 / 9.0,
    };
    // As sharp as a million records: then nothing is too faint.
    let fit = fit_pooled_noise(&points, range, 1e6).unwrap();
    let found = fit.coefficients();
    for (got, want) in [
        (found.quantisation_arcsec, truth.quantisation_arcsec),
        (
            found.angle_random_walk_deg_per_h_sqrt_s,
            truth.angle_random_walk_deg_per_h_sqrt_s,
        ),
        (
            found.bias_instability_deg_per_h,
            truth.bias_instability_deg_per_h,
        ),
        (
            found.rate_random_walk_deg_per_h_per_sqrt_s,
            truth.rate_random_walk_deg_per_h_per_sqrt_s,
        ),
        (
            found.rate_ramp_deg_per_h_per_s,
            truth.rate_ramp_deg_per_h_per_s,
        ),
    ] {
        assert_close(got, want, 1e-6, 0.0);
    }
}

#[test]
fn fit_leaves_out_what_white_noise_does_not_show_and_refuses_a_short_record() {
    let range = |duration_s: f64| FitRange {
        tau_min_s: 0.1,
        tau_max_s: duration_s / 9.0,
    };
    let mut slow_terms = 0;
    for seed in 0..60 {
        let values = white(7000 + seed, 12_000, 1.0);
        let fit = fit_noise(&overlapping_allan(&values, 0.01), range(120.0)).unwrap();
        for term in [
            fit.bias_instability_deg_per_h,
            fit.rate_random_walk_deg_per_h_per_sqrt_s,
            fit.rate_ramp_deg_per_h_per_s,
        ] {
            slow_terms += usize::from(term.estimate().low > 0.0);
        }
    }
    // The interval of each of three terms leaves zero out in one record of forty:
    // 60 x 0.075 = 4.5 at most, standard deviation 2.1.
    assert!(slow_terms <= 11, "{slow_terms}");
    let short = overlapping_allan(&white(1, 500, 1.0), 0.01);
    assert!(fit_noise(&short, range(5.0)).is_err());
}

#[test]
fn known_answer_k21_block_means_of_white_noise_scatter_as_predicted() {
    let (runs, count, block) = (400, 36, 25);
    let coefficients = NoiseCoefficients {
        angle_random_walk_deg_per_h_sqrt_s: 3.0 * PERIOD_S.sqrt(),
        ..NoiseCoefficients::default()
    };
    let expected = expected_bias_stability(&coefficients, block as f64 * PERIOD_S, count);
    let mut sum = 0.0;
    for seed in 0..runs {
        let means = block_means(&white(seed, count * block, 3.0), block);
        let mean = means.iter().sum::<f64>() / count as f64;
        sum += means.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / (count - 1) as f64;
    }
    let found = (sum / runs as f64).sqrt();
    // Standard error of the rms: 1 / sqrt(2 runs (count - 1)) = 0.6 %; four of them.
    assert_close(found, expected, 0.024, 0.0);
    assert!((found / (expected * 2.0_f64.sqrt()) - 1.0).abs() > 0.2);
}

#[test]
fn welch_integrates_to_the_variance_and_shows_the_white_level_one_sided() {
    let values = white(11, 1 << 18, 22.8);
    let spectrum = welch(&values, PERIOD_S, 1 << 10);
    let step = spectrum.frequency_hz[1] - spectrum.frequency_hz[0];
    let density = &spectrum.density_deg2_per_h2_per_hz;
    let integral: f64 = density.iter().sum::<f64>() * step;
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / count;
    // The zero-frequency bin, one of 512, is left out, and windows weigh the samples unevenly at
    // the ends: 1 / 512 + 2 / 512.
    assert_close(integral, variance, 3.0 / 512.0, 0.0);
    let level = density.iter().sum::<f64>() / density.len() as f64;
    // Relative standard error of the variance of 2^18 samples: sqrt(2/n) = 0.28 %; four of them.
    assert_close(level, 2.0 * 22.8 * 22.8 * PERIOD_S, 0.0112, 0.0);
    // The check can fail: the two-sided level is half of this.
    assert!((level / (22.8 * 22.8 * PERIOD_S) - 2.0).abs() < 0.03);
}

/// Flicker noise of bias instability 1 after Kasdin, Proc. IEEE 83 (1995) 802: white noise through
/// `h_0 = 1, h_k = h_(k-1) (k - 1/2) / k`. The first half, where the filter still fills, is dropped.
fn flicker(seed: u64, count: usize) -> Vec<f64> {
    let noise = white(seed, 2 * count, 1.0);
    let mut response = vec![1.0; 2 * count];
    for k in 1..response.len() {
        response[k] = response[k - 1] * (k as f64 - 0.5) / k as f64;
    }
    let reversed: Vec<f64> = noise.into_iter().rev().collect();
    (count..2 * count)
        .map(|k| {
            let past = &reversed[2 * count - 1 - k..];
            past.iter().zip(&response).map(|(a, b)| a * b).sum()
        })
        .collect()
}

#[test]
fn slow_noise_is_fitted_and_its_intervals_cover_the_truth() {
    const RUNS: u64 = 150;
    const COUNT: usize = 3600;
    // The gyro's own slow noise, one word a second: N 0.36 (deg/h) sqrt(s), B 0.045 deg/h.
    let truth = NoiseCoefficients {
        angle_random_walk_deg_per_h_sqrt_s: 0.36,
        bias_instability_deg_per_h: 0.045,
        ..NoiseCoefficients::default()
    };
    let expected_stability = expected_bias_stability(&truth, 100.0, 36);
    let walk = units::deg_per_h_sqrt_s_to_deg_per_sqrt_h(0.36);
    let mut covered = [0_u64; 3];
    let (mut found, mut stability_square) = (0, 0.0);
    let mut repeats = Vec::new();
    for seed in 0..RUNS {
        let mut raw = white(seed, COUNT, 0.36);
        for (value, slow) in raw.iter_mut().zip(flicker(9000 + seed, COUNT)) {
            *value += 0.045 * slow;
        }
        let zero = vec![0.0; COUNT];
        let record = Record {
            channel_deg_per_h: &raw,
            raw_deg_per_h: &raw,
            truth_deg_per_h: Rates::Words(&zero),
            response_deg_per_h: &[],
            encoder_rad: None,
            sample_period_s: 1.0,
            first_stamp_s: 0.0,
            drift: None,
        };
        let settings = Settings {
            motion: Motion::Steady,
            bias_averaging_time_s: 100.0,
            fit_tau_min_s: 1.0,
            allan: AllanOptions::default(),
            bridges: Vec::new(),
        };
        let metrics = measure(&record, &settings, None);
        let covers = |name: &str, wanted: f64| {
            metrics
                .metrics
                .get(name)
                .is_some_and(|m| m.estimate.low <= wanted && wanted <= m.estimate.high)
        };
        covered[0] += u64::from(covers("angle_random_walk_deg_per_sqrt_h", walk));
        covered[1] += u64::from(covers("bias_stability_deg_per_h", expected_stability));
        covered[2] += u64::from(covers("bias_instability_deg_per_h", 0.045));
        found += u64::from(metrics.metrics.contains_key("bias_instability_deg_per_h"));
        stability_square += value(&metrics, "bias_stability_deg_per_h").powi(2);
        repeats.push(metrics);
    }
    // Binomial standard deviation of 150 at 0.95: 2.7; three of them below 142.5, and one part in
    // fifty for intervals that rest on a fit made from the same record.
    assert!(covered[0] >= 131 && covered[1] >= 131, "{covered:?}");
    // B is found in most hours and missed in some; where it is found its interval holds it.
    assert!(found >= 120, "{found}");
    assert!(covered[2] * 100 >= found * 87, "{covered:?} of {found}");
    // Relative standard error of a pooled bias stability: 1 / sqrt(2 x 150 x 19 to 35) = 1.3 %.
    let pooled_stability = (stability_square / RUNS as f64).sqrt();
    assert_close(pooled_stability, expected_stability, 0.04, 0.0);
    // All 150 hours together: N to 0.25 %, B to 1.7 %, one standard error each.
    let pooled = aggregate(&repeats);
    assert_close(
        value(&pooled, "angle_random_walk_deg_per_sqrt_h"),
        walk,
        0.01,
        0.0,
    );
    assert_close(
        value(&pooled, "bias_instability_deg_per_h"),
        0.045,
        0.068,
        0.0,
    );
}
