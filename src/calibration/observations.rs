//! Group means: what the estimators see of a record.
//!
//! A group is one mounting at one constant rate, minutes long. Its noise averages down as
//! `ARW / sqrt(t)`: 0.05 deg/sqrt(h) over 600 s leaves 0.12 deg/h. Three things do not average down and
//! are dealt with here: outliers, of which 0.2 % at 50 standard deviations raise that error two and a
//! half times; horizontal Earth rate over a part of a turn, up to 0.2 deg/h at 10 deg/s over 600 s;
//! and the temperature, which belongs to the same stretch of time as the outputs.

use super::design::GroupDesign;
use super::error::{AXES, CalibrationError};
use super::reference::whole_turns_s;

/// One group of samples, reduced to means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroupObservation {
    /// Rates and temperatures of the group.
    pub design: GroupDesign,
    /// Mean outputs of the gyros x, y, z, deg/s.
    pub output_deg_per_s: [f64; 3],
    /// Standard errors of these means, deg/s; 0 for noise-free data.
    pub standard_error_deg_per_s: [f64; 3],
}

/// Checks that all numbers of all groups are usable.
pub(super) fn check_groups(groups: &[GroupObservation]) -> Result<(), CalibrationError> {
    for (index, group) in groups.iter().enumerate() {
        let design = &group.design;
        let finite: [(&'static str, [f64; 3]); 5] = [
            ("reference rate (deg/s)", design.reference_rate_deg_per_s),
            ("temperature (deg C)", design.temperature_c),
            (
                "temperature rate (K/min)",
                design.temperature_rate_k_per_min,
            ),
            ("output (deg/s)", group.output_deg_per_s),
            ("standard error (deg/s)", group.standard_error_deg_per_s),
        ];
        for (quantity, values) in finite {
            let is_error = quantity.starts_with("standard");
            for (axis, value) in AXES.into_iter().zip(values) {
                if !value.is_finite() || (is_error && value < 0.0) {
                    return Err(CalibrationError::BadValue {
                        group: index + 1,
                        quantity,
                        axis,
                        value,
                        expected: if is_error { ">= 0" } else { "a finite number" },
                    });
                }
            }
        }
    }
    Ok(())
}

/// Threshold of the rejection of outliers in robust standard deviations.
///
/// A normal sample lies beyond 4 with a probability of 6.3e-5: of 6000 samples none or one goes.
pub const OUTLIER_THRESHOLD: f64 = 4.0;

/// Factor `1 / Phi^-1(3/4)`.
///
/// Median absolute deviation of a normal distribution times this is its standard deviation.
const MAD_TO_STD: f64 = 1.4826;
/// Factor `sqrt(pi / 2)`.
///
/// Mean absolute deviation of a normal distribution times this is its standard deviation.
const MEAN_DEVIATION_TO_STD: f64 = 1.2533;
/// Blocks that the standard error of a mean rests on: few enough to be longer than the correlation of
/// the samples, enough to know their spread to 16 %.
const BLOCKS: usize = 20;

/// The samples of one group.
#[derive(Clone, Copy, Debug)]
pub struct GroupSamples<'a> {
    /// Outputs of the gyros x, y, z, deg/s, equally spaced.
    pub output_deg_per_s: [&'a [f64]; 3],
    /// Temperatures of the gyros over the group, deg C, equally spaced at any rate, at least one each.
    pub temperature_c: [&'a [f64]; 3],
    /// Output sample rate, Hz.
    pub sample_rate_hz: f64,
}

/// How long to average.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Averaging {
    /// The longest whole turns of a table at this rate, deg/s; all samples at rest.
    WholeTurns(f64),
    /// All samples.
    FixedTime,
}

/// Means of one group.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct GroupMeans {
    /// Mean outputs of the gyros x, y, z, deg/s.
    pub output_deg_per_s: [f64; 3],
    /// Standard errors of these, deg/s: from block means, so that correlated noise is allowed for.
    pub standard_error_deg_per_s: [f64; 3],
    /// Mean temperatures of the gyros over the same time, deg C.
    pub temperature_c: [f64; 3],
    /// Mean rates of these between the ends, K/min; 0 with fewer than two readings.
    pub temperature_rate_k_per_min: [f64; 3],
    /// Outputs rejected as outliers.
    pub rejected: [usize; 3],
    /// Outputs averaged over, rejected ones included.
    pub samples: usize,
    /// Time averaged over, s.
    pub averaging_time_s: f64,
}

impl GroupMeans {
    /// The observation of these means at a reference rate.
    #[must_use]
    pub fn at_rate(&self, reference_rate_deg_per_s: [f64; 3]) -> GroupObservation {
        GroupObservation {
            design: GroupDesign {
                reference_rate_deg_per_s,
                temperature_c: self.temperature_c,
                temperature_rate_k_per_min: self.temperature_rate_k_per_min,
            },
            output_deg_per_s: self.output_deg_per_s,
            standard_error_deg_per_s: self.standard_error_deg_per_s,
        }
    }
}

/// Means of a group without its outliers.
///
/// Rejects `|x - median| > k 1.4826 MAD`; where more than half of the samples are equal (a coarse
/// converter), 1.2533 times the mean absolute deviation takes the place of the median one.
///
/// * `outlier_threshold`: k, usually [`OUTLIER_THRESHOLD`]; none keeps all.
///
/// # Errors
/// [`CalibrationError::TooFewSamples`] with fewer than 40 outputs or no temperature;
/// [`CalibrationError::NoWholeTurn`] if a turning table makes less than one turn.
pub fn group_means(
    samples: &GroupSamples<'_>,
    averaging: Averaging,
    outlier_threshold: Option<f64>,
) -> Result<GroupMeans, CalibrationError> {
    let available = samples.output_deg_per_s.map(<[f64]>::len).into_iter().min();
    let available = available.unwrap_or_default();
    let count = averaged_samples(averaging, available, samples.sample_rate_hz)?;
    let share = count_to_f64(count) / count_to_f64(available.max(1));
    let averaging_time_s = count_to_f64(count) / samples.sample_rate_hz;
    let mut means = GroupMeans {
        output_deg_per_s: [0.0; 3],
        standard_error_deg_per_s: [0.0; 3],
        temperature_c: [0.0; 3],
        temperature_rate_k_per_min: [0.0; 3],
        rejected: [0; 3],
        samples: count,
        averaging_time_s,
    };
    for (axis, name) in AXES.into_iter().enumerate() {
        let outputs = samples.output_deg_per_s[axis];
        if count < 2 * BLOCKS || samples.temperature_c[axis].is_empty() {
            return Err(CalibrationError::TooFewSamples {
                axis: name,
                count: count.min(outputs.len()),
                needed: 2 * BLOCKS,
            });
        }
        let kept = without_outliers(&outputs[..count], outlier_threshold);
        means.rejected[axis] = count - kept.iter().flatten().count();
        means.output_deg_per_s[axis] = mean(kept.iter().flatten());
        means.standard_error_deg_per_s[axis] = block_standard_error(&kept);
        let all = samples.temperature_c[axis];
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a share of a count, 0 < share <= 1"
        )]
        let used = ((count_to_f64(all.len()) * share).round() as usize).clamp(1, all.len());
        means.temperature_c[axis] = mean(&all[..used]);
        if used > 1 {
            let span_min = averaging_time_s / 60.0 * (1.0 - 1.0 / count_to_f64(used));
            means.temperature_rate_k_per_min[axis] = (all[used - 1] - all[0]) / span_min;
        }
    }
    Ok(means)
}

/// Samples to average, from the first: all, or the longest whole turns.
fn averaged_samples(
    averaging: Averaging,
    available: usize,
    sample_rate_hz: f64,
) -> Result<usize, CalibrationError> {
    let Averaging::WholeTurns(rate) = averaging else {
        return Ok(available);
    };
    if rate.abs() < f64::MIN_POSITIVE {
        return Ok(available);
    }
    let duration_s = count_to_f64(available) / sample_rate_hz;
    let Some((time_s, _)) = whole_turns_s(rate, duration_s) else {
        return Err(CalibrationError::NoWholeTurn {
            duration_s,
            turn_s: 360.0 / rate.abs(),
        });
    };
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and a count"
    )]
    let count = (time_s * sample_rate_hz).round() as usize;
    Ok(count.min(available))
}

/// The samples in their places, outliers left out.
fn without_outliers(samples: &[f64], threshold: Option<f64>) -> Vec<Option<f64>> {
    let Some(threshold) = threshold else {
        return samples.iter().copied().map(Some).collect();
    };
    let centre = median(samples.to_vec());
    let deviations: Vec<f64> = samples
        .iter()
        .map(|sample| (sample - centre).abs())
        .collect();
    let spread = match MAD_TO_STD * median(deviations.clone()) {
        none if none <= 0.0 => MEAN_DEVIATION_TO_STD * mean(&deviations),
        spread => spread,
    };
    let pairs = samples.iter().zip(deviations);
    pairs
        .map(|(sample, deviation)| (deviation <= threshold * spread).then_some(*sample))
        .collect()
}

/// Middle value, or the mean of the two; NaN sorts to the end.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len() % 2 == 1 {
        values[middle]
    } else {
        0.5 * (values[middle - 1] + values[middle])
    }
}

fn mean<'a>(values: impl IntoIterator<Item = &'a f64>) -> f64 {
    let (sum, count) = values
        .into_iter()
        .fold((0.0, 0_usize), |(sum, count), value| {
            (sum + value, count + 1)
        });
    sum / count_to_f64(count.max(1))
}

/// Standard deviation of the means of 20 blocks over sqrt(20): safe with correlation shorter than a
/// block; its own relative error is 16 %.
fn block_standard_error(kept: &[Option<f64>]) -> f64 {
    let blocks: Vec<f64> = (0..BLOCKS)
        .map(|block| &kept[block * kept.len() / BLOCKS..(block + 1) * kept.len() / BLOCKS])
        .filter(|block| block.iter().flatten().count() > 0)
        .map(|block| mean(block.iter().flatten()))
        .collect();
    let centre = mean(&blocks);
    let count = count_to_f64(blocks.len());
    let squares: f64 = blocks.iter().map(|block| (block - centre).powi(2)).sum();
    (squares / (count - 1.0).max(1.0) / count.max(1.0)).sqrt()
}

#[expect(
    clippy::cast_precision_loss,
    reason = "counts of samples are exact in f64"
)]
fn count_to_f64(count: usize) -> f64 {
    count as f64
}
