//! Confidence intervals: chi-square, Student t, jackknife.
//!
//! All are two-sided at [`CONFIDENCE`](super::estimate::CONFIDENCE), which is 95 %, unless the caller
//! names another.

use statrs::distribution::{ChiSquared, ContinuousCDF, Normal, StudentsT};
use statrs::function::gamma::ln_gamma;

use super::influence::{Spread, resampled};
use super::value::Estimate;

/// Why a record gives no interval where it holds no two blocks.
pub(crate) const TOO_FEW_BLOCKS: &str = "the record is too short for an interval";

/// Quantile 0.975 of the standard normal distribution.
pub(crate) const NORMAL_QUANTILE: f64 = 1.959_963_984_540_054;

/// Standard deviation of a Gaussian variable over the median of its size.
pub(crate) const PER_MEDIAN: f64 = 1.482_602_218_505_602;

/// Tail probability on each side of an interval.
const TAIL: f64 = 0.025;

/// Degrees of freedom beyond which the Wilson-Hilferty cube is used instead of the exact quantile:
/// its relative error there is below 1e-8, and the exact one needs a slow incomplete gamma.
const EXACT_DEGREES_OF_FREEDOM_MAX: f64 = 5000.0;

/// Quantiles `tail` and `1 - tail` of the chi-square distribution.
///
/// `normal_quantile` is the quantile `1 - tail` of the standard normal distribution. Degrees of freedom
/// that are no number give quantiles that are none, and so a metric that is unavailable.
fn chi_square_quantiles(degrees_of_freedom: f64, tail: f64, normal_quantile: f64) -> (f64, f64) {
    let freedom = degrees_of_freedom.max(0.1);
    if freedom < EXACT_DEGREES_OF_FREEDOM_MAX {
        return ChiSquared::new(freedom).map_or((f64::NAN, f64::NAN), |distribution| {
            (
                distribution.inverse_cdf(tail),
                distribution.inverse_cdf(1.0 - tail),
            )
        });
    }
    let spread = normal_quantile * (2.0 / (9.0 * freedom)).sqrt();
    let centre = 1.0 - 2.0 / (9.0 * freedom);
    (
        freedom * (centre - spread).powi(3),
        freedom * (centre + spread).powi(3),
    )
}

/// Interval of a variance that has `degrees_of_freedom` equivalent degrees of freedom.
///
/// `[nu s^2 / chi2(0.975), nu s^2 / chi2(0.025)]`, NIST SP 1065 section 5.3.2.
pub(crate) fn variance(value: f64, degrees_of_freedom: f64) -> Estimate {
    if !degrees_of_freedom.is_finite() {
        return Estimate::exact(value);
    }
    let freedom = degrees_of_freedom.max(0.1);
    let (low, high) = chi_square_quantiles(freedom, TAIL, NORMAL_QUANTILE);
    Estimate::with_interval(value, value * freedom / high, value * freedom / low)
}

/// Interval of a standard deviation (or Allan deviation): the square root of [`variance`].
pub(crate) fn deviation(value: f64, degrees_of_freedom: f64) -> Estimate {
    let square = variance(value * value, degrees_of_freedom);
    Estimate::with_interval(value, square.low.sqrt(), square.high.sqrt())
}

/// Interval of the mean over records of a sample standard deviation.
///
/// That is `c4 = sqrt(2 / nu) Gamma((nu + 1) / 2) / Gamma(nu / 2)` times the root of the variance: of
/// six values 5 % below it.
pub(crate) fn sample_deviation(value: f64, degrees_of_freedom: f64) -> Estimate {
    let of_root = deviation(value, degrees_of_freedom);
    let freedom = degrees_of_freedom.max(0.1);
    let c4 = if freedom < EXACT_DEGREES_OF_FREEDOM_MAX {
        (2.0 / freedom).sqrt() * (ln_gamma(0.5 * freedom + 0.5) - ln_gamma(0.5 * freedom)).exp()
    } else {
        1.0
    };
    Estimate {
        low: c4 * of_root.low,
        high: c4 * of_root.high,
        ..of_root
    }
}

/// As [`deviation`] at another two-sided confidence, between 0 and 1 and kept short of both.
pub(crate) fn deviation_at(value: f64, degrees_of_freedom: f64, confidence: f64) -> Estimate {
    let confidence = confidence.clamp(1e-6, 1.0 - 1e-9);
    let tail = (1.0 - confidence) / 2.0;
    let normal_quantile = Normal::standard().inverse_cdf(1.0 - tail);
    let freedom = degrees_of_freedom.max(0.1);
    let (low, high) = chi_square_quantiles(freedom, tail, normal_quantile);
    let (low, high) = ((freedom / high).sqrt(), (freedom / low).sqrt());
    Estimate {
        confidence,
        ..Estimate::with_interval(value, value * low, value * high)
    }
}

/// Quantile 0.975 of Student's t distribution.
pub(crate) fn student_quantile(degrees_of_freedom: f64) -> f64 {
    if degrees_of_freedom > 1e5 {
        return NORMAL_QUANTILE;
    }
    student(degrees_of_freedom.max(1.0), 1.0 - TAIL)
}

/// Quantile of Student's t distribution for `count` intervals that shall all hold at once.
///
/// Source: Bonferroni; each tail gets the `count`-th part of the probability.
pub(crate) fn student_quantile_of_many(degrees_of_freedom: f64, count: usize) -> f64 {
    let tail = TAIL / count.max(1) as f64;
    // Beyond a million degrees of freedom the distribution is normal to 1e-6.
    student(degrees_of_freedom.clamp(1.0, 1e6), 1.0 - tail)
}

/// A quantile of Student's t distribution; no number for degrees of freedom that are none.
fn student(degrees_of_freedom: f64, probability: f64) -> f64 {
    StudentsT::new(0.0, 1.0, degrees_of_freedom).map_or(f64::NAN, |distribution| {
        distribution.inverse_cdf(probability)
    })
}

/// Arithmetic mean; 0 for no values.
pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Arithmetic mean of the values that are there (no NaN); no number where more than half are missing.
pub(crate) fn mean_of_present(values: &[f64]) -> f64 {
    let whole = mean(values);
    if !whole.is_nan() {
        return whole;
    }
    let present = values.iter().filter(|value| !value.is_nan());
    let (sum, count) = present.fold((0.0, 0_usize), |(sum, count), value| {
        (sum + value, count + 1)
    });
    if 2 * count < values.len() {
        return f64::NAN;
    }
    sum / count as f64
}

/// Median of some values, whose order it changes; 0 of none.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    let count = values.len();
    if count == 0 {
        return 0.0;
    }
    let middle = count / 2;
    let (below, upper, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    let upper = *upper;
    if count % 2 == 1 {
        return upper;
    }
    let lower = below.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    0.5 * (lower + upper)
}

/// Unbiased sample variance; 0 for fewer than two values.
pub(crate) fn sample_variance(values: &[f64]) -> f64 {
    if values.len() < 2 {
        return 0.0;
    }
    let centre = mean(values);
    let sum: f64 = values
        .iter()
        .map(|value| (value - centre) * (value - centre))
        .sum();
    sum / (values.len() - 1) as f64
}

/// `value` with the Student t interval of the mean of independent `parts`.
///
/// `value` may differ from the mean of the parts: it is the estimate from the whole record, whose
/// scatter the parts reveal. Fewer than two parts give no interval.
pub(crate) fn from_parts(value: f64, parts: &[f64]) -> Estimate {
    if parts.len() < 2 {
        return Estimate::without_interval(value, TOO_FEW_BLOCKS);
    }
    let count = parts.len() as f64;
    let spread = Spread {
        variance: sample_variance(parts) / count,
        freedom: count - 1.0,
    };
    spread.about(value)
}

/// `value` with the jackknife interval of its leave-one-block-out versions.
///
/// `se^2 = (n-1)/n sum (theta_i - mean)^2`, Student t with n - 1 degrees of freedom. Blocks of raw
/// and filtered samples leave together, so that the noise common to both cancels in a ratio.
///
/// Source: Efron, The Jackknife, the Bootstrap and Other Resampling Plans, SIAM 1982, chapter 3.
pub(crate) fn jackknife(value: f64, left_out: &[f64]) -> Estimate {
    resampled(value, left_out, None)
}

/// Rounds a non-negative number to a count.
pub(crate) fn round_to_count(value: f64) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the range in which f64 holds integers exactly"
    )]
    let count = value.round().clamp(0.0, 9e15) as usize;
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(got: f64, want: f64, rtol: f64) {
        assert!((got / want - 1.0).abs() < rtol, "got {got}, want {want}");
    }

    #[test]
    fn quantiles_agree_with_tables() {
        // Abramowitz and Stegun, tables 26.8 and 26.10.
        let (low, high) = chi_square_quantiles(10.0, TAIL, NORMAL_QUANTILE);
        close(low, 3.246_97, 1e-5);
        close(high, 20.483_18, 1e-6);
        close(student_quantile(9.0), 2.262_157, 1e-6);
        close(student_quantile(19.0), 2.093_024, 1e-6);
        close(student_quantile(1e6), 1.959_964, 1e-6);
    }

    #[test]
    fn chi_square_quantiles_do_not_jump_where_the_formula_changes() {
        let at = |freedom: f64| chi_square_quantiles(freedom, TAIL, NORMAL_QUANTILE);
        let exact = at(EXACT_DEGREES_OF_FREEDOM_MAX * (1.0 - 1e-9));
        let cube = at(EXACT_DEGREES_OF_FREEDOM_MAX * (1.0 + 1e-9));
        close(exact.0, cube.0, 1e-6);
        close(exact.1, cube.1, 1e-6);
    }

    #[test]
    fn jackknife_of_a_mean_is_its_student_interval() {
        let parts = [1.0, 2.0, 4.0, 8.0];
        let total: f64 = parts.iter().sum();
        let left_out: Vec<f64> = parts.iter().map(|part| (total - part) / 3.0).collect();
        let jackknifed = jackknife(total / 4.0, &left_out);
        let student = from_parts(total / 4.0, &parts);
        close(jackknifed.high, student.high, 1e-12);
    }
}
