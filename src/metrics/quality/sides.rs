//! Where a word should lie by what stands on either side of it: robust lines through a few words each.

use crate::metrics::estimate::interval::median;

/// Words on either side that a line is put through, at most and at least.
pub(crate) const SIDE: usize = 8;
pub(crate) const SIDE_MIN: usize = 4;

/// Pairs of the words of a side.
const PAIRS: usize = SIDE * (SIDE - 1) / 2;

/// A few words on one side of a place, with their distances from it in words.
#[derive(Clone, Copy, Debug)]
struct Side {
    distances: [f64; SIDE],
    words: [f64; SIDE],
    count: usize,
}

impl Side {
    fn new(words: &[f64], indices: impl Iterator<Item = usize>, origin: usize) -> Self {
        let mut side = Self {
            distances: [0.0; SIDE],
            words: [0.0; SIDE],
            count: 0,
        };
        for index in indices.take(SIDE) {
            side.distances[side.count] = index as f64 - origin as f64;
            side.words[side.count] = words[index];
            side.count += 1;
        }
        side
    }

    fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        let distances = self.distances[..self.count].iter();
        distances
            .copied()
            .zip(self.words[..self.count].iter().copied())
    }

    /// Median of the slopes of all pairs, which two words in eight do not move far.
    fn slope(&self) -> f64 {
        let mut slopes = [0.0; PAIRS];
        let mut pairs = 0;
        for (first, (at, word)) in self.points().enumerate() {
            for (other_at, other) in self.points().skip(first + 1) {
                slopes[pairs] = (other - word) / (other_at - at);
                pairs += 1;
            }
        }
        median(&mut slopes[..pairs])
    }

    /// Median of what the words say of the place at distance zero under a slope.
    fn level(&self, slope: f64) -> f64 {
        let mut levels = [0.0; SIDE];
        for (level, (at, word)) in levels.iter_mut().zip(self.points()) {
            *level = word - slope * at;
        }
        median(&mut levels[..self.count])
    }
}

/// The lines on both sides of a stretch of words.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sides {
    slopes: [f64; 2],
    /// `levels[side][slope]`: level by the words of a side under the slope of either.
    levels: [[f64; 2]; 2],
    /// Median distance of the words from the line of their own side.
    scatter: f64,
}

impl Sides {
    /// The lines by the words nearest to `first .. end` that are not left out; distances count from
    /// `first`. Nothing where a side has fewer than four words within reach.
    ///
    /// Source: Theil, Proc. Kon. Ned. Akad. Wet. A 53 (1950) 386; Sen, J. Am. Stat. Assoc. 63 (1968) 1379.
    pub(crate) fn of(
        words: &[f64],
        (first, end): (usize, usize),
        is_left_out: impl Fn(usize) -> bool,
    ) -> Option<Self> {
        let reach = 2 * SIDE;
        let before = (first.saturating_sub(reach)..first).rev();
        let after = end..(end + reach).min(words.len());
        let left = Side::new(words, before.filter(|index| !is_left_out(*index)), first);
        let right = Side::new(words, after.filter(|index| !is_left_out(*index)), first);
        Self::through([left, right])
    }

    /// The same for words at an end of a record: the lines through the eight words next to them and
    /// through the eight beyond these.
    ///
    /// * `is_start`: whether the words stand at the start of the record, else at its end.
    pub(crate) fn at_end(
        words: &[f64],
        (first, end): (usize, usize),
        is_start: bool,
        is_left_out: impl Fn(usize) -> bool,
    ) -> Option<Self> {
        let reach = 4 * SIDE;
        let range = if is_start {
            end..(end + reach).min(words.len())
        } else {
            first.saturating_sub(reach)..first
        };
        let mut indices: Vec<usize> = range.filter(|index| !is_left_out(*index)).collect();
        if !is_start {
            indices.reverse();
        }
        let side = |skipped: usize| Side::new(words, indices.iter().skip(skipped).copied(), first);
        Self::through([side(0), side(SIDE)])
    }

    /// Nothing where a side has fewer than four words.
    fn through([left, right]: [Side; 2]) -> Option<Self> {
        if left.count < SIDE_MIN || right.count < SIDE_MIN {
            return None;
        }
        let slopes = [left.slope(), right.slope()];
        let levels = [left, right].map(|side| slopes.map(|slope| side.level(slope)));
        let mut residuals = [0.0; 2 * SIDE];
        let mut count = 0;
        for (own, side) in [left, right].iter().enumerate() {
            for (at, word) in side.points() {
                residuals[count] = (word - levels[own][own] - slopes[own] * at).abs();
                count += 1;
            }
        }
        Some(Self {
            slopes,
            levels,
            scatter: median(&mut residuals[..count]),
        })
    }

    /// Mean of what both lines say of the word so many words after the first.
    pub(crate) fn between(&self, distance: f64) -> f64 {
        let own = |side: usize| self.levels[side][side] + self.slopes[side] * distance;
        0.5 * (own(0) + own(1))
    }

    /// Median distance of the words from the line of their own side.
    pub(crate) fn scatter(&self) -> f64 {
        self.scatter
    }

    /// Lowest and highest of what either side says, by its own slope and by that of the other: on a
    /// step, a bend or the end of a ramp they lie far apart.
    pub(crate) fn range(&self, distance: f64) -> [f64; 2] {
        let all = self.levels.iter().flat_map(|levels| {
            let pairs = levels.iter().zip(&self.slopes);
            pairs.map(|(level, slope)| level + slope * distance)
        });
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], it| {
            [low.min(it), high.max(it)]
        })
    }
}
