//! Weights of a filter that shows its words alone: its answer to an impulse, if that explains them.

use crate::signal::{FilterShape, WeightRule};

/// Longest answer that is looked at, samples: as many as a filter of the bench has taps.
const PROBE_SAMPLES: usize = 4096;

/// Part of the sum of the answer's magnitudes below which it has died out.
const DIED_OUT: f64 = 1e-15;

/// Part of the largest possible word by which a word may miss what the weights make: the rounding of
/// sums in another order.
const ROUNDING: f64 = 1e-9;

/// Words of the record, spaced equally, that the weights are to explain; and all at its beginning.
const CHECKED_SAMPLES: usize = 4000;

/// An impulse of 1 and then nothing, no longer than a record.
pub(super) fn impulse(record_samples: usize) -> Vec<f64> {
    let mut words = vec![0.0; PROBE_SAMPLES.min(record_samples)];
    if let Some(first) = words.first_mut() {
        *first = 1.0;
    }
    words
}

/// Weights of a filter and the age of the newest sample that it weighs.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Weights {
    newest_age_samples: usize,
    weights: Vec<f64>,
    /// Whether the answer ended; else it only died out.
    is_finite: bool,
}

impl Weights {
    /// The weights that an answer to [`impulse`] shows, the register in it; none where it has not died
    /// out, or nothing came.
    pub(super) fn of(answer: &[f64], register_samples: usize) -> Option<Self> {
        let total: f64 = answer.iter().map(|word| word.abs()).sum();
        let counts = |word: &f64| word.abs() > DIED_OUT * total;
        let first = answer.iter().position(counts)?;
        let last = answer.iter().rposition(counts)?;
        // A last word that counts may be one of many behind the probe.
        if last + 1 == answer.len() || first < register_samples {
            return None;
        }
        Some(Self {
            newest_age_samples: first,
            weights: answer[first..=last].to_vec(),
            is_finite: answer[last + 1..].iter().all(|word| *word == 0.0),
        })
    }

    /// Whether the words of a filter are what the weights make of its input.
    pub(super) fn explain(&self, input: &[f64], output: &[f64]) -> bool {
        let largest = input
            .iter()
            .fold(0.0, |most: f64, word| most.max(word.abs()));
        let magnitudes: f64 = self.weights.iter().map(|weight| weight.abs()).sum();
        let tolerance = ROUNDING * largest * magnitudes;
        let made = |sample: usize| -> f64 {
            let ages = (self.newest_age_samples..).zip(&self.weights);
            let terms = ages.map_while(|(age, weight)| {
                let word = input.get(sample.checked_sub(age)?)?;
                Some(weight * word)
            });
            terms.sum()
        };
        let stride = output.len().div_ceil(CHECKED_SAMPLES).max(1);
        let beginning = 0..output
            .len()
            .min(self.newest_age_samples + self.weights.len());
        let mut samples = beginning.chain((0..output.len()).step_by(stride));
        samples.all(|sample| (output[sample] - made(sample)).abs() <= tolerance)
    }

    /// The outline of the filter behind a register.
    pub(super) fn shape(self, register_samples: usize) -> FilterShape {
        FilterShape {
            taps: self.is_finite.then_some(self.weights.len()),
            newest_age_samples: self.newest_age_samples,
            register_samples,
            rule: WeightRule::Fixed(self.weights),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What weights behind a delay make of words.
    fn filtered(weights: &[f64], delay: usize, words: &[f64]) -> Vec<f64> {
        let at = |now: usize| {
            let ages = (delay..).zip(weights);
            let terms =
                ages.filter_map(|(age, weight)| Some(weight * words[now.checked_sub(age)?]));
            terms.sum()
        };
        (0..words.len()).map(at).collect()
    }

    fn record() -> Vec<f64> {
        (0..9000).map(|k| 8.0 + f64::from(k * k % 101)).collect()
    }

    #[test]
    fn the_answer_to_an_impulse_shows_weights_and_delay() {
        let own = [0.25, -0.5, 0.75];
        let answer = filtered(&own, 3, &impulse(9000));
        let weights = Weights::of(&answer, 1).unwrap();
        assert_eq!(weights.newest_age_samples, 3);
        assert!(weights.explain(&record(), &filtered(&own, 3, &record())));
        let shape = weights.shape(1);
        assert_eq!((shape.taps, shape.register_samples), (Some(3), 1));
        assert_eq!(shape.rule, WeightRule::Fixed(own.to_vec()));
    }

    #[test]
    fn an_answer_that_dies_out_has_weights_without_a_number_of_taps() {
        let pole: Vec<f64> = (0..3000).map(|age| 0.1 * 0.9_f64.powi(age)).collect();
        let answer = filtered(&pole, 0, &impulse(9000));
        let weights = Weights::of(&answer, 0).unwrap();
        assert!(weights.explain(&record(), &filtered(&pole, 0, &record())));
        assert_eq!(weights.shape(0).taps, None);
        let slow: Vec<f64> = (0..9000).map(|age| 0.999_99_f64.powi(age)).collect();
        assert_eq!(Weights::of(&filtered(&slow, 0, &impulse(9000)), 0), None);
    }

    #[test]
    fn words_of_another_law_are_not_explained() {
        let answer = filtered(&[0.5, 0.5], 0, &impulse(9000));
        let weights = Weights::of(&answer, 0).unwrap();
        let mut words = filtered(&[0.5, 0.5], 0, &record());
        words[4000..].iter_mut().for_each(|word| *word *= 1.001);
        assert!(!weights.explain(&record(), &words));
        assert_eq!(Weights::of(&[0.0; 100], 0), None);
    }
}
