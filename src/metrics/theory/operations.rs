//! What a word costs a filter, by its shape.

use crate::signal::{FilterShape, Section, WeightRule};

/// Multiplications, additions and divisions of the plain equations for one word; none where these are not
/// shown.
pub(crate) fn operations_per_word(shape: &FilterShape) -> Option<usize> {
    match &shape.rule {
        WeightRule::Hidden(_) => None,
        WeightRule::Fixed(weights) => Some(inner_product(weights.len())),
        WeightRule::Sections(sections) => Some(sections.iter().map(of_section).sum()),
        WeightRule::Adaptive {
            is_dc_gain_one,
            forgetting_factor,
            ..
        } => {
            let taps = shape.taps?;
            Some(match (forgetting_factor, is_dc_gain_one) {
                (None, _) => least_mean_squares(taps),
                (Some(_), false) => least_squares(taps),
                // The mean, the differences, the desired signal without the mean and the weights from those
                // that are free come on top.
                (Some(_), true) => {
                    least_squares(taps - 1) + inner_product(taps) + taps + (taps - 1) + 1 + 2 * taps
                }
            })
        }
    }
}

/// Of so many products and their sum.
fn inner_product(taps: usize) -> usize {
    (2 * taps).saturating_sub(1)
}

/// A product for each coefficient that is not zero, and their sum.
fn of_section(section: &Section) -> usize {
    let all = section.numerator.iter().chain(&section.denominator);
    inner_product(all.filter(|coefficient| coefficient.abs() > 0.0).count())
}

/// `y = W'L`, `W += mu (d - y) L / (epsilon + L'L)`.
fn least_mean_squares(taps: usize) -> usize {
    let energy = inner_product(taps) + 1;
    inner_product(taps) + energy + 3 + 2 * taps
}

/// `y = W'L`, `k = P L / (lambda + L'P L)`, `W += k (d - y)`, the upper triangle of `P = (P - k L'P) / lambda`.
fn least_squares(taps: usize) -> usize {
    let projection = taps * inner_product(taps);
    let denominator = inner_product(taps) + 1;
    let weights = 2 + 2 * taps;
    let matrix = taps + 3 * taps * (taps + 1) / 2;
    inner_product(taps) + projection + denominator + weights + matrix
}

#[cfg(test)]
mod tests {
    use super::*;

    fn adaptive(taps: usize, is_dc_gain_one: bool, forgetting_factor: Option<f64>) -> FilterShape {
        FilterShape {
            taps: Some(taps),
            newest_age_samples: 1,
            register_samples: 0,
            rule: WeightRule::Adaptive {
                desired_weights: vec![1.0],
                is_dc_gain_one,
                forgetting_factor,
            },
        }
    }

    #[test]
    fn known_answers_of_operations_counted_by_hand() {
        // Four products and three sums; with P of four by four 28, 8, 10 and 34 more.
        assert_eq!(inner_product(4), 7);
        assert_eq!(
            operations_per_word(&adaptive(4, false, Some(1.0))),
            Some(87)
        );
        assert_eq!(operations_per_word(&adaptive(10, false, None)), Some(62));
        let one = operations_per_word(&adaptive(1, false, Some(1.0)));
        assert_eq!(one, Some(1 + 1 + 2 + 4 + 4));
        let two = operations_per_word(&adaptive(2, true, Some(1.0)));
        assert_eq!(two, Some(12 + 3 + 2 + 1 + 1 + 4));
        let pole = Section {
            numerator: [0.1, 0.0, 0.0],
            denominator: [-0.9, 0.0],
        };
        let shape = FilterShape {
            rule: WeightRule::Sections(vec![pole]),
            ..adaptive(1, false, None)
        };
        assert_eq!(operations_per_word(&shape), Some(3));
    }
}
