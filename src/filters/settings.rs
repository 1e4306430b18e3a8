//! What each kind of filter says of itself.

use super::common::{Complaints, Filter};
use super::hardware::PipelineSettings;

/// Settings of a filter of one kind, and all that follows from them.
pub trait FilterSettings {
    /// Refuses settings that contradict each other.
    fn check(&self, _complaints: &mut Complaints) {}

    /// Refuses settings that do not suit the words to be filtered.
    fn check_on(&self, _words: &ExpectedWords, _complaints: &mut Complaints) {}

    /// What a user must know of the settings before such words are filtered, in sentences.
    fn notes(&self, _words: &ExpectedWords) -> Vec<String> {
        Vec::new()
    }

    /// The textbook filter for words that come every `sample_period_s`.
    ///
    /// # Panics
    /// If a setting is one that the reader or [`Self::check_on`] refuses.
    fn build(&self, sample_period_s: f64) -> Box<dyn Filter>;

    /// The hardware that filters in its place; none for the arithmetic of the textbook.
    fn hardware(&self) -> Option<PipelineSettings> {
        None
    }
}

/// What is known beforehand of the words to be filtered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExpectedWords {
    /// Words per second, Hz.
    pub sample_rate_hz: f64,
    /// Largest word, deg/h; 0 where none is known yet.
    pub peak_deg_per_h: f64,
    /// What a simulation knows besides; none of a recorded log.
    pub run: Option<ExpectedRun>,
}

/// What a simulation knows of its run beforehand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExpectedRun {
    /// Largest rate on the axis, deg/h.
    pub rate_max_deg_per_h: f64,
    /// Phase step of a swing from sample to sample, rad; none of any other motion.
    pub swing_step_rad: Option<f64>,
    /// Standard deviation of the white noise of a word, deg/h.
    pub noise_std_deg_per_h: f64,
    /// Time before the record, s.
    pub warm_up_s: f64,
    /// Length of the record, s.
    pub duration_s: f64,
}
