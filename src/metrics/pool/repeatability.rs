//! Repeatability: the scatter of a metric over independent repeats, each a start of its own.

use super::pooling::Pooling;
use crate::metrics::estimate::interval;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::table::{ChannelMetrics, DEGREES_OF_FREEDOM};
use crate::metrics::key::metric::{Applies, MetricKey, Pool, Table};
use crate::metrics::motion::mean::MEAN;
use crate::metrics::steps::scale_factor::scale_factor_repeatability;
use crate::metrics::steps::staircase::SCALE_FACTOR_ERROR;
use crate::units::ratio_to_ppm;

/// Bias repeatability.
pub static BIAS_REPEATABILITY: MetricKey = MetricKey::new(
    "bias_repeatability_deg_per_h",
    "deg/h",
    Applies::Steady,
    "standard deviation of the means of six repeats or more, each a start of its own",
)
.lower_is_better()
.heading("bias repeatability")
.pooled(Pool::ScatterOf(&MEAN))
.by_choice()
.tables(&[Table::Rest]);

/// Scale factor repeatability.
pub static SCALE_FACTOR_REPEATABILITY: MetricKey = MetricKey::new(
    "scale_factor_repeatability_ppm",
    "ppm",
    Applies::Steps,
    "standard deviation of the scale factors of six repeats or more over their mean",
)
.lower_is_better()
.heading("scale factor repeatability")
.pooled(Pool::RelativeScatterOf(&SCALE_FACTOR_ERROR))
.of_turned_axis()
.by_choice()
.tables(&[Table::Steps]);

/// The metrics of this file.
const REPEATABILITIES: [&MetricKey; 2] = [&BIAS_REPEATABILITY, &SCALE_FACTOR_REPEATABILITY];

/// Fewest repeats of which a repeatability is given.
///
/// Source: GJB 2426A and IEEE Std 952 ask for six.
const REPEATS_MIN: usize = 6;

/// Why too few repeats can never have a metric; nothing for other metrics.
#[must_use]
pub fn repeats_lack(key: &MetricKey, repeats: usize) -> Option<Unavailable> {
    let is_lacking = key.is_repeatability() && repeats < REPEATS_MIN;
    is_lacking
        .then(|| format!("it needs {REPEATS_MIN} repeats or more; there are {repeats}").into())
}

/// Enters the scatter of scale factor and bias over the repeats, where a single record would have
/// them but for their number.
///
/// Source: IEEE Std 952, repeatability; the interval is the chi-square one of a standard deviation.
pub(crate) fn put_repeatability(repeats: &Pooling, pooled: &mut ChannelMetrics) {
    for key in REPEATABILITIES {
        let (Pool::ScatterOf(source) | Pool::RelativeScatterOf(source)) = key.pool else {
            continue;
        };
        let single = repeats_lack(key, 1);
        if pooled.why_unavailable(key) != single.as_ref().map(Unavailable::as_str) {
            continue;
        }
        if let Some(reason) = repeats_lack(key, repeats.count) {
            pooled.miss(key, reason);
            continue;
        }
        let Some(values) = repeats.values_of_all(source) else {
            pooled.miss(key, format!("not every repeat has a {}", source.name));
            continue;
        };
        let factors: Vec<f64> = values
            .iter()
            .map(|ppm| 1.0 + ppm / ratio_to_ppm(1.0))
            .collect();
        let is_relative = matches!(key.pool, Pool::RelativeScatterOf(_));
        let scatter = match scale_factor_repeatability(&factors) {
            Some(ratio) if is_relative => ratio_to_ppm(ratio),
            _ => interval::sample_variance(values).sqrt(),
        };
        let freedom = values.len() as f64 - 1.0;
        let fields = &mut pooled
            .put(key, interval::deviation(scatter, freedom))
            .fields;
        fields.insert(DEGREES_OF_FREEDOM, freedom);
        fields.insert("repeats", values.len() as f64);
    }
}
