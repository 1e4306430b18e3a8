//! A log that was smoothed: white noise that falls off inside an averaging time.

use std::f64::consts::PI;

use super::coarse::smallest_change;
use super::density::{Bin, Density};
use crate::metrics::estimate::interval::round_to_count;
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::{Applies, MetricKey, Needs};
use crate::wording::plain;

/// Averaging time of a smoothed log.
pub static SMOOTHING_TIME: MetricKey = MetricKey::new(
    "smoothing_averaging_time_s",
    "s",
    Applies::Log,
    "averaging time 1/(2 B) that the log's noise falls off inside, B its noise bandwidth: of a mean its length, of one pole two time constants",
)
.synonyms(&["smoothing", "averaging"])
.needs(Needs::Samples);

/// Least averaging time that counts as smoothing, words: what is shorter may be the loop of the gyro.
const WORDS_MIN: f64 = 10.0;

/// Largest part of the record that such a time is.
const PART_MAX: f64 = 1.0 / 50.0;

/// Frequency, in reciprocals of the averaging time, beyond which a smoothing leaves next to nothing, and the
/// largest part of its power that may lie there: a mean leaves 1.3 % of it, one pole 2.5 %.
const TAIL_FROM: f64 = 8.0;
const TAIL_MAX: f64 = 0.05;

/// Part of the smoothed density that is added to words and fits alike: how a low pass looks beyond that
/// does not count.
const DEPTH: f64 = 0.003;

/// Fits after the first, each with the depth that the one before says.
const REFINEMENTS: usize = 2;

/// Gain in twice the logarithm of the likelihood that smoothing must bring.
const GAIN_MIN: f64 = 20.0;

/// The same by which the interval of the averaging time is bounded: quantile 0.95 of chi-square with one
/// degree of freedom.
const GAIN_95: f64 = 3.841_458_820_694_124;

/// Factor by which the density of the pass band may lie off the fit, beyond its scatter.
const MISFIT_MAX: f64 = 2.0;

/// Independent ordinates that are compared with the fit together, at least.
const TOGETHER_MIN: f64 = 8.0;

/// Frequency, in reciprocals of the averaging time, at which white noise must stand above the slow.
const CORNER: f64 = 0.25;

/// Averaging times tried per factor of two.
const PER_OCTAVE: f64 = 6.0;

/// Steps of the fit of either kind.
const STEPS: usize = 8;

/// Sweeps of a least squares.
const SWEEPS: usize = 60;

/// A low pass as its power response shows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Smoothing {
    /// Mean over a time.
    Mean,
    /// Mean of such means.
    MeanOfMeans,
    /// Low pass without overshoot or with that of Butterworth: so many poles.
    Poles(u32),
}

impl Smoothing {
    /// Those that are tried.
    const ALL: [Self; 6] = [
        Self::Mean,
        Self::MeanOfMeans,
        Self::Poles(1),
        Self::Poles(2),
        Self::Poles(3),
        Self::Poles(4),
    ];

    /// Power response at a frequency, both in units of the words' rate, the averaging time `1/(2 B)` in
    /// words. One pole is the recursive one; more are those of the bilinear transform.
    fn power(self, frequency: f64, words: f64) -> f64 {
        match self {
            Self::Mean => mean_power(frequency, words),
            // Noise bandwidth of a triangle of length 2 L: two thirds of that of a mean of L.
            Self::MeanOfMeans => mean_power(frequency, words / 1.5).powi(2),
            Self::Poles(order) => {
                let poles = f64::from(order);
                // B of a Butterworth low pass: fc (pi/2n) / sin(pi/2n), in tangents of half the angle.
                let quarter = PI / (2.0 * poles);
                let cutoff = 0.5 / words * quarter.sin() / quarter;
                let warped = |frequency: f64| {
                    let half = PI * frequency.min(0.499);
                    if order == 1 { half.sin() } else { half.tan() }
                };
                let ratio = warped(frequency) / warped(cutoff);
                1.0 / (1.0 + ratio.powf(2.0 * poles))
            }
        }
    }

    /// In words, of an averaging time and the like.
    #[must_use]
    pub fn words(self) -> String {
        match self {
            Self::Mean => "a mean".to_owned(),
            Self::MeanOfMeans => "a mean of means".to_owned(),
            Self::Poles(1) => "a one-pole low pass".to_owned(),
            Self::Poles(order) => format!("a low pass of {order} poles"),
        }
    }
}

/// Power response of a mean of words.
fn mean_power(frequency: f64, words: f64) -> f64 {
    let turn = PI * frequency;
    if turn * words < 1e-4 {
        return 1.0;
    }
    let ratio = (turn * words).sin() / (words * turn.sin());
    ratio * ratio
}

/// How a log was smoothed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Smoothed {
    /// Averaging time `1/(2 B)`, s.
    pub averaging_time_s: Estimate,
    /// What it looks like.
    pub like: Smoothing,
    /// Gain in twice the logarithm of the likelihood over a record that was not.
    pub gain: f64,
}

/// Terms of a density: smoothed white noise, flicker and walk, and what lies under all frequencies.
const TERMS: usize = 4;

/// Finds out whether the white noise of a record falls off inside an averaging time.
///
/// The density of the words is fitted by likelihood (Whittle) with white noise, flicker and walk behind a
/// low pass, mean or mean of means, and a floor beside it; and without one. Smoothed is a log whose
/// likelihood asks for the low pass, whose floor has no more than a fiftieth of the power of the words
/// (rounding excepted), whose pass band is described, and whose white noise stands above the slow noise
/// there. A sine, a walk and a rounding are none of that; the loop of a gyro, whose response lies within a
/// few words, is below the ten words from which on an averaging time counts.
///
/// * `words_deg_per_h`: missing ones are NaN.
/// * `sample_period_s`: s, > 0.
///
/// # Errors
/// Why nothing is said: nothing shows, or too short a record.
pub fn find_smoothing(
    words_deg_per_h: &[f64],
    sample_period_s: f64,
) -> Result<Smoothed, Unavailable> {
    let Some(density) = Density::new(words_deg_per_h) else {
        return Err("the record is too short to show an averaging".into());
    };
    let none = || {
        Err(format!(
            "no averaging shows: the noise does not fall off inside averaging times of {} s and more",
            plain(WORDS_MIN * sample_period_s)
        )
        .into())
    };
    if !density.may_fall_off() {
        return none();
    }
    let most = PART_MAX * words_deg_per_h.len() as f64;
    let mut search = Search::new(&density.bins, DEPTH * density.largest());
    let mut best = search.best(most);
    for _ in 0..REFINEMENTS {
        // The depth follows the white noise found; drift may have made the largest density.
        search.depth = DEPTH * best.as_ref().map_or(0.0, Fit::plateau);
        best = search.best(most);
    }
    let Some(best) = best else {
        return none();
    };
    let gain = search.without() - best.deviance;
    let step = smallest_change(words_deg_per_h);
    let rounding = if step.is_finite() {
        step * step / 8.0
    } else {
        0.0
    };
    let stands = gain >= GAIN_MIN
        && (WORDS_MIN..=most).contains(&best.words)
        && search.is_sound(&best, rounding);
    if !stands {
        return none();
    }
    let [low, high] = search.interval(&best, most);
    let value = best.words * sample_period_s;
    Ok(Smoothed {
        averaging_time_s: Estimate::with_interval(
            value,
            (low * sample_period_s).min(value),
            (high * sample_period_s).max(value),
        ),
        like: best.like,
        gain,
    })
}

/// A fitted density.
#[derive(Clone, Copy, Debug)]
struct Fit {
    like: Smoothing,
    /// Averaging time, words.
    words: f64,
    squares: [f64; TERMS],
    deviance: f64,
}

impl Fit {
    /// Density of white and slow noise at a quarter of the reciprocal averaging time.
    fn plateau(&self) -> f64 {
        let [white, flicker, walk, _] = self.squares;
        let corner = CORNER / self.words;
        white + flicker / corner + walk / (corner * corner)
    }
}

/// Least squares with no coefficient below zero, one after another from a start.
fn least_squares(
    normal: &[[f64; TERMS]; TERMS],
    right: &[f64; TERMS],
    mut squares: [f64; TERMS],
) -> [f64; TERMS] {
    for _ in 0..SWEEPS {
        for term in 0..TERMS {
            let others = (0..TERMS).filter(|other| *other != term);
            let taken: f64 = others
                .map(|other| normal[term][other] * squares[other])
                .sum();
            squares[term] = ((right[term] - taken) / normal[term][term]).max(0.0);
        }
    }
    squares
}

/// The density of a record to be fitted.
struct Search<'a> {
    bins: &'a [Bin],
    /// What is added to the density of words and fits alike.
    depth: f64,
}

impl<'a> Search<'a> {
    fn new(bins: &'a [Bin], depth: f64) -> Self {
        Self { bins, depth }
    }

    /// Fits the terms with a response over the bins: twice the negative logarithm of the likelihood and
    /// the squares.
    ///
    /// The first steps are multiplicative, which come near from anywhere (Févotte, Idier, Neural Computation
    /// 23 (2011) 2421), the last are weighted least squares with none below zero (scoring).
    fn fit(&self, response: &[f64]) -> ([f64; TERMS], f64) {
        let basis: Vec<[f64; TERMS]> = self
            .bins
            .iter()
            .zip(response)
            .map(|(bin, power)| {
                let slow = power / bin.frequency;
                [*power, slow, slow / bin.frequency, 1.0]
            })
            .collect();
        let mut squares = [0.0; TERMS];
        for (term, square) in squares.iter_mut().enumerate() {
            // Each begins where it would take a quarter of the density in the middle.
            let ratios = self.bins.iter().zip(&basis);
            let sum: f64 = ratios
                .map(|(bin, basis)| (bin.density / basis[term].max(1e-300)).ln())
                .sum();
            *square = 0.25 * (sum / self.bins.len() as f64).exp();
        }
        let model = |squares: &[f64; TERMS], basis: &[f64; TERMS]| {
            let sum: f64 = squares.iter().zip(basis).map(|(a, b)| a * b).sum();
            (sum + self.depth).max(f64::MIN_POSITIVE)
        };
        for step in 0..2 * STEPS {
            let (mut normal, mut right) = ([[0.0; TERMS]; TERMS], [0.0; TERMS]);
            let mut down = [0.0; TERMS];
            for (bin, basis) in self.bins.iter().zip(&basis) {
                let density = model(&squares, basis);
                let weight = bin.count / (density * density);
                for term in 0..TERMS {
                    right[term] += weight * basis[term] * bin.density;
                    down[term] += weight * basis[term] * (density - self.depth);
                    for other in 0..TERMS {
                        normal[term][other] += weight * basis[term] * basis[other];
                    }
                }
            }
            if step < STEPS {
                for term in 0..TERMS {
                    squares[term] *= (right[term] / down[term].max(f64::MIN_POSITIVE)).sqrt();
                }
            } else {
                squares = least_squares(&normal, &right, squares);
            }
        }
        let deviance = self
            .bins
            .iter()
            .zip(&basis)
            .map(|(bin, basis)| {
                let density = model(&squares, basis);
                2.0 * bin.count * (density.ln() + (bin.density + self.depth) / density)
            })
            .sum();
        (squares, deviance)
    }

    fn response(&self, like: Smoothing, words: f64) -> Vec<f64> {
        let of = |bin: &Bin| bin.mean(|frequency| like.power(frequency, words));
        self.bins.iter().map(of).collect()
    }

    /// The likelihood of a record that was not smoothed.
    fn without(&self) -> f64 {
        self.fit(&vec![1.0; self.bins.len()]).1
    }

    fn at(&self, like: Smoothing, words: f64) -> Fit {
        let (squares, deviance) = self.fit(&self.response(like, words));
        Fit {
            like,
            words,
            squares,
            deviance,
        }
    }

    /// The likeliest smoothing of up to so many words.
    fn best(&self, most: f64) -> Option<Fit> {
        let steps = ((most / 2.0).log2() * PER_OCTAVE).floor().max(0.0);
        let count = round_to_count(steps);
        let times = (0..=count).map(|step| 2.0 * (step as f64 / PER_OCTAVE).exp2());
        let times: Vec<f64> = times.collect();
        let fits = Smoothing::ALL
            .iter()
            .flat_map(|like| times.iter().map(|words| self.at(*like, *words)));
        let best = fits.min_by(|a, b| a.deviance.total_cmp(&b.deviance))?;
        Some(self.refined(best))
    }

    /// The best averaging time near one, by bisection of the interval about it.
    fn refined(&self, mut best: Fit) -> Fit {
        let mut ratio = (1.0 / PER_OCTAVE).exp2();
        for _ in 0..8 {
            ratio = ratio.sqrt();
            for words in [best.words / ratio, best.words * ratio] {
                let other = self.at(best.like, words);
                if other.deviance < best.deviance {
                    best = other;
                }
            }
        }
        best
    }

    /// Averaging times on either side at which the likelihood has fallen to the limit, words.
    fn interval(&self, best: &Fit, most: f64) -> [f64; 2] {
        [-1.0, 1.0].map(|side: f64| {
            let (mut inside, mut outside) = (0.0, 2.0_f64.ln());
            for _ in 0..12 {
                let middle = 0.5 * (inside + outside);
                let words = best.words * (side * middle).exp();
                if self.at(best.like, words).deviance - best.deviance < GAIN_95 {
                    inside = middle;
                } else {
                    outside = middle;
                }
            }
            (best.words * (side * outside).exp()).min(2.0 * most)
        })
    }

    /// Whether floor, pass band and slow noise are as behind a smoothing.
    fn is_sound(&self, fit: &Fit, rounding: f64) -> bool {
        let response = self.response(fit.like, fit.words);
        let [white, flicker, walk, floor] = fit.squares;
        let smoothed = white * 0.5 / fit.words;
        let beyond = self.bins.iter();
        let beyond = beyond.filter(|bin| bin.frequency * fit.words > TAIL_FROM);
        let is_bare = beyond.map(Bin::power).sum::<f64>() <= TAIL_MAX * smoothed + rounding;
        // White noise has at least half of the density where the fall begins.
        let is_white = 2.0 * white >= fit.plateau();
        let passes = self.bins.iter().zip(&response);
        let mut is_described = true;
        // Single ordinates may be next to nothing: as many are taken together as say something.
        let (mut sum, mut count) = (0.0, 0.0);
        for (bin, power) in passes.filter(|(_, power)| **power > 0.2) {
            let slow = power / bin.frequency;
            let density = white * power + flicker * slow + walk * slow / bin.frequency + floor;
            sum += bin.count * bin.density / density;
            count += bin.count;
            if count >= TOGETHER_MIN {
                // The logarithm of a mean of n exponential variables scatters by 1/sqrt(n).
                let most = MISFIT_MAX.ln() + 4.0 / count.sqrt();
                is_described &= (sum / count).ln().abs() <= most;
                (sum, count) = (0.0, 0.0);
            }
        }
        is_bare && is_white && is_described
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::quality::white;

    fn walk(words: &[f64]) -> Vec<f64> {
        let mut sum = 0.0;
        let add = |word: &f64| {
            sum += word;
            sum
        };
        words.iter().map(add).collect()
    }

    fn mean(words: &[f64], length: usize) -> Vec<f64> {
        let windows = words.windows(length);
        windows
            .map(|window| window.iter().sum::<f64>() / length as f64)
            .collect()
    }

    fn one_pole(words: &[f64], samples: f64) -> Vec<f64> {
        let decay = (-1.0 / samples).exp();
        let mut state = 0.0;
        let of = |word: &f64| {
            state = decay * state + (1.0 - decay) * word;
            state
        };
        let all: Vec<f64> = words.iter().map(of).collect();
        all[round_to_count(10.0 * samples)..].to_vec()
    }

    /// Second order low pass of Butterworth by the bilinear transform.
    fn butterworth(words: &[f64], cutoff: f64) -> Vec<f64> {
        let k = (PI * cutoff).tan();
        let norm = 1.0 / (1.0 + 2.0_f64.sqrt() * k + k * k);
        let (b, a1) = (k * k * norm, 2.0 * (k * k - 1.0) * norm);
        let a2 = (1.0 - 2.0_f64.sqrt() * k + k * k) * norm;
        let (mut x, mut y) = ([0.0; 2], [0.0; 2]);
        let of = |word: &f64| {
            let out = b * (word + 2.0 * x[0] + x[1]) - a1 * y[0] - a2 * y[1];
            (x, y) = ([*word, x[0]], [out, y[0]]);
            out
        };
        let all: Vec<f64> = words.iter().map(of).collect();
        all[round_to_count(3.0 / cutoff)..].to_vec()
    }

    /// White noise with flicker and walk, which rule from some 2000 words on.
    fn gyro(seed: u64, count: usize) -> Vec<f64> {
        let slow = walk(&white(seed + 1, count));
        let mut words = white(seed, count);
        for (word, slow) in words.iter_mut().zip(slow) {
            *word += 3e-4 * slow;
        }
        for octave in 0..6 {
            let time = 4.0_f64.powi(octave + 2);
            let decay = (-1.0 / time).exp();
            let mut state = 0.0;
            let drive = white(seed + 10 + u64::from(octave.unsigned_abs()), count);
            for (word, drive) in words.iter_mut().zip(drive) {
                state = decay * state + (1.0 - decay * decay).sqrt() * drive;
                *word += 0.01 * state;
            }
        }
        words
    }

    #[test]
    fn a_smoothed_record_is_named_with_its_averaging_time() {
        const PERIOD_S: f64 = 0.01;
        let words = gyro(100, 60_000);
        let rounded = |words: Vec<f64>| {
            let round = |word: f64| (word * 40.0).round() / 40.0;
            words.into_iter().map(round).collect::<Vec<f64>>()
        };
        // Time constants and cutoffs in words; 1/(2 B) is 2 T of one pole, 0.45 over the cutoff of two.
        let cases = [
            (mean(&words, 200), 2.0),
            (rounded(mean(&words, 200)), 2.0),
            (mean(&words, 16), 0.16),
            (mean(&mean(&words, 60), 60), 0.9),
            (one_pole(&words, 50.0), 1.0),
            (butterworth(&words, 0.002), 0.01 / (2.0 * 1.110_72 * 0.002)),
        ];
        for (case, (smooth, wanted)) in cases.into_iter().enumerate() {
            let found =
                find_smoothing(&smooth, PERIOD_S).unwrap_or_else(|it| panic!("{case}: {it}"));
            let Estimate {
                value, low, high, ..
            } = found.averaging_time_s;
            assert!((value / wanted - 1.0).abs() < 0.15, "{case}: {found:?}");
            assert!(low < value && value < high, "{case}: {found:?}");
            assert!(
                low / 1.05 < wanted && wanted < high * 1.05,
                "{case}: {found:?}"
            );
        }
    }

    #[test]
    fn what_no_filter_made_is_not_named() {
        let words = gyro(200, 30_000);
        let sine = |amplitude: f64| {
            let at = |index: usize| amplitude * (PI * index as f64 / 400.0).sin();
            let sum = words
                .iter()
                .enumerate()
                .map(|(index, word)| word + at(index));
            sum.collect::<Vec<f64>>()
        };
        // A Gauss-Markov noise well above the white one, which goes on inside its correlation time.
        let correlated: Vec<f64> = one_pole(&white(300, 33_000), 300.0)
            .iter()
            .zip(&words)
            .map(|(slow, word)| 20.0 * slow + word)
            .collect();
        let cases = [
            words.clone(),
            one_pole(&words, 3.0),
            walk(&words),
            sine(1.0),
            sine(100.0),
            words.windows(2).map(|two| two[1] - two[0]).collect(),
            correlated,
            words.iter().map(|word| (word / 4.0).round()).collect(),
            vec![3.0; 5000],
        ];
        for (case, words) in cases.into_iter().enumerate() {
            let found = find_smoothing(&words, 0.01);
            assert!(found.is_err(), "{case}: {found:?}");
        }
    }

    #[test]
    fn records_that_were_not_smoothed_are_hardly_ever_named() {
        let named =
            (0..20).filter(|seed| find_smoothing(&gyro(1000 + 100 * seed, 4000), 1.0).is_ok());
        assert_eq!(named.count(), 0);
    }

    #[test]
    fn the_noise_bandwidth_of_every_response_is_that_of_its_averaging_time() {
        for like in Smoothing::ALL {
            for words in [20.0, 200.0] {
                let step = 1e-5;
                let band: f64 = (0..50_000)
                    .map(|index| step * like.power((f64::from(index) + 0.5) * step, words))
                    .sum();
                let found = 0.5 / band;
                assert!(
                    (found / words - 1.0).abs() < 0.02,
                    "{like:?} {words} {found}"
                );
            }
        }
    }
}
