//! Axes: where the ticks stand and what they say.

use serde_json::Value;

use super::picture::text_width;
use crate::report::layout::json::object;
use crate::wording::to_digits;

/// Digits of the ends of an axis, for programs: finer than a pixel.
const DIGITS: usize = 7;

/// Largest ratio of the ends of a logarithmic axis: values of rounding alone, hundreds of decades down,
/// lie below the picture.
const LOG_SPAN_MAX: f64 = 1e60;

/// One axis: range, scale, ticks and title.
#[derive(Clone, Debug)]
pub(in crate::report::plot) struct Axis {
    low: f64,
    high: f64,
    is_log: bool,
    /// Title with unit.
    pub(in crate::report::plot) title: String,
    /// Labelled ticks.
    pub(in crate::report::plot) ticks: Vec<(f64, String)>,
    /// Ticks without labels.
    pub(in crate::report::plot) minor: Vec<f64>,
}

impl Axis {
    /// A linear axis over at least `[low, high]`, with a margin if asked.
    pub(in crate::report::plot) fn linear(
        (low, high): (f64, f64),
        margin: f64,
        title: &str,
    ) -> Self {
        let (low, high) = widened(low, high);
        let span = high - low;
        let (low, high) = (low - margin * span, high + margin * span);
        Self {
            low,
            high,
            is_log: false,
            title: title.to_owned(),
            ticks: linear_ticks(low, high),
            minor: Vec::new(),
        }
    }

    /// A logarithmic axis over `[low, high]`, both positive, or the upper sixty decades of it.
    ///
    /// Every range has at least two labels: decades where there are two, else 1-2-5 steps, else
    /// linear steps.
    pub(in crate::report::plot) fn log((low, high): (f64, f64), margin: f64, title: &str) -> Self {
        let high = high.clamp(1e-200, 1e200);
        let low = low.clamp(high / LOG_SPAN_MAX, high);
        let factor = (high / low).powf(margin).max(1.02);
        let (low, high) = (low / factor, high * factor);
        let decades = exponents(low, high);
        let at = |digits: &[i32]| -> Vec<f64> {
            decades
                .clone()
                .flat_map(|exponent| {
                    digits
                        .iter()
                        .map(move |digit| f64::from(*digit) * 10_f64.powi(exponent))
                })
                .filter(|value| (low..=high).contains(value))
                .collect()
        };
        let labelled = [at(&[1]), at(&[1, 2, 5])]
            .into_iter()
            .find(|values| values.len() > 1);
        let ticks = match labelled {
            Some(values) => values
                .into_iter()
                .map(|value| (value, label(value)))
                .collect(),
            None => linear_ticks(low, high),
        };
        Self {
            low,
            high,
            is_log: true,
            title: title.to_owned(),
            ticks,
            minor: at(&[1, 2, 3, 4, 5, 6, 7, 8, 9]),
        }
    }

    /// The axis with labels at the given values in place of round ones, if they fit side by side into a
    /// length in pixels.
    pub(in crate::report::plot) fn labelled_at(
        mut self,
        ticks: &[(f64, String)],
        length: f64,
    ) -> Self {
        const SIZE: f64 = 13.0;
        const GAP: f64 = 10.0;
        let place = |value: f64| self.fraction(value) * length;
        let fits = ticks.windows(2).all(|pair| {
            let half = |text: &str| 0.5 * text_width(text, SIZE);
            let distance = (place(pair[1].0) - place(pair[0].0)).abs();
            distance >= half(&pair[0].1) + half(&pair[1].1) + GAP
        });
        if fits {
            self.ticks = ticks.to_vec();
        }
        self
    }

    /// Where a value stands: 0 at the low end, 1 at the high end.
    pub(in crate::report::plot) fn fraction(&self, value: f64) -> f64 {
        if self.is_log {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }

    /// A value that stands a part of the axis further on.
    pub(in crate::report::plot) fn moved(&self, value: f64, part: f64) -> f64 {
        if self.is_log {
            value * (self.high / self.low).powf(part)
        } else {
            value + (self.high - self.low) * part
        }
    }

    /// What the axis measures, for programs.
    pub(in crate::report::plot) fn json(&self) -> Value {
        let record = object([
            ("title", self.title.as_str().into()),
            ("low", to_digits(self.low, DIGITS).into()),
            ("high", to_digits(self.high, DIGITS).into()),
            ("log", self.is_log.into()),
        ]);
        record.into()
    }

    /// The range.
    pub(in crate::report::plot) fn range(&self) -> (f64, f64) {
        (self.low, self.high)
    }
}

/// Exponents of the decades that touch `[low, high]`.
fn exponents(low: f64, high: f64) -> std::ops::RangeInclusive<i32> {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "decimal exponents of positive f64 lie within +-324"
    )]
    let bounds = (low.log10().floor() as i32, high.log10().floor() as i32);
    bounds.0..=bounds.1
}

/// A range that is not empty.
fn widened(low: f64, high: f64) -> (f64, f64) {
    let least = 1e-9 * low.abs().max(high.abs()).max(1e-3);
    if high - low > least {
        (low, high)
    } else {
        let middle = 0.5 * (low + high);
        let half = (0.05 * middle.abs()).max(1e-3);
        (middle - half, middle + half)
    }
}

/// Between four and nine ticks at 1-2-5 steps.
fn linear_ticks(low: f64, high: f64) -> Vec<(f64, String)> {
    let rough = (high - low) / 8.0;
    let exponent = rough.log10().floor();
    let decade = 10_f64.powf(exponent);
    let step = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|digit| digit * decade)
        .find(|step| *step >= rough)
        .unwrap_or(decade);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a small non-negative count of decimals"
    )]
    let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
    let first = (low / step).ceil();
    (0..20)
        .map(|index| (first + f64::from(index)) * step)
        .take_while(|value| *value <= high + 1e-9 * step)
        .map(|value| {
            // Adding zero turns a negative zero into a plain one.
            let value = if value.abs() < 1e-9 * step {
                0.0
            } else {
                value
            };
            (value, format!("{value:.decimals$}"))
        })
        .collect()
}

/// A tick of a logarithmic axis.
fn label(value: f64) -> String {
    if (0.99e-4..1.01e5).contains(&value) {
        crate::gate::plain(value)
    } else {
        format!("{value:.0e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<&str> {
        axis.ticks.iter().map(|(_, label)| label.as_str()).collect()
    }

    #[test]
    fn a_wide_log_axis_is_labelled_at_decades() {
        let axis = Axis::log((0.005, 20.0), 0.0, "");
        assert_eq!(labels(&axis), ["0.01", "0.1", "1", "10"]);
    }

    #[test]
    fn a_narrow_log_axis_still_has_labels() {
        assert_eq!(labels(&Axis::log((1.5, 6.0), 0.0, "")), ["2", "5"]);
        let narrow = Axis::log((1.1, 1.15), 0.0, "");
        assert!(narrow.ticks.len() >= 4, "{:?}", narrow.ticks);
    }

    #[test]
    fn a_linear_axis_has_round_ticks_even_over_nothing() {
        let axis = Axis::linear((-0.3, 0.75), 0.0, "");
        assert_eq!(labels(&axis), ["-0.2", "0.0", "0.2", "0.4", "0.6"]);
        let flat = Axis::linear((7.0, 7.0), 0.0, "");
        assert!(flat.ticks.len() >= 4 && flat.range().0 < flat.range().1);
    }
}
