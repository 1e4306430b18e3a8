//! Words that every filter of taps has: what enters it, its weights, what leaves it.

use super::format::{Format, Stored};

/// Formats of the signals that every pipeline has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TapFormats {
    /// Regressor words x and the ring of L.
    pub input: Format,
    /// Desired words d, in which samples arrive.
    pub desired: Format,
    /// Weights W.
    pub weight: Format,
    /// Output y and error e.
    pub output: Format,
}

impl TapFormats {
    /// `Q_y` of a sum of products of L and W.
    pub(super) fn output(&self, sum: i128) -> Stored {
        let scale = self.input.fraction_bits + self.weight.fraction_bits;
        self.output.store(sum, scale)
    }

    /// `Q_y(d - y)`.
    pub(super) fn error(&self, desired: i64, output: i64) -> Stored {
        let scales = [self.desired.fraction_bits, self.output.fraction_bits];
        let values = [i128::from(desired), -i128::from(output)];
        self.output.store_sum(values, scales)
    }
}
