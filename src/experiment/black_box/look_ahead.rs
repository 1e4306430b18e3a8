//! Whether an output knows words that come after it.
//!
//! From a place on all words are changed. A causal filter gives the same outputs before it.

use rayon::prelude::*;

use super::Figure;
use super::subject::{Handing, Lack, Twins};
use crate::metrics::{REACHES_START, TwinFigure};

/// Most words of the record, but for blocks that hold more.
const WORDS: usize = 1 << 14;

/// Blocks that the places lie in, the first left out.
const BLOCKS: usize = 3;

/// Places in a record that is handed over as a whole.
const PLACES: usize = 10;

/// Most words that are handed over one by one.
const SINGLE_WORDS: usize = 1 << 13;

/// What a word of the future becomes, of itself and the standard deviation of its noise.
type Future = fn(f64, f64) -> f64;

/// What the future becomes, each made of a word and the standard deviation of its noise.
const FUTURES: [Future; 3] = [
    |word, sigma| word + 100.0 * sigma,
    |word, sigma| word + sigma,
    |_, _| 0.0,
];

/// What one change of the future showed.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    /// Samples ahead.
    samples: usize,
    /// Whether the first word already shows it.
    reaches_start: bool,
    /// Largest change that counts as rounding, deg/h.
    rounding: f64,
}

impl Seen {
    fn or(self, other: Self) -> Self {
        let further = if other.samples > self.samples {
            other
        } else {
            self
        };
        Self {
            rounding: self.rounding.max(other.rounding),
            ..further
        }
    }
}

/// The look-ahead with what defines it.
pub(super) fn look_ahead(twins: &Twins) -> Figure {
    let handing = twins.handing();
    let block = match handing {
        Handing::Blocks(block) if block >= PLACES => block,
        _ => WORDS / (BLOCKS + 1),
    };
    let words = &twins.words[..twins.words.len().min(WORDS.max((BLOCKS + 1) * block))];
    let own = twins.answer(words)?;
    let futures = if twins.is_whole {
        &FUTURES[..]
    } else {
        &FUTURES[..1]
    };
    let places = match handing {
        Handing::Record => in_record(words.len()),
        _ if words.len() < (BLOCKS + 1) * block => in_record(words.len()),
        _ => in_blocks(block),
    };
    let cases: Vec<(usize, &Future)> = places
        .iter()
        .flat_map(|place| futures.iter().map(|future| (*place, future)))
        .collect();
    let seen: Vec<Seen> = cases
        .par_iter()
        .map(|(place, future)| seen_of(twins, words, &own, *place, future))
        .collect::<Result<_, Lack>>()?;
    let seen = seen.into_iter().fold(Seen::default(), Seen::or);
    let figure = TwinFigure::alone(seen.samples as f64)
        .with("places", places.len() as f64)
        .with(REACHES_START, f64::from(u8::from(seen.reaches_start)))
        .with("rounding_deg_per_h", seen.rounding);
    match handing {
        Handing::Blocks(block) if block > 1 => {
            let words = &words[..words.len().min(SINGLE_WORDS)];
            let single = twins.answer_word_by_word(words)?;
            let pairs = single.iter().zip(&own);
            let most = pairs.fold(0.0, |most: f64, (single, own)| {
                most.max((single - own).abs())
            });
            Ok(figure.with("change_by_single_words_deg_per_h", most))
        }
        _ => Ok(figure),
    }
}

/// First, middle, last but one and others of several blocks.
fn in_blocks(block: usize) -> Vec<usize> {
    let offsets = [0, block / 2, block.saturating_sub(2), block / 3];
    let mut places: Vec<usize> = (1..=BLOCKS)
        .flat_map(|index| offsets.map(|offset| index * block + offset))
        .collect();
    places.sort_unstable();
    places.dedup();
    places
}

/// Places throughout a record, even and odd ones: a wavelet looks ahead from every other word.
fn in_record(words: usize) -> Vec<usize> {
    let place = |index: usize| words * (2 * index + 1) / (2 * PLACES) + index;
    (0..PLACES).map(place).collect()
}

/// How far ahead an output sees a change of all words from `place` on.
fn seen_of(
    twins: &Twins,
    words: &[f64],
    own: &[f64],
    place: usize,
    future: &Future,
) -> Result<Seen, Lack> {
    let mut changed = words.to_vec();
    for word in &mut changed[place..] {
        *word = future(*word, twins.sigma);
    }
    let answer = twins.answer(&changed)?;
    // An output behind a register appears later than the words that it was made of.
    let end = (place + twins.register_samples()).min(own.len());
    let changes: Vec<f64> = answer[..end]
        .iter()
        .zip(own)
        .map(|(twin, own)| (twin - own).abs())
        .collect();
    let first = changes.iter().position(|change| *change > twins.rounding());
    let before = &changes[..first.unwrap_or(end)];
    Ok(Seen {
        samples: first.map_or(0, |first| end - first),
        reaches_start: first.is_some_and(|first| first <= twins.register_samples()),
        rounding: before.iter().fold(0.0, |most, change| most.max(*change)),
    })
}
