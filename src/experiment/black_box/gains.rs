//! Gains for small changes of the rate: one that lasts, a step at mid-record, and sines; and mean out over mean in.

use std::f64::consts::TAU;

use rayon::prelude::*;

use super::Figure;
use super::subject::{Lack, Twins, std_of};
use crate::metrics::catalogue::{ADAPTATION_MEMORY, LASTING_RATE_GAIN, SINE_GAIN, TWIN_MEAN_RATIO};
use crate::metrics::{GainUnits, MetricKey, SINE_DELAY_MS, SINE_FREQUENCY, STEP_GAINS, TwinFigure};

/// Size of a change in standard deviations of a word's noise, and the field of the gain for it.
type Size = (f64, &'static str);

const HUNDREDTH: Size = (0.01, "gain_at_0p01_sigma");
const TENTH: Size = (0.1, "gain_at_0p1_sigma");
const WHOLE: Size = (1.0, "gain_at_1_sigma");

/// Sizes of steps and sines; the figure is that of the first.
const SIZES: [Size; 3] = [TENTH, HUNDREDTH, WHOLE];

/// Sizes of a rate that lasts: one of a tenth already teaches an adaptive filter that it is there.
const LASTING_SIZES: [Size; 3] = [HUNDREDTH, TENTH, WHOLE];

/// Signs of a change.
const SIGNS: [f64; 2] = [1.0, -1.0];

/// Cycles of the sines in the second half of the record, and the field of the gain of each.
const SINES: [(usize, &str); 4] = [
    (2, "gain_at_1_times"),
    (8, "gain_at_4_times"),
    (32, "gain_at_16_times"),
    (128, "gain_at_64_times"),
];

/// Blocks of the second half whose means tell how sure a mean is, and Student's t of as many.
const BLOCKS: (usize, f64) = (10, 2.262);

/// Least standard errors of a mean of which a ratio is told.
const MEAN_PER_ERROR_MIN: f64 = 10.0;

/// Keys of what is told here.
pub(super) fn keys() -> impl Iterator<Item = &'static MetricKey> {
    let steps = STEP_GAINS.iter().map(|(key, _)| *key);
    steps.chain([
        &ADAPTATION_MEMORY,
        &SINE_GAIN,
        &LASTING_RATE_GAIN,
        &TWIN_MEAN_RATIO,
    ])
}

/// The answer to a change of one size and sign, over its size.
struct Answer {
    size: f64,
    field: &'static str,
    sign: f64,
    /// Change of the words, deg/h.
    scale: f64,
    /// By sample.
    gain: Vec<f64>,
}

/// All of them.
///
/// * `memory_s`: behind which the gain for a step is taken.
pub(super) fn gains(twins: &Twins, memory_s: f64) -> Vec<(&'static MetricKey, Figure)> {
    let middle = twins.middle();
    let steps = answers(twins, &SIZES, |at| f64::from(u8::from(at >= middle)));
    let sines = answers(twins, &SIZES, |at| sines_at(twins, at));
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
    drop((steps, sines));
    let lasting = answers(twins, &LASTING_SIZES, |_| 1.0);
    found.push((
        &LASTING_RATE_GAIN,
        each(&lasting, |lasting| {
            Ok(pooled(lasting, |answer| mean(&answer.gain[middle..])))
        }),
    ));
    found.push((
        &TWIN_MEAN_RATIO,
        each(&lasting, |lasting| mean_ratio(twins, lasting)),
    ));
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
fn answers(
    twins: &Twins,
    sizes: &[Size],
    shape: impl Fn(usize) -> f64 + Sync,
) -> Result<Vec<Answer>, Lack> {
    let (sizes, signs) = if twins.is_whole {
        (sizes, &SIGNS[..])
    } else {
        (&sizes[..1], &SIGNS[..1])
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
            scale,
            gain,
        })
    };
    cases.par_iter().map(answer).collect()
}

/// Mean of some numbers.
fn mean(numbers: &[f64]) -> f64 {
    numbers.iter().sum::<f64>() / numbers.len() as f64
}

/// Mean out over mean in over the second half, of the sizes and signs that leave the mean sure.
fn mean_ratio(twins: &Twins, lasting: &[Answer]) -> Figure {
    let words = &twins.words[twins.middle()..];
    let own = &twins.own[twins.middle()..];
    let (count, student) = BLOCKS;
    let length = words.len() / count;
    let blocks = |of: &dyn Fn(usize) -> f64| {
        let means: Vec<f64> = (0..count)
            .map(|block| {
                let at = block * length..(block + 1) * length;
                at.map(of).sum::<f64>() / length as f64
            })
            .collect();
        std_of(&means) / ((count - 1) as f64).sqrt()
    };
    let (mean_in, mean_out) = (mean(words), mean(own));
    let error = blocks(&|at| words[at]);
    let is_sure = |mean: f64| mean.abs() >= MEAN_PER_ERROR_MIN * error;
    let ratio = |answer: &Answer| {
        let mean_in = mean_in + answer.scale;
        let mean_out = mean_out + answer.scale * mean(&answer.gain[twins.middle()..]);
        if is_sure(mean_in) {
            mean_out / mean_in
        } else {
            f64::NAN
        }
    };
    let figure = pooled(lasting, ratio);
    if !figure.value.is_finite() {
        return Err(format!(
            "the mean of {mean_in:.4} deg/h is less than {MEAN_PER_ERROR_MIN} of its standard errors of \
             {error:.4} deg/h"
        )
        .into());
    }
    // What output and input do not share of their noise, both ends of the record among it.
    let own_ratio = figure.value;
    let apart = blocks(&|at| own[at] - own_ratio * words[at]);
    let half = student * apart / (mean_in + lasting[0].scale).abs();
    Ok(figure.within(half).with("standard_error_deg_per_h", error))
}

/// The mean over signs of what each answer of the first size shows, and fields for all sizes; answers that
/// show no number are left out.
fn pooled(answers: &[Answer], of: impl Fn(&Answer) -> f64) -> TwinFigure {
    let shown: Vec<(&Answer, f64)> = answers.iter().map(|answer| (answer, of(answer))).collect();
    let mean = |field: &str| {
        let own = shown.iter().filter(|(answer, _)| answer.field == field);
        let own = own
            .map(|(_, shown)| *shown)
            .filter(|shown| shown.is_finite());
        let (sum, count) = own.fold((0.0, 0.0), |(sum, count), shown| (sum + shown, count + 1.0));
        (count > 0.0).then_some(sum / count)
    };
    let first = answers.first().map_or("", |answer| answer.field);
    let value = mean(first).unwrap_or(f64::NAN);
    let sizes = SIZES
        .iter()
        .filter_map(|(_, field)| Some((*field, mean(field)?)));
    let mut figure = TwinFigure::alone(value);
    figure.fields.extend(sizes);
    let of_sign = |sign: f64| {
        let is_own = |answer: &Answer| (answer.sign - sign).abs() < 0.5 && answer.field == first;
        let own = shown.iter().find(|(answer, _)| is_own(answer));
        own.map(|(_, shown)| *shown)
    };
    match of_sign(1.0).zip(of_sign(-1.0)) {
        Some((up, down)) if (up - down).is_finite() => {
            figure.with("difference_of_signs", up - down)
        }
        _ => figure,
    }
}

/// Mean gain over a time behind the step.
fn step_gain(twins: &Twins, steps: &[Answer], time_s: f64, memory_s: f64) -> Figure {
    let start = twins.middle() + twins.register_samples() + twins.samples(memory_s);
    let end = start.saturating_add(twins.samples(time_s).max(1));
    if end > twins.words.len() {
        let left_s = (twins.words.len() - twins.middle()) as f64 * twins.sample_period_s;
        return Err(
            format!("the {left_s:.4} s behind the step do not hold memory and {time_s} s").into(),
        );
    }
    let figure = pooled(steps, |step| mean(&step.gain[start..end]));
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
    let last = self::mean(&mean[mean.len() - mean.len() / 4..]);
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
    let parts = |answer: &Answer, cycles: usize| {
        let (mut sine, mut cosine) = (0.0, 0.0);
        for at in twins.middle()..twins.words.len() {
            let (s, c) = phase(twins, cycles, at).sin_cos();
            sine += s * answer.gain[at];
            cosine += c * answer.gain[at];
        }
        (2.0 / half as f64 * sine, 2.0 / half as f64 * cosine)
    };
    let gain = |answer: &Answer, cycles: usize| {
        let (sine, cosine) = parts(answer, cycles);
        sine.hypot(cosine)
    };
    if 4 * SINES[3].0 > half {
        return Err(format!("the record holds less than {} words", 8 * SINES[3].0).into());
    }
    let mut figure = pooled(sines, |answer| gain(answer, SINES[0].0));
    let frequency_hz = SINES[0].0 as f64 / (half as f64 * twins.sample_period_s);
    figure.fields.insert(SINE_FREQUENCY, frequency_hz);
    let late = pooled(sines, |answer| {
        let (sine, cosine) = parts(answer, SINES[0].0);
        (-cosine).atan2(sine) / (TAU * frequency_hz)
    });
    figure.fields.insert(SINE_DELAY_MS, 1e3 * late.value);
    for (cycles, field) in &SINES[1..] {
        let others = pooled(sines, |answer| gain(answer, *cycles));
        figure.fields.insert(field, others.value);
    }
    Ok(figure)
}
