//! Settings of the Allan curve of every channel.

use crate::declare::table;
use crate::vocabulary::AveragingTimes;
use crate::vocabulary::words;

table! {
    /// The Allan curve of every channel at rest or at constant rate: allan.csv, allan.svg and the curve
    /// `allan` of summary.json. The noise terms are fitted to the overlapping Allan deviation whatever
    /// stands here.
    #[derive(Copy, Eq)]
    pub struct AllanConfig {
        /// Which deviation of the Allan family the curve of every channel shows: Allan over every start, Allan
        /// of neighbouring blocks, modified Allan, overlapping Hadamard. Source of the default: IEEE Std 952
        /// asks for the Allan deviation; overlapping starts waste no samples.
        estimator: AllanEstimatorConfig = "overlapping";
        /// The averaging times of that curve: 1, 2, 4, 8, ... samples; 1, 2, 5, 10, ... samples; or all: every
        /// number of samples where there are up to 1000 of them, else 1000 at most (of a long record at least
        /// 100, as many as 2e9 differences allow), every one at the short end and a constant ratio beyond. They
        /// end at a quarter of the record, of the modified and the Hadamard deviation at a fifth. Source of the
        /// default: neighbours closer than an octave say little more.
        averaging_times: AveragingTimes = "octave";
    }
}

words! {
    /// A deviation of the Allan family.
    pub enum AllanEstimatorConfig {
        /// Allan deviation over every start.
        Overlapping = "overlapping",
        /// Allan deviation of neighbouring blocks.
        Plain = "plain",
        /// Modified Allan deviation.
        Modified = "modified",
        /// Overlapping Hadamard deviation.
        Hadamard = "hadamard",
    }
}
