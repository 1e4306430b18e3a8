//! A filter that is begun afresh for each twin, and the twins of one record.

use super::{TwinInput, WORDS_MAX, WORDS_MIN};
use crate::experiment::channel_filter::Arithmetic;
use crate::experiment::run::{RecordLength, Unfinished};
use crate::filters::FilterKind;
use crate::metrics::Unavailable;
use crate::turntable::first_measured_index;

/// How a filter is handed its words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::experiment) enum Handing {
    /// One by one: it cannot look ahead.
    Words,
    /// So many at once.
    Blocks(usize),
    /// The record as a whole.
    Record,
}

/// What makes words out of words.
pub(in crate::experiment) trait Subject: Sync {
    /// What it makes of some words from its first state on; none where it fails on them.
    fn answer(&self, words_deg_per_h: &[f64]) -> Result<Option<Vec<f64>>, Unfinished>;

    /// The same with the words handed over one by one, where that is another way.
    fn answer_word_by_word(&self, words_deg_per_h: &[f64]) -> Result<Option<Vec<f64>>, Unfinished> {
        self.answer(words_deg_per_h)
    }

    /// How it is handed its words.
    fn handing(&self) -> Handing;

    /// Samples by which a register delays its outputs.
    fn register_samples(&self) -> usize;
}

/// A filter of the bench.
#[derive(Clone, Copy, Debug)]
pub(in crate::experiment) struct BuiltIn<'a> {
    /// Its kind and settings.
    pub(in crate::experiment) kind: &'a FilterKind,
    /// Samples by which a register delays its outputs.
    pub(in crate::experiment) register_samples: usize,
    /// Sample period, s.
    pub(in crate::experiment) sample_period_s: f64,
}

impl Subject for BuiltIn<'_> {
    fn answer(&self, words_deg_per_h: &[f64]) -> Result<Option<Vec<f64>>, Unfinished> {
        let length = RecordLength {
            warm_up: 0,
            measured: words_deg_per_h.len(),
        };
        let mut filter = Arithmetic::new(self.kind, length, self.sample_period_s);
        let outputs = words_deg_per_h.iter().map(|word| filter.step(*word).ok());
        Ok(outputs
            .map(|output| Some(output?.value_deg_per_h))
            .collect())
    }

    fn handing(&self) -> Handing {
        Handing::Words
    }

    fn register_samples(&self) -> usize {
        self.register_samples
    }
}

/// Why there is no figure.
#[derive(Debug)]
pub(super) enum Lack {
    /// The run was stopped.
    Unfinished(Unfinished),
    /// It cannot be told.
    Reason(Unavailable),
}

impl Lack {
    /// The same once more, for another figure.
    pub(super) fn again(&self) -> Self {
        match self {
            Self::Unfinished(Unfinished::Stopped) => Self::Unfinished(Unfinished::Stopped),
            Self::Unfinished(unfinished) => unfinished.to_string().into(),
            Self::Reason(reason) => Self::Reason(reason.clone()),
        }
    }
}

impl From<Unfinished> for Lack {
    fn from(unfinished: Unfinished) -> Self {
        Self::Unfinished(unfinished)
    }
}

impl From<&'static str> for Lack {
    fn from(reason: &'static str) -> Self {
        Self::Reason(reason.into())
    }
}

impl From<String> for Lack {
    fn from(reason: String) -> Self {
        Self::Reason(reason.into())
    }
}

/// A filter, its record and what it makes of it.
pub(super) struct Twins<'a> {
    subject: &'a dyn Subject,
    /// The record, deg/h.
    pub(super) words: &'a [f64],
    /// What the filter makes of it, deg/h.
    pub(super) own: Vec<f64>,
    /// Standard deviation of the noise of a word, deg/h.
    pub(super) sigma: f64,
    /// Standard deviation of an output, deg/h.
    pub(super) own_std: f64,
    pub(super) sample_period_s: f64,
    /// Whether everything is asked for.
    pub(super) is_whole: bool,
}

impl<'a> Twins<'a> {
    /// Runs the filter on its record, twice: nothing is told of one that answers otherwise each time.
    pub(super) fn of(
        subject: &'a dyn Subject,
        input: &TwinInput<'a>,
        is_whole: bool,
    ) -> Result<Self, Lack> {
        let words = input.words_deg_per_h;
        let words = &words[..words.len().min(WORDS_MAX)];
        if words.len() < WORDS_MIN {
            return Err(format!("the record holds less than {WORDS_MIN} words").into());
        }
        let sigma = noise_std(words);
        if sigma <= 0.0 || !sigma.is_finite() {
            return Err("the record has no noise that sizes of twins go by".into());
        }
        let own = subject.answer(words)?;
        let own = own.ok_or("the filter fails on its record")?;
        let twins = Self {
            subject,
            words,
            sigma,
            own_std: std_of(&own),
            own,
            sample_period_s: input.sample_period_s,
            is_whole,
        };
        let again = twins.answer(words)?;
        let mut pairs = again.iter().zip(&twins.own);
        if !pairs.all(|(again, own)| again.to_bits() == own.to_bits()) {
            return Err(
                "not measured: it answered the same words otherwise when it was run again".into(),
            );
        }
        Ok(twins)
    }

    /// What the filter makes of changed words.
    pub(super) fn answer(&self, words: &[f64]) -> Result<Vec<f64>, Lack> {
        let answer = self.subject.answer(words)?;
        answer.ok_or_else(|| "the filter fails on changed words".into())
    }

    /// The same, word by word.
    pub(super) fn answer_word_by_word(&self, words: &[f64]) -> Result<Vec<f64>, Lack> {
        let answer = self.subject.answer_word_by_word(words)?;
        answer.ok_or_else(|| "the filter fails on words that come one by one".into())
    }

    /// What the record becomes where each word is changed.
    pub(super) fn changed(&self, change: impl Fn(usize, f64) -> f64) -> Vec<f64> {
        let words = self.words.iter().enumerate();
        words.map(|(at, word)| change(at, *word)).collect()
    }

    /// How the outputs change with the words.
    pub(super) fn difference(&self, words: &[f64]) -> Result<Vec<f64>, Lack> {
        let answer = self.answer(words)?;
        let pairs = answer.iter().zip(&self.own);
        Ok(pairs.map(|(twin, own)| twin - own).collect())
    }

    /// How the filter is handed its words.
    pub(super) fn handing(&self) -> Handing {
        self.subject.handing()
    }

    /// Samples by which a register delays its outputs.
    pub(super) fn register_samples(&self) -> usize {
        self.subject.register_samples()
    }

    /// Samples of a time that is a whole number of them but for rounding.
    pub(super) fn samples(&self, time_s: f64) -> usize {
        let period_s = self.sample_period_s;
        let samples = first_measured_index(time_s - 1e-3 * period_s, period_s);
        usize::try_from(samples).unwrap_or(usize::MAX)
    }

    /// First word of the second half.
    pub(super) fn middle(&self) -> usize {
        self.words.len() / 2
    }

    /// Changes of an output below this are rounding, deg/h.
    pub(super) fn rounding(&self) -> f64 {
        1e-9 * self.own_std
    }
}

/// Standard deviation of words.
pub(super) fn std_of(words: &[f64]) -> f64 {
    let count = words.len().max(1) as f64;
    let mean = words.iter().sum::<f64>() / count;
    let squares: f64 = words.iter().map(|word| (word - mean).powi(2)).sum();
    (squares / count).sqrt()
}

/// Root of the mean square.
pub(super) fn rms(words: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = words.fold((0.0, 0.0), |(sum, count), word| {
        (word.mul_add(word, sum), count + 1.0)
    });
    if count > 0.0 {
        let mean: f64 = sum / count;
        mean.sqrt()
    } else {
        0.0
    }
}

/// Standard deviation of white noise on a smooth motion: that of its third differences, which hold 20 times
/// its variance.
fn noise_std(words: &[f64]) -> f64 {
    let thirds = words
        .windows(4)
        .map(|four| four[3] - 3.0 * four[2] + 3.0 * four[1] - four[0]);
    rms(thirds) / 20.0_f64.sqrt()
}
