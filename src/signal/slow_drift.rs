//! Slow noise of a gyro in closed form: how the means of stretches of a record scatter over seeds.

/// Slow noise as a sum of exponentially correlated processes and a random walk that starts at 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SlowDrift {
    /// Variance, (deg/h)^2, and correlation time, s, of each process; a time without bound is that of
    /// a bias drawn at the start.
    pub processes: Vec<(f64, f64)>,
    /// Growth of the walk's variance, (deg/h)^2 per s.
    pub walk_deg2_per_h2_per_s: f64,
}

impl SlowDrift {
    /// Covariance over seeds of the means over two stretches that are the same or apart, each from
    /// its first to its last instant, s from the start of the gyro; (deg/h)^2.
    #[must_use]
    pub fn mean_covariance(&self, one: [f64; 2], other: [f64; 2]) -> f64 {
        let (first, second) = if one[0] <= other[0] {
            (one, other)
        } else {
            (other, one)
        };
        let is_same = first[1] > second[0];
        let [length, other_length] = [first, second].map(|ends| ends[1] - ends[0]);
        let processes = self.processes.iter().map(|&(variance, time_s)| {
            if time_s.is_infinite() {
                return variance;
            }
            let [own, other] = [length, other_length].map(|it| it / time_s);
            let mean = |x: f64| -(-x).exp_m1() / x;
            if !is_same {
                return variance
                    * (-(second[0] - first[1]) / time_s).exp()
                    * mean(own)
                    * mean(other);
            }
            // 2 (x - 1 + e^-x) / x^2, whose terms cancel at small x.
            let of_mean = if own < 1e-4 {
                1.0 - own / 3.0
            } else {
                2.0 * (1.0 - mean(own)) / own
            };
            variance * of_mean
        });
        let walked = if is_same {
            first[0] + length / 3.0
        } else {
            first[0] + length / 2.0
        };
        processes.sum::<f64>() + self.walk_deg2_per_h2_per_s * walked
    }

    /// Variance over seeds of the mean from one instant to another, (deg/h)^2.
    #[must_use]
    pub fn mean_variance(&self, stretch: [f64; 2]) -> f64 {
        self.mean_covariance(stretch, stretch)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn covariance_of_means_is_the_mean_of_the_covariance() {
        let drift = SlowDrift {
            processes: vec![(2.0, 3.0), (0.5, f64::INFINITY), (1.0, 1e9)],
            walk_deg2_per_h2_per_s: 0.1,
        };
        let covariance =
            |s: f64, t: f64| 2.0 * (-(s - t).abs() / 3.0).exp() + 0.5 + 1.0 + 0.1 * s.min(t);
        for (one, other) in [([1.0, 5.0], [1.0, 5.0]), ([7.0, 9.0], [1.0, 5.0])] {
            let steps = 400;
            let at = |ends: [f64; 2], k: i32| {
                ends[0] + (ends[1] - ends[0]) * (f64::from(k) + 0.5) / f64::from(steps)
            };
            let mut sum = 0.0;
            for i in 0..steps {
                for j in 0..steps {
                    sum += covariance(at(one, i), at(other, j));
                }
            }
            let mean = sum / f64::from(steps * steps);
            let got = drift.mean_covariance(one, other);
            assert!((got / mean - 1.0).abs() < 1e-4, "{got} {mean}");
        }
    }
}
