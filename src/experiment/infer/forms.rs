//! Metrics that have a closed form.

use crate::metrics::MetricKey;
use crate::metrics::catalogue as known;

/// How a metric follows from a record in closed form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Form {
    /// Angle random walk.
    Walk,
    /// Angle random walk at restored scale.
    WalkOverGain,
    /// Bias stability over the averaging time, s; none for that of the scenario.
    Blocks(Option<f64>),
    /// Time mean of the DC gain.
    Gain,
    /// Mean of the words.
    Mean,
    /// Standard deviation of the noise.
    Noise,
    /// Noise power over that of raw.
    NoiseGain,
    /// Delay behind raw at a swing.
    DelayVsRaw,
    /// Delay behind the true rate at a swing.
    DelayVsTruth,
    /// Error of the scale factor.
    Scale,
    /// Largest distance from the line, by full scale.
    Nonlinearity,
    /// Bandwidth behind several sines.
    Bandwidth,
    /// Overlapping Allan deviation at an averaging time, s.
    Allan(f64),
    /// Autocovariance of the noise at a lag, s.
    Autocovariance(f64),
}

impl Form {
    /// Whether two figures of one record are made of the same sums, so that the one tells nothing beside the
    /// other: fits and means of blocks beside the Allan curve, powers beside the autocovariance.
    pub(crate) fn repeats(self, other: Self) -> bool {
        use Form::{Allan, Autocovariance, Blocks, Noise, NoiseGain, Walk, WalkOverGain};
        matches!(
            (self, other),
            (Allan(_), Walk | WalkOverGain | Blocks(_))
                | (Walk | WalkOverGain | Blocks(_), Allan(_))
                | (Autocovariance(_), Noise | NoiseGain)
                | (Noise | NoiseGain, Autocovariance(_))
        )
    }
}

/// The metrics, each with its form.
static FORMS: &[(&MetricKey, Form)] = &[
    (&known::ANGLE_RANDOM_WALK, Form::Walk),
    (&known::ANGLE_RANDOM_WALK_OVER_DC_GAIN, Form::WalkOverGain),
    (&known::BIAS_STABILITY_1S, Form::Blocks(Some(1.0))),
    (&known::BIAS_STABILITY_10S, Form::Blocks(Some(10.0))),
    (&known::BIAS_STABILITY_100S, Form::Blocks(Some(100.0))),
    (&known::BIAS_STABILITY, Form::Blocks(None)),
    (&known::DC_GAIN, Form::Gain),
    (&known::DC_GAIN_PREDICTED, Form::Gain),
    (&known::MEAN, Form::Mean),
    (&known::NOISE_STD, Form::Noise),
    (&known::NOISE_GAIN, Form::NoiseGain),
    (&known::DELAY_VS_RAW, Form::DelayVsRaw),
    (&known::DELAY_PREDICTED, Form::DelayVsRaw),
    (&known::DELAY_VS_TRUTH, Form::DelayVsTruth),
    (&known::SCALE_FACTOR_ERROR, Form::Scale),
    (&known::SCALE_FACTOR_NONLINEARITY, Form::Nonlinearity),
    (&known::BANDWIDTH, Form::Bandwidth),
];

/// The form of a metric; none of one that is simulated alone.
pub(crate) fn form_of(metric: &MetricKey) -> Option<Form> {
    let row = FORMS.iter().find(|(key, _)| key.name == metric.name)?;
    Some(row.1)
}
