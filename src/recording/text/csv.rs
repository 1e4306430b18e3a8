//! Rate words as text.

use std::fmt::Write as _;

/// Rate words as text: a heading, then time (s) and rate (deg/h) of each, exact to the last bit.
///
/// Sample `k` is stamped `(k + 1)` sample periods after the start of the record.
///
/// ```
/// use fogbench::recording::csv_text;
///
/// assert_eq!(csv_text(&[1.5, -2.0], 0.5), "time_s,rate_deg_per_h\n0.5,1.5\n1.0,-2.0\n");
/// ```
#[must_use]
pub fn csv_text(rate_deg_per_h: &[f64], sample_period_s: f64) -> String {
    let mut text = String::from("time_s,rate_deg_per_h\n");
    let mut ordinal = 0.0;
    for rate in rate_deg_per_h {
        ordinal += 1.0;
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{:?},{rate:?}", ordinal * sample_period_s);
    }
    text
}
