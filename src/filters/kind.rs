//! The kinds of filters: what each says of itself, and the one list of them.

use serde::Deserialize;

use super::butterworth::ButterworthFilterConfig;
use super::common::{Complaint, Complaints, Filter};
use super::constrained_rls::ConstrainedRlsFilterConfig;
use super::hardware::PipelineSettings;
use super::kalman::KalmanFilterConfig;
use super::lms::LmsFilterConfig;
use super::moving_average::MovingAverageFilterConfig;
use super::one_pole::OnePoleFilterConfig;
use super::rls::RlsFilterConfig;
use super::savitzky_golay::SavitzkyGolayFilterConfig;
use super::sign_lms::SignLmsFilterConfig;

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

/// Declares the kinds: the settings of each and the name of its table in a scenario.
macro_rules! kinds {
    ($($(#[$doc:meta])* $kind:ident($settings:ty) = $name:literal,)+) => {
        /// Kind of a filter and its settings.
        #[derive(Clone, Debug, PartialEq, Deserialize)]
        pub enum FilterKind {
            $($(#[$doc])* #[serde(rename = $name)] $kind($settings),)+
        }

        /// Names of the kinds, in the order of the list.
        pub const KINDS: &[&str] = &[$($name),+];

        impl FilterKind {
            /// Name of the kind, that of its table in a scenario.
            #[must_use]
            pub fn name(&self) -> &'static str {
                match self {
                    $(Self::$kind(_) => $name,)+
                }
            }

            /// The settings, whatever the kind.
            #[must_use]
            pub fn settings(&self) -> &dyn FilterSettings {
                match self {
                    $(Self::$kind(settings) => settings,)+
                }
            }
        }
    };
}

kinds! {
    /// Recursive least squares.
    Rls(RlsFilterConfig) = "rls",
    /// Least mean squares, normalised or not.
    Lms(LmsFilterConfig) = "lms",
    /// Line enhancer with the sign of the error, and its normalised forms.
    SignLms(SignLmsFilterConfig) = "sign_lms",
    /// Recursive least squares held to unit DC gain.
    ConstrainedRls(ConstrainedRlsFilterConfig) = "constrained_rls",
    /// Mean of the newest samples.
    MovingAverage(MovingAverageFilterConfig) = "moving_average",
    /// Savitzky-Golay filter at the newest sample.
    SavitzkyGolay(SavitzkyGolayFilterConfig) = "savitzky_golay",
    /// One-pole low pass.
    OnePole(OnePoleFilterConfig) = "one_pole",
    /// Butterworth low pass.
    Butterworth(ButterworthFilterConfig) = "butterworth",
    /// Kalman filter for a rate that walks.
    Kalman(KalmanFilterConfig) = "kalman",
}

/// One filter channel of a scenario.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct FilterConfig {
    /// Channel name.
    pub name: String,
    /// Kind and settings (`[filter.rls]` or `[filter.lms]`).
    #[serde(flatten)]
    pub kind: FilterKind,
}

impl FilterConfig {
    /// Contradictions among the settings.
    ///
    /// * `index`: of the filter in its scenario, for the paths.
    #[must_use]
    pub fn check(&self, index: usize) -> Vec<Complaint> {
        let mut complaints = self.complaints(index);
        self.kind.settings().check(&mut complaints);
        complaints.found()
    }

    /// Settings that do not suit the words to be filtered, and hardware that cannot be or cannot keep
    /// up with them.
    ///
    /// * `index`: of the filter in its scenario, for the paths.
    #[must_use]
    pub fn check_on(&self, index: usize, words: &ExpectedWords) -> Vec<Complaint> {
        let mut complaints = self.complaints(index);
        if let Some(hardware) = self.kind.settings().hardware() {
            hardware.check(words.sample_rate_hz, &mut complaints);
        }
        self.kind.settings().check_on(words, &mut complaints);
        complaints.found()
    }

    /// What a user must know of the filter before such words are filtered, in sentences that name it.
    #[must_use]
    pub fn notes(&self, words: &ExpectedWords) -> Vec<String> {
        let hardware = self.kind.settings().hardware();
        let digits = hardware.and_then(|hardware| hardware.digits_warning(words.peak_deg_per_h));
        let notes = self.kind.settings().notes(words);
        let notes = digits
            .map(|warning| warning.to_string())
            .into_iter()
            .chain(notes);
        notes
            .map(|note| format!("filter `{}`: {note}", self.name))
            .collect()
    }

    fn complaints(&self, index: usize) -> Complaints {
        Complaints::about(format!("filter[{index}].{}", self.kind.name()))
    }
}
