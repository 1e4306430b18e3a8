//! Limits as people read them.

use crate::metrics::wants_exponent;

/// Limits as an interval: `[0.33, 0.35]`, `<= 0.35` or `>= 0.33`.
pub(crate) fn limits_text(min: Option<f64>, max: Option<f64>) -> String {
    match (min, max) {
        (Some(min), Some(max)) => format!("[{}, {}]", limit(min), limit(max)),
        (None, Some(max)) => format!("<= {}", limit(max)),
        (Some(min), None) => format!(">= {}", limit(min)),
        (None, None) => "no limit".to_owned(),
    }
}

/// A limit as the scenario gives it: never rounded.
fn limit(value: f64) -> String {
    if wants_exponent(value) {
        format!("{value:e}")
    } else {
        value.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_read_as_a_range() {
        assert_eq!(limits_text(Some(0.33), Some(0.35)), "[0.33, 0.35]");
        assert_eq!(limits_text(None, Some(1e-9)), "<= 1e-9");
        assert_eq!(limits_text(Some(0.0), None), ">= 0");
    }
}
