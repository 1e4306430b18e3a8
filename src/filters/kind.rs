//! The one list of the kinds of filters.

use super::butterworth::ButterworthFilterConfig;
use super::common::{Complaint, Complaints};
use super::constrained_rls::ConstrainedRlsFilterConfig;
use super::kalman::KalmanFilterConfig;
use super::lms::LmsFilterConfig;
use super::moving_average::MovingAverageFilterConfig;
use super::one_pole::OnePoleFilterConfig;
use super::rls::RlsFilterConfig;
use super::savitzky_golay::SavitzkyGolayFilterConfig;
use super::settings::{ExpectedWords, FilterSettings};
use super::sign_lms::SignLmsFilterConfig;
use crate::declare::{alternatives, table};

/// Declares the kinds: the settings of each and the name of its table in a scenario.
macro_rules! kinds {
    ($($kind:ident($settings:ty) = $name:literal,)+) => {
        alternatives! {
            /// Kind of a filter and its settings.
            pub enum FilterKind, one "filter kind" {
                $($kind($settings) = $name,)+
            }
        }

        impl FilterKind {
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
    Rls(RlsFilterConfig) = "rls",
    Lms(LmsFilterConfig) = "lms",
    SignLms(SignLmsFilterConfig) = "sign_lms",
    ConstrainedRls(ConstrainedRlsFilterConfig) = "constrained_rls",
    MovingAverage(MovingAverageFilterConfig) = "moving_average",
    SavitzkyGolay(SavitzkyGolayFilterConfig) = "savitzky_golay",
    OnePole(OnePoleFilterConfig) = "one_pole",
    Butterworth(ButterworthFilterConfig) = "butterworth",
    Kalman(KalmanFilterConfig) = "kalman",
}

table! {
    /// Filters: one `[[filter]]` per channel, with one kind. None by default.
    pub struct FilterConfig {
        /// Channel name; raw, truth, time_s and encoder_arcsec are reserved.
        name: String, example "rls", kind Name;
        #[serde(flatten)]
        kind: FilterKind;
    }
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
