//! What a filter remembers.

use crate::signal::{FilterShape, Section, WeightRule};

/// Part of the first moment of the impulse response that may lie beyond the memory.
const TAIL: f64 = 0.01;

/// Longest impulse response that is looked at, samples.
const RESPONSE_MAX: usize = 1 << 20;

/// Part of the first moment below which the newest half of a response no longer counts.
const DIED_OUT: f64 = 1e-4;

/// Samples a filter remembers: beyond them lies at most a hundredth of `sum k |h(k)|`.
///
/// h is the impulse response; of hidden weights the correlation of the words stands for it. An adaptive filter remembers as many samples as it has taps. A moving
/// average of p samples remembers p, a one-pole filter with a time constant of t samples 6.6 t.
#[must_use]
pub fn memory_samples(shape: &FilterShape) -> usize {
    match &shape.rule {
        WeightRule::Adaptive { .. } => shape.taps.unwrap_or(0),
        WeightRule::Fixed(weights) => memory_of(weights),
        WeightRule::Sections(sections) => memory_of(&impulse_response(sections)),
        WeightRule::Hidden(hidden) => hidden.memory_samples,
    }
}

fn memory_of(response: &[f64]) -> usize {
    let moment = |(age, weight): (usize, &f64)| age as f64 * weight.abs();
    let total: f64 = response.iter().enumerate().map(moment).sum();
    let mut beyond = 0.0;
    for (age, weight) in response.iter().enumerate().rev() {
        beyond += moment((age, weight));
        if beyond > TAIL * total {
            return age + 1;
        }
    }
    // Nothing is remembered but the newest sample.
    usize::from(!response.is_empty())
}

/// Output of a cascade that starts empty.
pub(crate) fn cascade(sections: &[Section], input: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut states = vec![[0.0; 2]; sections.len()];
    input
        .map(|value| step(sections, &mut states, value))
        .collect()
}

/// One sample through a cascade; transposed direct form II, two states a section.
fn step(sections: &[Section], states: &mut [[f64; 2]], input: f64) -> f64 {
    let mut value = input;
    for (section, state) in sections.iter().zip(states) {
        let [b0, b1, b2] = section.numerator;
        let [a1, a2] = section.denominator;
        let output = b0 * value + state[0];
        state[0] = b1 * value - a1 * output + state[1];
        state[1] = b2 * value - a2 * output;
        value = output;
    }
    value
}

/// Impulse response of a cascade until it has died out.
pub(crate) fn impulse_response(sections: &[Section]) -> Vec<f64> {
    let mut states = vec![[0.0; 2]; sections.len()];
    let mut response = Vec::new();
    let (mut moment, mut of_half, mut half_end) = (0.0, 0.0, 64);
    while response.len() < RESPONSE_MAX {
        let impulse = if response.is_empty() { 1.0 } else { 0.0 };
        let value = step(sections, &mut states, impulse);
        of_half += response.len() as f64 * value.abs();
        response.push(value);
        if response.len() == half_end {
            moment += of_half;
            if of_half <= DIED_OUT * moment {
                break;
            }
            (of_half, half_end) = (0.0, 2 * half_end);
        }
    }
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shape(rule: WeightRule) -> FilterShape {
        FilterShape {
            taps: Some(10),
            newest_age_samples: 1,
            register_samples: 1,
            rule,
        }
    }

    #[test]
    fn filters_remember_their_taps_or_their_time_constants() {
        let of = |rule: WeightRule| memory_samples(&shape(rule));
        assert_eq!(of(WeightRule::Fixed(vec![1.0])), 1);
        assert_eq!(of(WeightRule::Fixed(vec![0.01; 100])), 100);
        let adaptive = WeightRule::Adaptive {
            desired_weights: vec![1.0],
            is_dc_gain_one: false,
            forgetting_factor: None,
        };
        assert_eq!(of(adaptive), 10);
        let pole = (-1.0_f64 / 100.0).exp();
        let section = Section {
            numerator: [1.0 - pole, 0.0, 0.0],
            denominator: [-pole, 0.0],
        };
        // (1 + x) exp(-x) = 0.01 at x = 6.64.
        let one_pole = of(WeightRule::Sections(vec![section]));
        assert!((655..675).contains(&one_pole), "{one_pole}");
        let two = of(WeightRule::Sections(vec![section; 2]));
        assert!(two > one_pole && two < 2 * one_pole, "{two}");
    }
}
