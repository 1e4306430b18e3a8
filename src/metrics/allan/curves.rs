//! The two Allan curves of a channel, how they are entered and how repeats are pooled.
//!
//! `allan` is the curve of the settings' estimator and averaging times, `allan_fit` the overlapping
//! Allan deviation that the noise terms are fitted to.

use std::collections::BTreeMap;

use super::noise_fit::NoiseFit;
use super::overlapping::AllanPoint;
use super::variants::{AllanEstimator, AllanVariantPoint};
use crate::metrics::estimate::table::ChannelMetrics;

/// The curve of the settings.
pub(crate) const CURVE: &str = "allan";
/// The curve that is fitted.
pub(crate) const FIT_CURVE: &str = "allan_fit";

/// Columns both curves have.
pub(crate) fn columns_of(points: &[AllanPoint]) -> BTreeMap<String, Vec<f64>> {
    type Pick = fn(&AllanPoint) -> f64;
    let picks: [(&str, Pick); 6] = [
        ("tau_s", |point| point.tau_s),
        ("deviation_deg_per_h", |point| {
            point.deviation_deg_per_h.value
        }),
        ("low_deg_per_h", |point| point.deviation_deg_per_h.low),
        ("high_deg_per_h", |point| point.deviation_deg_per_h.high),
        ("edf", |point| point.degrees_of_freedom),
        // Differences of one record.
        ("count", |point| point.count as f64),
    ];
    picks
        .into_iter()
        .map(|(name, pick)| (name.to_owned(), points.iter().map(pick).collect()))
        .collect()
}

/// The fitted overlapping Allan deviation at the times of a curve.
pub(crate) fn fitted_column(points: &[AllanPoint], fit: &NoiseFit) -> (String, Vec<f64>) {
    let fitted = points
        .iter()
        .map(|point| fit.deviation_deg_per_h(point.tau_s));
    ("fitted_deg_per_h".to_owned(), fitted.collect())
}

/// Enters the curve of the settings with the noise identified at every averaging time.
///
/// `noise_alpha` is the exponent of the rate's spectrum, the word column `noise` its name, the word
/// `estimator` that of the curve. `noise_identified` is 0 where there are too few averaging times and
/// the noise is that of the last one that has enough. The fitted deviation stands beside the Allan
/// deviations only; that of the others is another function of the same terms.
pub(crate) fn put_curve(
    variants: &[AllanVariantPoint],
    estimator: AllanEstimator,
    fit: Option<&NoiseFit>,
    metrics: &mut ChannelMetrics,
) {
    let points: Vec<AllanPoint> = variants.iter().map(|variant| variant.point).collect();
    let mut curve = columns_of(&points);
    let alpha = variants.iter().map(|variant| variant.noise.alpha().into());
    curve.insert("noise_alpha".to_owned(), alpha.collect());
    let identified = variants.iter().map(|variant| variant.noise_identified);
    let identified = identified.map(|known| f64::from(u8::from(known)));
    curve.insert("noise_identified".to_owned(), identified.collect());
    let is_allan = matches!(
        estimator,
        AllanEstimator::Overlapping | AllanEstimator::Plain
    );
    curve.extend(
        fit.filter(|_| is_allan)
            .map(|fit| fitted_column(&points, fit)),
    );
    metrics.curves.insert(CURVE.to_owned(), curve);
    let noise = variants.iter().map(|variant| variant.noise.name());
    put_labels(noise.collect(), estimator.name(), metrics);
}

pub(crate) fn put_labels(
    noise: Vec<&'static str>,
    estimator: &'static str,
    metrics: &mut ChannelMetrics,
) {
    let labels = BTreeMap::from([
        ("estimator".to_owned(), vec![estimator]),
        ("noise".to_owned(), noise),
    ]);
    metrics.curve_labels.insert(CURVE.to_owned(), labels);
}

/// Enters the curve that the noise is fitted to; its column of the fit is absent without one.
pub(crate) fn put_fit_curve(
    points: &[AllanPoint],
    fit: Option<&NoiseFit>,
    metrics: &mut ChannelMetrics,
) {
    let mut curve = columns_of(points);
    curve.extend(fit.map(|fit| fitted_column(points, fit)));
    metrics.curves.insert(FIT_CURVE.to_owned(), curve);
}
