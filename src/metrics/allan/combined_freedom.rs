//! Degrees of freedom of every variance of the Allan family, for every power law.

use super::noise_identification::PowerLaw;

/// Terms of a sum beyond which its limit is used instead.
const TERMS_MAX: usize = 100;

/// What kind of difference of the angle a variance is the mean square of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Differences {
    /// 2 for Allan, 3 for Hadamard.
    pub(crate) order: usize,
    /// Starts one sample apart; else one averaging time.
    pub(crate) overlapping: bool,
    /// Angles averaged over tau first.
    pub(crate) modified: bool,
}

/// How long the averaging filter on the angle is in units of the sample, F of the source.
#[derive(Clone, Copy)]
enum Filter {
    Samples(f64),
    Continuous,
}

/// Equivalent degrees of freedom of a variance of the Allan family.
///
/// The autocovariance of the differences follows from the generalised autocovariance of the noise;
/// its squares are summed over the lags, with the limit of dense overlap beyond a hundred terms.
/// White angle noise has correlation at multiples of tau only and an exact sum. Never below 1.
///
/// The source averages the angle over one sample before it is differenced, as a phase meter does. A
/// rate word is the mean of the rate over its sample and its sum the angle itself, so that for
/// white, flicker and steeper rate noise the angle is taken as it is. The difference is one of short
/// averaging times: for white rate noise and m = 1 the source has 0.78 degrees of freedom a sample,
/// independent words have 2/3 (as in [`degrees_of_freedom`](super::overlapping::degrees_of_freedom)).
///
/// * `angle_count`: angle points, one more than the rate samples.
/// * `averaged_samples`: m, at least 1; one difference at least.
///
/// Source: Greenhall and Riley, Uncertainty of stability variances based on finite differences,
/// 35th PTTI (2003); NIST SP 1065 section 5.4.1, combined edf algorithm.
pub(crate) fn combined_degrees_of_freedom(
    noise: PowerLaw,
    differences: Differences,
    angle_count: usize,
    averaged_samples: usize,
) -> f64 {
    let alpha = noise.alpha();
    let d = differences.order;
    let m = averaged_samples as f64;
    // Averages of a single angle are the angle.
    let modified = differences.modified && averaged_samples > 1;
    let stride = if differences.overlapping {
        averaged_samples
    } else {
        1
    };
    let taus = if modified { d + 1 } else { d };
    let filter = if modified { 0 } else { 1 };
    let room = angle_count.saturating_sub(taus * averaged_samples + filter);
    let count = 1 + stride * room / averaged_samples;
    let r = count as f64 / stride as f64;
    let terms = count.min((d + 1) * stride);
    let sum = |terms: usize, count: usize, stride: f64, filter: Filter| {
        let at_zero = covariance(0.0, filter, alpha, d);
        squared_covariances(terms, count as f64, stride, filter, alpha, d)
            / (at_zero * at_zero * count as f64)
    };
    let limit = |coefficients: [[f64; 2]; 3]| {
        let [a0, a1] = coefficients[d - 1];
        (a0 - a1 / r) / r
    };
    let dense = r > d as f64 + 1.0;
    let thinned = TERMS_MAX as f64 / r;
    let stride_f = stride as f64;
    let reciprocal = if modified {
        if terms <= TERMS_MAX {
            sum(terms, count, stride_f, Filter::Samples(1.0))
        } else if dense {
            limit(modified_limit(alpha))
        } else {
            sum(TERMS_MAX, TERMS_MAX, thinned, Filter::Samples(1.0))
        }
    } else if alpha == 2 {
        white_angle(d, count as f64, r)
    } else if alpha == 1 {
        // The variance of flicker angle grows with ln m, so that its limit needs m.
        let [b0, b1] = [[6.0, 4.0], [15.23, 12.0], [47.8, 40.0]][d - 1];
        let at_zero = b0 + b1 * m.ln();
        if terms <= TERMS_MAX {
            sum(terms, count, stride_f, Filter::Samples(m))
        } else if dense {
            limit([[78.6, 25.2], [790.0, 410.0], [9950.0, 6520.0]]) / (at_zero * at_zero)
        } else {
            let filter = Filter::Samples(thinned);
            squared_covariances(TERMS_MAX, TERMS_MAX as f64, thinned, filter, alpha, d)
                / (at_zero * at_zero * TERMS_MAX as f64)
        }
    } else if terms <= TERMS_MAX {
        sum(terms, count, stride_f, Filter::Continuous)
    } else if dense {
        limit(plain_limit(alpha))
    } else {
        sum(TERMS_MAX, TERMS_MAX, thinned, Filter::Continuous)
    };
    (1.0 / reciprocal).max(1.0)
}

/// Coefficients a0, a1 of `1/edf = (a0 - a1/r)/r` for differences of order 1, 2, 3 of averaged
/// angles; a law steeper than an order bears has the order above.
fn modified_limit(alpha: i32) -> [[f64; 2]; 3] {
    match alpha {
        2 => [[2.0 / 3.0, 1.0 / 3.0], [7.0 / 9.0, 0.5], [0.88, 2.0 / 3.0]],
        1 => [[0.840, 0.345], [0.997, 0.616], [1.141, 0.843]],
        0 => [[1.079, 0.368], [1.033, 0.607], [1.184, 0.848]],
        -1 => [[1.048, 0.534], [1.048, 0.534], [1.180, 0.816]],
        -2 => [[1.302, 0.535], [1.302, 0.535], [1.175, 0.777]],
        -3 => [[1.194, 0.703]; 3],
        _ => [[1.489, 0.702]; 3],
    }
}

/// The same for angles that are not averaged, alpha 0 and below.
fn plain_limit(alpha: i32) -> [[f64; 2]; 3] {
    match alpha {
        0 => [
            [2.0 / 3.0, 1.0 / 6.0],
            [2.0 / 3.0, 1.0 / 3.0],
            [7.0 / 9.0, 0.5],
        ],
        -1 => [[0.852, 0.375], [0.852, 0.375], [0.997, 0.617]],
        -2 => [[1.079, 0.368], [1.079, 0.368], [1.033, 0.607]],
        -3 => [[1.053, 0.553]; 3],
        _ => [[1.302, 0.535]; 3],
    }
}

/// `1/edf` of white angle noise: differences k tau apart correlate by `C(2d,d-k)/C(2d,d)`.
fn white_angle(d: usize, count: f64, r: f64) -> f64 {
    let central = binomial(2 * d, d);
    let repeated: f64 = (1..=d)
        .map(|k| {
            let correlation = binomial(2 * d, d - k) / central;
            2.0 * (1.0 - k as f64 / r).max(0.0) * correlation * correlation
        })
        .sum();
    (1.0 + repeated) / count
}

fn binomial(n: usize, k: usize) -> f64 {
    (1..=k).map(|i| (n - k + i) as f64 / i as f64).product()
}

/// Squared autocovariances of the differences summed over the lags, ends weighted down.
fn squared_covariances(
    terms: usize,
    count: f64,
    stride: f64,
    filter: Filter,
    alpha: i32,
    d: usize,
) -> f64 {
    let square = |lag: f64| covariance(lag / stride, filter, alpha, d).powi(2);
    let inner: f64 = (1..terms)
        .map(|lag| 2.0 * (1.0 - lag as f64 / count) * square(lag as f64))
        .sum();
    square(0.0) + (1.0 - terms as f64 / count) * square(terms as f64) + inner
}

/// Autocovariance of differences of order d at a lag in units of tau, up to a factor.
fn covariance(lag: f64, filter: Filter, alpha: i32, d: usize) -> f64 {
    let angle = |shift: f64| angle_covariance(lag + shift, filter, alpha);
    let side: f64 = (1..=d)
        .map(|k| {
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            let shift = k as f64;
            sign * binomial(2 * d, d - k) * (angle(shift) + angle(-shift))
        })
        .sum();
    binomial(2 * d, d) * angle(0.0) + side
}

/// Generalised autocovariance of the averaged angle.
fn angle_covariance(t: f64, filter: Filter, alpha: i32) -> f64 {
    match filter {
        Filter::Continuous => power_covariance(t, alpha + 2),
        Filter::Samples(length) => {
            let step = 1.0 / length;
            let here = 2.0 * power_covariance(t, alpha);
            length
                * length
                * (here - power_covariance(t - step, alpha) - power_covariance(t + step, alpha))
        }
    }
}

/// Generalised autocovariance of the doubly integrated noise, up to factor and sign.
fn power_covariance(t: f64, alpha: i32) -> f64 {
    let power = t.abs().powi(3 - alpha);
    if alpha == 2 {
        -power
    } else if alpha % 2 == 0 || t.abs() <= 0.0 {
        power
    } else {
        power * t.abs().ln()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALLAN: Differences = Differences {
        order: 2,
        overlapping: true,
        modified: false,
    };
    const PLAIN: Differences = Differences {
        overlapping: false,
        ..ALLAN
    };
    const MODIFIED: Differences = Differences {
        modified: true,
        ..ALLAN
    };
    const HADAMARD: Differences = Differences { order: 3, ..ALLAN };
    const PLAIN_HADAMARD: Differences = Differences { order: 3, ..PLAIN };

    /// Noise, differences, averaging factor, angles, and the degrees of freedom.
    ///
    /// allantools 2024.06: `edf_greenhall(alpha, d, m, N, overlapping, modified)`, every branch but the
    /// short sums of alpha <= 0, which are `1/edf = greenhall_BasicSum(J, M, S, inf, alpha, d) /
    /// (greenhall_sz(0, inf, alpha, d)**2 * M)` with J, M and S as in edf_greenhall.
    #[rustfmt::skip]
    const KNOWN: &[(PowerLaw, Differences, usize, usize, f64)] = &[
        (PowerLaw::AngleWhite, ALLAN, 1, 1001, 5.140360545970e+02),
        (PowerLaw::AngleWhite, ALLAN, 200, 1001, 3.729061084026e+02),
        (PowerLaw::AngleWhite, PLAIN, 1, 1001, 5.140360545970e+02),
        (PowerLaw::AngleWhite, PLAIN, 200, 1001, 2.360655737705e+00),
        (PowerLaw::AngleWhite, MODIFIED, 200, 1001, 3.781911689585e+00),
        (PowerLaw::AngleWhite, MODIFIED, 40000, 200001, 3.770383732315e+00),
        (PowerLaw::AngleWhite, HADAMARD, 40, 1001, 3.929710243986e+02),
        (PowerLaw::AngleWhite, PLAIN_HADAMARD, 4, 1001, 1.076411494977e+02),
        (PowerLaw::AngleFlicker, ALLAN, 1, 1001, 6.354659059508e+02),
        (PowerLaw::AngleFlicker, ALLAN, 200, 1001, 2.855742658928e+01),
        (PowerLaw::AngleFlicker, ALLAN, 40000, 200001, 9.309919860648e+01),
        (PowerLaw::AngleFlicker, PLAIN, 40, 1001, 1.316910660718e+01),
        (PowerLaw::AngleFlicker, PLAIN, 2000, 100001, 2.610341007216e+01),
        (PowerLaw::AngleFlicker, MODIFIED, 4, 1001, 2.475769825015e+02),
        (PowerLaw::AngleFlicker, MODIFIED, 300, 1001, 1.175208744189e+00),
        (PowerLaw::AngleFlicker, HADAMARD, 1, 1001, 5.086129151276e+02),
        (PowerLaw::AngleFlicker, HADAMARD, 200, 1001, 2.045274424047e+01),
        (PowerLaw::AngleFlicker, HADAMARD, 40000, 200001, 6.733042280533e+01),
        (PowerLaw::AngleFlicker, PLAIN_HADAMARD, 40, 1001, 1.054528062227e+01),
        (PowerLaw::AngleFlicker, PLAIN_HADAMARD, 2000, 100001, 2.141182378068e+01),
        (PowerLaw::RateWhite, ALLAN, 4, 1001, 3.460579951744e+02),
        (PowerLaw::RateWhite, ALLAN, 300, 1001, 3.156716789973e+00),
        (PowerLaw::RateWhite, PLAIN, 1, 1001, 6.662222963952e+02),
        (PowerLaw::RateWhite, PLAIN, 200, 1001, 2.909090909091e+00),
        (PowerLaw::RateWhite, PLAIN, 40000, 200001, 2.909090909091e+00),
        (PowerLaw::RateWhite, MODIFIED, 40, 1001, 2.193000656273e+01),
        (PowerLaw::RateWhite, MODIFIED, 2000, 100001, 4.607555491723e+01),
        (PowerLaw::RateWhite, HADAMARD, 4, 1001, 2.913808509142e+02),
        (PowerLaw::RateWhite, HADAMARD, 300, 1001, 1.473986281460e+00),
        (PowerLaw::RateWhite, PLAIN_HADAMARD, 1, 1001, 5.135217690192e+02),
        (PowerLaw::RateWhite, PLAIN_HADAMARD, 200, 1001, 1.862068965517e+00),
        (PowerLaw::RateWhite, PLAIN_HADAMARD, 40000, 200001, 1.862068965517e+00),
        (PowerLaw::RateFlicker, ALLAN, 40, 1001, 2.755131273289e+01),
        (PowerLaw::RateFlicker, ALLAN, 2000, 100001, 5.685999303800e+01),
        (PowerLaw::RateFlicker, PLAIN, 4, 1001, 2.202539284595e+02),
        (PowerLaw::RateFlicker, PLAIN, 300, 1001, 1.910122863083e+00),
        (PowerLaw::RateFlicker, MODIFIED, 200, 1001, 2.550244752509e+00),
        (PowerLaw::RateFlicker, MODIFIED, 40000, 200001, 2.541140109066e+00),
        (PowerLaw::RateFlicker, HADAMARD, 40, 1001, 2.272993766963e+01),
        (PowerLaw::RateFlicker, HADAMARD, 2000, 100001, 4.777092656985e+01),
        (PowerLaw::RateFlicker, PLAIN_HADAMARD, 4, 1001, 1.578537131942e+02),
        (PowerLaw::RateFlicker, PLAIN_HADAMARD, 300, 1001, 1.000000000000e+00),
        (PowerLaw::RateRandomWalk, ALLAN, 1, 1001, 8.880987764182e+02),
        (PowerLaw::RateRandomWalk, ALLAN, 200, 1001, 3.141539350020e+00),
        (PowerLaw::RateRandomWalk, ALLAN, 40000, 200001, 3.137004315069e+00),
        (PowerLaw::RateRandomWalk, PLAIN, 40, 1001, 2.143255813953e+01),
        (PowerLaw::RateRandomWalk, PLAIN, 2000, 100001, 4.365454545455e+01),
        (PowerLaw::RateRandomWalk, MODIFIED, 4, 1001, 1.903681385037e+02),
        (PowerLaw::RateRandomWalk, MODIFIED, 300, 1001, 1.034754760072e+00),
        (PowerLaw::RateRandomWalk, HADAMARD, 1, 1001, 7.812476904305e+02),
        (PowerLaw::RateRandomWalk, HADAMARD, 200, 1001, 2.742717422457e+00),
        (PowerLaw::RateRandomWalk, HADAMARD, 40000, 200001, 2.738657107861e+00),
        (PowerLaw::RateRandomWalk, PLAIN_HADAMARD, 40, 1001, 1.820650095602e+01),
        (PowerLaw::RateRandomWalk, PLAIN_HADAMARD, 2000, 100001, 3.777049180328e+01),
        (PowerLaw::RateFlickerWalk, HADAMARD, 4, 1001, 2.352495617594e+02),
        (PowerLaw::RateFlickerWalk, HADAMARD, 300, 1001, 1.067405988075e+00),
        (PowerLaw::RateFlickerWalk, PLAIN_HADAMARD, 1, 1001, 8.889709867626e+02),
        (PowerLaw::RateFlickerWalk, PLAIN_HADAMARD, 200, 1001, 2.890883903274e+00),
        (PowerLaw::RateFlickerWalk, PLAIN_HADAMARD, 40000, 200001, 2.890883903274e+00),
        (PowerLaw::RateRandomRun, HADAMARD, 200, 1001, 1.936849599807e+00),
        (PowerLaw::RateRandomRun, PLAIN_HADAMARD, 1, 1001, 7.615276183629e+02),
        (PowerLaw::RateRandomRun, PLAIN_HADAMARD, 200, 1001, 2.485355648536e+00),
        (PowerLaw::RateRandomRun, PLAIN_HADAMARD, 40000, 200001, 2.485355648536e+00),
    ];

    #[test]
    fn degrees_of_freedom_agree_with_allantools() {
        for &(noise, differences, m, angles, wanted) in KNOWN {
            let got = combined_degrees_of_freedom(noise, differences, angles, m);
            assert!(
                (got / wanted - 1.0).abs() < 1e-9,
                "{noise:?} {differences:?} m {m} N {angles}: {got} {wanted}"
            );
        }
    }

    #[test]
    fn white_angle_noise_has_degrees_of_freedom_at_the_longest_averaging_times() {
        // One difference alone has one degree of freedom.
        let alone = combined_degrees_of_freedom(PowerLaw::AngleWhite, ALLAN, 1001, 500);
        assert!((alone - 1.0).abs() < 1e-12);
        // Barely more than one tau of starts: only neighbours one tau apart correlate, by 2/3.
        let few = combined_degrees_of_freedom(PowerLaw::AngleWhite, ALLAN, 1001, 300);
        let (count, m) = (401.0, 300.0);
        let wanted = count / (1.0 + 2.0 * (1.0 - m / count) * 4.0 / 9.0);
        assert!((few / wanted - 1.0).abs() < 1e-12);
    }
}
