//! Noise like that of a record, for filters that run again.
//!
//! Pieces of the record's noise from near their place, of either sign, fade into each other by sine and
//! cosine: the sum of the squares of these is 1, so that independent pieces keep their power. Each piece
//! is many times as long as the words of a gyro correlate, and its ends are soft: the colour stays, to
//! zero frequency. As pieces stay about where they were, so does noise that changes with the rate. Slow
//! noise, of which a record shows next to nothing, is not in it.
//!
//! Source: derived; Kuensch, Annals of Statistics 17 (1989), for blocks drawn with replacement, Paparoditis
//! and Politis, Biometrika 88 (2001), for tapered ones, C. R. Acad. Sci. Paris 335 (2002), for local ones.

use std::f64::consts::PI;

use crate::metrics::estimate::interval::{PER_MEDIAN, median, round_to_count};
use crate::random::Streams;

/// Samples of a piece: some thirty times those over which the words of a gyro correlate.
const PIECE: usize = 480;

/// Pieces that a record holds, at least: those of a short one are shorter.
const PIECES_MIN: usize = 16;

/// Part of the record by which a piece may be from before its place or from behind it.
const NEAR: f64 = 1.0 / 24.0;

/// Words on either side of a step in which it leaves something of itself: those over which the words of a gyro
/// correlate.
const STEP_REACH: usize = 16;

/// Rate from one word to the next that is a step, in standard deviations of the noise.
const STEP: f64 = 4.0;

/// The noise of words, given what of them is none; where the motion steps it is that of the words behind.
///
/// What a step leaves of itself is the same in every record and stays where it is. Moved, it would be noise.
#[must_use]
pub fn noise_beside_steps(words: &[f64], motion: &[f64]) -> Vec<f64> {
    let pairs = words.iter().zip(motion);
    let mut noise: Vec<f64> = pairs.map(|(word, motion)| word - motion).collect();
    let mut sizes: Vec<f64> = noise.iter().map(|value| value.abs()).collect();
    // The median, which few steps do not move.
    let least = STEP * PER_MEDIAN * median(&mut sizes);
    let is_step = |at: &usize| (motion[*at] - motion[at - 1]).abs() > least;
    let steps: Vec<usize> = (1..noise.len()).filter(is_step).collect();
    for near in steps.chunk_by(|step, next| next - step <= 2 * STEP_REACH) {
        let start = near[0].saturating_sub(STEP_REACH);
        let end = (near[near.len() - 1] + STEP_REACH + 1).min(noise.len());
        for place in start..end {
            let behind = 2 * end - 1 - place;
            let before = (2 * start).checked_sub(place + 1);
            let from = noise.get(behind).or(before.and_then(|at| noise.get(at)));
            noise[place] = from.copied().unwrap_or_default();
        }
    }
    noise
}

/// Noise like `noise`; one draw for each `run`.
#[must_use]
pub fn noise_like(noise: &[f64], run: u64) -> Vec<f64> {
    let samples = noise.len();
    let hop = (PIECE / 2).min(samples / (2 * PIECES_MIN)).max(1);
    let window: Vec<f64> = (0..2 * hop)
        .map(|index| (PI * (index as f64 + 0.5) / (2 * hop) as f64).sin())
        .collect();
    let mut stream = Streams::new(0, run).stream("pieces of noise");
    let mut made = vec![0.0; samples + 2 * hop];
    let last = samples.saturating_sub(2 * hop) as f64;
    // At either end from as wide a part as elsewhere: pieces that stayed where the record begins would be the
    // same in all runs, and filters that forget nothing learn the most from them.
    let near = (NEAR * samples as f64).min(0.5 * last);
    for start in (0..=samples).step_by(hop) {
        // The first half of the first piece is cut off below.
        let place = start as f64 - hop as f64;
        let away = (2.0 * stream.uniform() - 1.0) * near;
        let from = round_to_count(place.clamp(near, last - near) + away);
        let sign = stream.normal().signum();
        let piece = noise[from..].iter().zip(&window);
        for (sum, (value, weight)) in made[start..].iter_mut().zip(piece) {
            *sum += sign * value * weight;
        }
    }
    // Half a piece in, both of two pieces are there.
    made.drain(..hop);
    made.truncate(samples);
    made
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_step_leaves_of_itself_is_no_noise() {
        let mut stream = Streams::new(4, 0).stream("white");
        let mut motion = vec![0.0; 2000];
        motion[700..].fill(1000.0);
        motion[1990..].fill(-1000.0);
        let white: Vec<f64> = motion.iter().map(|_| stream.normal()).collect();
        let mut words: Vec<f64> = white.iter().zip(&motion).map(|(a, b)| a + b).collect();
        for left in [700, 701, 1990] {
            words[left] += 50.0;
        }
        let noise = noise_beside_steps(&words, &motion);
        assert!(noise.iter().all(|value| value.abs() < 6.0));
        let same = noise
            .iter()
            .zip(&white)
            .filter(|(a, b)| (*a - *b).abs() < 1e-9);
        assert!((1900..2000).contains(&same.count()));
    }

    #[test]
    fn no_run_begins_with_the_noise_that_another_begins_with() {
        let mut stream = Streams::new(5, 0).stream("white");
        let white: Vec<f64> = (0..40_000).map(|_| stream.normal()).collect();
        let mut first: Vec<f64> = (0..40)
            .map(|run| noise_like(&white, run)[0].abs())
            .collect();
        first.sort_by(f64::total_cmp);
        // Of the same two pieces it would be the same but for their signs.
        let apart = first.windows(2).map(|two| two[1] - two[0]);
        assert!(apart.fold(f64::INFINITY, f64::min) > 1e-9);
    }

    #[test]
    fn it_has_the_colour_of_the_noise_to_zero_frequency() {
        let mut stream = Streams::new(3, 0).stream("white");
        let white: Vec<f64> = (0..40_001).map(|_| stream.normal()).collect();
        let differences: Vec<f64> = white.windows(2).map(|two| two[1] - two[0]).collect();
        let (mut squares, mut products, mut sums) = (0.0, 0.0, 0.0);
        let runs = 50;
        for run in 0..runs {
            let made = noise_like(&differences, run);
            let pairs = made.windows(2).map(|two| two[0] * two[1]);
            squares += made.iter().map(|value| value * value).sum::<f64>();
            products += pairs.sum::<f64>();
            sums += made.iter().sum::<f64>().powi(2);
        }
        let samples = 40_000.0 * 50.0;
        assert!((squares / samples / 2.0 - 1.0).abs() < 0.03, "{squares}");
        assert!((products / samples + 1.0).abs() < 0.03, "{products}");
        // The sum of white values has a thousand times as much; the sharp ends of a run are 2.
        assert!(sums / samples < 2e-3, "{sums}");
    }
}
