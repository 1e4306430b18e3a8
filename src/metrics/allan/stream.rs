//! Overlapping Allan deviation of a record too long to be kept.

use super::angle::squared_second_differences;
use super::noise_identification::MEANS_MAX;
use super::overlapping::{AllanPoint, Differences};

/// Longest averaging factor, in samples, whose differences start at every sample: 2^18.
const DENSE_FACTOR_MAX: usize = 1 << 18;

/// Longest averaging factor that is ever served, samples.
const FACTOR_MAX: usize = 1 << 44;

/// New angles after which the sums of a level move on.
const BLOCK: usize = 8192;

/// Starts in an averaging time, at least, where differences do not start at every sample.
const STARTS_PER_TAU: usize = 1 << 10;

/// Overlapping Allan deviation from samples that come one after another.
///
/// For m up to 2^18 the differences start at every sample, exactly as in
/// [`overlapping_allan_at`](crate::metrics::overlapping_allan_at). Beyond, angles are kept at every 256th,
/// 65536th, ... sample, so that the starts are tau/1024 apart or less: such a difference repeats its
/// neighbour to a part in a million, and nothing is lost. Memory is two averaging times of
/// angles per level and one level per factor of 256 of the record: 6 MB each.
///
/// The rate of the first sample is left out of the integration, which cancels in every difference
/// and keeps the digits of the rest.
#[derive(Clone, Debug)]
pub struct AllanStream {
    sample_period_s: f64,
    offset_deg_per_h: Option<f64>,
    samples: usize,
    /// Samples from which on differences of long averaging times start at some samples only.
    thinned_from: usize,
    angle: f64,
    levels: Vec<Level>,
    means: Vec<Means>,
}

/// Angles at one spacing, and the sums of the differences formed from them.
#[derive(Clone, Debug)]
struct Level {
    /// Samples from one angle to the next.
    spacing: usize,
    /// Those served, the averaging factor rising.
    terms: Vec<Term>,
    /// Newest angles; those before `done` have been the last one of their differences.
    angles: Vec<f64>,
    done: usize,
    /// Angles that are no longer kept.
    dropped: usize,
}

/// The sum of one averaging factor.
#[derive(Clone, Copy, Debug)]
struct Term {
    /// Averaging factor in spacings of its level.
    factor: usize,
    sum: f64,
    /// Starts that the sum stands for.
    weight: usize,
    /// Differences that it is made of.
    count: usize,
}

/// Means of blocks of so many samples at the start of a record.
#[derive(Clone, Debug)]
struct Means {
    block: usize,
    values: Vec<f64>,
    last_angle: f64,
}

/// What a stream knows of an averaging factor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StreamedSum {
    /// Averaging factor, samples.
    pub(crate) averaged_samples: usize,
    /// Sum of the squared second differences of the angle.
    pub(crate) sum: f64,
    /// Starts that the sum stands for.
    pub(crate) weight: usize,
    /// Differences that it is made of.
    pub(crate) count: usize,
}

impl StreamedSum {
    /// The point that it gives of so many angles.
    pub(crate) fn point(&self, angles: usize, sample_period_s: f64) -> AllanPoint {
        let differences = Differences {
            sum: self.sum,
            weight: self.weight,
            count: self.count,
            share: 1.0,
        };
        AllanPoint::of_differences(self.averaged_samples, differences, angles, sample_period_s)
    }
}

impl Term {
    /// Adds the differences whose last angles are `first .. end`, of those one in `stride`.
    fn add(&mut self, angles: &[f64], (first, end): (usize, usize), stride: usize) {
        let m = self.factor;
        if first >= end {
            return;
        }
        let (a, b, c) = (
            &angles[first - 2 * m..end - 2 * m],
            &angles[first - m..end - m],
            &angles[first..end],
        );
        let count = (end - first).div_ceil(stride);
        let sum = match stride {
            1 => squared_second_differences(a, b, c),
            _ => (0..c.len())
                .step_by(stride)
                .map(|k| {
                    let difference = (a[k] + c[k]) - 2.0 * b[k];
                    difference * difference
                })
                .sum(),
        };
        self.sum += stride as f64 * sum;
        self.weight += stride * count;
        self.count += count;
    }
}

impl Level {
    /// A level that holds the first angle of every record, zero.
    fn new(spacing: usize) -> Self {
        Self {
            spacing,
            terms: Vec::new(),
            angles: vec![0.0],
            done: 0,
            dropped: 0,
        }
    }

    /// Angles that later differences reach back to.
    fn history(&self) -> usize {
        self.terms.last().map_or(0, |term| 2 * term.factor)
    }

    /// Forms every difference whose last angle is new; of those behind `thinned_from` some.
    fn advance(&mut self, thinned_from: usize) {
        let end = self.angles.len();
        let border = (thinned_from / self.spacing)
            .saturating_sub(self.dropped)
            .clamp(self.done, end);
        for term in &mut self.terms {
            let first = self.done.max(2 * term.factor);
            term.add(&self.angles, (first, border), 1);
            let stride = (term.factor / STARTS_PER_TAU).checked_ilog2();
            let stride = stride.map_or(1, |power| 1 << power);
            // Starts are multiples of the stride, however the record comes in pieces.
            let first = (self.dropped + first.max(border)).next_multiple_of(stride);
            term.add(&self.angles, (first - self.dropped, end), stride);
        }
        self.done = end;
    }

    /// Takes angles.
    fn extend(&mut self, angles: impl Iterator<Item = f64>, thinned_from: usize) {
        self.angles.extend(angles);
        if self.angles.len() - self.done >= BLOCK {
            self.advance(thinned_from);
        }
        let history = self.history();
        // Moved once per half a history of new angles, so that moving costs two copies an angle.
        if self.angles.len() >= history + history / 2 + BLOCK {
            self.advance(thinned_from);
            let old = self.angles.len() - history;
            self.angles.drain(..old);
            self.dropped += old;
            self.done = history;
        }
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
        let dense = 1 << dense_factor_max.max(1).ilog2();
        let octaves = (0..FACTOR_MAX.ilog2()).map(|power| 1 << power);
        Self::of_factors(sample_period_s, dense, octaves.collect())
    }

    /// An empty record that is looked at by these averaging factors, rising, samples; beyond
    /// `dense_factor_max` they are rounded to the spacing of the angles that are kept.
    pub(crate) fn of_factors(
        sample_period_s: f64,
        dense_factor_max: usize,
        factors: Vec<usize>,
    ) -> Self {
        let step = (dense_factor_max / STARTS_PER_TAU).max(2);
        let step = 1 << step.ilog2();
        let mut levels = vec![Level::new(1)];
        for factor in factors.into_iter().take_while(|it| *it <= FACTOR_MAX) {
            let mut level = levels.len() - 1;
            while factor / levels[level].spacing > dense_factor_max {
                levels.push(Level::new(levels[level].spacing * step));
                level += 1;
            }
            let Level { spacing, terms, .. } = &mut levels[level];
            let factor = (factor + *spacing / 2) / *spacing;
            if terms.last().is_none_or(|last| last.factor < factor) {
                terms.push(Term {
                    factor,
                    sum: 0.0,
                    weight: 0,
                    count: 0,
                });
            }
        }
        Self {
            sample_period_s,
            offset_deg_per_h: None,
            samples: 0,
            thinned_from: usize::MAX,
            angle: 0.0,
            levels,
            means: Vec::new(),
        }
    }

    /// Lets differences start at every sample in the first so many samples alone: behind them those of
    /// averaging times from 2048 samples on start tau/1024 apart or nearer.
    pub(crate) fn thinned_from(self, samples: usize) -> Self {
        Self {
            thinned_from: samples,
            ..self
        }
    }

    /// Keeps means over blocks of these lengths, samples, of the start of the record.
    pub(crate) fn with_means(mut self, blocks: &[usize]) -> Self {
        let means = |block: &usize| Means {
            block: *block,
            values: Vec::new(),
            last_angle: 0.0,
        };
        self.means = blocks.iter().map(means).collect();
        self
    }

    /// Takes the next samples of the rate, deg/h.
    pub fn extend(&mut self, rate_deg_per_h: &[f64]) {
        for rates in rate_deg_per_h.chunks(BLOCK) {
            let offset = *self.offset_deg_per_h.get_or_insert(rates[0]);
            let mut angle = self.angle;
            let angles = rates.iter().map(|rate| {
                angle += rate - offset;
                angle
            });
            let (dense, coarse) = self.levels.split_at_mut(1);
            dense[0].angles.extend(angles);
            self.angle = angle;
            let before = self.samples;
            self.samples += rates.len();
            let angles = &dense[0].angles;
            let at = |sample: usize| angles[angles.len() - 1 - (self.samples - sample)];
            let new = |spacing: usize| {
                let first = before / spacing + 1;
                (first..=self.samples / spacing).map(move |index| index * spacing)
            };
            for level in coarse {
                level.extend(new(level.spacing).map(at), self.thinned_from);
            }
            for means in &mut self.means {
                let room = MEANS_MAX - means.values.len();
                for angle in new(means.block).take(room).map(at) {
                    let mean = (angle - means.last_angle) / means.block as f64;
                    means.values.push(mean);
                    means.last_angle = angle;
                }
            }
            dense[0].extend(std::iter::empty(), self.thinned_from);
        }
    }

    /// Samples taken so far.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// The means over blocks of a length that [`with_means`](Self::with_means) names, of the start of the
    /// record.
    pub(crate) fn means(&self, block: usize) -> Option<&[f64]> {
        let means = self.means.iter().find(|means| means.block == block);
        means.map(|means| means.values.as_slice())
    }

    /// The mean squares so far, up to an averaging factor.
    pub(crate) fn sums(&mut self, factor_max: usize) -> Vec<StreamedSum> {
        let thinned_from = self.thinned_from;
        let mut sums = Vec::new();
        for level in &mut self.levels {
            level.advance(thinned_from);
            let terms = level.terms.iter().filter(|term| term.count > 0);
            sums.extend(terms.map(|term| StreamedSum {
                averaged_samples: term.factor * level.spacing,
                sum: term.sum,
                weight: term.weight,
                count: term.count,
            }));
        }
        sums.retain(|sum| sum.averaged_samples <= factor_max);
        sums
    }

    /// The points supported so far: m = 1, 2, 4, ... up to a quarter of the record.
    ///
    /// Degrees of freedom are those of white noise, as in
    /// [`overlapping_allan`](crate::metrics::overlapping_allan); the points suit
    /// [`fit_noise`](crate::metrics::fit_noise) and
    /// [`mixed_degrees_of_freedom`](crate::metrics::mixed_degrees_of_freedom).
    #[must_use]
    pub fn points(&mut self) -> Vec<AllanPoint> {
        let (angles, period_s) = (self.samples + 1, self.sample_period_s);
        let sums = self.sums(self.samples / 4).into_iter();
        sums.map(|sum| sum.point(angles, period_s)).collect()
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
        // Sixty-four times the record adds six levels, each below 2^15 angles of capacity.
        assert!(held(64 * 20_000) <= held(20_000) + 6 * (1 << 15));
    }
}
