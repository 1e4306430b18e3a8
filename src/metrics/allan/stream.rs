//! Overlapping Allan deviation of a record too long to be kept.

use super::angle::squared_second_differences;
use super::overlapping::{AllanPoint, NoiseType, degrees_of_freedom};
use crate::metrics::estimate::interval;

/// Longest averaging factor, in samples, whose differences start at every sample: 2^18.
const DENSE_FACTOR_MAX: usize = 1 << 18;

/// New angles after which the sums of a level move on.
const BLOCK: usize = 8192;

/// Overlapping Allan deviation at octave averaging times from samples that come one after another.
///
/// For m up to 2^18 the differences start at every sample, exactly as in
/// [`overlapping_allan_at`](crate::metrics::overlapping_allan_at). Beyond, angles are kept at every second,
/// fourth, ... sample, so that the starts are tau/2^18 apart: such a difference repeats its
/// neighbour to four parts in a million, and nothing is lost. Memory is two averaging times of
/// angles per level and one level per doubling of the record: 10 MB at first, 100 MB at 1e9 samples.
///
/// The rate of the first sample is left out of the integration, which cancels in every difference
/// and keeps the digits of the rest.
#[derive(Clone, Debug)]
pub struct AllanStream {
    dense_factor_max: usize,
    sample_period_s: f64,
    offset_deg_per_h: Option<f64>,
    samples: usize,
    angle: f64,
    levels: Vec<Level>,
}

/// Angles at one spacing, and the sums of the differences formed from them.
#[derive(Clone, Debug)]
struct Level {
    /// Averaging factors served, in spacings of this level, rising.
    factors: Vec<usize>,
    sums: Vec<f64>,
    counts: Vec<usize>,
    /// Newest angles; those before `done` have been the last one of their differences.
    angles: Vec<f64>,
    done: usize,
    /// Whether the next angle is one that the level above keeps as well.
    even: bool,
}

impl Level {
    /// A level that holds the first angle of every record, zero.
    fn new(factors: Vec<usize>) -> Self {
        Self {
            sums: vec![0.0; factors.len()],
            counts: vec![0; factors.len()],
            factors,
            angles: vec![0.0],
            done: 0,
            even: false,
        }
    }

    /// Angles that later differences reach back to.
    fn history(&self) -> usize {
        2 * self.factors[self.factors.len() - 1]
    }

    /// Forms every difference whose last angle is new.
    fn advance(&mut self) {
        let end = self.angles.len();
        for ((&m, sum), count) in self
            .factors
            .iter()
            .zip(&mut self.sums)
            .zip(&mut self.counts)
        {
            let first = self.done.max(2 * m);
            if first < end {
                *sum += squared_second_differences(
                    &self.angles[first - 2 * m..end - 2 * m],
                    &self.angles[first - m..end - m],
                    &self.angles[first..end],
                );
                *count += end - first;
            }
        }
        self.done = end;
    }

    /// Takes an angle; true if the level above keeps it as well.
    fn push(&mut self, angle: f64) -> bool {
        self.angles.push(angle);
        if self.angles.len() - self.done >= BLOCK {
            self.advance();
        }
        let history = self.history();
        // Moved once per half a history of new angles, so that moving costs two copies an angle.
        if self.angles.len() >= history + history / 2 + BLOCK {
            self.advance();
            self.angles.drain(..self.angles.len() - history);
            self.done = history;
        }
        let even = self.even;
        self.even = !even;
        even
    }
}

impl AllanStream {
    /// An empty record of samples `sample_period_s` (s, > 0) apart.
    #[must_use]
    pub fn new(sample_period_s: f64) -> Self {
        Self::with_dense_factor_max(sample_period_s, DENSE_FACTOR_MAX)
    }

    /// As [`new`](Self::new) with differences at every sample up to this averaging factor, rounded
    /// down to a power of two; a smaller one takes less memory.
    #[must_use]
    pub fn with_dense_factor_max(sample_period_s: f64, dense_factor_max: usize) -> Self {
        let octaves = dense_factor_max.max(1).ilog2();
        let factors = (0..=octaves).map(|power| 1 << power).collect();
        Self {
            dense_factor_max: 1 << octaves,
            sample_period_s,
            offset_deg_per_h: None,
            samples: 0,
            angle: 0.0,
            levels: vec![Level::new(factors)],
        }
    }

    /// Takes the next samples of the rate, deg/h.
    pub fn extend(&mut self, rate_deg_per_h: &[f64]) {
        for &rate in rate_deg_per_h {
            let offset = *self.offset_deg_per_h.get_or_insert(rate);
            self.angle += rate - offset;
            self.samples += 1;
            self.push_angle();
        }
    }

    fn push_angle(&mut self) {
        let mut index = 0;
        while self.levels[index].push(self.angle) {
            index += 1;
            if index == self.levels.len() {
                self.levels.push(Level::new(vec![self.dense_factor_max]));
            }
        }
    }

    /// Samples taken so far.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// The points supported so far: m = 1, 2, 4, ... up to a quarter of the record.
    ///
    /// Degrees of freedom are those of white noise, as in
    /// [`overlapping_allan`](crate::metrics::overlapping_allan); the points suit
    /// [`fit_noise`](crate::metrics::fit_noise) and
    /// [`mixed_degrees_of_freedom`](crate::metrics::mixed_degrees_of_freedom).
    #[must_use]
    pub fn points(&mut self) -> Vec<AllanPoint> {
        let mut points = Vec::new();
        for (power, level) in self.levels.iter_mut().enumerate() {
            level.advance();
            for ((factor, &sum), &count) in level.factors.iter().zip(&level.sums).zip(&level.counts)
            {
                let m = factor << power;
                if m > self.samples / 4 {
                    return points;
                }
                let m_f = m as f64;
                let deviation = (sum / (2.0 * m_f * m_f * count as f64)).sqrt();
                let freedom = degrees_of_freedom(NoiseType::White, self.samples + 1, m);
                points.push(AllanPoint {
                    tau_s: m_f * self.sample_period_s,
                    averaged_samples: m,
                    deviation_deg_per_h: interval::deviation(deviation, freedom),
                    degrees_of_freedom: freedom,
                    count,
                });
            }
        }
        points
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::overlapping_allan_at;

    /// White noise on a ramp and a large mean, without a generator of its own.
    fn record(count: usize) -> Vec<f64> {
        let mut state = 1_u64;
        (0..count)
            .map(|index| {
                state = 16_807 * state % 2_147_483_647;
                15.0 + 1e-6 * index as f64 + state as f64 / 2_147_483_647.0
            })
            .collect()
    }

    #[test]
    fn a_stream_agrees_with_the_whole_record_whatever_the_pieces() {
        let values = record(100_003);
        let mut stream = AllanStream::new(0.5);
        for piece in values.chunks(7919) {
            stream.extend(piece);
            // Asking in between changes nothing.
            assert!(stream.points().len() >= 10);
        }
        assert_eq!(stream.samples(), values.len());
        let points = stream.points();
        let factors: Vec<usize> = points.iter().map(|point| point.averaged_samples).collect();
        assert_eq!(factors.last(), Some(&16_384));
        let batch = overlapping_allan_at(&values, 0.5, &factors);
        for (got, want) in points.iter().zip(&batch) {
            assert_eq!((got.count, got.tau_s), (want.count, want.tau_s));
            let ratio = got.deviation_deg_per_h.value / want.deviation_deg_per_h.value;
            assert!((ratio - 1.0).abs() < 1e-12, "{} {ratio}", got.tau_s);
        }
    }

    #[test]
    fn beyond_the_dense_factors_differences_start_at_every_spacing_of_the_level() {
        let values = record(50_000);
        let mut angle = vec![0.0];
        for value in &values {
            angle.push(angle[angle.len() - 1] + value - values[0]);
        }
        let mut stream = AllanStream::with_dense_factor_max(1.0, 20);
        stream.extend(&values);
        for point in stream.points() {
            let m = point.averaged_samples;
            let terms: Vec<f64> = (0..angle.len() - 2 * m)
                .step_by((m / 16).max(1))
                .map(|k| (angle[k + 2 * m] - 2.0 * angle[k + m] + angle[k]).powi(2))
                .collect();
            assert_eq!(point.count, terms.len());
            let wanted = terms.iter().sum::<f64>() / (terms.len() * 2 * m * m) as f64;
            assert!((point.variance() / wanted - 1.0).abs() < 1e-11, "{m}");
        }
    }

    #[test]
    fn memory_grows_with_the_logarithm_of_the_record() {
        let held = |count: usize| {
            let mut stream = AllanStream::with_dense_factor_max(1.0, 64);
            stream.extend(&record(count));
            let levels = stream.levels.iter();
            levels.map(|level| level.angles.capacity()).sum::<usize>()
        };
        // Sixty-four times the record adds six levels, each below 2^14 angles of capacity.
        assert!(held(64 * 20_000) <= held(20_000) + 6 * (1 << 14));
    }
}
