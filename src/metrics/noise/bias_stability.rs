//! Bias stability: the scatter of non-overlapping block means. Bias instability is another quantity,
//! the flicker coefficient B of `metrics/allan/noise_fit.rs`.

use std::f64::consts::PI;

use crate::metrics::allan::coefficients::NoiseCoefficients;
use crate::metrics::estimate::blocks::is_sample_or_longer;
use crate::metrics::estimate::interval;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::{DEGREES_OF_FREEDOM, RAW_CORRELATION};
use crate::metrics::estimate::value::{Estimate, Metric};
use crate::metrics::key::metric::{Applies, Headline, MetricKey, Needs, Table};
use crate::wording::plain;

/// Bias stability over 1 s.
pub static BIAS_STABILITY_1S: MetricKey = MetricKey::new(
    "bias_stability_1s_deg_per_h",
    "deg/h",
    Applies::Steady,
    "standard deviation of non-overlapping 1 s means",
)
.lower_is_better()
.heading("bias stability")
.slow_noise()
.needs(Needs::Blocks(1.0));

/// Bias stability over 10 s.
pub static BIAS_STABILITY_10S: MetricKey = MetricKey::new(
    "bias_stability_10s_deg_per_h",
    "deg/h",
    Applies::Steady,
    "standard deviation of non-overlapping 10 s means",
)
.lower_is_better()
.heading("bias stability")
.slow_noise()
.needs(Needs::Blocks(10.0));

/// Bias stability over 100 s.
pub static BIAS_STABILITY_100S: MetricKey = MetricKey::new(
    "bias_stability_100s_deg_per_h",
    "deg/h",
    Applies::Steady,
    "standard deviation of non-overlapping 100 s means",
)
.lower_is_better()
.heading("bias stability")
.slow_noise()
.needs(Needs::Blocks(100.0));

/// Bias stability.
pub static BIAS_STABILITY: MetricKey = MetricKey::new(
    "bias_stability_deg_per_h",
    "deg/h",
    Applies::Steady,
    "standard deviation of non-overlapping means over the scenario's bias_averaging_time_s",
)
.lower_is_better()
.heading("bias stability")
.slow_noise()
.needs(Needs::ScenarioBlocks)
.run_column(6)
.tables(&[Table::Rest])
.headlines(&[Headline::Rest]);

/// Fewest blocks of which a bias stability is given.
pub(crate) const BLOCKS_MIN: usize = 5;

/// Why samples of a period cannot be averaged over a time; nothing if they can.
pub(crate) fn averaging_lack(averaging_time_s: f64, sample_period_s: f64) -> Option<Unavailable> {
    (!is_sample_or_longer(averaging_time_s, sample_period_s)).then(|| {
        format!(
            "an averaging time of {} s is shorter than a sample, which takes {} s",
            plain(averaging_time_s),
            plain(sample_period_s)
        )
        .into()
    })
}

/// Expected standard deviation of `count` block means of `averaging_time_s` each, deg/h.
///
/// `Bs^2 = 2Q^2/t^2 + N^2/t + B^2 n ln n / (pi (n-1)) + (K^2 t/3)(n/2) + R^2 t^2 n (n+1)/12`: it
/// grows with the number of blocks as soon as there is slow noise.
///
/// Source: Barnes, NBS Technical Note 375 (1969), bias functions; derived for the ramp.
#[must_use]
pub fn expected_bias_stability(
    coefficients: &NoiseCoefficients,
    averaging_time_s: f64,
    count: usize,
) -> f64 {
    let n = count as f64;
    let t = averaging_time_s;
    let square = |value: f64| value * value;
    let quantisation = 2.0 * square(coefficients.quantisation_arcsec / t);
    let white = square(coefficients.angle_random_walk_deg_per_h_sqrt_s) / t;
    let flicker =
        square(coefficients.bias_instability_deg_per_h) * n * n.ln() / (PI * (n - 1.0).max(1.0));
    let walk = square(coefficients.rate_random_walk_deg_per_h_per_sqrt_s) * t / 3.0 * n / 2.0;
    let ramp = square(coefficients.rate_ramp_deg_per_h_per_s * t) * n * (n + 1.0) / 12.0;
    (quantisation + white + flicker + walk + ramp).sqrt()
}

/// Correlation of two records' means about their averages; `None` where one of them stands still.
#[must_use]
pub(crate) fn correlation(own: &[f64], other: &[f64]) -> Option<f64> {
    let (mean_own, mean_other) = (interval::mean(own), interval::mean(other));
    let pairs = || own.iter().zip(other);
    let product: f64 = pairs()
        .map(|(a, b)| (a - mean_own) * (b - mean_other))
        .sum();
    let square = |values: &[f64], mean: f64| -> f64 {
        values.iter().map(|value| (value - mean).powi(2)).sum()
    };
    let scale = (square(own, mean_own) * square(other, mean_other)).sqrt();
    (scale > 0.0).then(|| (product / scale).clamp(-1.0, 1.0))
}

/// Ratio of two bias stabilities measured on the same gyro at the same time.
///
/// Both hold the same noise, so that their ratio is known far better than each of them. With r the
/// correlation of their means and nu degrees of freedom the limits are `q / g` and `q g`,
/// `g^2 = K + sqrt(K^2 - 1)`, `K = 1 + 2 t^2 (1 - r^2) / (nu - 1)`, t the quantile of Student's
/// distribution with `nu - 1` degrees of freedom. Only the correlation of each with raw is kept:
/// for a pair of filters the factors g of both multiply, which errs to the wide side. `None` where a
/// metric has no such correlation.
///
/// Source: Pitman, Biometrika 31 (1939) 9, for independent pairs; nu in the place of n - 1 allows
/// for means that wander together.
#[must_use]
pub fn paired_ratio(own: &Metric, other: &Metric) -> Option<Estimate> {
    let factor = |metric: &Metric| {
        let correlation = metric.fields.get(RAW_CORRELATION)?;
        let freedom = metric.fields.get(DEGREES_OF_FREEDOM)? - 1.0;
        let t = interval::student_quantile(freedom.max(1.0));
        let k = 1.0 + 2.0 * t * t * (1.0 - correlation * correlation) / freedom.max(1.0);
        Some((k + (k * k - 1.0).max(0.0).sqrt()).sqrt())
    };
    let g = factor(own)? * factor(other)?;
    let ratio = own.estimate.value / other.estimate.value;
    let is_sound = ratio.is_finite() && ratio > 0.0;
    is_sound.then(|| Estimate::with_interval(ratio, ratio / g, ratio * g))
}

/// Degrees of freedom of the sample variance of block means under a fitted noise model.
///
/// For Gaussian means with covariance S and the centring projection P the sample variance behaves
/// like chi-square with `(tr PS)^2 / tr (PS)^2` degrees of freedom (Satterthwaite): n - 1 for white
/// noise, few for flicker or random walk, whose means wander together. S is known up to terms that
/// P removes: `-B^2/pi` times the mean of `ln |s|` over pairs of blocks for flicker,
/// `-K^2 t (L - 1/3) / 2` for random walk at a distance of L blocks.
///
/// Source: derived; flicker's generalised covariance from `S2(f) = B^2 / (2 pi |f|)`.
#[must_use]
pub fn effective_degrees_of_freedom(
    coefficients: &NoiseCoefficients,
    averaging_time_s: f64,
    count: usize,
) -> f64 {
    if count < 2 {
        return 0.0;
    }
    let covariance: Vec<f64> = (0..count)
        .map(|distance| block_covariance(coefficients, averaging_time_s, distance))
        .collect();
    if covariance.iter().all(|value| value.abs() <= 0.0) {
        return count as f64 - 1.0;
    }
    let n = count as f64;
    // Row sums of the Toeplitz matrix from running sums of its first row.
    let mut running = Vec::with_capacity(count + 1);
    running.push(0.0);
    for value in &covariance {
        running.push(running[running.len() - 1] + value);
    }
    let row_means: Vec<f64> = (0..count)
        .map(|row| (running[row + 1] + running[count - row] - covariance[0]) / n)
        .collect();
    let grand_mean = interval::mean(&row_means);
    let trace = n * (covariance[0] - grand_mean);
    let squares: f64 = covariance
        .iter()
        .enumerate()
        .map(|(distance, value)| {
            let pairs = if distance == 0 {
                n
            } else {
                2.0 * (n - distance as f64)
            };
            pairs * value * value
        })
        .sum();
    let row_squares: f64 = row_means.iter().map(|mean| mean * mean).sum();
    let centred_squares = squares - 2.0 * n * row_squares + n * n * grand_mean * grand_mean;
    if centred_squares > 0.0 {
        (trace * trace / centred_squares).clamp(1.0, n - 1.0)
    } else {
        n - 1.0
    }
}

/// Generalised covariance of two block means `distance` blocks apart, (deg/h)^2.
pub(crate) fn block_covariance(
    coefficients: &NoiseCoefficients,
    averaging_time_s: f64,
    distance: usize,
) -> f64 {
    let l = distance as f64;
    let t = averaging_time_s;
    let white = if distance == 0 {
        coefficients.angle_random_walk_deg_per_h_sqrt_s.powi(2) / t
    } else {
        0.0
    };
    let integral = |x: f64| {
        if x > 0.0 {
            x * x / 2.0 * x.ln() - 0.75 * x * x
        } else {
            0.0
        }
    };
    let mean_logarithm = integral(l + 1.0) - 2.0 * integral(l) + integral((l - 1.0).abs());
    let flicker = -coefficients.bias_instability_deg_per_h.powi(2) / PI * mean_logarithm;
    let walk_distance = if distance == 0 { 0.0 } else { l - 1.0 / 3.0 };
    let walk =
        -coefficients.rate_random_walk_deg_per_h_per_sqrt_s.powi(2) * t * walk_distance / 2.0;
    white + flicker + walk
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flicker(bias_instability_deg_per_h: f64) -> NoiseCoefficients {
        NoiseCoefficients {
            bias_instability_deg_per_h,
            ..NoiseCoefficients::default()
        }
    }

    fn covariance_formula_agrees(coefficients: &NoiseCoefficients) {
        // The expected sample variance is tr(PS)/(n-1): an independent road to Barnes' functions.
        let (t, n) = (2.0, 36_usize);
        let mut pair_sum = 0.0;
        for i in 0..n {
            for j in 0..n {
                pair_sum += block_covariance(coefficients, t, 0)
                    - block_covariance(coefficients, t, i.abs_diff(j));
            }
        }
        let variance = pair_sum / (n * (n - 1)) as f64;
        let expected = expected_bias_stability(coefficients, t, n).powi(2);
        assert!(
            (variance / expected - 1.0).abs() < 1e-9,
            "{variance} {expected}"
        );
    }

    #[test]
    fn block_covariance_gives_barnes_bias_functions() {
        covariance_formula_agrees(&flicker(0.3));
        covariance_formula_agrees(&NoiseCoefficients {
            angle_random_walk_deg_per_h_sqrt_s: 0.36,
            rate_random_walk_deg_per_h_per_sqrt_s: 0.1,
            ..NoiseCoefficients::default()
        });
    }

    #[test]
    fn flicker_of_36_means_is_1_083_times_the_bias_instability() {
        assert!((expected_bias_stability(&flicker(1.0), 100.0, 36) - 1.083).abs() < 5e-4);
    }

    #[test]
    fn white_noise_keeps_all_degrees_of_freedom_and_a_random_walk_few() {
        let white = NoiseCoefficients {
            angle_random_walk_deg_per_h_sqrt_s: 1.0,
            ..NoiseCoefficients::default()
        };
        assert!((effective_degrees_of_freedom(&white, 10.0, 50) - 49.0).abs() < 1e-9);
        let walk = NoiseCoefficients {
            rate_random_walk_deg_per_h_per_sqrt_s: 1.0,
            ..NoiseCoefficients::default()
        };
        // A Brownian path's sample variance: eigenvalues 1/(k pi)^2, (sum)^2 / sum of squares = 2.5.
        let freedom = effective_degrees_of_freedom(&walk, 10.0, 500);
        assert!((freedom - 2.5).abs() < 0.02, "{freedom}");
    }

    #[test]
    fn the_interval_of_a_paired_ratio_covers_the_true_one() {
        // Output = half of raw and a tenth of its noise on top, 36 means; normal numbers by the
        // sum of twelve uniform ones from a linear congruence.
        let mut state = 1_u64;
        let mut normal = || -> f64 {
            let uniform = (0..12).map(|_| {
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1_442_695_040_888_963_407);
                (state >> 11) as f64 / (1_u64 << 53) as f64
            });
            uniform.sum::<f64>() - 6.0
        };
        let (trials, truth) = (2000, 0.26_f64.sqrt());
        let mut covered = 0;
        let mut width = 0.0;
        for _ in 0..trials {
            let raw: Vec<f64> = (0..36).map(|_| normal()).collect();
            let own: Vec<f64> = raw.iter().map(|x| 0.5 * x + 0.1 * normal()).collect();
            let metric = |values: &[f64]| {
                let deviation = interval::sample_variance(values).sqrt();
                let correlation = correlation(values, &raw).expect("both move");
                Metric::new(Estimate::exact(deviation), "deg/h")
                    .with(DEGREES_OF_FREEDOM, 35.0)
                    .with(RAW_CORRELATION, correlation)
            };
            let ratio = paired_ratio(&metric(&own), &metric(&raw)).expect("both are measured");
            covered += usize::from((ratio.low..=ratio.high).contains(&truth));
            width += (ratio.high - ratio.low) / f64::from(trials);
        }
        let coverage = covered as f64 / f64::from(trials);
        assert!((coverage - 0.95).abs() < 0.02, "{coverage}");
        // Two separate intervals of 35 degrees of freedom would span 0.5 and more.
        assert!(width < 0.1, "{width}");
    }
}
