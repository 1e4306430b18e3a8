//! What the temperature does to the words of a log, and the words without it.

use super::trial::{LogSettings, RAW};
use crate::experiment::run::{Cut, stamp_s};
use crate::metrics::{ChannelMetrics, WarmRecord, measure, measure_present, measure_temperature};
use crate::recording::{Log, LogMotion};
use crate::scenario::WITHOUT_TEMPERATURE;
use crate::signal::TemperatureModel;

/// What a column of the temperature says of a log.
pub(super) struct Warmth {
    found: ChannelMetrics,
    /// The significant coefficients; none where none is told.
    fitted: Option<FittedTemperature>,
    /// All words, warm-up included, without the significant coefficients; none where there are none.
    without: Option<Vec<f64>>,
}

/// Coefficients that a log has shown.
#[derive(Clone, Copy, Debug)]
pub(super) struct FittedTemperature {
    pub(super) model: TemperatureModel,
    /// Lowest and highest temperature, deg C.
    pub(super) range_c: (f64, f64),
}

impl Warmth {
    /// Of a log as it was read; nothing of one without temperatures.
    pub(super) fn of(log: &Log, warm_up: usize, settings: &LogSettings) -> Option<Self> {
        if log.temperature_c.is_empty() {
            return None;
        }
        let sample_period_s = log.sample_period_s();
        let record = |first: usize| WarmRecord {
            words_deg_per_h: &log.rate_deg_per_h[first..],
            truth_deg_per_h: log.reference_deg_per_h.get(first..).unwrap_or(&[]),
            temperature_c: &log.temperature_c[first..],
            sample_period_s,
            first_stamp_s: stamp_s(first as u64, sample_period_s),
            swing_hz: match settings.motion {
                LogMotion::Static | LogMotion::Dwells => None,
                LogMotion::Swing { frequency_hz } => Some(frequency_hz),
            },
        };
        let mut found = ChannelMetrics::default();
        let reference_c = settings.temperature_reference_c;
        let warmed = measure_temperature(&record(warm_up), reference_c, &mut found);
        found.keep_finite();
        let fitted = warmed.as_ref().map(|warmed| FittedTemperature {
            model: warmed.model,
            range_c: warmed.range_c(),
        });
        // The words before those that are measured are the start of the channel, as they are of raw.
        let without = warmed.and_then(|warmed| warmed.words_without(&record(0)));
        let without = without.map(|words| {
            let mut own = log.with_words(words);
            own.take_about_common_mean();
            own.rate_deg_per_h
        });
        Some(Self {
            found,
            fitted,
            without,
        })
    }

    /// The significant coefficients; none where none is told.
    pub(super) fn fitted(&self) -> Option<FittedTemperature> {
        self.fitted.filter(|it| !it.model.is_flat())
    }

    /// Enters it: coefficients beside the other metrics of raw, the words without it behind that channel.
    pub(super) fn enter(self, cut: &Cut, channels: &mut Vec<(String, ChannelMetrics)>) {
        let Some(place) = channels.iter().position(|(name, _)| name == RAW) else {
            return;
        };
        let raw = &mut channels[place].1;
        raw.metrics.extend(self.found.metrics);
        raw.unavailable.extend(self.found.unavailable);
        raw.curves.extend(self.found.curves);
        if let Some(words) = self.without {
            let record = cut.of(&words, &words);
            let metrics = match words.iter().any(|word| word.is_nan()) {
                true => measure_present(&record, cut.settings),
                false => measure(&record, cut.settings, None),
            };
            channels.insert(place + 1, (format!("{RAW}{WITHOUT_TEMPERATURE}"), metrics));
        }
    }
}
