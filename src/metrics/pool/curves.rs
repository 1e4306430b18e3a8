//! Pooling of curves over repeats.

use crate::metrics::catalogue::known_curves;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::key::curve::{Column, CurveKey, CurvePool};

/// Pools the curves but for the Allan curves, whose pooling fits the noise terms again.
pub(crate) fn pool_curves(repeats: &[ChannelMetrics], pooled: &mut ChannelMetrics) {
    for key in known_curves() {
        match key.pool {
            CurvePool::AllanVariance => {}
            CurvePool::Power | CurvePool::Points => pool_points(key, repeats, pooled),
        }
    }
}

/// Column of a curve in every repeat; `None` unless all have it in the same length.
pub(crate) fn columns<'a>(
    repeats: &'a [ChannelMetrics],
    curve: &CurveKey,
    column: &Column,
) -> Option<Vec<&'a [f64]>> {
    let found: Option<Vec<&[f64]>> = repeats
        .iter()
        .map(|repeat| column.get(repeat.curve(curve)?))
        .collect();
    found.filter(|all| !all.is_empty() && all.iter().all(|one| one.len() == all[0].len()))
}

/// Mean over the repeats of `transform(value)`, entry by entry.
pub(crate) fn mean_of(columns: &[&[f64]], transform: fn(f64) -> f64) -> Vec<f64> {
    (0..columns[0].len())
        .map(|index| {
            let sum: f64 = columns.iter().map(|column| transform(column[index])).sum();
            sum / columns.len() as f64
        })
        .collect()
}

/// Averages the columns of a curve; the intervals of its points shrink with the root of the number of
/// repeats. What powers go with is that of the first repeat. A curve that one repeat lacks, or has at other points, is left out.
fn pool_points(key: &CurveKey, repeats: &[ChannelMetrics], pooled: &mut ChannelMetrics) {
    let Some(first) = repeats.first().and_then(|repeat| repeat.curve(key)) else {
        return;
    };
    let shrink = 1.0 / (repeats.len() as f64).sqrt();
    let mean = |column: &Column| {
        let found = columns(repeats, key, column)?;
        Some(mean_of(&found, std::convert::identity))
    };
    let pool = |column: &&'static Column| {
        if key.pool == CurvePool::Power && key.columns.first() == Some(column) {
            return Some((*column, column.of(first).to_vec()));
        }
        let own = mean(column)?;
        let values = match column.end_of.and_then(mean) {
            Some(middle) => own
                .iter()
                .zip(&middle)
                .map(|(end, middle)| middle + shrink * (end - middle))
                .collect(),
            None => own,
        };
        Some((*column, values))
    };
    let present = key
        .columns
        .iter()
        .filter(|column| column.get(first).is_some());
    let curve: Option<Vec<_>> = present.map(pool).collect();
    if let Some(curve) = curve {
        pooled.put_curve(key, curve);
    }
}
