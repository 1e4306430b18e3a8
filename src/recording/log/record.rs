//! A recorded log: words at equal spacing, and what was found out about them.

use std::ops::Range;

use super::format::LogFormat;
use crate::recording::column::LinesBetween;
use crate::recording::text::lines::shown;
use crate::recording::time::timing::Timing;
use crate::signal::Bridge;
use crate::wording::counted;

/// Most stretches whose means are named.
const NAMED_STRETCHES: usize = 6;

/// A recorded log.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Log {
    /// Name of the file without its folder.
    pub file: String,
    /// Column of the numbers where the file has several or names its only one.
    pub column: Option<String>,
    /// Unit it was recorded in.
    pub unit: String,
    /// Rate words, deg/h: finite, or NaN where samples are missing.
    pub rate_deg_per_h: Vec<f64>,
    /// What the column of the reference shows at the words, deg/h; empty without one.
    pub reference_deg_per_h: Vec<f64>,
    /// Temperature at the words, deg C; empty without a column of it.
    pub temperature_c: Vec<f64>,
    /// Samples per second, Hz.
    pub sample_rate_hz: f64,
    /// What the time column says; none without one.
    pub timing: Option<Timing>,
    /// Empty lines between the samples.
    pub lines_between: LinesBetween,
    /// Stretches of words between which samples are missing.
    pub stretches: Vec<Stretch>,
    /// Gaps within stretches that differences of the Allan deviation span.
    pub bridges: Vec<Bridge>,
    /// Gaps that the stamps show.
    pub(super) gaps_in_time: usize,
    /// What the file was taken for, in a line; none of an array.
    pub layout: Option<String>,
    /// The same as a format: what was given, and what was found.
    pub format: LogFormat,
    /// What else is worth saying of how it was read.
    pub(super) remarks: Vec<String>,
}

/// Words at equal spacing without a gap.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch {
    /// The words in the log.
    pub words: Range<usize>,
    /// Their mean, deg/h.
    pub mean_deg_per_h: f64,
}

impl Log {
    /// Sample period, s.
    #[must_use]
    pub fn sample_period_s(&self) -> f64 {
        1.0 / self.sample_rate_hz
    }

    /// Holds a reference against the words: of an angle, or beside one, the first word has no partner.
    pub(super) fn take_reference(&mut self, reference: &Self) -> Result<(), ReferenceError> {
        if self.has_gaps() || reference.has_gaps() {
            return Err(ReferenceError::Gaps);
        }
        let (words, rates) = (&mut self.rate_deg_per_h, &reference.rate_deg_per_h);
        let count = words.len().min(rates.len());
        words.drain(..words.len() - count);
        let temperatures = self.temperature_c.len();
        self.temperature_c
            .drain(..temperatures.saturating_sub(count));
        self.reference_deg_per_h = rates[rates.len() - count..].to_vec();
        self.stretches = vec![Stretch::of(words, 0..count)];
        let name = reference.column.as_deref().unwrap_or_default();
        self.remarks.push(format!(
            "the true rate is what column {} shows, in {}",
            shown(name),
            reference.unit
        ));
        Ok(())
    }

    /// Adds what is worth saying.
    pub(super) fn remark(&mut self, remark: Option<String>) {
        self.remarks.extend(remark);
    }

    /// Whether samples are missing between the words.
    #[must_use]
    pub fn has_gaps(&self) -> bool {
        self.stretches.len() > 1 || self.rate_deg_per_h.iter().any(|word| word.is_nan())
    }

    /// Spanned gaps behind the first `count` words, as gaps of the record that is left.
    #[must_use]
    pub fn bridges_behind(&self, count: usize) -> Vec<Bridge> {
        let behind = self.bridges.iter().filter(|it| it.words.start > count);
        let moved = behind.map(|bridge| Bridge {
            words: bridge.words.start - count..bridge.words.end - count,
            ..bridge.clone()
        });
        moved.collect()
    }

    /// Moves every stretch to the mean of all words, so that noise is measured about each one's own.
    pub fn take_about_common_mean(&mut self) {
        if self.stretches.len() < 2 {
            return;
        }
        let present = self.rate_deg_per_h.iter().filter(|word| !word.is_nan());
        let (sum, count) = present.fold((0.0, 0.0), |(sum, count), word| (sum + word, count + 1.0));
        for stretch in &self.stretches {
            let step = sum / count - stretch.mean_deg_per_h;
            for word in &mut self.rate_deg_per_h[stretch.words.clone()] {
                *word += step;
            }
            let own = |bridge: &&mut Bridge| stretch.words.contains(&bridge.words.start);
            for bridge in self.bridges.iter_mut().filter(own) {
                bridge.mean_deg_per_h += step;
            }
        }
    }

    /// What is worth saying about how it was read.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let LinesBetween { empty, headings } = self.lines_between;
        let mut notes = Vec::new();
        if headings.count > 0 {
            notes.push(format!(
                "heading once more in {}, from line {} on, passed over: where files were joined there, --rows \
                 takes one of them",
                counted(headings.count, "line"),
                headings.first
            ));
        }
        match self.timing {
            Some(timing) => notes.push(timing.note(self.gaps_in_time)),
            None if empty.count > 0 => notes.push(format!(
                "{} between the samples, from line {} on, passed over: the samples are taken to be \
                 equally spaced all the same",
                counted(empty.count, "empty line"),
                empty.first
            )),
            None => {}
        }
        notes.extend(self.remarks.iter().cloned());
        notes.extend(self.stretches_note());
        notes.extend(self.bridges_note());
        notes
    }

    /// What is said of gaps that differences span.
    fn bridges_note(&self) -> Option<String> {
        let first = self.bridges.first()?;
        let lengths = self.bridges.iter().map(|bridge| bridge.words.len());
        let exist = if first.is_known {
            "their three angles exist"
        } else {
            "their three angles exist and nine tenths of both mean rates are words, the mean over a gap that of \
             the words on both sides"
        };
        Some(format!(
            "differences of the Allan deviation span {} ({} in all) where {exist}; its count and degrees of \
             freedom are those of the differences that were used, and nothing else spans a gap",
            counted(self.bridges.len(), "gap"),
            counted(lengths.sum::<usize>(), "missing word")
        ))
    }

    /// What is said of several stretches: how long they are, their means and the largest step between two.
    fn stretches_note(&self) -> Option<String> {
        if self.stretches.len() < 2 {
            let missing = self
                .rate_deg_per_h
                .iter()
                .filter(|word| word.is_nan())
                .count();
            return (missing > 0 && self.bridges.is_empty()).then(|| {
                format!(
                    "{} missing: nothing is put in their place, and no sum spans one",
                    counted(missing, "sample")
                )
            });
        }
        let named = self.stretches.iter().take(NAMED_STRETCHES).map(|stretch| {
            format!(
                "{:.4} ({})",
                stretch.mean_deg_per_h,
                counted(stretch.words.len(), "sample")
            )
        });
        let more = self.stretches.len().saturating_sub(NAMED_STRETCHES);
        let more = match more {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let steps = self.stretches.windows(2);
        let steps = steps.map(|two| two[1].mean_deg_per_h - two[0].mean_deg_per_h);
        let largest = steps.fold(
            0.0_f64,
            |most, step| if step.abs() > most.abs() { step } else { most },
        );
        Some(format!(
            "{} with gaps between them are pooled: no sum spans a gap, and each is taken about its own mean. \
             Means {}{more} deg/h; the largest step from one to the next is {largest:.4} deg/h",
            counted(self.stretches.len(), "part"),
            named.collect::<Vec<_>>().join(", ")
        ))
    }
}

impl Stretch {
    pub(in crate::recording) fn of(words: &[f64], range: Range<usize>) -> Self {
        let present = words[range.clone()].iter().filter(|word| !word.is_nan());
        let (sum, count) = present.fold((0.0, 0.0), |(sum, count), word| (sum + word, count + 1.0));
        Self {
            words: range,
            mean_deg_per_h: sum / count,
        }
    }
}

/// Why a reference is not held against the words.
#[derive(Debug, thiserror::Error)]
pub(super) enum ReferenceError {
    #[error(
        "samples are missing, and a reference is compared word by word: --rows, or --from-s and --to-s, takes \
         a part without gaps"
    )]
    Gaps,
}
