//! Gain of a filter at rates of the table.

use crate::metrics::estimate::interval;
use crate::metrics::estimate::table::ChannelMetrics;
use crate::metrics::key::curve::{Column, CurveKey};
use crate::metrics::record::{FilterFacts, RateGain};

/// Rate.
pub static RATE: Column = Column::new("rate_deg_per_s", "deg/s", "constant rate that was added");

/// Gain.
pub static GAIN: Column = Column::new("gain", "1", "change of the output over the added rate");

/// Lower end of the gain.
pub static GAIN_LOW: Column = Column::low("gain_low", &GAIN);

/// Upper end of the gain.
pub static GAIN_HIGH: Column = Column::high("gain_high", &GAIN);

/// Mean ratio.
pub static MEAN_RATIO: Column = Column::new("mean_ratio", "1", "mean output over mean input");

/// Lower end of the mean ratio.
pub static MEAN_RATIO_LOW: Column = Column::low("mean_ratio_low", &MEAN_RATIO);

/// Upper end of the mean ratio.
pub static MEAN_RATIO_HIGH: Column = Column::high("mean_ratio_high", &MEAN_RATIO);

/// Columns of [`RATE_GAIN`].
const COLUMNS: &[&Column; 7] = &[
    &RATE,
    &GAIN,
    &GAIN_LOW,
    &GAIN_HIGH,
    &MEAN_RATIO,
    &MEAN_RATIO_LOW,
    &MEAN_RATIO_HIGH,
];

/// Gain over the rate.
pub static RATE_GAIN: CurveKey = CurveKey::new(
    "rate_gain",
    COLUMNS,
    "gain of a filter free to adapt at constant rates present from the first sample on",
)
.picture("rate-gain.svg");

/// Enters the gain over the rate: Student's t on the blocks.
pub(crate) fn put_rate_gains(facts: &FilterFacts, metrics: &mut ChannelMetrics) {
    if facts.rate_gains.is_empty() {
        return;
    }
    let row = |rate: &RateGain| {
        let pooled = |blocks: &[f64]| interval::from_parts(interval::mean(blocks), blocks);
        let gain = pooled(&rate.block_gains);
        let ratio = pooled(&rate.block_mean_ratios);
        [
            rate.rate_deg_per_s,
            gain.value,
            gain.low,
            gain.high,
            ratio.value,
            ratio.low,
            ratio.high,
        ]
    };
    let rows: Vec<[f64; 7]> = facts.rate_gains.iter().map(row).collect();
    let columns = COLUMNS.iter().enumerate();
    let columns = columns.map(|(at, column)| (*column, rows.iter().map(|row| row[at]).collect()));
    metrics.put_curve(&RATE_GAIN, columns);
}
