//! What twins of a filter on the same record say of it, whatever makes its words.

use std::collections::BTreeMap;

use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::MetricKey;

/// Look-ahead.
pub static LOOK_AHEAD: MetricKey = MetricKey::of_twins(
    "look_ahead_samples",
    "1",
    "samples between an output and the latest word that changes it, where that lies ahead of it; 0 of a causal filter",
)
.lower_is_better()
.heading("look-ahead");

/// Memory to 1 %.
pub static MEMORY_1_PERCENT: MetricKey = MetricKey::of_twins(
    "memory_1_percent_s",
    "s",
    "time from a word that is changed by its noise until the last output that it changes by more than 1 % of the largest change",
)
.heading("memory to 1 %");

/// Memory to 0.1 %.
pub static MEMORY_0P1_PERCENT: MetricKey = MetricKey::of_twins(
    "memory_0p1_percent_s",
    "s",
    "the same to 0.1 %: angle random walk is read beyond it",
)
.heading("memory to 0.1 %");

/// Memory of what is learned.
pub static ADAPTATION_MEMORY: MetricKey = MetricKey::of_twins(
    "adaptation_memory_1_percent_s",
    "s",
    "time after a small step that is added at mid-record until the gain for it stays within 1 % of the one at the end",
)
.heading("memory by adaptation");

/// Gain for a step over 1 s.
pub static STEP_GAIN_1S: MetricKey = MetricKey::of_twins(
    "step_gain_1s",
    "1",
    "gain over the first 1 s, behind the memory, for a small step that is added at mid-record",
)
.heading("step gain, 1 s");

/// Gain for a step over 10 s.
pub static STEP_GAIN_10S: MetricKey = MetricKey::of_twins(
    "step_gain_10s",
    "1",
    "gain over the first 10 s, behind the memory, for a small step that is added at mid-record",
)
.heading("step gain, 10 s");

/// Gain for a step over 100 s.
pub static STEP_GAIN_100S: MetricKey = MetricKey::of_twins(
    "step_gain_100s",
    "1",
    "gain over the first 100 s, behind the memory, for a small step that is added at mid-record",
)
.heading("step gain, 100 s");

/// Gain for small sines.
pub static SINE_GAIN: MetricKey = MetricKey::of_twins(
    "sine_gain",
    "1",
    "gain for the slowest of four small sines that are added together, two cycles of which fill the second half of the record",
)
.heading("sine gain");

/// Gain for a rate that is there from the first word on.
pub static LASTING_RATE_GAIN: MetricKey = MetricKey::of_twins(
    "lasting_rate_gain",
    "1",
    "gain over the second half of the record for a rate of a hundredth of the noise that is added from the first word on: an adaptive filter learns it",
)
.heading("lasting rate gain");

/// Mean out over mean in.
pub static TWIN_MEAN_RATIO: MetricKey = MetricKey::of_twins(
    "twin_mean_ratio",
    "1",
    "mean output over mean input, both of the second half of the record with the same rate added, where the mean input is ten of its standard errors",
)
.heading("mean out / mean in");

/// Delay of one word.
pub static DELAY_AT_REST: MetricKey = MetricKey::of_twins(
    "delay_at_rest_ms",
    "ms",
    "centroid of what one word that is changed by its noise changes in the outputs, within twice the memory to 0.1 %",
)
.lower_is_better()
.heading("delay of one word");

/// Delay of a swing.
pub static DELAY_UNDER_SWING: MetricKey = MetricKey::of_twins(
    "delay_under_swing_ms",
    "ms",
    "delay of a swing of ten standard deviations of the noise that begins at mid-record, over the last quarter of the record",
)
.lower_is_better()
.heading("delay under a swing");

/// Time in which a swing is learned.
pub static SWING_READAPTATION: MetricKey = MetricKey::of_twins(
    "swing_readaptation_s",
    "s",
    "time after the same swing begins until the gain for it stays within 1 % of the one at the end",
)
.lower_is_better()
.heading("readaptation to a swing");

/// Start-up.
pub static START_UP: MetricKey = MetricKey::of_twins(
    "start_up_s",
    "s",
    "time after which the outputs of a record that begins at mid-record differ from those of the whole record by less than 1 % of their largest difference",
)
.lower_is_better()
.heading("start-up");

/// Saturation.
pub static SATURATION_GAIN: MetricKey = MetricKey::of_twins(
    "saturation_gain",
    "1",
    "least of the gains for steps at mid-record of 100, 1000 and 100 000 standard deviations of the noise, up and down, over the largest of them",
)
.higher_is_better()
.heading("gain in saturation");

/// Departure from linearity.
pub static LINEARITY_ERROR: MetricKey = MetricKey::of_twins(
    "linearity_error",
    "1",
    "largest departure from linearity: of the record with noise or a swing added over the answer to that, of twice the record and of its negative over the answer to it; rms over the second half",
)
.lower_is_better()
.heading("linearity error");

/// Departure from time invariance.
pub static TIME_INVARIANCE_ERROR: MetricKey = MetricKey::of_twins(
    "time_invariance_error",
    "1",
    "largest difference of the answers over the second half when the record begins later, over their standard deviation",
)
.lower_is_better()
.heading("time invariance error");

/// Response to a glitch.
pub static GLITCH_RESPONSE: MetricKey = MetricKey::of_twins(
    "glitch_response",
    "1",
    "largest change of an output over the change of one word by 100 standard deviations of its noise",
)
.lower_is_better()
.heading("glitch response");

/// Gains for a step, shortest time first, with the time of each, s.
pub(crate) static STEP_GAINS: [(&MetricKey, f64); 3] = [
    (&STEP_GAIN_1S, 1.0),
    (&STEP_GAIN_10S, 10.0),
    (&STEP_GAIN_100S, 100.0),
];

/// Field of `sine_gain`: frequency of the slowest sine, Hz.
pub(crate) const SINE_FREQUENCY: &str = "frequency_hz";

/// Field of `sine_gain`: delay of the slowest sine, ms.
pub(crate) const SINE_DELAY_MS: &str = "delay_ms";

/// Field of `look_ahead_samples`: 1 if the first word already shows the future, so that the look-ahead is as
/// long as the record.
pub(crate) const REACHES_START: &str = "reaches_the_first_word";

/// Why a figure of twins has no interval.
const ONE_RECORD: &str = "twins of one record do not tell how it scatters from seed to seed";

/// A figure with what defines it.
#[derive(Clone, Debug, PartialEq)]
pub struct TwinFigure {
    /// Value.
    pub value: f64,
    /// What defines it.
    pub fields: BTreeMap<&'static str, f64>,
    /// Half width of its interval where the record tells it.
    pub half_width: Option<f64>,
}

impl TwinFigure {
    /// A figure alone.
    #[must_use]
    pub fn alone(value: f64) -> Self {
        Self {
            value,
            fields: BTreeMap::new(),
            half_width: None,
        }
    }

    /// The same with the half width of its interval.
    #[must_use]
    pub fn within(mut self, half_width: f64) -> Self {
        self.half_width = Some(half_width);
        self
    }

    /// The same with a field.
    #[must_use]
    pub fn with(mut self, field: &'static str, value: f64) -> Self {
        self.fields.insert(field, value);
        self
    }
}

/// Figures that twins gave of one filter.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BlackBox {
    figures: Vec<(&'static MetricKey, Result<TwinFigure, Unavailable>)>,
}

impl BlackBox {
    /// Keeps a figure, or the reason for its lack.
    pub fn keep(&mut self, key: &'static MetricKey, figure: Result<TwinFigure, Unavailable>) {
        self.figures.push((key, figure));
    }

    /// The value of a figure, where it was found.
    #[must_use]
    pub fn value(&self, key: &MetricKey) -> Option<f64> {
        let own = self.figures.iter().find(|(known, _)| *known == key)?;
        Some(own.1.as_ref().ok()?.value)
    }

    /// A field of a figure, where it was found.
    #[must_use]
    pub fn field(&self, key: &MetricKey, field: &str) -> Option<f64> {
        let own = self.figures.iter().find(|(known, _)| *known == key)?;
        own.1.as_ref().ok()?.fields.get(field).copied()
    }
}

/// Enters what twins gave.
///
/// * `is_fixed`: whether the weights are given, so that no noise of another seed moves a figure.
pub(crate) fn put_black_box(found: &BlackBox, is_fixed: bool, metrics: &mut ChannelMetrics) {
    for (key, figure) in &found.figures {
        match figure {
            Ok(figure) => {
                let value = figure.value;
                let estimate = match figure.half_width {
                    Some(half) => Estimate::with_interval(value, value - half, value + half),
                    None if is_fixed || **key == LOOK_AHEAD => Estimate::exact(value),
                    None => Estimate::without_interval(value, ONE_RECORD),
                };
                let fields = &mut metrics.put(key, estimate).fields;
                fields.extend(figure.fields.iter().map(|(name, value)| (*name, *value)));
            }
            Err(reason) => metrics.miss(key, reason.clone()),
        }
    }
    metrics.keep_finite();
}
