//! Gain of a filter at rates of the table.

use std::collections::BTreeMap;

use crate::metrics::estimate::interval;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::record::FilterFacts;

/// Enters the curve `rate_gain`: Student's t on the blocks.
pub(crate) fn put_rate_gains(facts: &FilterFacts, metrics: &mut ChannelMetrics) {
    let mut curve: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for rate in &facts.rate_gains {
        let pooled = |blocks: &[f64]| interval::from_parts(interval::mean(blocks), blocks);
        let gain = pooled(&rate.block_gains);
        let ratio = pooled(&rate.block_mean_ratios);
        for (column, value) in [
            ("rate_deg_per_s", rate.rate_deg_per_s),
            ("gain", gain.value),
            ("gain_low", gain.low),
            ("gain_high", gain.high),
            ("mean_ratio", ratio.value),
            ("mean_ratio_low", ratio.low),
            ("mean_ratio_high", ratio.high),
        ] {
            curve.entry(column.to_owned()).or_default().push(value);
        }
    }
    if !curve.is_empty() {
        metrics.curves.insert("rate_gain".to_owned(), curve);
    }
}
