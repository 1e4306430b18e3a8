//! The channels of a scenario: which there are, in which order, whose words they carry and against
//! which motion they are measured.

use std::borrow::Cow;

use crate::filters::FilterConfig;
use crate::recording::{LogFormat, LogMotion};
use crate::scenario::config::Scenario;
use crate::turntable::{MotionConfig, MultiSineConfig, StepsConfig, SwingConfig};

/// Prefixes of the channels of an assembly, in the order of its case axes.
const ASSEMBLY: &[&str] = &["x_", "y_", "z_"];
/// A single gyro needs no prefix.
const SINGLE: &[&str] = &[""];

/// Name of the unfiltered output of a gyro, behind its prefix.
const RAW: &str = "raw";
/// Name of that output with its constant errors taken out, which is what filters are given.
pub(in crate::scenario) const COMPENSATED: &str = "compensated";
/// What stands behind the name of the channel of a log whose outliers are left out.
pub(crate) const WITHOUT_OUTLIERS: &str = "_without_outliers";

/// What stands behind the name of the channel of a log whose temperature is taken out.
pub(crate) const WITHOUT_TEMPERATURE: &str = "_without_temperature";

/// What decides which channels a log has of its own, beside the raw one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LogChannels {
    /// Whether errors that are known are taken out of its words.
    pub is_compensated: bool,
    /// Whether a temperature stands beside them.
    pub has_temperature: bool,
}

impl From<&LogFormat> for LogChannels {
    fn from(format: &LogFormat) -> Self {
        Self {
            is_compensated: format.calibration.is_some(),
            has_temperature: format.temperature_column.is_some(),
        }
    }
}

/// Option without which no known errors are taken out.
const CALIBRATION_OPTION: &str = "--calibration";
/// Option without which there is no temperature.
const TEMPERATURE_OPTION: &str = "--temperature-column";

impl LogChannels {
    /// All that a log can have, each with the option that it needs: the words, then what is measured without
    /// outliers and without the temperature.
    fn all() -> [(String, Option<&'static str>); 5] {
        [
            (RAW.to_owned(), None),
            (format!("{RAW}{WITHOUT_OUTLIERS}"), None),
            (
                format!("{RAW}{WITHOUT_TEMPERATURE}"),
                Some(TEMPERATURE_OPTION),
            ),
            (COMPENSATED.to_owned(), Some(CALIBRATION_OPTION)),
            (
                format!("{COMPENSATED}{WITHOUT_OUTLIERS}"),
                Some(CALIBRATION_OPTION),
            ),
        ]
    }

    /// The names of those that are there.
    #[must_use]
    pub(crate) fn names(self) -> Vec<String> {
        let is_there = |option: Option<&str>| match option {
            Some(CALIBRATION_OPTION) => self.is_compensated,
            Some(_) => self.has_temperature,
            None => true,
        };
        let there = Self::all()
            .into_iter()
            .filter(|(_, option)| is_there(*option));
        there.map(|(name, _)| name).collect()
    }

    /// The option by which a channel is there that a log need not have.
    pub(in crate::scenario) fn option_for(channel: &str) -> Option<&'static str> {
        Self::all().into_iter().find(|(name, _)| name == channel)?.1
    }
}

/// Prefix of the names of estimates.
const CALIBRATION: &str = "calibration_";

/// The motion of a log as reports head their columns by it; a log does not tell a swing's amplitude.
#[must_use]
pub(crate) fn motion_of_log(motion: LogMotion) -> MotionConfig {
    match motion {
        LogMotion::Static => MotionConfig::rest(),
        // Which rates it holds is found in it.
        LogMotion::Dwells => MotionConfig::Steps(StepsConfig {
            rates_deg_per_s: Vec::new(),
            dwell_s: 1.0,
            settle_s: 0.0,
        }),
        LogMotion::Swing { frequency_hz } => MotionConfig::Swing(SwingConfig {
            rate_amplitude_deg_per_s: None,
            angle_amplitude_deg: None,
            frequency_hz,
            soft_start_s: 0.0,
            from_rest: false,
        }),
    }
}

impl Scenario {
    /// The motion that a record is measured against: the table's, what an injected signal equals, or what
    /// is said of a log.
    #[must_use]
    pub fn measured_motion(&self) -> Cow<'_, MotionConfig> {
        if let Some(log) = &self.log {
            return Cow::Owned(motion_of_log(log.motion.unwrap_or_default()));
        }
        match self.injected_sines() {
            None => Cow::Borrowed(&self.turntable.motion),
            Some(sines) => Cow::Owned(MotionConfig::MultiSine(sines)),
        }
    }

    /// The signal that is added inside the loop, as the sines of rate that would do the same.
    ///
    /// To the loop a step `-A` added to each step of its ramp is the Sagnac phase `A` of the rate
    /// `A / Ks`, `Ks` the scale factor in seconds.
    #[must_use]
    pub fn injected_sines(&self) -> Option<MultiSineConfig> {
        let injection = self.gyro.injection.as_ref()?;
        Some(MultiSineConfig {
            frequencies_hz: injection.frequencies_hz.clone(),
            rate_amplitudes_deg_per_s: injection.rate_amplitudes_deg_per_s.clone(),
            phases: injection.phases,
            soft_start_s: injection.soft_start_s,
        })
    }

    /// Prefix of the channel names of each gyro: one empty one, or `x_`, `y_`, `z_`.
    #[must_use]
    pub fn axis_prefixes(&self) -> &'static [&'static str] {
        match self.gyro.assembly {
            None => SINGLE,
            Some(_) => ASSEMBLY,
        }
    }

    /// Names of the unfiltered channels, one for each gyro: `raw`, or `x_raw`, `y_raw`, `z_raw`.
    #[must_use]
    pub fn raw_channels(&self) -> Vec<String> {
        let prefixes = self.axis_prefixes().iter();
        prefixes.map(|prefix| format!("{prefix}{RAW}")).collect()
    }

    /// Names of the compensated channels, one for each gyro; none without a compensation.
    #[must_use]
    pub fn compensated_channels(&self) -> Vec<String> {
        let of_log = self.log.as_ref().and_then(|log| log.calibration.as_ref());
        if self.compensation.is_none() && of_log.is_none() {
            return Vec::new();
        }
        let prefixes = self.axis_prefixes().iter();
        prefixes
            .map(|prefix| format!("{prefix}{COMPENSATED}"))
            .collect()
    }

    /// Every channel in the order of the report: the unfiltered ones, the compensated ones, then
    /// those of each filter.
    #[must_use]
    pub fn channel_names(&self) -> Vec<String> {
        let mut names = self.raw_channels();
        names.extend(self.compensated_channels());
        for filter in &self.filters {
            let prefixes = self.axis_prefixes().iter();
            names.extend(prefixes.map(|prefix| format!("{prefix}{}", filter.name)));
        }
        names
    }

    /// Every channel of a log that is put through its filters.
    #[must_use]
    pub(in crate::scenario) fn channels_of_log(&self, log: LogChannels) -> Vec<String> {
        let filters = self.filters.iter().map(|filter| filter.name.clone());
        log.names().into_iter().chain(filters).collect()
    }

    /// Names under which gates find the estimates of a calibration campaign, one for each estimator;
    /// none with another motion.
    #[must_use]
    pub fn calibration_channels(&self) -> Vec<String> {
        if self.turntable.motion.campaign().is_none() {
            return Vec::new();
        }
        let kinds = self.calibration.kinds();
        let names = kinds.iter().map(|kind| kind.word());
        names.map(|name| format!("{CALIBRATION}{name}")).collect()
    }

    /// Whether a channel is the unfiltered output of a gyro.
    #[must_use]
    pub fn is_raw(&self, channel: &str) -> bool {
        self.raw_channels().iter().any(|raw| raw == channel)
    }

    /// Whether a channel is no filter's: the output of a gyro, compensated or not.
    #[must_use]
    pub fn is_unfiltered(&self, channel: &str) -> bool {
        let is_compensated = |name: &String| name == channel;
        self.is_raw(channel) || self.compensated_channels().iter().any(is_compensated)
    }

    /// The filter whose words a channel carries; none for an unfiltered or unknown one.
    #[must_use]
    pub fn filter_of(&self, channel: &str) -> Option<&FilterConfig> {
        let prefixes = self.axis_prefixes();
        self.filters.iter().find(|filter| {
            prefixes
                .iter()
                .any(|prefix| channel.strip_prefix(prefix) == Some(filter.name.as_str()))
        })
    }
}
