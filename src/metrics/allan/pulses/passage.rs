//! Times at which the angle first passes one pulse more: a record without quantisation.

use crate::metrics::estimate::interval;

/// Most pulses in a word of the mean rate: of more the words do not tell when each came.
const PULSES_PER_WORD_MAX: f64 = 1.0;

/// Fewest intervals that make a record.
const INTERVALS_MIN: usize = 80;

/// Angle of an interval, in `N^2/v`, from which on the skewness of first passage times does no harm: the
/// excess kurtosis of the inverse Gaussian distribution, 15 over it, is then 0.3.
const STEADINESS: f64 = 50.0;

/// Variance of an interval, in squares of the word's period, from which on the place of a passage within
/// its word is random.
const DITHER: f64 = 0.25;

/// Words in an interval, at least: those nearer are correlated as a loop makes them.
const WORDS_MIN: f64 = 10.0;

/// Scatter of the intervals over their mean up to which a rate is one that may be called steady.
const SCATTER_MAX: f64 = 0.5;

/// Rounds in which number of pulses and walk settle.
const ROUNDS: usize = 4;

/// Intervals of equal angle.
///
/// At a mean rate v the angle walks over the next pulse L, beyond the largest it ever had, after a time
/// of the inverse Gaussian distribution with mean `L/v` and variance `N^2 L/v^3`, whatever came before
/// (strong Markov property). The intervals, taken linearly, are thus rates averaged over `L/v` with
/// the walk N, exactly.
///
/// Source: Cox and Miller, The Theory of Stochastic Processes (1965), section 5.7.
#[derive(Clone, Debug)]
pub(crate) struct Passages {
    /// Pulses that one interval takes.
    pub(crate) pulses: usize,
    /// Mean rate over each interval, deg/h, linear in its length.
    pub(crate) rates_deg_per_h: Vec<f64>,
    /// Mean length of an interval, s.
    pub(crate) period_s: f64,
    /// Square of the angle random walk, (deg/h)^2 s, by differences of neighbours.
    pub(crate) white: f64,
    /// Mean rate, deg/h.
    pub(crate) rate_deg_per_h: f64,
}

impl Passages {
    /// The intervals of a record of words that count pulses; nothing where it does not turn steadily
    /// enough for them, or too fast.
    ///
    /// * `step`: word of one pulse, deg/h; `step_arcsec`: its angle.
    pub(crate) fn new(words: &[f64], step: f64, sample_period_s: f64) -> Option<Self> {
        let step_arcsec = step * sample_period_s;
        let mean = interval::mean(words);
        let per_word = mean.abs() / step;
        if per_word > PULSES_PER_WORD_MAX || per_word * (words.len() as f64) < INTERVALS_MIN as f64
        {
            return None;
        }
        let firsts = first_words(words, step * mean.signum());
        let mut pulses = 1;
        let mut found = None;
        for _ in 0..ROUNDS {
            let passages = Self::every(
                pulses,
                &firsts,
                mean.signum() * step_arcsec,
                sample_period_s,
            )?;
            let rate = passages.rate_deg_per_h.abs();
            let white = passages.white.max(f64::MIN_POSITIVE);
            let needed = [
                STEADINESS * white / rate,
                DITHER * sample_period_s * sample_period_s * rate.powi(3) / white,
                WORDS_MIN * sample_period_s * rate,
            ];
            let needed = needed.into_iter().fold(0.0, f64::max) / step_arcsec;
            found = Some(passages);
            if needed <= pulses as f64 {
                break;
            }
            if needed > firsts.len() as f64 {
                return None;
            }
            pulses = interval::round_to_count(needed.ceil());
            found = None;
        }
        found.filter(|it| it.white > 0.0)
    }

    fn every(pulses: usize, firsts: &[usize], step: f64, sample_period_s: f64) -> Option<Self> {
        let times: Vec<usize> = firsts.iter().copied().step_by(pulses).collect();
        let intervals: Vec<f64> = times
            .windows(2)
            .map(|two| (two[1] - two[0]) as f64 * sample_period_s)
            .collect();
        if intervals.len() < INTERVALS_MIN {
            return None;
        }
        let period_s = interval::mean(&intervals);
        let scatter = interval::sample_variance(&intervals).sqrt();
        if scatter > SCATTER_MAX * period_s && pulses > 1 {
            return None;
        }
        let angle = pulses as f64 * step;
        let rate = angle / period_s;
        let squares: f64 = intervals
            .windows(2)
            .map(|two| (two[1] - two[0]).powi(2))
            .sum();
        let half = squares / (2.0 * (intervals.len() - 1) as f64);
        // Passages are stamped at the end of their word: a second difference of stamps has half a
        // square of its period more.
        let own = half - sample_period_s * sample_period_s / 4.0;
        Some(Self {
            pulses,
            rates_deg_per_h: intervals
                .iter()
                .map(|it| rate * (2.0 - it / period_s))
                .collect(),
            period_s,
            white: own * rate.abs().powi(3) / angle.abs(),
            rate_deg_per_h: rate,
        })
    }

    /// `tau^2` times the Allan variance that the stamps make, arcsec^2: each is late by a part of a word.
    pub(crate) fn stamps(&self, sample_period_s: f64) -> f64 {
        (self.rate_deg_per_h * sample_period_s).powi(2) / 4.0
    }
}

/// The words at which the number of pulses first reaches each multiple, in the sense of the mean rate.
fn first_words(words: &[f64], step: f64) -> Vec<usize> {
    let (mut count, mut largest) = (0.0, 0.0);
    let mut firsts = Vec::new();
    for (index, word) in words.iter().enumerate() {
        count += (word / step).round();
        while largest < count {
            largest += 1.0;
            firsts.push(index);
        }
    }
    firsts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Streams;

    /// Words of a walk of N^2 = 0.1296 at this rate, counted in pulses of `step` arcsec.
    fn counted(step: f64, rate: f64, period_s: f64, count: usize) -> Vec<f64> {
        let mut words = vec![0.0; count];
        Streams::new(7, 0).stream("walk").fill_normal(&mut words);
        let mut left = 0.0;
        for word in &mut words {
            let angle = rate * period_s + 0.36 * period_s.sqrt() * *word + left;
            let pulses = (angle / step).round();
            left = angle - pulses * step;
            *word = pulses * step / period_s;
        }
        words
    }

    #[test]
    fn times_between_pulses_tell_the_walk_in_either_sense() {
        let period_s = 0.01;
        for (step, rate) in [(5.0, 8.47), (5.0, -8.47), (1.0, 20.0)] {
            let words = counted(step, rate, period_s, 400_000);
            let passages = Passages::new(&words, step / period_s, period_s).expect("a record");
            let intervals = passages.rates_deg_per_h.len() as f64;
            // The square of neighbours' differences has two thirds of the information.
            let error = (3.0 / intervals).sqrt();
            let ratio = passages.white / 0.1296;
            assert!((ratio - 1.0).abs() < 4.0 * error, "{step} {rate}: {ratio}");
            assert!((passages.rate_deg_per_h / rate - 1.0).abs() < 0.01);
            let mean = interval::mean(&passages.rates_deg_per_h);
            assert!((mean / passages.rate_deg_per_h - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn a_rate_of_zero_or_too_few_pulses_have_no_times() {
        let period_s = 0.01;
        for (step, rate) in [(1.0, 0.0), (200.0, 8.47)] {
            let words = counted(step, rate, period_s, 100_000);
            assert!(Passages::new(&words, step / period_s, period_s).is_none());
        }
    }
}
