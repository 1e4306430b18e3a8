//! Many tests in one call: p-values corrected together.
//!
//! Source: S. Holm, "A simple sequentially rejective multiple test procedure", Scand. J. Statist. 6
//! (1979), with weights (its section 4). It holds whatever the dependence of the tests, which metrics of one
//! run, and runs of one seed, have.

/// Probability of a false alarm in a whole call, at most.
pub const FAMILY_ERROR: f64 = 0.05;

/// Weight of the metrics that the suite's lines show: the share of the error that each may spend.
pub const HEADLINE_WEIGHT: f64 = 1.0;

/// Weight of every other metric.
pub const OTHER_WEIGHT: f64 = 0.1;

/// P-values corrected for their number: each is below [`FAMILY_ERROR`] where its test is significant.
///
/// * `tests`: p-value and weight of each; weights are positive.
pub(super) fn corrected(tests: &[(f64, f64)]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..tests.len()).collect();
    let share = |index: &usize| tests[*index].0 / tests[*index].1;
    order.sort_by(|one, other| share(one).total_cmp(&share(other)));
    let mut left: f64 = tests.iter().map(|(_, weight)| weight).sum();
    let mut corrected = vec![1.0; tests.len()];
    let mut largest: f64 = 0.0;
    for index in order {
        largest = largest.max(share(&index) * left).min(1.0);
        corrected[index] = largest;
        left -= tests[index].1;
    }
    corrected
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_answer_of_equal_weights() {
        // 4 x 0.01, 3 x 0.015, then no less than what went before.
        let found = corrected(&[(0.04, 1.0), (0.01, 1.0), (0.015, 1.0), (0.021, 1.0)]);
        for (got, want) in found.iter().zip([0.045, 0.04, 0.045, 0.045]) {
            assert!((got - want).abs() < 1e-12, "{found:?}");
        }
    }

    #[test]
    fn known_answer_of_weights() {
        // 0.01/1 x 1.2 = 0.012; 0.001/0.1 x 1.2 comes first at 0.012 as well; then 0.5/0.1 x 0.1.
        let found = corrected(&[(0.01, 1.0), (0.001, 0.1), (0.5, 0.1)]);
        for (got, want) in found.iter().zip([0.012, 0.012, 0.5]) {
            assert!((got - want).abs() < 1e-12, "{found:?}");
        }
        assert_eq!(corrected(&[]), Vec::<f64>::new());
    }
}
