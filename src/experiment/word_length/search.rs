//! The search: one length for all signals, then signal by signal.

use super::bench::{Bench, WordLengthError, WordLengthLimits, WordLengthTrial};
use crate::experiment::plan::Plan;
use crate::filters::FixedWords;

/// Most bits of a word.
const BITS_MAX: u32 = 48;

/// Trials of a search, in the order in which they were made.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct WordLengths {
    /// Table of the filter's kind in a scenario.
    pub kind: &'static str,
    /// Samples that every trial filtered.
    pub samples: usize,
    /// Time that they take, s.
    pub filtered_s: f64,
    /// One length for all signals, from the shortest on, to the first that does.
    pub uniform: Vec<WordLengthTrial>,
    /// From there, signal by signal: each the shortest that does beside the others.
    pub greedy: Vec<WordLengthTrial>,
}

impl WordLengths {
    /// The fewest bits that do; none if 48 are too few.
    #[must_use]
    pub fn best(&self) -> Option<&WordLengthTrial> {
        let trials = self.greedy.last().or(self.uniform.last());
        trials.filter(|trial| trial.does)
    }

    /// Whether no other trial is as good in bits, noise, delay and life and better in one of them.
    #[must_use]
    pub fn is_pareto(&self, trial: &WordLengthTrial) -> bool {
        let all = self.uniform.iter().chain(&self.greedy);
        let own = costs(trial);
        !all.map(costs).any(|other| {
            let pairs = || other.iter().zip(&own);
            pairs().all(|(other, own)| other <= own) && pairs().any(|(other, own)| other < own)
        })
    }
}

/// What is to be small: bits, how far the noise is from that of binary64, change of the delay, and the life with
/// its sign.
fn costs(trial: &WordLengthTrial) -> [f64; 4] {
    [
        f64::from(trial.words.total_bits()),
        trial
            .arw_ratio
            .map_or(f64::INFINITY, |ratio| ratio.ln().abs()),
        trial.delay_change_us.map_or(0.0, f64::abs),
        -trial.diverged_at_s.unwrap_or(f64::INFINITY),
    ]
}

/// Searches the shortest words of a filter.
///
/// # Errors
/// No such filter, constants that no words hold, a gyro without words.
pub fn word_lengths(
    plan: &Plan,
    filter: &str,
    limits: WordLengthLimits,
) -> Result<WordLengths, WordLengthError> {
    let bench = Bench::new(plan, filter, limits)?;
    let mut found = WordLengths {
        kind: bench.kind(),
        samples: bench.samples(),
        filtered_s: bench.filtered_s(),
        uniform: Vec::new(),
        greedy: Vec::new(),
    };
    let given = bench.words();
    let integer_bits = given.signals.iter().map(|(_, word)| word.integer_bits);
    for bits in integer_bits.max().unwrap_or(1).max(2)..=BITS_MAX {
        let trial = match bench.trial(given.clone().uniform(bits)) {
            // Too short for a constant; what no length holds is told at the last one.
            Err(WordLengthError::Pipeline(_)) if bits < BITS_MAX => continue,
            trial => trial?,
        };
        found.uniform.push(trial);
        if found.uniform.last().is_some_and(|trial| trial.does) {
            break;
        }
    }
    let Some(mut best) = found.uniform.last().filter(|trial| trial.does).cloned() else {
        return Ok(found);
    };
    for (signal, word) in &given.signals {
        best = shortened(&bench, best, signal, word.integer_bits)?;
        found.greedy.push(best.clone());
    }
    Ok(found)
}

/// The shortest words of a signal beside the others, by halving.
fn shortened(
    bench: &Bench,
    mut best: WordLengthTrial,
    signal: &str,
    integer_bits: u32,
) -> Result<WordLengthTrial, WordLengthError> {
    let bits = |words: &FixedWords| words.word(signal).word_bits;
    // A word of integer bits alone may do.
    let mut too_short = integer_bits.saturating_sub(1).max(1);
    while bits(&best.words) > too_short + 1 {
        let middle = too_short.midpoint(bits(&best.words));
        match bench.trial(best.words.clone().with_bits(signal, middle)) {
            Ok(trial) if trial.does => best = trial,
            // Too short for a constant as well.
            Ok(_) | Err(WordLengthError::Pipeline(_)) => too_short = middle,
            Err(error) => return Err(error),
        }
    }
    Ok(best)
}
