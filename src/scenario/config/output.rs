//! What to write besides the report.

use crate::declare::table;
use crate::vocabulary::words;

table! {
    /// What to write besides the report.
    pub struct OutputConfig {
        /// Rate words of every channel and the truth, written as NPY or not.
        samples: SamplesFormat = "none";
        /// Runs that get a `report.html`. Without it every run does, of a sweep of more than 100 points only
        /// those that fail.
        report: Option<ReportedRuns>, example "all";
    }
}

words! {
    /// Runs that get a page.
    pub enum ReportedRuns {
        /// Every run.
        All = "all",
        /// Those that fail, or of which a gate or a channel fails.
        Failed = "failed",
    }
}

words! {
    /// Format of the rate words.
    pub enum SamplesFormat {
        /// Not written.
        None = "none",
        /// One NPY file per channel.
        Npy = "npy",
    }
}
