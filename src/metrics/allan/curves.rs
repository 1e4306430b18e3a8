//! The two Allan curves of a channel, how they are entered and how repeats are pooled.
//!
//! `allan` is the curve of the settings' estimator and averaging times, `allan_fit` the overlapping
//! Allan deviation that the noise terms are fitted to.

use super::noise_fit::NoiseFit;
use super::overlapping::AllanPoint;
use super::variants::{AllanEstimator, AllanVariantPoint};
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::key::curve::{Column, CurveKey, CurvePool};

/// Averaging time.
pub static TAU: Column = Column::new("tau_s", "s", "averaging time");

/// Deviation.
pub static DEVIATION: Column = Column::new("deviation_deg_per_h", "deg/h", "deviation at it");

/// Lower end of the deviation.
pub static LOW: Column = Column::low("low_deg_per_h", &DEVIATION);

/// Upper end of the deviation.
pub static HIGH: Column = Column::high("high_deg_per_h", &DEVIATION);

/// Degrees of freedom.
pub static FREEDOM: Column = Column::new("edf", "1", "equivalent degrees of freedom of its square");

/// Number of differences.
pub static COUNT: Column = Column::new("count", "1", "differences that it rests on, of one record");

/// Fitted deviation.
pub static FITTED: Column = Column::new(
    "fitted_deg_per_h",
    "deg/h",
    "Allan deviation of the fitted noise terms; absent without a fit",
);

/// Exponent of the identified noise.
pub static NOISE_ALPHA: Column = Column::new(
    "noise_alpha",
    "1",
    "exponent of the rate's spectrum that the noise was identified by",
);

/// Whether the noise was identified at this time.
pub static NOISE_IDENTIFIED: Column = Column::new(
    "noise_identified",
    "1",
    "0 where there are too few averages and the noise is that of the last time with enough",
);

/// Estimator.
pub static ESTIMATOR: Column = Column::words("estimator", "estimator of the scenario");

/// Identified noise.
pub static NOISE: Column = Column::words("noise", "name of the identified noise");

/// The curve of the settings' estimator and averaging times.
pub static ALLAN: CurveKey = CurveKey::new(
    "allan",
    &[
        &TAU,
        &DEVIATION,
        &LOW,
        &HIGH,
        &FREEDOM,
        &COUNT,
        &NOISE_ALPHA,
        &NOISE_IDENTIFIED,
        &FITTED,
    ],
    "Allan deviation, or the one of its family that the scenario names, over its averaging times",
)
.with_words(&[&ESTIMATOR, &NOISE])
.csv("allan.csv")
.picture("allan.svg")
.pooled(CurvePool::AllanVariance);

/// The curve that is fitted.
pub static ALLAN_FIT: CurveKey = CurveKey::new(
    "allan_fit",
    &[&TAU, &DEVIATION, &LOW, &HIGH, &FREEDOM, &COUNT, &FITTED],
    "overlapping Allan deviation that the noise terms are fitted to",
)
.pooled(CurvePool::AllanVariance);

/// Columns of a curve that is being made.
pub(crate) type Columns = Vec<(&'static Column, Vec<f64>)>;

/// Columns both curves have.
pub(crate) fn columns_of(points: &[AllanPoint]) -> Columns {
    let column = |pick: fn(&AllanPoint) -> f64| points.iter().map(pick).collect();
    vec![
        (&TAU, column(|point| point.tau_s)),
        (&DEVIATION, column(|point| point.deviation_deg_per_h.value)),
        (&LOW, column(|point| point.deviation_deg_per_h.low)),
        (&HIGH, column(|point| point.deviation_deg_per_h.high)),
        (&FREEDOM, column(|point| point.degrees_of_freedom)),
        // Differences of one record.
        (&COUNT, column(|point| point.count as f64)),
    ]
}

/// The fitted overlapping Allan deviation at the times of a curve.
pub(crate) fn fitted_column(points: &[AllanPoint], fit: &NoiseFit) -> (&'static Column, Vec<f64>) {
    let fitted = points
        .iter()
        .map(|point| fit.deviation_deg_per_h(point.tau_s));
    (&FITTED, fitted.collect())
}

/// Enters the curve of the settings with the noise identified at every averaging time.
///
/// `noise_alpha` is the exponent of the rate's spectrum, the word column `noise` its name, the word
/// `estimator` that of the curve. `noise_identified` is 0 where there are too few averaging times and
/// the noise is that of the last one that has enough. The fitted deviation stands beside the Allan
/// deviations only; that of the others is another function of the same terms.
pub(crate) fn put_allan_curve(
    variants: &[AllanVariantPoint],
    estimator: AllanEstimator,
    fit: Option<&NoiseFit>,
    metrics: &mut ChannelMetrics,
) {
    let points: Vec<AllanPoint> = variants.iter().map(|variant| variant.point).collect();
    let mut curve = columns_of(&points);
    let alpha = variants.iter().map(|variant| variant.noise.alpha().into());
    curve.push((&NOISE_ALPHA, alpha.collect()));
    let identified = variants.iter().map(|variant| variant.noise_identified);
    let identified = identified.map(|known| f64::from(u8::from(known)));
    curve.push((&NOISE_IDENTIFIED, identified.collect()));
    let is_allan = matches!(
        estimator,
        AllanEstimator::Overlapping | AllanEstimator::Plain
    );
    curve.extend(
        fit.filter(|_| is_allan)
            .map(|fit| fitted_column(&points, fit)),
    );
    metrics.put_curve(&ALLAN, curve);
    let noise = variants.iter().map(|variant| variant.noise.name());
    put_allan_words(noise.collect(), estimator.name(), metrics);
}

pub(crate) fn put_allan_words(
    noise: Vec<&'static str>,
    estimator: &'static str,
    metrics: &mut ChannelMetrics,
) {
    metrics.put_words(&ALLAN, [(&ESTIMATOR, vec![estimator]), (&NOISE, noise)]);
}

/// Enters the curve that the noise is fitted to; its column of the fit is absent without one.
pub(crate) fn put_fit_curve(
    points: &[AllanPoint],
    fit: Option<&NoiseFit>,
    metrics: &mut ChannelMetrics,
) {
    let mut curve = columns_of(points);
    curve.extend(fit.map(|fit| fitted_column(points, fit)));
    metrics.put_curve(&ALLAN_FIT, curve);
}
