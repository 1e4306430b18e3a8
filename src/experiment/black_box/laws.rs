//! Whether a filter keeps the laws of a linear one that does not change, and what it makes of a glitch.

use super::Figure;
use super::memory::MARGIN;
use super::subject::{Lack, Twins, rms};
use crate::metrics::catalogue::{
    GLITCH_RESPONSE, LINEARITY_ERROR, SATURATION_GAIN, START_UP, TIME_INVARIANCE_ERROR,
};
use crate::metrics::{MetricKey, TwinFigure};
use crate::random::Streams;

/// A figure of a law, by twins.
type Law = fn(&Twins) -> Figure;

/// What is told here, with its key.
pub(super) const LAWS: [(&MetricKey, Law); 5] = [
    (&LINEARITY_ERROR, linearity),
    (&TIME_INVARIANCE_ERROR, time_invariance),
    (&GLITCH_RESPONSE, glitch),
    (&START_UP, start_up),
    (&SATURATION_GAIN, saturation),
];

/// Period of the added swing, samples, and its amplitude in standard deviations of the noise.
const SWING: (f64, f64) = (200.0, 10.0);

/// Words by which the record begins later: a prime number, so that no block divides it.
const SHIFT: usize = 137;

/// Standard deviations of the noise that a glitch has.
const GLITCH: f64 = 100.0;

/// Sizes of large steps, standard deviations of the noise, and the field of the gain of each.
const LARGE: [(f64, &str); 3] = [
    (1e2, "gain_at_100_sigma"),
    (1e3, "gain_at_1000_sigma"),
    (1e5, "gain_at_100000_sigma"),
];

/// Part of the largest difference below which a start is over.
const STARTED: f64 = 0.01;

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

/// How long it matters that the record began.
fn start_up(twins: &Twins) -> Figure {
    let middle = twins.middle();
    let begun = twins.answer(&twins.words[middle..])?;
    let pairs = begun.iter().zip(&twins.own[middle..]);
    let changes: Vec<f64> = pairs.map(|(begun, own)| (begun - own).abs()).collect();
    let largest = changes.iter().fold(0.0, |most: f64, own| most.max(*own));
    let is_over = |change: &f64| *change <= (STARTED * largest).max(twins.rounding());
    let last = changes.iter().rposition(|change| !is_over(change));
    let samples = last.map_or(0, |last| last + 1);
    if samples as f64 > (1.0 - MARGIN) * changes.len() as f64 {
        let left_s = changes.len() as f64 * twins.sample_period_s;
        return Err(
            format!("it takes longer than the second half of the record, {left_s:.4} s").into(),
        );
    }
    let figure = TwinFigure::alone(samples as f64 * twins.sample_period_s);
    Ok(figure.with("largest_deg_per_h", largest))
}

/// How the gain falls as a step becomes large.
fn saturation(twins: &Twins) -> Figure {
    let middle = twins.middle();
    let tail = twins.words.len() - middle / 2;
    let gain = |height: f64| -> Result<f64, Lack> {
        let words = twins.changed(|at, word| if at < middle { word } else { word + height });
        let change = twins.difference(&words)?;
        let tail = &change[tail..];
        Ok(tail.iter().sum::<f64>() / (height * tail.len() as f64))
    };
    let (mut least, mut largest) = (f64::INFINITY, 0.0_f64);
    let mut figure = TwinFigure::alone(f64::NAN);
    for (size, field) in LARGE {
        let height = size * twins.sigma;
        let gains = [gain(height)?, gain(-height)?];
        for gain in gains {
            least = least.min(gain);
            largest = largest.max(gain);
        }
        figure.fields.insert(field, 0.5 * (gains[0] + gains[1]));
    }
    if largest <= 0.0 {
        return Err("the filter passes no large step".into());
    }
    figure.value = least / largest;
    Ok(figure)
}
