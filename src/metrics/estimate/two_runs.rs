//! Sums of the difference of two runs of a filter, block by block.

/// Number, sum and sum of squares of a difference over a part of the record.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DifferenceSums {
    count: f64,
    sum: f64,
    squares: f64,
}

impl DifferenceSums {
    /// Takes one more difference.
    #[inline]
    pub fn take(&mut self, difference: f64) {
        self.count += 1.0;
        self.sum += difference;
        self.squares += difference * difference;
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        Self {
            count: self.count + other.count,
            sum: self.sum + other.sum,
            squares: self.squares + other.squares,
        }
    }

    /// Standard deviation over sqrt(2): that of one of the runs.
    pub(crate) fn deviation(self) -> f64 {
        let squares = self.squares - self.sum * self.sum / self.count;
        (squares.max(0.0) / (2.0 * (self.count - 1.0))).sqrt()
    }
}

/// Differences of two runs over the blocks of a record, deg/h.
#[derive(Clone, Debug, PartialEq)]
pub struct TwoRuns {
    /// Of the outputs.
    pub whole: Vec<DifferenceSums>,
    /// Of the noise through the weights.
    pub through_weights: Vec<DifferenceSums>,
    /// Of the weights, times the motion.
    pub of_weights: Vec<DifferenceSums>,
}

impl TwoRuns {
    /// Nothing taken yet, in so many blocks.
    #[must_use]
    pub fn of_blocks(count: usize) -> Self {
        let empty = vec![DifferenceSums::default(); count];
        Self {
            whole: empty.clone(),
            through_weights: empty.clone(),
            of_weights: empty,
        }
    }
}
