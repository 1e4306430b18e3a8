//! Pooling of curves over repeats.

use std::collections::BTreeMap;

use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::noise::spectrum::TWO_SIDED_PSD;

/// Curves of points that have intervals of their own.
const POINT_CURVES: [&str; 8] = [
    "autocovariance",
    "response",
    "scale_factor",
    "frequency_response",
    "frequency_response_vs_raw",
    "frozen_response",
    "noise_delay_bound",
    "rate_gain",
];

/// Column of a curve in every repeat; `None` unless all have it in the same length.
pub(crate) fn columns<'a>(
    repeats: &'a [ChannelMetrics],
    curve: &str,
    column: &str,
) -> Option<Vec<&'a Vec<f64>>> {
    let found: Option<Vec<&Vec<f64>>> = repeats
        .iter()
        .map(|repeat| repeat.curves.get(curve)?.get(column))
        .collect();
    found.filter(|all| !all.is_empty() && all.iter().all(|one| one.len() == all[0].len()))
}

/// Mean over the repeats of `transform(value)`, entry by entry.
pub(crate) fn mean_of(columns: &[&Vec<f64>], transform: fn(f64) -> f64) -> Vec<f64> {
    (0..columns[0].len())
        .map(|index| {
            let sum: f64 = columns.iter().map(|column| transform(column[index])).sum();
            sum / columns.len() as f64
        })
        .collect()
}

pub(crate) fn pool_spectra(repeats: &[ChannelMetrics], pooled: &mut ChannelMetrics) {
    let frequency = columns(repeats, "psd", "frequency_hz");
    let density = columns(repeats, "psd", "psd_deg2_per_h2_per_hz");
    if let (Some(frequency), Some(density)) = (frequency, density) {
        let curve = BTreeMap::from([
            ("frequency_hz".to_owned(), frequency[0].clone()),
            (
                "psd_deg2_per_h2_per_hz".to_owned(),
                mean_of(&density, std::convert::identity),
            ),
            (
                TWO_SIDED_PSD.to_owned(),
                mean_of(&density, |value| value / 2.0),
            ),
        ]);
        pooled.curves.insert("psd".to_owned(), curve);
    }
}

/// Averages the curves whose points have intervals of their own, which shrink with the root of the
/// number of repeats.
pub(crate) fn pool_points(repeats: &[ChannelMetrics], pooled: &mut ChannelMetrics) {
    let shrink = 1.0 / (repeats.len() as f64).sqrt();
    for name in POINT_CURVES {
        let Some(first) = repeats.first().and_then(|repeat| repeat.curves.get(name)) else {
            continue;
        };
        let mean = |column: &str| {
            let found = columns(repeats, name, column)?;
            Some(mean_of(&found, std::convert::identity))
        };
        let pool = |column: &String| {
            let own = mean(column)?;
            let middle = ["_low", "_high"]
                .iter()
                .find(|end| column.contains(*end))
                .and_then(|end| mean(&column.replace(end, "")));
            let values = match middle {
                Some(middle) => own
                    .iter()
                    .zip(&middle)
                    .map(|(end, middle)| middle + shrink * (end - middle))
                    .collect(),
                None => own,
            };
            Some((column.clone(), values))
        };
        let curve: Option<BTreeMap<String, Vec<f64>>> = first.keys().map(pool).collect();
        if let Some(curve) = curve {
            pooled.curves.insert(name.to_owned(), curve);
        }
    }
}
