//! A metric over the independent repeats of a run: every value, and what they have in common.

use super::interval;
use super::value::Metric;

/// One metric over the repeats.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RepeatStatistics {
    /// Unit of the metric.
    pub unit: &'static str,
    /// Averaging time of the metric, s, where that defines it.
    pub averaging_time_s: Option<f64>,
    /// Values of the repeats that have it, in order.
    pub values: Vec<f64>,
    /// Indices of the repeats that lack it, in order.
    pub lacking: Vec<usize>,
    /// Their mean.
    pub mean: f64,
    /// Their standard deviation, divisor one less than their number.
    pub standard_deviation: f64,
    /// The smallest.
    pub minimum: f64,
    /// The largest.
    pub maximum: f64,
}

impl RepeatStatistics {
    /// Statistics of one metric; `None` where fewer than two repeats have it.
    ///
    /// * `first`: that of the first repeat that has it; `values`: those of all, in order.
    /// * `lacking`: indices of the others, in order.
    #[must_use]
    pub fn of(first: &Metric, values: Vec<f64>, lacking: Vec<usize>) -> Option<Self> {
        if values.len() < 2 {
            return None;
        }
        let mean = interval::mean(&values);
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        Some(Self {
            unit: first.unit,
            averaging_time_s: first.fields.get("averaging_time_s").copied(),
            mean,
            standard_deviation: (squares / (values.len() - 1) as f64).sqrt(),
            minimum: values.iter().copied().fold(f64::INFINITY, f64::min),
            maximum: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            lacking,
            values,
        })
    }

    /// Count of the repeats, those that lack the metric among them.
    #[must_use]
    pub fn repeats(&self) -> usize {
        self.values.len() + self.lacking.len()
    }

    /// Value of the repeat of an index; none where it lacks the metric.
    #[must_use]
    pub fn value_of(&self, repeat: usize) -> Option<f64> {
        match self.lacking.binary_search(&repeat) {
            Ok(_) => None,
            Err(before) => self.values.get(repeat - before).copied(),
        }
    }

    /// Percentile of the values, by linear interpolation between the two nearest in order: definition 7
    /// of Hyndman and Fan (1996), that of NumPy.
    ///
    /// * `percent`: 0 for the smallest, 100 for the largest.
    #[must_use]
    pub fn percentile(&self, percent: f64) -> f64 {
        let mut sorted = self.values.clone();
        sorted.sort_by(f64::total_cmp);
        let place = (percent / 100.0).clamp(0.0, 1.0) * (sorted.len() - 1) as f64;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a place between 0 and the number of values"
        )]
        let below = place as usize;
        let above = (below + 1).min(sorted.len() - 1);
        let part = place - below as f64;
        sorted[below] + part * (sorted[above] - sorted[below])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::Estimate;

    /// Statistics over repeats, some of which have no value.
    fn of(repeats: &[Option<f64>]) -> Option<RepeatStatistics> {
        let metric = Metric::new(Estimate::exact(0.0), "deg/h");
        let lacks = |index: &usize| repeats[*index].is_none();
        let lacking = (0..repeats.len()).filter(lacks).collect();
        let values = repeats.iter().copied().flatten().collect();
        RepeatStatistics::of(&metric, values, lacking)
    }

    #[test]
    fn known_answer_of_four_repeats() {
        let statistics = of(&[2.0, 4.0, 4.0, 6.0].map(Some)).expect("four values");
        assert!((statistics.mean - 4.0).abs() < 1e-15);
        // Squares 4 + 0 + 0 + 4 over three.
        assert!((statistics.standard_deviation - (8.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert_eq!(statistics.minimum.to_bits(), 2.0_f64.to_bits());
        assert_eq!(statistics.maximum.to_bits(), 6.0_f64.to_bits());
        assert_eq!(statistics.values.len(), 4);
    }

    #[test]
    fn one_repeat_has_no_statistics() {
        assert!(of(&[Some(1.0)]).is_none());
        assert!(of(&[Some(1.0), None]).is_none());
    }

    #[test]
    fn a_repeat_that_lacks_the_metric_keeps_its_place() {
        let repeats = [None, Some(1.0), None, Some(3.0), None];
        let statistics = of(&repeats).expect("two values");
        assert_eq!(statistics.repeats(), 5);
        let places: Vec<Option<f64>> = (0..6).map(|index| statistics.value_of(index)).collect();
        assert_eq!(places, [None, Some(1.0), None, Some(3.0), None, None]);
    }

    #[test]
    fn known_answer_of_percentiles() {
        // numpy.percentile([15, 20, 35, 40, 50], [0, 5, 25, 40, 50, 75, 95, 100])
        let repeats = [40.0, 15.0, 50.0, 20.0, 35.0].map(Some);
        let statistics = of(&repeats).expect("five values");
        for (percent, expected) in [
            (0.0, 15.0),
            (5.0, 16.0),
            (25.0, 20.0),
            (40.0, 29.0),
            (50.0, 35.0),
            (75.0, 40.0),
            (95.0, 48.0),
            (100.0, 50.0),
        ] {
            let found = statistics.percentile(percent);
            assert!((found - expected).abs() < 1e-12, "{percent} %: {found}");
        }
    }
}
