//! Words that were computed elsewhere: by another program, on a board, in a simulation of hardware.

use super::common::Filter;
use super::kind::FilterSettings;
use crate::declare::table;
use crate::vocabulary::OutputRegister;

table! {
    /// Words that were computed elsewhere, from the samples of this very run.
    pub struct ReplayFilterConfig {
        /// File of the words, one for each sample of the run, warm-up included, in deg/h: an NPY array of one
        /// dimension, or a .hex file of a testbench, whose words are binary64 or binary32.
        samples: String, example "y.npy", kind File;
        /// Digest of the samples that the words were computed from, as it stands beside them in
        /// samples/input_digest.toml, or in input_digest.toml of an export.
        input_digest: String, example "af1349b9f5f9a1a6a0404dea36dcc9499bcb25c9adc112b7cc9a93cae41f3262", kind Digest;
        /// When the words appear: "immediate" if they stand in the file as they are to be stamped, as those of a
        /// run do; "next-sample" if the bench is to hold each until the next tick, as of the y.hex of an export.
        output_register: OutputRegister, example "immediate";
    }
}

impl FilterSettings for ReplayFilterConfig {
    fn build(&self, _sample_period_s: f64) -> Option<Box<dyn Filter>> {
        None
    }
}
