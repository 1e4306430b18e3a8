//! How overlapping Allan variances at different averaging times go together.

/// Correlation coefficient of the overlapping Allan variances of white rate noise at two averaging
/// times, in a record much longer than both.
///
/// An Allan variance is half the mean square of `z = rate * h`, where h is -1/tau for one tau and
/// +1/tau for the next. For Gaussian noise `cov(AVAR_1, AVAR_2) = (1/2T) integral C12(s)^2 ds` with
/// `C12` the cross-covariance of the two z, which for white noise is the overlap of two box pairs:
/// piecewise linear in s, so that the integral is exact by Simpson's rule between its corners.
/// Flicker and random walk decorrelate faster with the ratio of the times; using the white value for
/// them overstates, slightly, how much the points repeat each other.
///
/// Source: derived; the diagonal gives `edf = 1.5 T/tau`, the limit of NIST SP 1065 table 4.
pub(crate) fn correlation(first_tau_s: f64, second_tau_s: f64) -> f64 {
    let cross = squared_overlap(first_tau_s, second_tau_s);
    let scale =
        squared_overlap(first_tau_s, first_tau_s) * squared_overlap(second_tau_s, second_tau_s);
    cross / scale.sqrt()
}

/// `integral C12(s)^2 ds`, both kernels with unit height.
fn squared_overlap(first: f64, second: f64) -> f64 {
    let mut corners: Vec<f64> = [0.0, first, 2.0 * first]
        .into_iter()
        .flat_map(|a| [0.0, second, 2.0 * second].map(|b| a - b))
        .collect();
    corners.sort_by(f64::total_cmp);
    corners
        .windows(2)
        .map(|ends| {
            let [a, b] = [ends[0], ends[1]].map(|shift| overlap(first, second, shift));
            (ends[1] - ends[0]) * (a * a + a * b + b * b) / 3.0
        })
        .sum()
}

/// `integral h1(u) h2(u - shift) du` of the two box pairs.
fn overlap(first: f64, second: f64, shift: f64) -> f64 {
    let boxes = |tau: f64, start: f64| {
        [
            (start, start + tau, -1.0),
            (start + tau, start + 2.0 * tau, 1.0),
        ]
    };
    let mut sum = 0.0;
    for (start_1, end_1, sign_1) in boxes(first, 0.0) {
        for (start_2, end_2, sign_2) in boxes(second, shift) {
            let common: f64 = end_1.min(end_2) - start_1.max(start_2);
            sum += sign_1 * sign_2 * common.max(0.0);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_diagonal_gives_the_degrees_of_freedom_of_white_noise() {
        // edf = T C(0)^2 / integral C^2 = 1.5 T / tau, with C(0) = 2 tau for unit height.
        let tau = 3.0;
        let freedom_per_time = (2.0 * tau) * (2.0 * tau) / squared_overlap(tau, tau);
        assert!((freedom_per_time - 1.5 / tau).abs() < 1e-12);
    }

    #[test]
    fn correlation_is_one_at_equal_times_and_falls_with_the_ratio() {
        assert!((correlation(0.2, 0.2) - 1.0).abs() < 1e-12);
        assert!((correlation(1.0, 2.0) - correlation(2.0, 1.0)).abs() < 1e-12);
        let falling: Vec<f64> = [1.2, 2.0, 4.0, 16.0]
            .into_iter()
            .map(|ratio| correlation(1.0, ratio))
            .collect();
        assert!(falling.windows(2).all(|pair| pair[0] > pair[1]));
        assert!(falling[3] > 0.0);
    }
}
