//! What to write besides the report.

use crate::declare::table;
use crate::vocabulary::words;

table! {
    /// What to write besides the report.
    pub struct OutputConfig {
        /// Rate words of every channel and the truth, written as NPY or not.
        samples: SamplesFormat = "none";
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
