//! Gains for small changes of the rate: a step at mid-record, and sines.

use std::f64::consts::TAU;

use rayon::prelude::*;

use super::Figure;
use super::subject::{Lack, Twins};
use crate::metrics::catalogue::{ADAPTATION_MEMORY, SINE_GAIN};
use crate::metrics::{GainUnits, MetricKey, SINE_FREQUENCY, STEP_GAINS, TwinFigure};
use crate::turntable::first_measured_index;

/// Sizes of a change in standard deviations of a word's noise; the figure is that of the first.
const SIZES: [(f64, &str); 3] = [
    (0.1, "gain_at_0p1_sigma"),
    (0.01, "gain_at_0p01_sigma"),
    (1.0, "gain_at_1_sigma"),
];

/// Signs of a change.
const SIGNS: [f64; 2] = [1.0, -1.0];

/// Cycles of the sines in the second half of the record, and the field of the gain of each.
const SINES: [(usize, &str); 4] = [
    (2, "gain_at_1_times"),
    (8, "gain_at_4_times"),
    (32, "gain_at_16_times"),
    (128, "gain_at_64_times"),
];

/// Keys of what is told here.
pub(super) fn keys() -> impl Iterator<Item = &'static MetricKey> {
    let steps = STEP_GAINS.iter().map(|(key, _)| *key);
    steps.chain([&ADAPTATION_MEMORY, &SINE_GAIN])
}

/// The answer to a change of one size and sign, over its size.
struct Answer {
    size: f64,
    field: &'static str,
    sign: f64,
    /// By sample.
    gain: Vec<f64>,
}

/// All of them.
///
/// * `memory_s`: behind which the gain for a step is taken.
pub(super) fn gains(twins: &Twins, memory_s: f64) -> Vec<(&'static MetricKey, Figure)> {
    let middle = twins.middle();
    let steps = answers(twins, |at| f64::from(u8::from(at >= middle)));
    let sines = answers(twins, |at| sines_at(twins, at));
    let mut found: Vec<(&'static MetricKey, Figure)> = STEP_GAINS
        .iter()
        .map(|(key, time_s)| {
            let figure = each(&steps, |steps| step_gain(twins, steps, *time_s, memory_s));
            (*key, figure)
        })
        .collect();
    found.push((
        &ADAPTATION_MEMORY,
        each(&steps, |steps| adaptation(twins, steps)),
    ));
    found.push((&SINE_GAIN, each(&sines, |sines| sine_gain(twins, sines))));
    found
}

/// A figure of answers that may be lacking.
fn each(answers: &Result<Vec<Answer>, Lack>, figure: impl Fn(&[Answer]) -> Figure) -> Figure {
    match answers {
        Ok(answers) => figure(answers),
        Err(lack) => Err(lack.again()),
    }
}

/// The answers to a change of every size and sign.
fn answers(twins: &Twins, shape: impl Fn(usize) -> f64 + Sync) -> Result<Vec<Answer>, Lack> {
    let (sizes, signs) = if twins.is_whole {
        (&SIZES[..], &SIGNS[..])
    } else {
        (&SIZES[..1], &SIGNS[..1])
    };
    let cases: Vec<(f64, &'static str, f64)> = sizes
        .iter()
        .flat_map(|(size, field)| signs.iter().map(move |sign| (*size, *field, *sign)))
        .collect();
    let answer = |&(size, field, sign): &(f64, &'static str, f64)| {
        let scale = size * sign * twins.sigma;
        let words = twins.changed(|at, word| word + scale * shape(at));
        let mut gain = twins.difference(&words)?;
        gain.iter_mut().for_each(|change| *change /= scale);
        Ok(Answer {
            size,
            field,
            sign,
            gain,
        })
    };
    cases.par_iter().map(answer).collect()
}

/// The mean over signs of what each answer of the first size shows, and fields for the other sizes.
fn pooled(answers: &[Answer], of: impl Fn(&Answer) -> f64) -> TwinFigure {
    let mean = |field: &str| {
        let own = answers.iter().filter(|answer| answer.field == field);
        let (sum, count) = own.fold((0.0, 0.0), |(sum, count), answer| {
            (sum + of(answer), count + 1.0)
        });
        (count > 0.0).then_some(sum / count)
    };
    let first = mean(SIZES[0].1).unwrap_or(f64::NAN);
    let sizes = SIZES
        .iter()
        .filter_map(|(_, field)| Some((*field, mean(field)?)));
    let mut figure = TwinFigure::alone(first);
    figure.fields.extend(sizes);
    let of_sign = |sign: f64| {
        let own = answers.iter().find(|answer| {
            (answer.sign - sign).abs() < 0.5 && (answer.size - SIZES[0].0).abs() <= 0.0
        });
        own.map(&of)
    };
    match of_sign(1.0).zip(of_sign(-1.0)) {
        Some((up, down)) => figure.with("difference_of_signs", up - down),
        None => figure,
    }
}

/// Mean gain over a time behind the step.
fn step_gain(twins: &Twins, steps: &[Answer], time_s: f64, memory_s: f64) -> Figure {
    let samples = |time_s: f64| {
        let samples = first_measured_index(time_s, twins.sample_period_s);
        usize::try_from(samples).unwrap_or(usize::MAX)
    };
    let start = twins.middle() + twins.register_samples() + samples(memory_s);
    let end = start.saturating_add(samples(time_s).max(1));
    if end > twins.words.len() {
        let left_s = (twins.words.len() - twins.middle()) as f64 * twins.sample_period_s;
        return Err(
            format!("the {left_s:.4} s behind the step do not hold memory and {time_s} s").into(),
        );
    }
    let figure = pooled(steps, |step| {
        step.gain[start..end].iter().sum::<f64>() / (end - start) as f64
    });
    Ok(figure.with("from_s", memory_s))
}

/// How long the gain for a step still changes.
fn adaptation(twins: &Twins, steps: &[Answer]) -> Figure {
    // The largest step is the surest.
    let most = steps
        .iter()
        .fold(0.0, |most: f64, step| most.max(step.size));
    let of_size = steps.iter().filter(|step| step.size >= most);
    let mut mean = vec![0.0; twins.words.len() - twins.middle()];
    let mut count = 0.0;
    for step in of_size {
        count += 1.0;
        let gains = step.gain[twins.middle()..].iter();
        mean.iter_mut()
            .zip(gains)
            .for_each(|(sum, gain)| *sum += gain);
    }
    mean.iter_mut().for_each(|sum| *sum /= count);
    let tail = &mean[mean.len() - mean.len() / 4..];
    let last = tail.iter().sum::<f64>() / tail.len() as f64;
    let ones = vec![1.0; mean.len()];
    let units = GainUnits::of_step(&mean, &ones, twins.sample_period_s);
    let found = units.readaptation(last).map_err(Lack::Reason)?;
    Ok(TwinFigure::alone(found.time_s.value)
        .with("first_gain", found.first_gain)
        .with("final_gain", last)
        .with("window_s", found.window_s))
}

/// Sine of one frequency: phase at a sample.
fn phase(twins: &Twins, cycles: usize, at: usize) -> f64 {
    let half = twins.words.len() - twins.middle();
    let part = (cycles * at % half) as f64 / half as f64;
    TAU * part
}

/// The four sines of amplitude 1 at a sample.
fn sines_at(twins: &Twins, at: usize) -> f64 {
    let sines = SINES
        .iter()
        .map(|(cycles, _)| phase(twins, *cycles, at).sin());
    sines.sum()
}

/// Gain for each of the sines over the second half of the record.
fn sine_gain(twins: &Twins, sines: &[Answer]) -> Figure {
    let half = twins.words.len() - twins.middle();
    let gain = |answer: &Answer, cycles: usize| {
        let (mut sine, mut cosine) = (0.0, 0.0);
        for at in twins.middle()..twins.words.len() {
            let (s, c) = phase(twins, cycles, at).sin_cos();
            sine += s * answer.gain[at];
            cosine += c * answer.gain[at];
        }
        sine.hypot(cosine) * 2.0 / half as f64
    };
    if 4 * SINES[3].0 > half {
        return Err(format!("the record holds less than {} words", 8 * SINES[3].0).into());
    }
    let mut figure = pooled(sines, |answer| gain(answer, SINES[0].0));
    let frequency_hz = SINES[0].0 as f64 / (half as f64 * twins.sample_period_s);
    figure.fields.insert(SINE_FREQUENCY, frequency_hz);
    for (cycles, field) in &SINES[1..] {
        let others = pooled(sines, |answer| gain(answer, *cycles));
        figure.fields.insert(field, others.value);
    }
    Ok(figure)
}
