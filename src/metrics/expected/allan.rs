//! How far the Allan variances of a record are expected to scatter, and how they go together.

use std::sync::Arc;

use super::channel::Words;
use crate::metrics::allan::coefficients::NoiseCoefficients;
use crate::metrics::allan::covariance::{FLICKER, Structure, TERMS, WALK, WHITE};
use crate::metrics::allan::least_squares::basis;
use crate::metrics::estimate::blocks::samples_in;

/// Averaging times of a record at which its overlapping Allan variance is read: what does not depend on the
/// noise.
#[derive(Clone, Debug)]
pub struct AllanGeometry {
    period_s: f64,
    factors: Vec<usize>,
    structure: Arc<Structure>,
}

/// Expected Allan variance at an averaging time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExpectedAllan {
    /// Expected variance, (deg/h)^2.
    pub variance: f64,
    /// Degrees of freedom.
    pub freedom: f64,
}

impl AllanGeometry {
    /// The geometry of a record; none where a time is below a word or beyond half of the record.
    #[must_use]
    pub fn new(times_s: &[f64], period_s: f64, duration_s: f64) -> Option<Self> {
        let words = samples_in(duration_s, period_s);
        let factors: Vec<usize> = times_s
            .iter()
            .map(|time_s| samples_in(*time_s, period_s))
            .collect();
        let is_inside = |factor: &usize| (1..=words / 2).contains(factor);
        if !factors.iter().all(is_inside) {
            return None;
        }
        // Second differences of the angles, of which there is one more than words.
        let counts = factors.iter().map(|factor| words + 1 - 2 * factor);
        let structure = Structure::shared(factors.clone(), counts.collect(), None);
        Some(Self {
            period_s,
            factors,
            structure,
        })
    }

    /// Squares of the slow terms and of white noise, in units of one word.
    fn squares(&self, coefficients: &NoiseCoefficients) -> [f64; TERMS] {
        let mut squares = [0.0; TERMS];
        squares[WHITE] = coefficients.angle_random_walk_deg_per_h_sqrt_s.powi(2);
        squares[FLICKER] = coefficients.bias_instability_deg_per_h.powi(2);
        squares[WALK] = coefficients.rate_random_walk_deg_per_h_per_sqrt_s.powi(2);
        for (term, square) in squares.iter_mut().enumerate() {
            *square *= basis(term, self.period_s) / basis(term, 1.0);
        }
        squares
    }

    /// Expected Allan variance at one of the times.
    ///
    /// The noise of the words comes in by its autocovariance R, so that the loop is in it:
    /// `(m R_0 + 2 sum_k<m (m - k) R_k - sum_k<2m min(k, 2m - k) R_k) / m^2`.
    #[must_use]
    pub fn expected(
        &self,
        place: usize,
        words: &Words,
        coefficients: &NoiseCoefficients,
    ) -> ExpectedAllan {
        let factor = self.factors[place];
        let m = factor as f64;
        let lags = words.autocovariance.iter().enumerate().take(2 * factor);
        let noise: f64 = lags
            .map(|(lag, own)| {
                let k = lag as f64;
                let within = if lag == 0 { m } else { 2.0 * (m - k).max(0.0) };
                (within - k.min(2.0 * m - k)) * own
            })
            .sum();
        let slow = NoiseCoefficients {
            angle_random_walk_deg_per_h_sqrt_s: 0.0,
            ..*coefficients
        };
        let time_s = m * self.period_s;
        let squares = self.squares(coefficients);
        let of_terms: f64 = [WHITE, FLICKER, WALK]
            .iter()
            .map(|term| squares[*term] * basis(*term, m))
            .sum();
        let scatter = self.structure.covariance(place, place, &squares);
        ExpectedAllan {
            variance: noise / (m * m) + slow.allan_variance(time_s),
            freedom: (2.0 * of_terms * of_terms / scatter).max(1.0),
        }
    }

    /// Correlation of the Allan variances at two of the times.
    #[must_use]
    pub fn correlation(&self, one: usize, other: usize, coefficients: &NoiseCoefficients) -> f64 {
        let squares = self.squares(coefficients);
        let of = |one, other| self.structure.covariance(one, other, &squares);
        let scale = (of(one, one) * of(other, other)).sqrt();
        if scale > 0.0 {
            (of(one, other) / scale).clamp(-1.0, 1.0)
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::overlapping_allan_at;
    use crate::random::Streams;

    fn words(autocovariance: Vec<f64>) -> Words {
        Words {
            autocovariance,
            mean_deg_per_h: 0.0,
            walk_scatter: 0.0,
            slow_deviation_deg_per_h: 0.0,
            sine: None,
            period_s: 0.01,
            warm_up_s: 0.0,
            duration_s: 40.0,
        }
    }

    #[test]
    fn variance_freedom_and_correlation_are_those_of_drawn_records() {
        // A mean of two unit normals: R = 1/2, 1/4.
        let words = words(vec![0.5, 0.25]);
        let coefficients = NoiseCoefficients {
            angle_random_walk_deg_per_h_sqrt_s: 0.1,
            ..NoiseCoefficients::default()
        };
        let times_s = [0.02, 0.2, 0.4];
        let geometry = AllanGeometry::new(&times_s, 0.01, 40.0).expect("a geometry");
        let records = 400;
        let mut stream = Streams::new(1, 0).stream("test");
        let mut drawn: Vec<[f64; 3]> = Vec::new();
        for _ in 0..records {
            let normals: Vec<f64> = (0..4001).map(|_| stream.normal()).collect();
            let rate: Vec<f64> = normals
                .windows(2)
                .map(|two| 0.5 * (two[0] + two[1]))
                .collect();
            let points = overlapping_allan_at(&rate, 0.01, &[2, 20, 40]);
            drawn.push(std::array::from_fn(|place| points[place].variance()));
        }
        let mean = |of: &dyn Fn(&[f64; 3]) -> f64| drawn.iter().map(of).sum::<f64>() / 400.0;
        let means: [f64; 3] = std::array::from_fn(|place| mean(&|own| own[place]));
        for place in 0..3 {
            let expected = geometry.expected(place, &words, &coefficients);
            let variance = mean(&|own| (own[place] - means[place]).powi(2));
            let standard_error = (variance / 400.0).sqrt();
            assert!(
                (means[place] - expected.variance).abs() < 4.0 * standard_error,
                "{place}: {} {}",
                means[place],
                expected.variance
            );
            // The loop is not in the freedom: of two words it matters.
            let freedom = 2.0 * means[place] * means[place] / variance;
            let allowed = if place == 0 { 0.4 } else { 0.3 };
            assert!(
                (freedom / expected.freedom - 1.0).abs() < allowed,
                "{place}: {freedom} {}",
                expected.freedom
            );
        }
        let product = mean(&|own| (own[1] - means[1]) * (own[2] - means[2]));
        let squares = [1, 2].map(|place| mean(&|own| (own[place] - means[place]).powi(2)));
        let found = product / (squares[0] * squares[1]).sqrt();
        let expected = geometry.correlation(1, 2, &coefficients);
        assert!((found - expected).abs() < 0.15, "{found} {expected}");
    }

    #[test]
    fn a_time_beyond_half_of_the_record_has_none() {
        assert!(AllanGeometry::new(&[20.0], 0.01, 40.0).is_some());
        assert!(AllanGeometry::new(&[20.1], 0.01, 40.0).is_none());
    }
}
