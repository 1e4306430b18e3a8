//! Words of the Allan curves.

use super::word::words;

words! {
    /// Averaging times at which an Allan curve is asked for.
    pub enum AveragingTimes {
        /// Doubling: m = 1, 2, 4, 8, ...
        Octave = "octave",
        /// Three to the decade: m = 1, 2, 5, 10, 20, 50, ...
        Decade = "decade",
        /// Every number of samples of a short record, up to 1000 of them.
        ///
        /// The work grows with the square of the record, so that there are 1000 at most, and fewer,
        /// but 100, where they would take more than 2e9 differences: every m at the short end, then a
        /// constant ratio.
        All = "all",
    }
}
