//! How far a channel is from the true rate where a motion is known but not modelled.

use super::mean::{filter_reach, mean_spread_of, put_mean};
use crate::metrics::estimate::influence::Spread;
use crate::metrics::estimate::interval;
use crate::metrics::estimate::paired::MeanScatter;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::{Against, Applies, Headline, MetricKey, Pool, Table};
use crate::metrics::noise::autocovariance::autocovariance;
use crate::metrics::record::{FilterFacts, Record};

/// Tracking error rms.
pub static TRACKING_ERROR_RMS: MetricKey = MetricKey::new(
    "tracking_error_rms_deg_per_h",
    "deg/h",
    Applies::Moving,
    "root mean square difference from the true rate at the same stamps",
)
.lower_is_better()
.synonyms(&["tracking_error", "rms_error"])
.heading("tracking error rms")
.against(Against::Truth)
.pooled(Pool::RootMeanSquare)
.run_column(11)
.of_one_motion()
.tables(&[Table::Swing, Table::MultiSine, Table::Steps])
.headlines(&[Headline::General]);

/// Why a motion without a settled part gives no interval of its tracking error.
const FEW_TRANSIENTS: &str = "not from one record: a few transients make it; repeats gives it";

/// Mean and tracking error over the whole record of a motion that is known but not modelled.
///
/// The noise is that of the samples from `settled` on, where the channel has the true rate but for
/// noise; where there are none, the interval of the mean is that of the differences from the truth
/// over the whole record, and the tracking error, which a few transients make, has none.
pub(crate) fn measure_tracking(
    record: &Record,
    settled: Option<usize>,
    filter: Option<&FilterFacts>,
    metrics: &mut ChannelMetrics,
) {
    let values = record.channel_deg_per_h;
    let errors: Vec<f64> = values
        .iter()
        .zip(record.truth_deg_per_h.iter())
        .map(|(rate, truth)| rate - truth)
        .collect();
    let noise = &errors[settled.unwrap_or(0)..];
    let truth = record.truth_deg_per_h.mean();
    let mean = interval::mean(&errors) + truth;
    let estimate = match mean_spread_of(record, noise, filter, false) {
        Ok(spread) => spread.about(mean),
        Err(reason) => Estimate::without_interval(mean, reason),
    };
    put_mean(
        estimate,
        Some(truth),
        values.len() as f64 * record.sample_period_s,
        metrics,
    );
    let square = errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64;
    let estimate = match settled {
        None => Estimate::without_interval(square.sqrt(), FEW_TRANSIENTS),
        Some(settled) => root(square, square_spread(record, &errors, settled, filter)),
    };
    metrics.put(&TRACKING_ERROR_RMS, estimate);
}

/// Spread of the mean square of the differences, of which those from `settled` on are noise.
///
/// That of the noise's square, and of twice the noise times what the transients p leave: `2 sum p n`
/// has the variance `4 sum_l R(l) sum_k p_k p_(k+l)`.
fn square_spread(
    record: &Record,
    errors: &[f64],
    settled: usize,
    filter: Option<&FilterFacts>,
) -> Spread {
    let reach = filter_reach(filter);
    let noise = &errors[settled..];
    let squares: Vec<f64> = noise.iter().map(|error| error * error).collect();
    let lags = reach.min(noise.len() / LAGS_PER_TAIL);
    let colour = autocovariance(noise, lags);
    let mut cross = 0.0;
    let truth = record.truth_deg_per_h.words();
    let changes = truth.windows(2).enumerate();
    let changes = changes.filter(|(_, two)| two[0] < two[1] || two[1] < two[0]);
    let mut end = 0;
    for (change, _) in changes {
        // A sample of a transient counts once, however many changes follow each other.
        let start = change.max(end);
        end = (change + 1 + reach).min(errors.len());
        let transient = &errors[start.min(end)..end];
        cross += colour
            .iter()
            .enumerate()
            .map(|(lag, covariance)| {
                let pairs = transient.iter().zip(transient.iter().skip(lag));
                let product: f64 = pairs.map(|(one, other)| one * other).sum();
                if lag == 0 {
                    covariance * product
                } else {
                    2.0 * covariance * product
                }
            })
            .sum::<f64>();
    }
    let n = errors.len() as f64;
    let of_noise = MeanScatter::of(&squares[..], reach).density_over(errors.len());
    of_noise.plus(Spread::known(4.0 * cross.max(0.0) / (n * n)))
}

/// Settled samples for each lag of their autocovariance.
const LAGS_PER_TAIL: usize = 8;

/// Root of a mean square with the interval of its spread, cut at zero.
pub(crate) fn root(square: f64, spread: Spread) -> Estimate {
    let Estimate {
        value,
        low,
        high,
        interval,
        ..
    } = spread.about(square);
    Estimate {
        interval,
        ..Estimate::with_interval(value.sqrt(), low.max(0.0).sqrt(), high.sqrt())
    }
}
