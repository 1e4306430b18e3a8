//! Estimates as people read them: digits follow the interval, not the machine.

use std::fmt;

use super::value::Estimate;
use crate::wording::to_digits;

/// Relative half width below which an interval is rounding noise and is not shown.
const EXACT: f64 = 1e-9;

/// Decimals that show `size` with `digits` significant digits.
fn decimals(size: f64, digits: i32) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a decimal exponent of a finite f64 lies within +-324"
    )]
    let exponent = size.abs().log10().floor() as i32;
    usize::try_from((digits - 1 - exponent).max(0)).unwrap_or(0)
}

/// Whether a number reads better in scientific notation.
pub(crate) fn wants_exponent(value: f64) -> bool {
    value != 0.0 && !(1e-4..1e7).contains(&value.abs())
}

/// `value` to at most six significant digits, trailing zeros left out.
pub(crate) fn plain(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    if wants_exponent(value) {
        let text = format!("{value:.5e}");
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{}e{exponent}", trimmed(mantissa));
    }
    trimmed(&format!("{value:.*}", decimals(value, 6))).to_owned()
}

/// As [`plain`], to three digits.
pub(crate) fn three_digits(value: f64) -> String {
    plain(to_digits(value, 3))
}

fn trimmed(text: &str) -> &str {
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        text
    }
}

/// Whether an interval is empty, or mere rounding noise about the value.
pub(crate) fn is_exact(estimate: &Estimate) -> bool {
    let Estimate {
        value, low, high, ..
    } = *estimate;
    let largest = value.abs().max(low.abs()).max(high.abs());
    0.5 * (high - low) <= EXACT * largest
}

/// An estimate with as many digits as its interval supports (`digits` of the half width).
///
/// `v +-h` where the interval is symmetric to a tenth of its half width, else `v [low, high]`; the
/// value alone where the interval is empty.
pub(crate) fn estimate_text(estimate: &Estimate, digits: i32) -> String {
    let Estimate {
        value, low, high, ..
    } = *estimate;
    let half_width = 0.5 * (high - low);
    let largest = value.abs().max(low.abs()).max(high.abs());
    if !half_width.is_finite() || is_exact(estimate) {
        return plain(value);
    }
    let skew = (0.5 * (high + low) - value).abs();
    if wants_exponent(largest) {
        let spread = decimals(half_width / largest, digits);
        return format!("{value:.spread$e} [{low:.spread$e}, {high:.spread$e}]");
    }
    let shown = decimals(half_width, digits);
    if skew <= 0.1 * half_width {
        format!("{value:.shown$} ±{half_width:.shown$}")
    } else {
        format!("{value:.shown$} [{low:.shown$}, {high:.shown$}]")
    }
}

impl fmt::Display for Estimate {
    /// The value and its interval, to two digits of the half width: `0.981 ±0.012`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&estimate_text(self, 2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_follow_the_interval() {
        assert_eq!(
            estimate_text(&Estimate::symmetric(0.006_012_3, 0.000_062), 2),
            "0.006012 ±0.000062"
        );
        assert_eq!(
            estimate_text(&Estimate::with_interval(0.0606, 0.0495, 0.0782), 2),
            "0.061 [0.050, 0.078]"
        );
        assert_eq!(estimate_text(&Estimate::exact(0.25), 2), "0.25");
        assert_eq!(
            estimate_text(&Estimate::symmetric(3601.23, 12.0), 2),
            "3601 ±12"
        );
        assert_eq!(
            estimate_text(&Estimate::symmetric(2e-9, 1e-10), 2),
            "2.000e-9 [1.900e-9, 2.100e-9]"
        );
    }

    #[test]
    fn plain_numbers_keep_six_digits() {
        assert_eq!(plain(0.340_012_345), "0.340012");
        assert_eq!(plain(3600.0), "3600");
        assert_eq!(plain(-2.5e-7), "-2.5e-7");
        assert_eq!(plain(0.0), "0");
    }

    #[test]
    fn an_estimate_prints_its_interval_and_takes_a_width() {
        let estimate = Estimate::symmetric(0.981, 0.012);
        assert_eq!(estimate.to_string(), "0.981 ±0.012");
        assert_eq!(format!("{estimate:>14}"), "  0.981 ±0.012");
    }
}
