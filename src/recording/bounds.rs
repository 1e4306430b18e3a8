//! How large and how small the numbers of a record can be and still mean something.
//!
//! Beyond these bounds a file is not what it is said to be: a corrupt word, a wrong unit, a wrong
//! column. Within them all that is made of the numbers (squares, sums over a record, ratios) stays far
//! inside binary64.

/// Largest rate that a word can stand for, deg/h: 800 000 turns a second. The fastest rate tables reach
/// 1e7 deg/h; the rest is room for words in another unit than the one that was named.
pub const RATE_MAX_DEG_PER_H: f64 = 1e12;

/// Least standard error of a mean, deg/h, but for 0: below the rounding of a rate of 2000 deg/s in
/// binary64.
pub const STANDARD_ERROR_MIN_DEG_PER_H: f64 = 1e-9;

/// Samples per second, Hz: from one in eleven days to those of the fastest converters.
pub const SAMPLE_RATE_HZ: (f64, f64) = (1e-6, 1e9);

/// Temperatures that a gyro works at, deg C: those that a compensation takes as its reference.
pub const TEMPERATURE_C: (f64, f64) = (-100.0, 150.0);

/// A number of a record beyond what it can mean.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum OutOfBounds {
    /// A rate, deg/h.
    #[error(
        "a rate of {0:e} deg/h is out of range: allowed [-{RATE_MAX_DEG_PER_H:e}, \
         {RATE_MAX_DEG_PER_H:e}] deg/h"
    )]
    Rate(f64),
    /// A sample rate, Hz.
    #[error(
        "a sample rate of {rate_hz:e} Hz is out of range: allowed [{least:e}, {most:e}] Hz",
        rate_hz = .0,
        least = SAMPLE_RATE_HZ.0,
        most = SAMPLE_RATE_HZ.1
    )]
    SampleRate(f64),
    /// A temperature, deg C.
    #[error(
        "a temperature of {temperature_c:?} deg C is out of range: expected {least} to {most} deg C",
        temperature_c = .0,
        least = TEMPERATURE_C.0,
        most = TEMPERATURE_C.1
    )]
    Temperature(f64),
}

/// Checks a rate.
///
/// # Errors
/// [`OutOfBounds::Rate`].
pub fn check_rate(rate_deg_per_h: f64) -> Result<(), OutOfBounds> {
    if rate_deg_per_h.abs() <= RATE_MAX_DEG_PER_H {
        return Ok(());
    }
    Err(OutOfBounds::Rate(rate_deg_per_h))
}

/// Checks a sample rate.
///
/// # Errors
/// [`OutOfBounds::SampleRate`].
pub fn check_sample_rate(sample_rate_hz: f64) -> Result<(), OutOfBounds> {
    let (least, most) = SAMPLE_RATE_HZ;
    if (least..=most).contains(&sample_rate_hz) {
        return Ok(());
    }
    Err(OutOfBounds::SampleRate(sample_rate_hz))
}

/// Checks a temperature.
///
/// # Errors
/// [`OutOfBounds::Temperature`].
pub fn check_temperature(temperature_c: f64) -> Result<(), OutOfBounds> {
    let (least, most) = TEMPERATURE_C;
    if (least..=most).contains(&temperature_c) {
        return Ok(());
    }
    Err(OutOfBounds::Temperature(temperature_c))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_without_meaning_are_refused_with_value_and_range() {
        assert!(check_rate(-1e12).is_ok() && check_sample_rate(1e-6).is_ok());
        let refused = check_rate(1e153).unwrap_err();
        assert_eq!(
            refused.to_string(),
            "a rate of 1e153 deg/h is out of range: allowed [-1e12, 1e12] deg/h"
        );
        for broken in [f64::NAN, f64::INFINITY, 5e-324] {
            assert!(check_sample_rate(broken).is_err(), "{broken}");
        }
        assert!(check_rate(f64::NAN).is_err() && check_temperature(f64::NAN).is_err());
    }
}
