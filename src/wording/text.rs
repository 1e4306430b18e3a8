//! Numbers and counts in messages.

use std::fmt::Display;

/// Most significant digits of a number that is printed as it is.
const DIGITS_MAX: usize = 9;

/// The option of the command line that says what a key does: `--time-unit` for `time_unit`.
pub(crate) fn option_of(key: &str) -> String {
    format!("--{}", key.replace('_', "-"))
}

/// A number and its noun, in the plural unless there is one.
pub(crate) fn counted<N: Display + PartialEq + From<u8>>(count: N, noun: &str) -> String {
    let plural = if count == N::from(1) { "" } else { "s" };
    format!("{count} {noun}{plural}")
}

/// A number with the digits that say something: one of more than nine, which nobody wrote but a
/// product of rounded numbers, is rounded to six.
pub(crate) fn number(value: f64) -> String {
    let exact = format!("{value:?}");
    let mantissa = exact.split('e').next().unwrap_or_default();
    let digits = mantissa.trim_start_matches(['-', '0', '.']);
    let count = digits.chars().filter(char::is_ascii_digit).count();
    // The zeros of 3600000000.0 are no digits that anyone has to read.
    let is_whole = mantissa.ends_with(".0");
    if count <= DIGITS_MAX || is_whole || !value.is_finite() {
        return exact;
    }
    format!("{:?}", to_digits(value, 6))
}

/// A number rounded to so many significant digits, one at least.
pub(crate) fn to_digits(value: f64, digits: usize) -> f64 {
    let rounded = format!("{value:.*e}", digits - 1);
    // What was printed is a number.
    rounded.parse().unwrap_or(value)
}

/// As [`number`], a whole one without its `.0`.
pub(crate) fn plain(value: f64) -> String {
    let text = number(value);
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// A number as it was written, without the `.0` of a whole one: what is compared with the end of a
/// range must not be rounded to it.
pub(crate) fn exact(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// A free text as it may stand on a terminal: what is no character that is seen, and would move the
/// cursor, colour or turn round the text behind it, is written out.
pub(crate) fn printable(text: &str) -> String {
    let is_plain = |c: char| {
        let turns_round = matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        !turns_round && (!c.is_control() || matches!(c, '\n' | '\t'))
    };
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        if is_plain(c) {
            shown.push(c);
        } else {
            shown.extend(c.escape_unicode());
        }
    }
    shown
}

/// Sizes beyond which a number in fixed decimals would be a row of digits that nobody reads.
const FIXED_MAX: f64 = 1e9;

/// A number in fixed decimals, a huge one with its power of ten. What is no number has no place in a
/// message: whoever could meet one says what is the matter instead.
pub(crate) fn decimals(value: f64, count: usize) -> String {
    debug_assert!(value.is_finite(), "{value} in a message");
    if value.abs() < FIXED_MAX {
        format!("{value:.count$}")
    } else {
        format!("{value:.3e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_thing_is_singular() {
        assert_eq!(counted(1_usize, "gate"), "1 gate");
        assert_eq!(counted(0_usize, "gate"), "0 gates");
        assert_eq!(counted(2_u64, "sample"), "2 samples");
    }

    #[test]
    fn fixed_decimals_stop_where_digits_say_nothing() {
        assert_eq!(decimals(107.84, 1), "107.8");
        assert_eq!(decimals(-0.00004, 4), "-0.0000");
        assert_eq!(decimals(4.2e300, 4), "4.200e300");
    }

    #[test]
    fn no_number_has_more_digits_than_say_something() {
        for (value, text) in [
            (7.0, "7.0"),
            (0.1 + 0.2, "0.3"),
            (59.999_753_797_675_59, "59.9998"),
            (29.999_720_235_790_587, "29.9997"),
            (0.123_456_789, "0.123456789"),
            (-1.0 / 3.0, "-0.333333"),
            (2.0e-9 / 3.0, "6.66667e-10"),
            (1e7, "10000000.0"),
            (3_600_000_000.0, "3600000000.0"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(number(value), text);
        }
        assert_eq!(plain(90.0), "90");
        assert_eq!(plain(29.999_720_235_790_587), "29.9997");
    }
}
