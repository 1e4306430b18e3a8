//! Numbers of the command line within their ranges.

/// A parser of numbers from `least` to `most`, both allowed, for what `unit` names.
///
/// The least values are those from which reciprocals and squares mean something; a complaint names
/// the range, clap the option and the value before it.
pub(super) fn within(
    least: f64,
    most: f64,
    unit: &'static str,
) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync + 'static {
    move |text| {
        let in_range = |number: &f64| (least..=most).contains(number);
        let number = text.trim().parse::<f64>().ok().filter(in_range);
        number.ok_or_else(|| {
            let unit = if unit.is_empty() {
                String::new()
            } else {
                format!(" {unit}")
            };
            format!(
                "expected a number from {} to {}{unit}",
                shown(least),
                shown(most)
            )
        })
    }
}

/// A parser of whole numbers from `least` to `most`.
pub(super) fn count_within(
    least: usize,
    most: usize,
) -> impl Fn(&str) -> Result<usize, String> + Clone + Send + Sync + 'static {
    move |text| {
        let in_range = |number: &usize| (least..=most).contains(number);
        let number = text.trim().parse::<usize>().ok().filter(in_range);
        number.ok_or_else(|| format!("expected a whole number from {least} to {most}"))
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
            assert_eq!(refused, "expected a number from 1e-6 to 1e9 Hz", "{text}");
        }
        assert_eq!(
            within(0.0, 1.0, "")("2").unwrap_err(),
            "expected a number from 0 to 1"
        );
        assert!(count_within(1, 64)("65").is_err() && count_within(1, 64)("64") == Ok(64));
    }
}
