//! Pooling of curves over repeats.

use super::pooling::Pooling;
use crate::metrics::catalogue::known_curves;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::key::curve::{Column, CurveKey, CurvePool};

/// Pools the curves but for the Allan curves, whose pooling fits the noise terms again.
pub(crate) fn pool_curves(repeats: &Pooling, pooled: &mut ChannelMetrics) {
    for key in known_curves() {
        match key.pool {
            CurvePool::AllanVariance => {}
            CurvePool::Power | CurvePool::Points => pool_points(key, repeats, pooled),
        }
    }
}

/// Averages the columns of a curve; the intervals of its points shrink with the root of the number of
/// repeats. What powers go with is that of the first repeat. A curve that one repeat lacks, or has at other points, is left out.
fn pool_points(key: &CurveKey, repeats: &Pooling, pooled: &mut ChannelMetrics) {
    let first = repeats.first.as_ref();
    let Some(first) = first.and_then(|repeat| repeat.curve(key)) else {
        return;
    };
    let shrink = 1.0 / (repeats.count as f64).sqrt();
    let mean = |column: &Column| repeats.mean_of(key, column);
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
