//! What a sweep sets, as axes.

use std::collections::BTreeMap;

use super::super::drawing::axis::Axis;
use super::super::drawing::panel::{LEFT, RIGHT};
use super::super::drawing::picture::text_width;
use super::super::drawing::series::real;
use super::names::{self, short_names};
use crate::report::layout::text::with_unit;
use crate::report::record::run::RunOutcome;
use crate::report::record::sweep::{swept_text, swept_value};
use crate::scenario::unit_of_written;
use crate::wording::{plain, to_digits};

/// Size of the titles of axes, pixels.
pub(super) const TITLE_SIZE: f64 = 14.0;

/// A key with the values that it takes.
pub(super) struct SweptKey {
    /// Its path as the matrix writes it.
    pub(super) name: String,
    /// The end of the path that no other swept key has.
    pub(super) short: String,
    unit: &'static str,
    /// Whether every value is a finite number.
    pub(super) is_number: bool,
    /// Distinct values as texts: numbers in ascending order, others as they occur.
    pub(super) labels: Vec<String>,
    /// Where each of them stands on an axis.
    pub(super) places: Vec<f64>,
    /// Number of the value of every point.
    pub(super) value_of: Vec<usize>,
}

impl SweptKey {
    /// The keys that the points of a sweep set.
    pub(super) fn of(points: &[&RunOutcome]) -> Vec<Self> {
        let set = |point: &RunOutcome| point.sweep.as_ref().map(|(_, set)| set.clone());
        let Some(first) = points.first().copied().and_then(set) else {
            return Vec::new();
        };
        let names: Vec<&str> = first.iter().map(|(name, _)| name.as_str()).collect();
        let shorts = short_names(&names).into_iter();
        let names = names.iter().zip(shorts).enumerate();
        names
            .map(|(index, (name, short))| {
                let values = points.iter().map(|point| {
                    let set = point.sweep.as_ref().map_or(&[][..], |(_, set)| set);
                    set.get(index).map_or("", |(_, toml)| toml.as_str())
                });
                Self {
                    short,
                    ..Self::new(name, &values.collect::<Vec<_>>())
                }
            })
            .collect()
    }

    /// A key from its value at every point, in TOML.
    fn new(name: &str, values: &[&str]) -> Self {
        let mut distinct: Vec<&str> = Vec::new();
        let mut known = BTreeMap::new();
        for value in values {
            known.entry(*value).or_insert_with(|| {
                distinct.push(*value);
                distinct.len() - 1
            });
        }
        let number = |toml: &&str| swept_value(toml).as_f64().filter(|it| it.is_finite());
        let numbers: Option<Vec<f64>> = distinct.iter().map(number).collect();
        let mut order: Vec<usize> = (0..distinct.len()).collect();
        if let Some(numbers) = &numbers {
            order.sort_by(|a, b| numbers[*a].total_cmp(&numbers[*b]));
        }
        let mut rank = vec![0; distinct.len()];
        for (place, index) in order.iter().enumerate() {
            rank[*index] = place;
        }
        let labels = match &numbers {
            Some(numbers) => number_labels(order.iter().map(|index| numbers[*index])),
            None => order.iter().map(|at| swept_text(distinct[*at])).collect(),
        };
        let places = order
            .iter()
            .enumerate()
            .map(|(place, index)| match &numbers {
                Some(numbers) => numbers[*index],
                None => real(place),
            });
        Self {
            name: name.to_owned(),
            short: name.to_owned(),
            unit: unit_of_written(name),
            is_number: numbers.is_some(),
            labels,
            places: places.collect(),
            value_of: values.iter().map(|value| rank[known[value]]).collect(),
        }
    }

    /// Name and unit.
    pub(super) fn title(&self) -> String {
        self.titled(&self.name)
    }

    /// Name and unit, the name as short as a room in pixels asks for.
    pub(super) fn title_within(&self, room: f64) -> String {
        let titles = [self.title(), self.short_title()];
        names::fitting(&titles, TITLE_SIZE, room)
    }

    /// Short name and unit.
    pub(super) fn short_title(&self) -> String {
        self.titled(&self.short)
    }

    fn titled(&self, name: &str) -> String {
        with_unit(name, self.unit)
    }

    /// The value of a point as text.
    pub(super) fn label(&self, point: usize) -> &str {
        &self.labels[self.value_of[point]]
    }

    /// Place of the value of a point.
    pub(super) fn place(&self, point: usize) -> f64 {
        self.places[self.value_of[point]]
    }

    /// Whether its values stand on a logarithmic axis.
    pub(super) fn is_log(&self) -> bool {
        self.is_number && is_log_spaced(&self.places)
    }

    /// The axis of its values.
    pub(super) fn axis(&self) -> Axis {
        let (first, last) = (self.places[0], self.places[self.places.len() - 1]);
        let title = self.title_within(RIGHT - LEFT);
        let labels = || self.places.iter().copied().zip(self.labels.iter().cloned());
        if !self.is_number {
            let mut axis = Axis::linear((-0.5, last + 0.5), 0.0, &title);
            axis.ticks = fitting(labels().collect());
            return axis;
        }
        let axis = if self.is_log() {
            Axis::log((first, last), 0.03, &title)
        } else {
            Axis::linear((first, last), 0.03, &title)
        };
        axis.labelled_at(&labels().collect::<Vec<_>>(), RIGHT - LEFT)
    }
}

/// Labels of different numbers, with four digits where these tell them apart.
fn number_labels(numbers: impl Iterator<Item = f64> + Clone) -> Vec<String> {
    let short: Vec<String> = numbers.clone().map(|it| plain(to_digits(it, 4))).collect();
    if short.windows(2).all(|pair| pair[0] != pair[1]) {
        short
    } else {
        numbers.map(plain).collect()
    }
}

/// Of labels that stand side by side every one, or every second, third ... so that none meets another.
pub(super) fn fitting(labels: Vec<(f64, String)>) -> Vec<(f64, String)> {
    let widths = labels.iter().map(|(_, label)| text_width(label, 13.0));
    let widest = widths.fold(0.0, f64::max) + 10.0;
    let room = (RIGHT - LEFT) / real(labels.len());
    let mut step = 1;
    while real(step) * room < widest && step < labels.len() {
        step += 1;
    }
    labels.into_iter().step_by(step).collect()
}

/// Settings of keys at a point, by short name and value each.
pub(super) fn others_text(keys: &[&SweptKey], point: usize) -> String {
    let settings = keys.iter();
    let settings = settings.map(|key| format!("{} = {}", key.short, key.label(point)));
    settings.collect::<Vec<_>>().join(", ")
}

/// Least ratio of the ends of values that are spaced by factors.
const LOG_SPACED_MIN: f64 = 4.0;

/// Whether values span more than a decade and a half, all above 0.
pub(super) fn is_log_span((low, high): (f64, f64)) -> bool {
    low > 0.0 && high / low > 10_f64.powf(1.5)
}

/// Whether three ascending values or more, all above 0, are spaced by factors rather than by steps: their
/// ratios differ less from one another than their differences. Over less than two octaves the two look alike.
fn is_log_spaced(values: &[f64]) -> bool {
    let (Some(first), Some(last)) = (values.first(), values.last()) else {
        return false;
    };
    let spread = |steps: &[f64]| {
        let mean = steps.iter().sum::<f64>() / real(steps.len());
        let squares = steps.iter().map(|step| (step / mean - 1.0).powi(2));
        squares.sum::<f64>()
    };
    let steps = |of: fn(f64, f64) -> f64| -> Vec<f64> {
        values.windows(2).map(|pair| of(pair[0], pair[1])).collect()
    };
    // An end that was computed may lie a rounding off.
    let is_wide = *first > 0.0 && last / first > LOG_SPACED_MIN * (1.0 - 1e-9);
    is_wide && values.len() > 2 && {
        let ratios = steps(|a, b| (b / a).ln());
        let differences = steps(|a, b| b - a);
        spread(&ratios) < spread(&differences)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_in_order_and_words_as_they_occur() {
        let numbers = SweptKey::new("gyro.source.power_uw", &["2.0", "0.5", "20", "0.5"]);
        assert_eq!(numbers.labels, ["0.5", "2", "20"]);
        assert_eq!(numbers.value_of, [1, 0, 2, 0]);
        assert_eq!(numbers.title(), "gyro.source.power_uw [uW]");
        let close = SweptKey::new("seed", &["10001", "10002"]);
        assert_eq!(close.labels, ["10001", "10002"]);
        let long = SweptKey::new("gyro.source.power_uw", &["0.104354", "0.217794"]);
        assert_eq!(long.labels, ["0.1044", "0.2178"]);
        let words = SweptKey::new("fidelity", &["\"rate\"", "\"loop\""]);
        assert!(!words.is_number);
        assert_eq!(words.labels, ["rate", "loop"]);
        assert_eq!(
            SweptKey::new("filter.rls.taps", &["3"]).title(),
            "filter.rls.taps"
        );
    }

    #[test]
    fn an_axis_is_logarithmic_where_its_values_are_spaced_so() {
        assert!(is_log_spaced(&[1.0, 10.0, 100.0]));
        assert!(is_log_spaced(&[0.5, 1.0, 5.0, 20.0]));
        assert!(!is_log_spaced(&[1.0, 50.0, 100.0]));
        assert!(!is_log_spaced(&[0.0, 10.0, 100.0]));
        assert!(is_log_spaced(&[1.0, 5.0, 20.0]));
        assert!(is_log_spaced(&[0.5, 1.0, 2.0]));
        for low in [100.0_f64, 200.0] {
            let even = |at: u32| low * (2000.0 / low).powf(f64::from(at) / 8.0);
            assert!(is_log_spaced(&(0..9).map(even).collect::<Vec<_>>()));
            let steps = |at: u32| low + (2000.0 - low) * f64::from(at) / 8.0;
            assert!(!is_log_spaced(&(0..9).map(steps).collect::<Vec<_>>()));
        }
        assert!(!is_log_spaced(&[100.0, 2000.0]));
        assert!(!is_log_spaced(&[1.0, 1.5, 2.25]));
        assert!(!is_log_spaced(&[1.0, 2.0, 3.0, 4.0, 5.0]));
        assert!(!is_log_spaced(&[-1.0, 10.0]));
        assert!(!is_log_spaced(&[]));
    }

    #[test]
    fn crowded_labels_leave_room() {
        let labels = |count: u32| (0..count).map(|at| (f64::from(at), "a-long-word".to_owned()));
        assert_eq!(fitting(labels(5).collect()).len(), 5);
        let kept = fitting(labels(40).collect());
        assert!((2..9).contains(&kept.len()), "{}", kept.len());
    }
}
