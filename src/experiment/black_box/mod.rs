//! What a black box cannot hide: a filter on twins of its own record, whatever makes its words.
//!
//! Each twin is the record with something known changed, given to the filter as it is at first. Everything is
//! told from the words that come back. Of a long record the beginning is taken ([`WORDS_MAX`]).

mod gains;
mod laws;
mod look_ahead;
mod memory;
mod subject;
mod swing;

use rayon::prelude::*;

use crate::experiment::run::Unfinished;
use crate::metrics::catalogue::{DELAY_AT_REST, LOOK_AHEAD, MEMORY_0P1_PERCENT, MEMORY_1_PERCENT};
use crate::metrics::{Applies, BlackBox, MetricKey, TwinFigure, Unavailable};
use crate::scenario::{BlackBoxTrial, Scenario};

pub(super) use subject::{BuiltIn, Handing, Subject};
use subject::{Lack, Twins};

/// Most words of a record that a twin is given: 260 s of the paper's gyro, and a second of the recursive
/// least squares for all of them.
const WORDS_MAX: usize = 1 << 20;

/// Fewest words that tell anything.
const WORDS_MIN: usize = 64;

/// Words to make twins of.
#[derive(Clone, Copy, Debug)]
pub(super) struct TwinInput<'a> {
    /// Input of the filter from its first word on, deg/h.
    pub(super) words_deg_per_h: &'a [f64],
    /// Sample period, s.
    pub(super) sample_period_s: f64,
}

/// A figure, or why there is none.
type Figure = Result<TwinFigure, Lack>;

/// Everything that twins tell of a filter, as far as it is asked for; none where nothing is.
pub(super) fn examine(
    subject: &dyn Subject,
    input: &TwinInput,
    trial: Option<BlackBoxTrial>,
) -> Result<Option<BlackBox>, Unfinished> {
    let Some(trial) = trial else {
        return Ok(None);
    };
    let mut found = BlackBox::default();
    let mut keep = |key: &'static MetricKey, figure: Figure| -> Result<Option<f64>, Unfinished> {
        let figure = match figure {
            Err(Lack::Unfinished(unfinished)) => return Err(unfinished),
            Err(Lack::Reason(reason)) => Err(reason),
            Ok(figure) => Ok(figure),
        };
        let value = figure.as_ref().ok().map(|figure| figure.value);
        found.keep(key, figure);
        Ok(value)
    };
    let is_whole = trial == BlackBoxTrial::Whole;
    let twins = match Twins::of(subject, input, is_whole) {
        Ok(twins) => twins,
        Err(Lack::Unfinished(unfinished)) => return Err(unfinished),
        Err(Lack::Reason(reason)) => {
            for key in all_keys() {
                keep(key, Err(Lack::Reason(reason.clone())))?;
            }
            return Ok(Some(found));
        }
    };
    keep(&LOOK_AHEAD, look_ahead::look_ahead(&twins))?;
    let [percent, tenth, delay] = memory::direct(&twins);
    let percent_s = keep(&MEMORY_1_PERCENT, percent)?;
    let memory_s = keep(&MEMORY_0P1_PERCENT, tenth)?.or(percent_s);
    keep(&DELAY_AT_REST, delay)?;
    for (key, figure) in gains::gains(&twins, memory_s.unwrap_or(0.0)) {
        keep(key, figure)?;
    }
    if is_whole {
        let laws = laws::LAWS.par_iter().map(|(key, law)| (*key, law(&twins)));
        for (key, figure) in laws.collect::<Vec<_>>() {
            keep(key, figure)?;
        }
        for (key, figure) in swing::KEYS.into_iter().zip(swing::swing(&twins, memory_s)) {
            keep(key, figure)?;
        }
    } else {
        for key in keys_of_whole() {
            keep(key, Err("left out by trial.black_box = \"brief\"".into()))?;
        }
    }
    Ok(Some(found))
}

/// Keys of everything that twins tell.
fn all_keys() -> Vec<&'static MetricKey> {
    let first = [
        &LOOK_AHEAD,
        &MEMORY_1_PERCENT,
        &MEMORY_0P1_PERCENT,
        &DELAY_AT_REST,
    ];
    let first = first.into_iter().chain(gains::keys());
    first.chain(keys_of_whole()).collect()
}

/// Keys of what is only told where everything is asked for.
fn keys_of_whole() -> impl Iterator<Item = &'static MetricKey> {
    let laws = laws::LAWS.iter().map(|(key, _)| *key);
    laws.chain(swing::KEYS)
}

/// The same lacking figures for one reason, where words of a channel cannot be made again.
pub(super) fn hidden(trial: Option<BlackBoxTrial>, reason: &'static str) -> Option<BlackBox> {
    trial?;
    let mut found = BlackBox::default();
    for key in all_keys() {
        found.keep(key, Err(Unavailable::from(reason)));
    }
    Some(found)
}

/// Why no channel of a scenario has a metric of twins; nothing for other metrics.
pub(super) fn lacks(scenario: &Scenario, key: &MetricKey) -> Option<&'static str> {
    let is_lacking = key.applies == Applies::Twins && scenario.trial.black_box.is_none();
    is_lacking.then_some("it needs trial.black_box = \"brief\" or \"whole\"")
}

#[cfg(test)]
mod tests;
