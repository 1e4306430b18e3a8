//! What each kind of filter says of itself. The list of the kinds, `kinds!`, stands in `mod.rs`.

use super::FilterKind;
use super::common::{Complaint, Complaints, Filter};
use super::hardware::PipelineSettings;
use super::words::{FixedWords, HardwareWords};
use crate::declare::table;

/// Settings of a filter of one kind, and all that follows from them.
pub trait FilterSettings {
    /// Refuses settings that contradict each other.
    fn check(&self, _complaints: &mut Complaints) {}

    /// Refuses settings that do not suit the words to be filtered.
    fn check_on(&self, _words: &ExpectedWords, _complaints: &mut Complaints) {}

    /// Keys that other settings of the filter can leave without effect.
    fn conditions() -> &'static [Condition<Self>]
    where
        Self: Sized,
    {
        &[]
    }

    /// What a user must know of the settings before such words are filtered, in sentences.
    fn notes(&self, _words: &ExpectedWords) -> Vec<String> {
        Vec::new()
    }

    /// The textbook filter for words that come every `sample_period_s`; none where no filter of the
    /// bench makes the words.
    ///
    /// # Panics
    /// If a setting is one that the reader or [`Self::check_on`] refuses.
    fn build(&self, sample_period_s: f64) -> Option<Box<dyn Filter>>;

    /// The hardware that filters in its place; none for the arithmetic of the textbook.
    fn hardware(&self) -> Option<PipelineSettings> {
        None
    }

    /// Its fixed-point words, or those of the reference; none of a filter without hardware for them.
    fn fixed_words(&self) -> Option<FixedWords> {
        None
    }

    /// Its hardware on these words, whatever its own are and whether it filters on them; none of a filter
    /// without hardware.
    fn hardware_on(&self, _words: &HardwareWords) -> Option<PipelineSettings> {
        None
    }
}

/// A key of a kind of filter that other settings can leave without effect.
#[derive(Clone, Copy, Debug)]
pub struct Condition<S> {
    /// Name of the key.
    pub key: &'static str,
    /// What must be set for it to act; a reason, where it helps, stands before it with a semicolon.
    pub needs: &'static str,
    /// Whether it acts.
    pub acts: fn(&S) -> bool,
}

impl<S: FilterSettings> Condition<S> {
    /// A key of the hardware, which acts where hardware filters.
    pub(super) const fn hardware(key: &'static str) -> Self {
        Self {
            key,
            needs: "pipeline = \"textbook\" has no hardware; pipeline = \"fpga\"",
            acts: |settings| settings.hardware().is_some(),
        }
    }

    /// The table of fixed-point words.
    pub(super) const fn fixed() -> Self {
        Self {
            key: "fixed",
            needs: "pipeline = \"fpga\" and number_format = \"fixed\"",
            acts: |settings| matches!(settings.hardware(), Some(PipelineSettings::Fixed(_))),
        }
    }

    /// A key of floating-point hardware.
    pub(super) const fn float(key: &'static str) -> Self {
        Self {
            key,
            needs: "only hardware of floating-point words has it; pipeline = \"fpga\" without \
                    number_format = \"fixed\"",
            acts: |settings| matches!(settings.hardware(), Some(PipelineSettings::Float(_))),
        }
    }
}

/// A key of any filter that other settings can leave without effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ConditionalKey {
    /// Kind of the filter.
    pub kind: &'static str,
    /// Name of the key.
    pub key: &'static str,
    /// What must be set for it to act, as of [`Condition`].
    pub needs: &'static str,
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
    ($($kind:ident($settings:ty) = $name:literal,)+) => {
        $crate::declare::alternatives! {
            /// Kind of a filter and its settings.
            pub enum FilterKind, one "filter kind" {
                $($kind($settings) = $name,)+
            }
        }

        impl FilterKind {
            /// Whether a key has an effect beside the other settings.
            #[must_use]
            pub fn acts(&self, key: &str) -> bool {
                match self {
                    $(Self::$kind(settings) => <$settings as $crate::filters::FilterSettings>::conditions()
                        .iter()
                        .all(|condition| condition.key != key || (condition.acts)(settings)),)+
                }
            }

            /// The settings, whatever the kind.
            #[must_use]
            pub fn settings(&self) -> &dyn $crate::filters::FilterSettings {
                match self {
                    $(Self::$kind(settings) => settings,)+
                }
            }
        }

        /// Keys of all kinds that other settings of their filter can leave without effect.
        #[must_use]
        pub fn conditional_keys() -> Vec<$crate::filters::ConditionalKey> {
            let mut keys = Vec::new();
            $(keys.extend(<$settings as $crate::filters::FilterSettings>::conditions().iter().map(|condition| $crate::filters::ConditionalKey {
                kind: $name,
                key: condition.key,
                needs: condition.needs,
            }));)+
            keys
        }
    };
}
pub(super) use kinds;

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
