//! Rates of a record, held as one where they never change.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::OnceLock;

/// Rates at the stamps of a record, deg/h.
///
/// That of an hour at rest is one number, and its words would be as many as those of a channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rates<'a> {
    /// One for each stamp; none where nobody knows them.
    Words(&'a [f64]),
    /// The same at every stamp.
    Constant {
        /// The rate, deg/h.
        deg_per_h: f64,
        /// How many stamps there are.
        samples: usize,
    },
}

impl<'a> Rates<'a> {
    /// Rates that nobody knows.
    pub const UNKNOWN: Self = Self::Words(&[]);

    /// How many stamps there are.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Words(words) => words.len(),
            Self::Constant { samples, .. } => *samples,
        }
    }

    /// Whether nobody knows them.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The rate at stamp `index`, deg/h, if there is one.
    #[must_use]
    pub fn get(&self, index: usize) -> Option<f64> {
        match self {
            Self::Words(words) => words.get(index).copied(),
            Self::Constant { deg_per_h, samples } => (index < *samples).then_some(*deg_per_h),
        }
    }

    /// Those of a range of stamps; none where the record does not hold all of it.
    #[must_use]
    pub fn cut(&self, range: Range<usize>) -> Self {
        match *self {
            Self::Words(words) => Self::Words(words.get(range).unwrap_or(&[])),
            Self::Constant { deg_per_h, samples } if range.end <= samples => Self::Constant {
                deg_per_h,
                samples: range.len(),
            },
            Self::Constant { .. } => Self::UNKNOWN,
        }
    }

    /// Those from a stamp on.
    #[must_use]
    pub fn from(&self, first: usize) -> Self {
        self.cut(first..self.len())
    }

    /// Each in turn, deg/h.
    pub fn iter(&self) -> impl Iterator<Item = f64> + use<'a> {
        let (words, constant) = match *self {
            Self::Words(words) => (words, (0.0, 0)),
            Self::Constant { deg_per_h, samples } => (&[][..], (deg_per_h, samples)),
        };
        let repeated = std::iter::repeat_n(constant.0, constant.1);
        words.iter().copied().chain(repeated)
    }

    /// A word for each stamp, deg/h; made only where there is one for all.
    #[must_use]
    pub fn words(&self) -> Cow<'a, [f64]> {
        match *self {
            Self::Words(words) => Cow::Borrowed(words),
            Self::Constant { deg_per_h, samples } => Cow::Owned(vec![deg_per_h; samples]),
        }
    }

    /// Their mean, deg/h; 0 of none.
    #[must_use]
    #[expect(
        clippy::cast_precision_loss,
        reason = "sample counts are far below 2^53"
    )]
    pub fn mean(&self) -> f64 {
        self.iter().sum::<f64>() / self.len().max(1) as f64
    }

    /// Whether it is different at two stamps.
    #[must_use]
    pub fn changes(&self) -> bool {
        match self {
            Self::Words(words) => words
                .windows(2)
                .any(|two| two[0] < two[1] || two[1] < two[0]),
            Self::Constant { .. } => false,
        }
    }
}

impl<'a> From<&'a [f64]> for Rates<'a> {
    fn from(words: &'a [f64]) -> Self {
        Self::Words(words)
    }
}

impl<'a> From<&'a Vec<f64>> for Rates<'a> {
    fn from(words: &'a Vec<f64>) -> Self {
        Self::Words(words)
    }
}

/// Rates of a record that is being made, deg/h: no words until one differs from the first.
#[derive(Debug, Default)]
pub struct RateRecord {
    /// Those of all stamps so far, if two differ; else empty.
    words: Vec<f64>,
    /// The one of all stamps so far.
    constant: f64,
    samples: usize,
    /// Stamps that there will be.
    capacity: usize,
    /// The words of a constant rate, once somebody asks for them.
    spelt: OnceLock<Vec<f64>>,
}

impl RateRecord {
    /// A record of so many stamps to come.
    #[must_use]
    pub fn with_capacity(capacity: usize) -> Self {
        Self {
            capacity,
            ..Self::default()
        }
    }

    /// Appends the rate at the next stamp, deg/h.
    pub fn push(&mut self, deg_per_h: f64) {
        if self.samples == 0 {
            self.constant = deg_per_h;
        }
        if self.words.is_empty() && deg_per_h.to_bits() != self.constant.to_bits() {
            self.words
                .reserve_exact(self.capacity.max(self.samples + 1));
            self.words.resize(self.samples, self.constant);
        }
        if !self.words.is_empty() {
            self.words.push(deg_per_h);
        }
        self.samples += 1;
    }

    /// How many stamps there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.samples
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.samples == 0
    }

    /// What there is.
    #[must_use]
    pub fn rates(&self) -> Rates<'_> {
        if self.words.is_empty() && self.samples > 0 {
            return Rates::Constant {
                deg_per_h: self.constant,
                samples: self.samples,
            };
        }
        Rates::Words(&self.words)
    }

    /// A word for each stamp, deg/h, kept from then on.
    #[must_use]
    pub fn words(&self) -> &[f64] {
        match self.rates() {
            Rates::Words(words) => words,
            Rates::Constant { deg_per_h, samples } => {
                self.spelt.get_or_init(|| vec![deg_per_h; samples])
            }
        }
    }
}

impl Extend<f64> for RateRecord {
    fn extend<T: IntoIterator<Item = f64>>(&mut self, rates: T) {
        for rate in rates {
            self.push(rate);
        }
    }
}

impl From<Vec<f64>> for RateRecord {
    fn from(words: Vec<f64>) -> Self {
        Self {
            samples: words.len(),
            words,
            ..Self::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(rates: &[f64]) -> RateRecord {
        let mut record = RateRecord::with_capacity(rates.len());
        record.extend(rates.iter().copied());
        record
    }

    #[test]
    fn a_record_reads_as_the_words_that_made_it() {
        for words in [
            &[][..],
            &[2.5],
            &[2.5, 2.5, 2.5],
            &[2.5, 2.5, 2.75, 2.5],
            &[0.0, -0.0, 0.0],
        ] {
            let record = of(words);
            let rates = record.rates();
            let bits = |words: &[f64]| words.iter().map(|rate| rate.to_bits()).collect::<Vec<_>>();
            assert_eq!(rates.len(), words.len());
            assert_eq!(bits(&rates.iter().collect::<Vec<_>>()), bits(words));
            assert_eq!(bits(&rates.words()), bits(words));
            assert_eq!(bits(record.words()), bits(words));
            for first in 0..=words.len() {
                assert_eq!(bits(&rates.from(first).words()), bits(&words[first..]));
                assert_eq!(rates.get(first), words.get(first).copied());
            }
        }
    }

    #[test]
    fn only_a_rate_that_changes_has_words() {
        assert!(matches!(of(&[1.0, 1.0]).rates(), Rates::Constant { .. }));
        assert!(!of(&[1.0, 1.0]).rates().changes());
        assert!(matches!(of(&[1.0, 2.0]).rates(), Rates::Words(_)));
        assert!(of(&[1.0, 2.0]).rates().changes());
    }
}
