//! Closed forms that tell beforehand whether a filter can work on given words.

/// Digits of binary64 that may be spent on the initial inverse correlation: beyond
/// `delta p x^2 = 1e10` fewer than six significant digits of P are left after the first updates.
const COVARIANCE_RATIO_MAX: f64 = 1e10;

/// Upper bound `2 / lambda_max` of the step size of un-normalised least mean squares.
///
/// * `eigenvalue_max`: largest eigenvalue of the input's correlation matrix, (deg/h)^2.
///
/// The bound is that of convergence of the mean weights. For a slow sine alone it is sharp: the
/// logarithm of `|1 - mu N A^2 sin^2|`, averaged over a cycle, changes sign at `mu = 4 / (N A^2)`.
///
/// # Source
/// Haykin, Adaptive Filter Theory, stability of the least-mean-squares algorithm; the remark on the
/// sine is derived.
#[must_use]
pub fn lms_step_bound(eigenvalue_max: f64) -> f64 {
    2.0 / eigenvalue_max
}

/// Largest eigenvalue of the correlation matrix of a sine in white noise, seen by `taps` taps.
///
/// `A^2 / 4 (N + |sin(N theta) / sin(theta)|) + s^2` with `theta` the phase step per sample; for a
/// slow swing (`N theta << 1`) that is `N A^2 / 2 + s^2`. Derived: the correlation
/// `A^2 / 2 cos((i - j) theta)` has rank 2.
///
/// * `amplitude`: A, deg/h.
/// * `phase_step_rad`: `2 pi f T`, rad.
/// * `noise_std`: s, deg/h.
///
/// Returns (deg/h)^2.
#[must_use]
pub fn sine_eigenvalue_max(
    taps: usize,
    amplitude: f64,
    phase_step_rad: f64,
    noise_std: f64,
) -> f64 {
    /// Below this `|sin|` the quotient equals N to rounding, or is 0 / 0.
    const SINE_MIN: f64 = 1e-9;
    let count = taps as f64;
    let sine = phase_step_rad.sin();
    let kernel = if sine.abs() < SINE_MIN {
        count
    } else {
        ((count * phase_step_rad).sin() / sine).abs()
    };
    amplitude * amplitude / 4.0 * (count + kernel) + noise_std * noise_std
}

/// Largest eigenvalue of the correlation matrix of a constant in white noise: `N m^2 + s^2`.
///
/// * `mean`: m, deg/h. * `noise_std`: s, deg/h.
///
/// Returns (deg/h)^2.
#[must_use]
pub fn constant_eigenvalue_max(taps: usize, mean: f64, noise_std: f64) -> f64 {
    taps as f64 * mean * mean + noise_std * noise_std
}

/// Warns where recursive least squares in binary64 loses its digits to the initial condition.
///
/// The first updates subtract nearly all of `P = delta I`; what is left carries a relative error of
/// about `2e-16 delta p x^2`.
///
/// * `initial_inverse_correlation`: delta, (deg/h)^-2.
/// * `rate_max_deg_per_h`: largest input word to be expected, deg/h.
///
/// Returns a sentence if `delta p x^2` exceeds 1e10.
#[must_use]
pub fn covariance_digits_warning(
    initial_inverse_correlation: f64,
    taps: usize,
    rate_max_deg_per_h: f64,
) -> Option<String> {
    let ratio = initial_inverse_correlation * taps as f64 * rate_max_deg_per_h * rate_max_deg_per_h;
    (ratio > COVARIANCE_RATIO_MAX).then(|| {
        let wanted = initial_inverse_correlation * COVARIANCE_RATIO_MAX / ratio;
        format!(
            "initial_inverse_correlation = {initial_inverse_correlation:e} (deg/h)^-2 with {taps} \
             taps and rates up to {rate_max_deg_per_h} deg/h makes delta p x^2 = {ratio:.1e}, \
             above {COVARIANCE_RATIO_MAX:e}: the covariance form loses its digits in binary64; \
             use {wanted:.1e} or less"
        )
    })
}
