//! Whether a filter keeps the laws of a linear one that does not change, and what it makes of a glitch.

use super::Figure;
use super::subject::{Lack, Twins, rms};
use crate::metrics::catalogue::{GLITCH_RESPONSE, LINEARITY_ERROR, TIME_INVARIANCE_ERROR};
use crate::metrics::{MetricKey, TwinFigure};
use crate::random::Streams;

/// A figure of a law, by twins.
type Law = fn(&Twins) -> Figure;

/// What is told here, with its key.
pub(super) const LAWS: [(&MetricKey, Law); 3] = [
    (&LINEARITY_ERROR, linearity),
    (&TIME_INVARIANCE_ERROR, time_invariance),
    (&GLITCH_RESPONSE, glitch),
];

/// Period of the added swing, samples, and its amplitude in standard deviations of the noise.
const SWING: (f64, f64) = (200.0, 10.0);

/// Words by which the record begins later: a prime number, so that no block divides it.
const SHIFT: usize = 137;

/// Standard deviations of the noise that a glitch has.
const GLITCH: f64 = 100.0;

/// Largest departure from linearity.
fn linearity(twins: &Twins) -> Figure {
    let mut noise = vec![0.0; twins.words.len()];
    Streams::new(0, 0)
        .stream("black box")
        .fill_normal(&mut noise);
    noise.iter_mut().for_each(|draw| *draw *= twins.sigma);
    let (period, amplitude) = SWING;
    let swing = |at: usize| {
        let phase = std::f64::consts::TAU * at as f64 / period;
        amplitude * twins.sigma * phase.sin()
    };
    let swing: Vec<f64> = (0..twins.words.len()).map(swing).collect();
    let half = twins.middle()..;
    let own = &twins.own[half.clone()];
    let of_scaled = |scale: f64| -> Result<f64, Lack> {
        let answer = twins.answer(&twins.changed(|_, word| scale * word))?;
        let pairs = answer[half.clone()].iter().zip(own);
        let error = rms(pairs.map(|(answer, own)| answer - scale * own));
        Ok(error / (scale.abs() * rms(own.iter().copied())))
    };
    let of_sum = |added: &[f64]| -> Result<f64, Lack> {
        let alone = twins.answer(added)?;
        let alone = &alone[half.clone()];
        let sum = twins.answer(&twins.changed(|at, word| word + added[at]))?;
        let sum = sum[half.clone()].iter().zip(own).zip(alone);
        let error = rms(sum.map(|((sum, own), alone)| sum - own - alone));
        Ok(error / rms(alone.iter().copied()))
    };
    let errors = [
        ("with_noise", of_sum(&noise)?),
        ("with_swing", of_sum(&swing)?),
        ("twice", of_scaled(2.0)?),
        ("negative", of_scaled(-1.0)?),
    ];
    if errors.iter().any(|(_, error)| !error.is_finite()) {
        return Err("the filter gives nothing that errors could be compared with".into());
    }
    let largest = errors
        .iter()
        .fold(0.0, |most: f64, (_, error)| most.max(*error));
    let mut figure = TwinFigure::alone(largest);
    figure.fields.extend(errors);
    Ok(figure)
}

/// Largest change of the outputs when the record begins later.
fn time_invariance(twins: &Twins) -> Figure {
    if twins.words.len() < 4 * SHIFT {
        return Err(format!("the record holds less than {} words", 4 * SHIFT).into());
    }
    let later = twins.answer(&twins.words[SHIFT..])?;
    let middle = twins.middle();
    let pairs = later[middle - SHIFT..].iter().zip(&twins.own[middle..]);
    let most = pairs.fold(0.0, |most: f64, (later, own)| most.max((later - own).abs()));
    if twins.own_std <= 0.0 {
        return Err("the outputs do not change".into());
    }
    Ok(TwinFigure::alone(most / twins.own_std).with("shift_samples", SHIFT as f64))
}

/// Answer to one word far outside.
fn glitch(twins: &Twins) -> Figure {
    let middle = twins.middle();
    let height = GLITCH * twins.sigma;
    let words = twins.changed(|at, word| if at == middle { word + height } else { word });
    let change = twins.difference(&words)?;
    let largest = change
        .iter()
        .fold(0.0, |most: f64, own| most.max(own.abs()));
    let beyond = change.iter().filter(|own| own.abs() > twins.sigma).count();
    Ok(TwinFigure::alone(largest / height).with("samples_beyond_sigma", beyond as f64))
}
