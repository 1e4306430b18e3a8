//! How far the block means of a record are expected to scatter.

use nalgebra::DMatrix;

use super::channel::ChannelTheory;
use crate::metrics::allan::coefficients::NoiseCoefficients;
use crate::metrics::noise::bias_stability::block_covariance;

/// Slow terms of which the covariance of block means is made.
const TERMS: usize = 3;
/// Ways in which a term comes into a pair of channels: by both outputs, by one and the other's pull of the
/// mean, by the other and the one's, by both pulls.
const WAYS: usize = 4;
/// Matrices of which the covariance of the block means of two channels is made; the last one is that of
/// a gain of its own.
const PARTS: usize = TERMS * WAYS + 1;

/// Geometry of the block means of a record: what does not depend on the noise.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockGeometry {
    count: usize,
    averaging_time_s: f64,
    traces: [f64; PARTS],
    products: Vec<[f64; PARTS]>,
}

/// Expected squares and degrees of freedom of the bias stability of a channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExpectedBlocks {
    /// Expected square, (deg/h)^2.
    pub square: f64,
    /// Degrees of freedom of the square.
    pub freedom: f64,
}

impl BlockGeometry {
    /// The geometry of so many blocks behind a warm-up; none of fewer than two.
    #[must_use]
    pub fn new(averaging_time_s: f64, count: usize, warm_up_s: f64) -> Option<Self> {
        if count < 2 || averaging_time_s <= 0.0 {
            return None;
        }
        let running = running_means(averaging_time_s, count, warm_up_s);
        let terms = unit_terms();
        let mut parts = Vec::with_capacity(PARTS);
        for term in &terms {
            let covariance = with_warm_up(term, averaging_time_s, count, warm_up_s);
            // The blocks stand behind the warm-up.
            let behind = |whole: &DMatrix<f64>| whole.columns(1, count).into_owned();
            let pulled = &running * &covariance;
            parts.push(covariance.view((1, 1), (count, count)).into_owned());
            parts.push(behind(&pulled).transpose());
            parts.push(behind(&pulled));
            parts.push(&pulled * running.transpose());
        }
        parts.push(gain_covariance(averaging_time_s, count, warm_up_s));
        for part in &mut parts {
            centre(part);
        }
        let products = parts
            .iter()
            .map(|left| std::array::from_fn(|other| left.component_mul(&parts[other]).sum()));
        Some(Self {
            count,
            averaging_time_s,
            traces: std::array::from_fn(|part| parts[part].trace()),
            products: products.collect(),
        })
    }

    /// What comes into the covariance of two channels.
    fn shares(
        own: &ChannelTheory,
        other: &ChannelTheory,
        coefficients: &NoiseCoefficients,
        mean_deg_per_h: f64,
        is_same: bool,
    ) -> [f64; PARTS] {
        let powers = [
            coefficients.angle_random_walk_deg_per_h_sqrt_s,
            coefficients.bias_instability_deg_per_h,
            coefficients.rate_random_walk_deg_per_h_per_sqrt_s,
        ]
        .map(|value| value * value);
        let ways = [
            own.dc_gain * other.dc_gain,
            own.dc_gain * other.mean_pull,
            own.mean_pull * other.dc_gain,
            own.mean_pull * other.mean_pull,
        ];
        std::array::from_fn(|part| match part {
            _ if part < TERMS * WAYS => powers[part / WAYS] * ways[part % WAYS],
            _ if is_same => mean_deg_per_h.powi(2) * own.gain_variance_s,
            _ => 0.0,
        })
    }

    fn square_sum(&self, shares: &[f64; PARTS]) -> f64 {
        let rows = shares.iter().zip(&self.products);
        rows.map(|(own, row)| own * row.iter().zip(shares).map(|(a, b)| a * b).sum::<f64>())
            .sum()
    }

    /// Expected bias stability of a channel.
    #[must_use]
    pub fn expected(
        &self,
        channel: &ChannelTheory,
        coefficients: &NoiseCoefficients,
        mean_deg_per_h: f64,
    ) -> ExpectedBlocks {
        let shares = Self::shares(channel, channel, coefficients, mean_deg_per_h, true);
        let trace: f64 = shares.iter().zip(&self.traces).map(|(a, b)| a * b).sum();
        let squares = self.square_sum(&shares);
        let most = self.count as f64 - 1.0;
        ExpectedBlocks {
            square: trace / most,
            freedom: (trace * trace / squares).clamp(1.0, most),
        }
    }

    /// Correlation of the squares of two channels of one record.
    #[must_use]
    pub fn correlation(
        &self,
        (own, other): (&ChannelTheory, &ChannelTheory),
        coefficients: &NoiseCoefficients,
        mean_deg_per_h: f64,
    ) -> f64 {
        let of = |own, other, is_same| {
            self.square_sum(&Self::shares(
                own,
                other,
                coefficients,
                mean_deg_per_h,
                is_same,
            ))
        };
        let scale = (of(own, own, true) * of(other, other, true)).sqrt();
        if scale > 0.0 {
            (of(own, other, false) / scale).clamp(0.0, 1.0)
        } else {
            0.0
        }
    }
}

/// Takes the means of rows and columns off.
fn centre(matrix: &mut DMatrix<f64>) {
    let rows = matrix.column_mean();
    for mut column in matrix.column_iter_mut() {
        column -= &rows;
    }
    let columns = matrix.row_mean();
    for mut row in matrix.row_iter_mut() {
        row -= &columns;
    }
}

/// The slow terms, each of coefficient 1.
fn unit_terms() -> [NoiseCoefficients; TERMS] {
    let none = NoiseCoefficients::default();
    [
        NoiseCoefficients {
            angle_random_walk_deg_per_h_sqrt_s: 1.0,
            ..none
        },
        NoiseCoefficients {
            bias_instability_deg_per_h: 1.0,
            ..none
        },
        NoiseCoefficients {
            rate_random_walk_deg_per_h_per_sqrt_s: 1.0,
            ..none
        },
    ]
}

/// Generalised covariance of the mean of the warm-up and the block means behind it.
fn with_warm_up(
    term: &NoiseCoefficients,
    averaging_time_s: f64,
    count: usize,
    warm_up_s: f64,
) -> DMatrix<f64> {
    let by_distance: Vec<f64> = (0..=count + 1)
        .map(|distance| block_covariance(term, averaging_time_s, distance))
        .collect();
    let white = term.angle_random_walk_deg_per_h_sqrt_s.powi(2);
    DMatrix::from_fn(count + 1, count + 1, |row, column| match (row, column) {
        (0, 0) if warm_up_s > 0.0 && white > 0.0 => white / warm_up_s,
        _ => by_distance[row.abs_diff(column)],
    })
}

/// Means over each block of the running mean since the start, as weights of the warm-up and the blocks.
fn running_means(averaging_time_s: f64, count: usize, warm_up_s: f64) -> DMatrix<f64> {
    let t = averaging_time_s;
    let mut running = DMatrix::zeros(count, count + 1);
    for row in 0..count {
        let mut left = 1.0;
        if let Some(reciprocal) = mean_reciprocal(t, row, warm_up_s) {
            running[(row, 0)] = warm_up_s * reciprocal;
            left -= running[(row, 0)];
            for column in 0..row {
                running[(row, column + 1)] = t * reciprocal;
                left -= t * reciprocal;
            }
        }
        running[(row, row + 1)] = left;
    }
    running
}

/// Mean of one over the time since the start over a block, 1/s; none of the first without warm-up.
fn mean_reciprocal(averaging_time_s: f64, block: usize, warm_up_s: f64) -> Option<f64> {
    let from = warm_up_s + averaging_time_s * block as f64;
    (from > 0.0).then(|| ((from + averaging_time_s) / from).ln() / averaging_time_s)
}

/// Covariance of block means of what has the covariance `1 / max(s, t)`, 1/s.
fn gain_covariance(averaging_time_s: f64, count: usize, warm_up_s: f64) -> DMatrix<f64> {
    let t = averaging_time_s;
    DMatrix::from_fn(count, count, |row, column| {
        let later = row.max(column);
        let from = warm_up_s + t * later as f64;
        let reciprocal = mean_reciprocal(t, later, warm_up_s);
        if row == column {
            2.0 / t - 2.0 * from / t * reciprocal.unwrap_or(0.0)
        } else {
            reciprocal.unwrap_or(0.0)
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::noise::bias_stability::{
        effective_degrees_of_freedom, expected_bias_stability,
    };

    #[test]
    fn blocks_of_raw_are_those_of_the_bias_stability() {
        let coefficients = NoiseCoefficients {
            angle_random_walk_deg_per_h_sqrt_s: 0.36,
            bias_instability_deg_per_h: 0.05,
            rate_random_walk_deg_per_h_per_sqrt_s: 5e-4,
            ..NoiseCoefficients::default()
        };
        let geometry = BlockGeometry::new(100.0, 35, 60.0).expect("blocks");
        let found = geometry.expected(&ChannelTheory::raw(), &coefficients, 8.0);
        let value = expected_bias_stability(&coefficients, 100.0, 35);
        let freedom = effective_degrees_of_freedom(&coefficients, 100.0, 35);
        assert!(
            (found.square.sqrt() / value - 1.0).abs() < 2e-3,
            "{} {value}",
            found.square.sqrt()
        );
        assert!(
            (found.freedom / freedom - 1.0).abs() < 1e-9,
            "{} {freedom}",
            found.freedom
        );
        let raw = ChannelTheory::raw();
        let correlation = geometry.correlation((&raw, &raw), &coefficients, 8.0);
        assert!((correlation - 1.0).abs() < 1e-9, "{correlation}");
    }
}
