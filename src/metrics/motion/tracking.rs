//! How far a channel is from the true rate where a motion is known but not modelled.

use super::mean::put_mean;
use crate::metrics::estimate::blocks::{RATIO_BLOCKS, equal_block_means};
use crate::metrics::estimate::interval;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::{Against, Applies, Headline, MetricKey, Pool, Table};
use crate::metrics::record::Record;

/// Tracking error rms.
pub static TRACKING_ERROR_RMS: MetricKey = MetricKey::new(
    "tracking_error_rms_deg_per_h",
    "deg/h",
    Applies::Moving,
    "root mean square difference from the true rate at the same stamps",
)
.synonyms(&["tracking_error", "rms_error"])
.heading("tracking error rms")
.against(Against::Truth)
.pooled(Pool::RootMeanSquare)
.run_column(11)
.of_one_motion()
.tables(&[Table::Swing, Table::MultiSine, Table::Steps])
.headlines(&[Headline::General]);

/// Mean and tracking error over the whole record of a motion that is known but not modelled.
///
/// The mean's interval comes from twenty blocks of the differences from the truth, so that the
/// motion itself does not widen it; the tracking error, which a few transients make, has none.
pub(crate) fn measure_tracking(record: &Record, metrics: &mut ChannelMetrics) {
    let values = record.channel_deg_per_h;
    let errors: Vec<f64> = values
        .iter()
        .zip(record.truth_deg_per_h)
        .map(|(rate, truth)| rate - truth)
        .collect();
    let error = interval::from_parts(
        interval::mean(&errors),
        &equal_block_means(&errors, RATIO_BLOCKS),
    );
    let truth = interval::mean(record.truth_deg_per_h);
    let mean = Estimate::with_interval(error.value + truth, error.low + truth, error.high + truth);
    put_mean(
        mean,
        Some(truth),
        values.len() as f64 * record.sample_period_s,
        metrics,
    );
    let square = errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64;
    metrics.put(&TRACKING_ERROR_RMS, Estimate::exact(square.sqrt()));
}
