//! Twins of a filter that measure its gain for constant rates of every size.
//!
//! A filter that learns from its input may pass a fast rate and attenuate a slow one. Every twin
//! runs on the words of the filter plus a constant rate, present from the first sample on.

use std::ops::Range;

use super::records::{RecordLength, count};
use crate::experiment::channel_filter::Arithmetic;
use crate::metrics::RateGain;
use crate::units::deg_per_s_to_deg_per_h;

/// The added rates, deg/s.
pub(crate) const RATES_DEG_PER_S: [f64; 11] = [
    0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0,
];

/// Blocks of time whose scatter gives the intervals.
const BLOCKS: usize = 10;

/// One twin.
struct RateTwin {
    rate_deg_per_s: f64,
    filter: Arithmetic,
    /// Sums of its output minus the filter's, deg/h, by block.
    totals: [f64; BLOCKS],
}

/// The twins of one filter.
pub(crate) struct RateTwins {
    twins: Vec<RateTwin>,
    length: RecordLength,
    counts: [u32; BLOCKS],
    /// Sums of the words and of the filter's outputs, deg/h, by block.
    input_totals: [f64; BLOCKS],
    output_totals: [f64; BLOCKS],
    taken: usize,
}

impl RateTwins {
    /// A twin for each rate, made by `filter`.
    pub(crate) fn new(length: RecordLength, filter: impl Fn() -> Arithmetic) -> Self {
        let twins = RATES_DEG_PER_S.iter().map(|&rate_deg_per_s| RateTwin {
            rate_deg_per_s,
            filter: filter(),
            totals: [0.0; BLOCKS],
        });
        Self {
            twins: twins.collect(),
            length,
            counts: [0; BLOCKS],
            input_totals: [0.0; BLOCKS],
            output_totals: [0.0; BLOCKS],
            taken: 0,
        }
    }

    /// Runs every twin on a word of raw, deg/h, of which the filter has made `output_deg_per_h`. A
    /// twin that fails is left out from then on.
    pub(crate) fn step(&mut self, word_deg_per_h: f64, output_deg_per_h: f64) {
        let measured = self.taken.checked_sub(self.length.warm_up);
        let block = measured.map(|index| (index * BLOCKS / self.length.measured).min(BLOCKS - 1));
        self.taken += 1;
        self.twins.retain_mut(|twin| {
            let rate_deg_per_h = deg_per_s_to_deg_per_h(twin.rate_deg_per_s);
            let Ok(output) = twin.filter.step(word_deg_per_h + rate_deg_per_h) else {
                return false;
            };
            if let Some(block) = block {
                twin.totals[block] += output.value_deg_per_h - output_deg_per_h;
            }
            true
        });
        if let Some(block) = block {
            self.counts[block] += 1;
            self.input_totals[block] += word_deg_per_h;
            self.output_totals[block] += output_deg_per_h;
        }
    }

    /// What every twin that is left makes of its rate, block by block.
    pub(crate) fn finish(&self) -> Vec<RateGain> {
        let blocks: Vec<usize> = (0..BLOCKS)
            .filter(|block| self.counts[*block] > 0)
            .collect();
        let twins = self.twins.iter().map(|twin| {
            let rate_deg_per_h = deg_per_s_to_deg_per_h(twin.rate_deg_per_s);
            let gain = |block: usize| {
                twin.totals[block] / (f64::from(self.counts[block]) * rate_deg_per_h)
            };
            let mean_ratio = |block: usize| {
                let added = f64::from(self.counts[block]) * rate_deg_per_h;
                (self.output_totals[block] + twin.totals[block])
                    / (self.input_totals[block] + added)
            };
            RateGain {
                rate_deg_per_s: twin.rate_deg_per_s,
                block_gains: blocks.iter().copied().map(gain).collect(),
                block_mean_ratios: blocks.iter().copied().map(mean_ratio).collect(),
            }
        });
        twins.collect()
    }
}

/// What a twin made of a constant rate that was added to the record, block by block.
///
/// * `input`, `output`, `twin`: measured words, deg/h, of the filter's input, its own and the twin's.
pub(crate) fn rate_gain(
    rate_deg_per_s: f64,
    input: &[f64],
    output: &[f64],
    twin: &[f64],
) -> RateGain {
    let rate_deg_per_h = deg_per_s_to_deg_per_h(rate_deg_per_s);
    let border = |block: usize| (input.len() * block).div_ceil(BLOCKS);
    let blocks = (0..BLOCKS).map(|block| border(block)..border(block + 1));
    let blocks: Vec<_> = blocks.filter(|block| !block.is_empty()).collect();
    let sum = |words: &[f64]| words.iter().sum::<f64>();
    let added = |samples: usize| count(samples) * rate_deg_per_h;
    let difference = |block: &Range<usize>| -> f64 {
        let pairs = twin[block.clone()].iter().zip(&output[block.clone()]);
        pairs.map(|(twin, own)| twin - own).sum()
    };
    let gains = blocks
        .iter()
        .map(|block| difference(block) / added(block.len()));
    let ratios = blocks.iter().map(|block| {
        (sum(&output[block.clone()]) + difference(block))
            / (sum(&input[block.clone()]) + added(block.len()))
    });
    RateGain {
        rate_deg_per_s,
        block_gains: gains.collect(),
        block_mean_ratios: ratios.collect(),
    }
}
