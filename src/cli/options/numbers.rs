//! Values of options within their ranges.

use thiserror::Error;

use crate::declare::Kind;
use crate::scenario::{declared_key, is_name};

/// A value that its option does not take; clap names the option and the value before it.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub(in crate::cli) enum OptionError {
    /// No number, or one outside of a range.
    #[error("expected a number from {} to {}{}", shown(*.least), shown(*.most), behind_blank(.unit))]
    Number {
        /// Least value.
        least: f64,
        /// Greatest value.
        most: f64,
        /// Unit, may be empty.
        unit: &'static str,
    },
    /// No whole number, or one outside of a range.
    #[error("expected a whole number from {least} to {most}")]
    Count {
        /// Least value.
        least: usize,
        /// Greatest value.
        most: usize,
    },
    /// No latitude.
    #[error("expected a latitude from -90 to 90 deg")]
    Latitude,
    /// No name of a scenario.
    #[error(
        "expected a name of 1 to 64 of the characters a-z, 0-9, _ and -, the first a letter or digit"
    )]
    Name,
}

/// A parser of numbers from `least` to `most`, both allowed, for what `unit` names.
///
/// The least values are those from which reciprocals and squares mean something.
pub(in crate::cli) fn within(
    least: f64,
    most: f64,
    unit: &'static str,
) -> impl Fn(&str) -> Result<f64, OptionError> + Clone + Send + Sync + 'static {
    move |text| {
        let in_range = |number: &f64| (least..=most).contains(number);
        let number = text.trim().parse::<f64>().ok().filter(in_range);
        number.ok_or(OptionError::Number { least, most, unit })
    }
}

/// A parser of numbers in the range of a declared key.
///
/// # Panics
/// If there is no such key, or one that takes no number.
pub(in crate::cli) fn within_key(
    path: &str,
) -> impl Fn(&str) -> Result<f64, OptionError> + Clone + Send + Sync + 'static {
    let key = declared_key(path).expect("the path of a key");
    match key.kind {
        Kind::Float(range) => within(range.low, range.high, key.unit),
        _ => panic!("{path} is no number"),
    }
}

/// A parser of names of scenarios.
pub(in crate::cli) fn name() -> impl Fn(&str) -> Result<String, OptionError> + Clone + Send + Sync {
    |text| match is_name(text) {
        true => Ok(text.to_owned()),
        false => Err(OptionError::Name),
    }
}

/// A parser of whole numbers from `least` to `most`.
pub(in crate::cli) fn count_within(
    least: usize,
    most: usize,
) -> impl Fn(&str) -> Result<usize, OptionError> + Clone + Send + Sync + 'static {
    move |text| {
        let in_range = |number: &usize| (least..=most).contains(number);
        let number = text.trim().parse::<usize>().ok().filter(in_range);
        number.ok_or(OptionError::Count { least, most })
    }
}

/// A unit behind its number.
fn behind_blank(unit: &str) -> String {
    if unit.is_empty() {
        String::new()
    } else {
        format!(" {unit}")
    }
}

/// A limit as people write it.
fn shown(limit: f64) -> String {
    if limit.abs() <= 0.0 || (1e-3..1e5).contains(&limit.abs()) {
        limit.to_string()
    } else {
        format!("{limit:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_outside_is_answered_with_the_range_and_its_unit() {
        let rate = within(1e-6, 1e9, "Hz");
        assert_eq!(rate("1e-6"), Ok(1e-6));
        for text in ["5e-324", "0", "-1", "1e10", "inf", "nan", "x"] {
            let refused = rate(text).unwrap_err();
            assert_eq!(
                refused.to_string(),
                "expected a number from 1e-6 to 1e9 Hz",
                "{text}"
            );
        }
        assert_eq!(
            within(0.0, 1.0, "")("2").unwrap_err().to_string(),
            "expected a number from 0 to 1"
        );
        assert!(count_within(1, 64)("65").is_err() && count_within(1, 64)("64") == Ok(64));
    }
}
