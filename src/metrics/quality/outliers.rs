//! Outliers of a record: words that lie far from what the words on both sides of them say.

use rayon::prelude::*;
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::coarse::{DISTINCT_MIN, are_pulses, distinct_values, smallest_change};
use super::sides::{SIDE, SIDE_MIN, Sides};
use crate::metrics::estimate::interval::{PER_MEDIAN, median};
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::key::metric::{Applies, MetricKey, Needs};
use crate::wording::{counted, plain, to_digits};

/// Outliers.
pub static OUTLIERS: MetricKey = MetricKey::new(
    "outliers",
    "1",
    Applies::Log,
    "words, or bursts of them, farther out than Gaussian noise has one in a hundred records; listed with their sizes",
)
.lower_is_better()
.synonyms(&["spikes", "glitches"])
.needs(Needs::Samples);

/// Expected number of false outliers of a Gaussian record of any length.
const FALSE_PER_RECORD: f64 = 0.01;

/// Longest burst, words; what lasts longer is a motion.
const BURST_MAX: usize = 32;

/// Lengths of bursts whose prediction has a scatter of its own.
const BURST_LENGTHS: [usize; 6] = [1, 2, 4, 8, 16, 32];

/// Longest burst at an end of a record, words: of a longer one nothing tells a step.
const END_BURST_MAX: usize = SIDE_MIN - 1;

/// Places at which such a scatter is measured, at most.
const PLACES_MAX: usize = 4096;

/// Change from word to word, in robust standard deviations, at which a burst may begin or end.
const EDGE: f64 = 3.5;

/// Changes whose scatter is measured, at most.
const CHANGES_MAX: usize = 1 << 17;

/// Part of the words of a scatter that the median of their sizes is worth.
const MEDIAN_EFFICIENCY: f64 = 0.37;

/// Size, in standard deviations of the words about the lines on both sides, that an outlier must have
/// beside them: the swings of a servo that settles stand out from nothing but their lines.
const LOCAL_SIZE_MIN: f64 = 4.0;

/// Words on either side from whose own predictions an outlier must stand out as well: where noise grows
/// for a while, its words are none.
const NEIGHBOURS: usize = 128;

/// Share of words that begin an outlier from which on the noise is not what it is taken for.
const SHARE_MAX: f64 = 0.01;

/// A word, or a burst of them in a row, that lies outside.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Outlier {
    /// Index of its first word.
    pub first: usize,
    /// Words in a row.
    pub words: usize,
    /// Distance of its farthest word from the words on both sides, deg/h.
    pub size_deg_per_h: f64,
    /// The same in standard deviations of such a distance.
    pub size_deviations: f64,
    /// Distance of its nearest word in such standard deviations, beyond what both sides say.
    least_deviations: f64,
}

/// What a record shows of outliers.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Outliers {
    /// Outliers in the order of time.
    pub events: Vec<Outlier>,
    /// Distance of a single word from the words on both sides beyond which it is one, deg/h.
    pub threshold_deg_per_h: f64,
    /// The same in standard deviations of such a distance.
    pub threshold_deviations: f64,
}

impl Outliers {
    /// Words of all events.
    #[must_use]
    pub fn words(&self) -> usize {
        self.events.iter().map(|event| event.words).sum()
    }

    /// The outliers of words that were taken out of a record, at their places in it.
    ///
    /// * `places`: index in the record of each word.
    pub(crate) fn moved_to(mut self, places: &[usize]) -> Self {
        for event in &mut self.events {
            event.first = places[event.first];
        }
        self
    }

    /// Makes the outliers of a record missing (NaN).
    pub(crate) fn leave_out(&self, words: &mut [f64]) {
        for event in &self.events {
            let end = (event.first + event.words).min(words.len());
            words[event.first..end].fill(f64::NAN);
        }
    }
}

/// Finds the outliers of a record of finite words.
///
/// A word is one where it lies outside of all that eight words on either side say of its place, each by a
/// robust line of its own slope and of that of the other side: farther than the threshold, and farther
/// than these lie apart. So a glitch on top of a motion is found; a step, a bend or the end of a ramp, on
/// which the sides disagree, is none, nor is what keeps off for more than 32 words. Words in a row that all
/// lie outside are one event. The first and last four words have but one side: up to three of them in a row
/// are judged by the lines through the next eight words and the eight beyond.
///
/// The threshold is that of 0.01 false outliers in a Gaussian record of this length, whatever its colour:
/// the scatter is that of the same prediction elsewhere in the record, by the median of its sizes, with
/// Student's distribution for the places it is known from.
///
/// # Errors
/// Why nothing is looked for: fewer than eight distinct values, words that are counted pulses of angle,
/// too short a record, or more outliers than one word in a hundred.
pub fn find_outliers(words_deg_per_h: &[f64]) -> Result<Outliers, Unavailable> {
    let words = words_deg_per_h;
    let search = Search {
        words,
        scale: Scale::of(words)?,
        ends: [true; 2],
    };
    let events = search.events();
    check_share(events.len(), words.len())?;
    Ok(Outliers {
        events,
        threshold_deg_per_h: search.scale.threshold * search.scale.scatters[0],
        threshold_deviations: search.scale.threshold,
    })
}

/// Refuses more outliers than one word in a hundred.
fn check_share(events: usize, words: usize) -> Result<(), Unavailable> {
    if events as f64 <= (SHARE_MAX * words as f64).max(5.0) {
        return Ok(());
    }
    Err(format!(
        "off: {events} of {} begin an outlier; the noise is not Gaussian, or changes",
        counted(words, "word")
    )
    .into())
}

/// The outliers of a record while it comes in: by the scatter of its first words.
pub(crate) struct OutlierStream {
    scale: Scale,
    /// Words that were not judged yet, and their neighbours.
    waiting: Vec<f64>,
    /// Index in the record of the first of them.
    first: usize,
    /// Index from which on words were not judged.
    next: usize,
    events: Vec<Outlier>,
}

impl OutlierStream {
    /// Words that are judged together.
    const PIECE: usize = 1 << 18;
    /// Words on either side of a piece that its judgement takes in.
    const MARGIN: usize = NEIGHBOURS + BURST_MAX + 4 * SIDE;
    /// Most outliers that are kept.
    const EVENTS_MAX: usize = 1 << 17;

    /// Of a record that begins with these words, which are taken by [`extend`](Self::extend) all the same.
    ///
    /// # Errors
    /// As [`find_outliers`] of the first words.
    pub(crate) fn new(first_words: &[f64]) -> Result<Self, Unavailable> {
        Ok(Self {
            scale: Scale::of(first_words)?,
            waiting: Vec::new(),
            first: 0,
            next: 0,
            events: Vec::new(),
        })
    }

    /// Takes the next words.
    pub(crate) fn extend(&mut self, words: &[f64]) {
        self.waiting.extend_from_slice(words);
        while self.waiting.len() >= Self::PIECE + 2 * Self::MARGIN {
            self.judge_up_to(self.first + Self::PIECE + Self::MARGIN);
            self.waiting.drain(..Self::PIECE);
            self.first += Self::PIECE;
        }
    }

    /// Judges the words before an index.
    fn judge_up_to(&mut self, end: usize) {
        let reach = (end + Self::MARGIN - self.first).min(self.waiting.len());
        let search = Search {
            words: &self.waiting[..reach],
            scale: self.scale,
            ends: [self.first == 0, end == self.first + self.waiting.len()],
        };
        let found = search.events().into_iter().map(|event| Outlier {
            first: self.first + event.first,
            ..event
        });
        let own = found.filter(|event| (self.next..end).contains(&event.first));
        let room = (Self::EVENTS_MAX + 1).saturating_sub(self.events.len());
        self.events.extend(own.take(room));
        self.next = end;
    }

    /// The outliers of the whole record.
    ///
    /// # Errors
    /// More of them than one word in a hundred, or than are kept.
    pub(crate) fn finish(mut self) -> Result<Outliers, Unavailable> {
        let count = self.first + self.waiting.len();
        self.judge_up_to(count);
        check_share(self.events.len(), count)?;
        if self.events.len() > Self::EVENTS_MAX {
            let most = Self::EVENTS_MAX;
            return Err(format!("off: more than {most} outliers, the most that are kept").into());
        }
        let of_record = threshold(self.scale.places, count);
        let threshold = of_record.unwrap_or(self.scale.threshold);
        self.events
            .retain(|event| event.least_deviations > threshold);
        Ok(Outliers {
            events: self.events,
            threshold_deg_per_h: threshold * self.scale.scatters[0],
            threshold_deviations: threshold,
        })
    }
}

/// How the words of a record scatter.
#[derive(Clone, Copy, Debug)]
struct Scale {
    /// Change from word to word at which a burst may begin or end.
    edge: f64,
    drift: f64,
    /// Standard deviation of the prediction of the middle of a burst of [`BURST_LENGTHS`].
    scatters: [f64; BURST_LENGTHS.len()],
    /// That of the prediction of a word at an end of the record, the farthest of bursts of up to
    /// [`END_BURST_MAX`].
    end_scatter: f64,
    /// Places by which the least known of them is known.
    places: usize,
    /// Words of the record.
    record: usize,
    threshold: f64,
}

impl Scale {
    /// That of a record.
    ///
    /// # Errors
    /// Words that cannot be judged: few distinct values, counted pulses, too few words.
    fn of(words: &[f64]) -> Result<Self, Unavailable> {
        let distinct = distinct_values(words);
        if distinct < DISTINCT_MIN {
            return Err(format!(
                "off: the words have {}, fewer than {DISTINCT_MIN}",
                counted(distinct, "distinct value")
            )
            .into());
        }
        let step = smallest_change(words);
        if are_pulses(words, step) {
            return Err(format!(
                "off: the words are counted pulses of {} deg/h, which a word holds or does not hold",
                plain(to_digits(step, 4))
            )
            .into());
        }
        Self::by_step(words, step).ok_or_else(|| {
            format!(
                "off: {} are too few to tell by",
                counted(words.len(), "word")
            )
            .into()
        })
    }

    /// Nothing where the record is too short to say how it scatters.
    fn by_step(words: &[f64], step: f64) -> Option<Self> {
        let least = if step.is_finite() { step } else { 0.0 };
        let stride = (words.len() / CHANGES_MAX).max(1);
        let changes = || (1..words.len()).step_by(stride);
        let mut sizes: Vec<f64> = changes().map(|k| words[k] - words[k - 1]).collect();
        let drift = median(&mut sizes);
        sizes.iter_mut().for_each(|it| *it = (*it - drift).abs());
        let change = (PER_MEDIAN * median(&mut sizes)).max(least);
        let mut scatters = [0.0; BURST_LENGTHS.len()];
        let mut places = usize::MAX;
        for (scatter, length) in scatters.iter_mut().zip(BURST_LENGTHS) {
            let (found, count) = prediction_scatter(words, length)?;
            *scatter = found.max(least);
            places = places.min(count);
        }
        let at_end = end_scatter(words).unwrap_or(f64::INFINITY);
        Some(Self {
            end_scatter: at_end.max(least),
            edge: EDGE * change,
            drift,
            scatters,
            places,
            record: words.len(),
            threshold: threshold(places, words.len())?,
        })
    }
}

/// A record, or a part of it, whose words are judged.
struct Search<'a> {
    words: &'a [f64],
    scale: Scale,
    /// Whether the words begin and end where the record does.
    ends: [bool; 2],
}

impl Search<'_> {
    /// Outliers in the order of time.
    fn events(&self) -> Vec<Outlier> {
        let edges = self.edges();
        let mut events: Vec<Outlier> = Vec::new();
        let mut next = 0;
        while next < edges.len() {
            let first = edges[next];
            let near = edges[next + 1..]
                .iter()
                .take_while(|end| **end <= first + BURST_MAX);
            let ends: Vec<usize> = near.copied().collect();
            // The longest burst first: one within it would take the rest of it for its neighbours.
            let found = ends
                .iter()
                .rev()
                .find_map(|end| self.judge(first, *end, &events));
            next += 1;
            if let Some(event) = found {
                let end = event.first + event.words;
                events.push(event);
                while next < edges.len() && edges[next] < end {
                    next += 1;
                }
            }
        }
        events
    }

    /// Words that differ much from the one before.
    fn edges(&self) -> Vec<usize> {
        const PART: usize = 1 << 16;
        let starts: Vec<usize> = (1..self.words.len()).step_by(PART).collect();
        let parts: Vec<Vec<usize>> = starts
            .into_par_iter()
            .map(|start| {
                let end = (start + PART).min(self.words.len());
                let pairs = self.words[start - 1..end].windows(2).enumerate();
                pairs
                    .filter(|(_, two)| (two[1] - two[0] - self.scale.drift).abs() > self.scale.edge)
                    .map(|(offset, _)| start + offset)
                    .collect()
            })
            .collect();
        let [starts, ends] = self.ends;
        let start = starts.then(|| vec![0]);
        let end = ends.then(|| vec![self.words.len()]);
        let all = start.into_iter().chain(parts).chain(end);
        all.collect::<Vec<_>>().concat()
    }

    /// What stands beside a stretch, and the scatter of its prediction by that over the scatter of a
    /// burst within the record.
    fn beside(
        &self,
        (first, end): (usize, usize),
        is_left_out: impl Fn(usize) -> bool,
    ) -> Option<(Sides, f64)> {
        let count = self.words.len();
        let is_start = self.ends[0] && first < SIDE_MIN;
        let is_end = self.ends[1] && count - end < SIDE_MIN;
        if !is_start && !is_end {
            return Sides::of(self.words, (first, end), is_left_out).map(|sides| (sides, 1.0));
        }
        if end - first > END_BURST_MAX {
            return None;
        }
        let sides = Sides::at_end(self.words, (first, end), is_start, is_left_out)?;
        let within = self.scale.scatters[burst_class(end - first)?];
        Some((sides, self.scale.end_scatter / within))
    }

    /// Distance that a stretch must have by the scatter of the predictions on either side of it alone;
    /// zero where neither has the words for it.
    fn needed_among_neighbours(&self, first: usize, end: usize) -> f64 {
        let count = self.words.len();
        let before = &self.words[first.saturating_sub(NEIGHBOURS)..first];
        let after = &self.words[end..(end + NEIGHBOURS).min(count)];
        let sides = [before, after].into_iter();
        sides
            .filter(|side| side.len() >= NEIGHBOURS)
            .filter_map(|side| {
                let (scatter, places) = prediction_scatter(side, end - first)?;
                Some(scatter * threshold(places, self.scale.record)?)
            })
            .fold(0.0, f64::max)
    }

    /// The words `first .. end` as one outlier, if all of them lie outside.
    fn judge(&self, first: usize, end: usize, found: &[Outlier]) -> Option<Outlier> {
        let is_left_out = |index: usize| {
            let later = found.iter().rev().take(2 * SIDE);
            later
                .into_iter()
                .any(|it| (it.first..it.first + it.words).contains(&index))
        };
        let (sides, ratio) = self.beside((first, end), is_left_out)?;
        let length = end - first;
        let scatter = ratio * self.scale.scatters[burst_class(length)?];
        let local = LOCAL_SIZE_MIN * PER_MEDIAN * sides.scatter();
        let needed = (self.scale.threshold * scatter).max(local);
        let (mut size, mut least) = (0.0_f64, f64::INFINITY);
        for (offset, word) in self.words[first..end].iter().enumerate() {
            let [low, high] = sides.range(offset as f64);
            let outside = (word - high).max(low - word);
            if outside <= needed.max(high - low) {
                return None;
            }
            least = least.min(outside);
            let own = word - sides.between(offset as f64);
            size = if own.abs() > size.abs() { own } else { size };
        }
        if least <= ratio * self.needed_among_neighbours(first, end) {
            return None;
        }
        Some(Outlier {
            first,
            words: length,
            size_deg_per_h: size,
            size_deviations: size.abs() / scatter,
            least_deviations: least / scatter,
        })
    }
}

/// Place among [`BURST_LENGTHS`] of a burst of so many words.
fn burst_class(words: usize) -> Option<usize> {
    BURST_LENGTHS.iter().position(|it| *it >= words)
}

/// Distance, in standard deviations known from so many places, that one in a hundred Gaussian records of so
/// many words has somewhere.
fn threshold(places: usize, words: usize) -> Option<f64> {
    let freedom = (MEDIAN_EFFICIENCY * places as f64).max(2.0);
    let tail = FALSE_PER_RECORD / 2.0 / words as f64;
    let student = StudentsT::new(0.0, 1.0, freedom).ok()?;
    Some(-student.inverse_cdf(tail))
}

/// Standard deviation of the middle word of a burst about what both sides say of it, by the median of
/// its sizes over the record, and the places looked at; nothing where there are none.
fn prediction_scatter(words: &[f64], length: usize) -> Option<(f64, usize)> {
    let last = words.len().checked_sub(length + SIDE)?;
    let places = last.checked_sub(SIDE)? + 1;
    let stride = places.div_ceil(PLACES_MAX);
    let middle = length / 2;
    let mut sizes: Vec<f64> = (SIDE..=last)
        .step_by(stride)
        .filter_map(|first| {
            let sides = Sides::of(words, (first, first + length), |_| false)?;
            Some((words[first + middle] - sides.between(middle as f64)).abs())
        })
        .collect();
    let count = sizes.len();
    (count > 0).then(|| (PER_MEDIAN * median(&mut sizes), count))
}

/// The same of a word that begins a record, the first of the longest burst there; that at the end has it too.
fn end_scatter(words: &[f64]) -> Option<f64> {
    let places = words.len().checked_sub(END_BURST_MAX + 2 * SIDE)? + 1;
    let sizes = (0..places).step_by(places.div_ceil(PLACES_MAX));
    let sizes = sizes.filter_map(|first| {
        let sides = Sides::at_end(words, (first, first + END_BURST_MAX), true, |_| false)?;
        Some((words[first] - sides.between(0.0)).abs())
    });
    let mut sizes: Vec<f64> = sizes.collect();
    (!sizes.is_empty()).then(|| PER_MEDIAN * median(&mut sizes))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::metrics::quality::white;

    /// First words and lengths of what is found.
    fn found(words: &[f64]) -> Vec<(usize, usize)> {
        let outliers = find_outliers(words).unwrap();
        let events = outliers.events.iter();
        events.map(|event| (event.first, event.words)).collect()
    }

    /// The words with a motion beneath them.
    fn with(mut words: Vec<f64>, motion: impl Fn(f64) -> f64) -> Vec<f64> {
        for (index, word) in words.iter_mut().enumerate() {
            *word += motion(index as f64);
        }
        words
    }

    #[test]
    fn spikes_and_bursts_are_found_at_their_places_with_their_sizes() {
        let mut words = white(1, 5000);
        words[700] += 300.0;
        words[1400] -= 12.0;
        for (index, size) in (3000..3007).zip([40.0, -60.0, 90.0, 30.0, -50.0, 80.0, 25.0]) {
            words[index] += size;
        }
        for word in &mut words[4000..4020] {
            *word -= 30.0;
        }
        assert_eq!(found(&words), [(700, 1), (1400, 1), (3000, 7), (4000, 20)]);
        let outliers = find_outliers(&words).unwrap();
        let sizes = [300.0, -12.0, 90.0, -30.0];
        for (event, size) in outliers.events.iter().zip(sizes) {
            assert!((event.size_deg_per_h - size).abs() < 4.0, "{event:?}");
        }
        // 0.01 / 5000 on both sides of a normal distribution, over the words and the lines of eight.
        assert!(
            (4.7..4.9).contains(&outliers.threshold_deviations),
            "{outliers:?}"
        );
        assert!(
            (5.0..6.0).contains(&outliers.threshold_deg_per_h),
            "{outliers:?}"
        );
    }

    #[test]
    fn a_motion_is_no_outlier_and_a_glitch_on_top_of_it_is_one() {
        let step = |t: f64| if t < 2000.0 { 0.0 } else { 5e4 };
        let ringing = |t: f64| {
            let after = t - 2000.0;
            if after < 0.0 {
                0.0
            } else {
                5e4 * (1.0 - (-after / 6.0).exp() * (TAU * after / 9.0).cos())
            }
        };
        let trapezoid = |t: f64| {
            let rise = ((t - 1000.4) * 360.0).clamp(0.0, 36_000.0);
            rise - ((t - 3000.7) * 360.0).clamp(0.0, 36_000.0)
        };
        let swing = |t: f64| 36_000.0 * (TAU * t / 400.0).sin();
        let ramp = |t: f64| 25.0 * t;
        let pulse = |t: f64| {
            if (1500.0..1600.0).contains(&t) {
                800.0
            } else {
                0.0
            }
        };
        let motions: [&dyn Fn(f64) -> f64; 6] =
            [&step, &ringing, &trapezoid, &swing, &ramp, &pulse];
        for (case, motion) in motions.iter().enumerate() {
            let mut words = with(white(2, 4096), motion);
            assert_eq!(found(&words), [], "motion {case}");
            words[1234] += 4000.0;
            assert_eq!(found(&words), [(1234, 1)], "motion {case}");
        }
    }

    #[test]
    fn a_spike_at_an_end_of_the_record_is_found_and_a_start_up_is_none() {
        for (first, length) in [
            (0, 1),
            (0, 3),
            (1, 2),
            (3, 1),
            (4999, 1),
            (4997, 3),
            (4996, 1),
        ] {
            for size in [14.0, -2000.0] {
                let mut words = white(21, 5000);
                for word in &mut words[first..first + length] {
                    *word += size;
                }
                assert_eq!(found(&words), [(first, length)], "{size}");
            }
        }
        // Ends of motions: a decay, a step that comes soon, a ramp, a swing.
        let decay = |t: f64| 5e4 * (-t / 6.0).exp();
        let step = |t: f64| if t < 4.0 { 5e4 } else { 0.0 };
        let ramp = |t: f64| 500.0 * t;
        let swing = |t: f64| 36_000.0 * (TAU * t / 400.0).cos();
        let rise = |t: f64| (t - 4980.0).max(0.0).powi(2);
        let motions: [&dyn Fn(f64) -> f64; 5] = [&decay, &step, &ramp, &swing, &rise];
        for (case, motion) in motions.iter().enumerate() {
            assert_eq!(found(&with(white(22, 5000), motion)), [], "motion {case}");
        }
    }

    #[test]
    fn noise_that_grows_for_a_while_has_no_outliers() {
        let mut words = white(3, 20_000);
        for word in &mut words[8000..12_000] {
            *word *= 30.0;
        }
        assert_eq!(found(&words), []);
        let mut words = vec![0.0; 5000];
        words[4000..].copy_from_slice(&white(4, 1000));
        assert_eq!(found(&words), []);
    }

    #[test]
    fn it_is_off_for_few_values_pulses_and_what_is_not_gaussian() {
        let why = |words: &[f64]| find_outliers(words).unwrap_err().to_string();
        let coarse: Vec<f64> = white(5, 5000).iter().map(|it| it.round() * 2.0).collect();
        let coarse: Vec<f64> = coarse.iter().map(|it| it.clamp(-6.0, 6.0)).collect();
        assert!(why(&coarse).starts_with("off: the words have 7 distinct values"));
        let mut rest = 0.0;
        let pulses: Vec<f64> = white(6, 12_000)
            .iter()
            .enumerate()
            .map(|(index, noise)| {
                rest += 0.1 * noise + 0.001 * index as f64;
                let whole = f64::round(rest);
                rest -= whole;
                25.0 * whole
            })
            .collect();
        assert!(
            why(&pulses).contains("counted pulses of 25 deg/h"),
            "{}",
            why(&pulses)
        );
        let cubes: Vec<f64> = white(7, 5000).iter().map(|it| it.powi(9)).collect();
        assert!(why(&cubes).contains("begin an outlier"), "{}", why(&cubes));
        assert!(why(&white(8, 12)).contains("12 words are too few"));
    }

    #[test]
    fn a_stream_finds_what_the_whole_record_has() {
        let mut words = white(11, 700_000);
        let piece = OutlierStream::PIECE;
        for place in [
            0,
            5,
            piece,
            piece + OutlierStream::MARGIN,
            2 * piece + 3,
            699_990,
            699_999,
        ] {
            words[place] += 40.0;
        }
        for word in &mut words[piece - 10..piece - 3] {
            *word -= 25.0;
        }
        let whole = find_outliers(&words).unwrap();
        assert_eq!(whole.events.len(), 8);
        for step in [1000, 70_001, 700_000] {
            let mut stream = OutlierStream::new(&words).unwrap();
            for part in words.chunks(step) {
                stream.extend(part);
            }
            assert_eq!(stream.finish().unwrap(), whole, "{step}");
        }
        // By the scatter of a part of the record the threshold is still that of all of it.
        let mut stream = OutlierStream::new(&words[..100_000]).unwrap();
        stream.extend(&words);
        let found = stream.finish().unwrap();
        assert_eq!(found.events.len(), 8);
        assert!((found.threshold_deviations / whole.threshold_deviations - 1.0).abs() < 0.01);
    }

    #[test]
    fn rounded_words_have_outliers_by_their_step() {
        let mut words: Vec<f64> = white(9, 5000).iter().map(|it| (it * 1.2).round()).collect();
        assert_eq!(found(&words), []);
        words[2500] = 30.0;
        assert_eq!(found(&words), [(2500, 1)]);
    }

    /// Records of every colour, each of variance growing from nothing.
    fn coloured(seed: u64, count: usize) -> Vec<Vec<f64>> {
        let one_pole = |words: &[f64], samples: f64| {
            let decay = (-1.0 / samples).exp();
            let mut state = 0.0;
            let of = |word: &f64| {
                state = decay * state + (1.0 - decay) * word;
                state
            };
            words.iter().map(of).collect::<Vec<f64>>()
        };
        let drive = white(seed, count);
        let flicker = (0..8).fold(vec![0.0; count], |sum: Vec<f64>, octave| {
            let time = 4.0_f64.powi(octave);
            let part = one_pole(
                &white(seed + 100 + u64::from(octave.unsigned_abs()), count),
                time,
            );
            sum.iter()
                .zip(part)
                .map(|(a, b)| a + b * time.sqrt())
                .collect()
        });
        vec![
            one_pole(&drive, 3.0),
            one_pole(&one_pole(&drive, 40.0), 40.0),
            one_pole(&drive, 1e9),
            drive,
            flicker,
        ]
    }

    #[test]
    fn gaussian_records_of_any_length_and_colour_have_hardly_any() {
        // 0.01 a record at most: of 200 records, 8 or more with an outlier are a chance of 1e-3. The
        // long form of it, 4000 records of 100 words, 60 of 10 000 and one of a million in thirteen
        // colours, had none.
        let mut with_outliers = 0;
        for (count, records) in [(100, 36), (2000, 4)] {
            for seed in 0..records {
                for words in coloured(10 * seed + 1, count) {
                    with_outliers += u32::from(!found(&words).is_empty());
                }
            }
        }
        assert!(with_outliers < 8, "{with_outliers}");
    }
}
