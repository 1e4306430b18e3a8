//! Clock-less engines: the words of a pipeline without its clocks.

use super::float_unit::Fp;
use super::front_end::Pair;

/// Clock-less engine of a pipeline, bit for bit its words.
pub trait Engine<F: Fp> {
    /// Filters one pair and returns `y`.
    fn process(&mut self, pair: Pair<F>) -> F;

    /// Filters many pairs, appending one output word per pair.
    fn run(&mut self, pairs: &[Pair<F>], outputs: &mut Vec<F>) {
        for pair in pairs {
            outputs.push(self.process(*pair));
        }
    }

    /// Weights, tap 0 (newest regressor word) first.
    fn weights(&self) -> &[F];

    /// Inverse correlation matrix; none for a filter without one.
    fn inverse_correlation(&self) -> Option<InverseCorrelation<'_, F>> {
        None
    }
}

/// Inverse correlation matrix R of an engine and the constants that it is judged by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InverseCorrelation<'a, F> {
    /// Elements, `[p * p]`, row by row.
    pub matrix: &'a [F],
    /// Number of weights p.
    pub tap_count: usize,
    /// Initial diagonal delta.
    pub delta: F,
    /// Forgetting factor alpha.
    pub alpha: F,
}
