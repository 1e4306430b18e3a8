//! How long an output remembers one word.

use rayon::prelude::*;

use super::Figure;
use super::subject::{Lack, Twins};
use crate::metrics::TwinFigure;

/// Parts of the record at which a word is changed, in eighths.
const PLACES: [usize; 3] = [4, 3, 5];

/// Parts of the largest change.
const PARTS: [f64; 2] = [1e-2, 1e-3];

/// Part of what is left of the record that the memory must leave unchanged to be known.
pub(super) const MARGIN: f64 = 0.1;

/// Memory to 1 % and to 0.1 % and delay, by one word changed by its noise.
pub(super) fn direct(twins: &Twins) -> [Figure; 3] {
    let places = if twins.is_whole {
        &PLACES[..]
    } else {
        &PLACES[..1]
    };
    let place = |eighths: &usize| twins.words.len() * eighths / 8;
    let changes: Result<Vec<(usize, Vec<f64>)>, Lack> = places
        .par_iter()
        .map(|eighths| {
            let place = place(eighths);
            let words = twins.changed(|at, word| {
                if at == place {
                    word + twins.sigma
                } else {
                    word
                }
            });
            Ok((place, twins.difference(&words)?))
        })
        .collect();
    match changes {
        Ok(changes) => {
            let [percent, tenth] = PARTS.map(|part| of_changes(twins, &changes, part));
            let delay = delay(twins, &changes, &tenth);
            [percent, tenth, delay]
        }
        Err(lack) => [Err(lack.again()), Err(lack.again()), Err(lack)],
    }
}

/// Centroid of the changes within twice the memory, beyond which a millionth of one pole is left.
fn delay(twins: &Twins, changes: &[(usize, Vec<f64>)], memory: &Figure) -> Figure {
    let memory = memory.as_ref().map_err(Lack::again)?;
    let memory = twins.samples(memory.value);
    let reach = 2 * memory + twins.register_samples();
    let (mut moment, mut sum) = (0.0, 0.0);
    for (place, change) in changes {
        // A filter that looks ahead changes outputs before the word as well.
        for (at, own) in change.iter().enumerate().take(place.saturating_add(reach)) {
            moment += (at as f64 - *place as f64) * own;
            sum += own;
        }
    }
    if sum.abs() <= twins.rounding() {
        return Err("what one word changes in the outputs adds up to nothing".into());
    }
    let samples = moment / sum;
    let figure = TwinFigure::alone(1e3 * samples * twins.sample_period_s);
    Ok(figure.with("samples", samples))
}

/// The longest memory of several words.
fn of_changes(twins: &Twins, changes: &[(usize, Vec<f64>)], part: f64) -> Figure {
    let mut longest = None;
    for (place, change) in changes {
        let after = &change[*place..];
        let largest = after.iter().fold(0.0, |most: f64, own| most.max(own.abs()));
        if largest <= twins.rounding() {
            continue;
        }
        let last = after.iter().rposition(|own| own.abs() > part * largest);
        let samples = last.map_or(0, |last| last + 1);
        if samples as f64 > (1.0 - MARGIN) * after.len() as f64 {
            return Err(longer_than(after.len() as f64 * twins.sample_period_s));
        }
        let samples = samples.saturating_sub(twins.register_samples());
        longest = longest.max(Some(samples));
    }
    let samples = longest.ok_or("no output changes with one word by its noise")?;
    let figure = TwinFigure::alone(samples as f64 * twins.sample_period_s);
    Ok(figure.with("samples", samples as f64))
}

fn longer_than(time_s: f64) -> Lack {
    format!("it is longer than the {time_s:.4} s behind the word that was changed").into()
}
