//! What a least-squares filter has learned from each stretch of its words: the seeds' scatter of
//! weights that forget nothing, from one record.
//!
//! With `R_c`, `p_c` the sums of products up to a checkpoint c, its weights are
//! `w_c = R_c^-1 p_c = w + R_c^-1 sum_(f <= c) s_f` exactly, for any w, with the score
//! `s_f = p_f - R_f w` of each stretch f. The scores of long stretches are independent, and those at the
//! weights that many records have in common at c are of mean 0, so that each stretch adds the mean of
//! `R_c^-1 s_f` over the checkpoints from f on to the mean weights of the record. Stretches
//! of the warm-up add theirs. What the known motion puts into a score is the same in every record and
//! taken off: it is the score of the words without their noise. The stretches of a motion fade into each
//! other. This is the sandwich covariance of least squares; leaving blocks of the
//! output out instead holds the weights of this record for given, and misses nearly all of it.
//!
//! Source: derived; White, Econometrica 48 (1980), for the sandwich.

use std::ops::Range;
use std::sync::OnceLock;

use nalgebra::{DMatrix, DVector};

use super::stretches::{Regression, TAPERED_POWER, Taper};
use crate::metrics::estimate::influence::Learned;
use crate::signal::{FilterShape, WeightRule};

/// Stretches of the record; those of the warm-up are as long.
const STRETCHES: usize = 160;

/// Fewest of them.
const STRETCHES_MIN: usize = 20;

/// Shortest stretch, in words that the filter reaches back: scores correlate over as many.
const REACHES_MIN: usize = 16;

/// Largest power of a stretch over the smallest of words that show one motion.
const POWER_RATIO_MAX: f64 = 4.0;

/// Part of the record that a memory may span for its blocks to tell how it scatters.
const MEMORY_PER_RECORD: f64 = 0.1;

/// Why a record does not tell how far it is from the ensemble.
pub(crate) const NOT_FROM_ONE_RECORD: &str =
    "not from one record: the filter remembers more than a tenth of it; repeats gives it";

/// Sums of products of a least-squares filter, stretch by stretch of all its words.
#[derive(Clone, Debug, PartialEq)]
pub struct Learning {
    taps: usize,
    is_dc_gain_one: bool,
    /// What a stretch counts for once the next has come.
    kept: f64,
    /// Stretches before the record.
    warm_up: usize,
    /// Standard deviation over seeds of a rate that all words share: the slow noise in their mean.
    drift_deg_per_h: f64,
    /// Sums of products of `[x_0 ... x_(p-1), d, 1]`: regressors, desired signal, number.
    moments: Vec<DMatrix<f64>>,
    /// What noise makes of them: less those of the motion and the mean of the rest.
    deviations: Vec<DMatrix<f64>>,
    /// What follows for the whole record, which several metrics ask for; none where the words do not
    /// determine the weights.
    of_record: OnceLock<Option<OfRecord>>,
}

/// Weights of the words as they are, and what each stretch adds to their mean over the record.
#[derive(Clone, Debug, PartialEq)]
struct OfRecord {
    solved: Solved,
    parts: Vec<DVector<f64>>,
    freedom: f64,
}

/// What each stretch adds to the mean weights over a part of the record.
#[derive(Clone, Debug)]
pub(crate) struct LearnedWeights {
    /// By stretch, those of the warm-up first; newest sample first.
    pub(crate) parts: Vec<DVector<f64>>,
    /// Stretches before the record.
    pub(crate) warm_up: usize,
    /// Degrees of freedom of the scatter of the parts, of which the first count for more.
    pub(crate) freedom: f64,
}

impl Learning {
    /// Whether the weights of a filter remember more than a tenth of a record of so many samples, whose
    /// blocks then do not tell how they scatter.
    #[must_use]
    pub fn is_of(shape: &FilterShape, samples: usize) -> bool {
        let memory = match shape.rule {
            WeightRule::Adaptive {
                forgetting_factor: Some(factor),
                ..
            } => 1.0 / (1.0 - factor),
            _ => 0.0,
        };
        memory > MEMORY_PER_RECORD * samples as f64
    }

    /// Sums of a filter over all its words, of which the record begins at `first`.
    ///
    /// * `motion`: the words without their noise; none at rest.
    ///
    /// None for a filter that forgets within a tenth of the record, whose own blocks tell its
    /// scatter, and for a record of too few stretches.
    #[must_use]
    pub fn of(
        shape: &FilterShape,
        words: &[f64],
        motion: Option<&[f64]>,
        first: usize,
    ) -> Option<Self> {
        let WeightRule::Adaptive {
            desired_weights,
            is_dc_gain_one,
            forgetting_factor: Some(factor),
        } = &shape.rule
        else {
            return None;
        };
        let record = words.len().checked_sub(first)?;
        let taps = shape.taps?;
        let lag = shape.newest_age_samples - shape.register_samples;
        let reach = (lag + taps).max(desired_weights.len());
        let count = STRETCHES.min(record / (REACHES_MIN * reach));
        if count < STRETCHES_MIN || !Self::is_of(shape, record) {
            return None;
        }
        let length = record / count;
        let warm_up = first.saturating_sub(reach).div_ceil(length);
        let border = |stretch: usize| match stretch.checked_sub(warm_up) {
            Some(own) => first + record * own / count,
            None => reach + (first - reach) * stretch / warm_up,
        };
        let stretches = warm_up + count;
        let range = |stretch: usize| border(stretch).max(reach)..border(stretch + 1);
        let regression = Regression {
            lag,
            taps,
            desired_weights,
        };
        let moments: Vec<DMatrix<f64>> = (0..stretches)
            .map(|stretch| regression.products(words, range(stretch), None))
            .collect();
        let deviations = match motion {
            None => deviations(moments.clone()),
            Some(motion) => {
                let ranges: Vec<Range<usize>> = (0..stretches).map(range).collect();
                let tapers = (0..stretches).map(|stretch| Taper::of(&ranges, stretch));
                let of_noise = tapers.map(|taper| {
                    let Taper { range, weights } = taper;
                    let own = regression.products(words, range.clone(), Some(&weights));
                    let known = regression.products(motion, range, Some(&weights));
                    // What is no noise are the words' number, which both have.
                    let number = own[(taps + 1, taps + 1)];
                    let mut noise = own - known;
                    noise[(taps + 1, taps + 1)] = number;
                    noise * TAPERED_POWER.sqrt()
                });
                deviations(of_noise.collect())
            }
        };
        Some(Self {
            taps,
            is_dc_gain_one: *is_dc_gain_one,
            kept: factor.powf(length as f64),
            warm_up,
            drift_deg_per_h: 0.0,
            deviations,
            moments,
            of_record: OnceLock::new(),
        })
    }

    /// The same of words whose mean scatters from seed to seed by slow noise of this variance,
    /// (deg/h)^2, of which one record shows next to nothing.
    #[must_use]
    pub fn with_drift(self, variance_deg2_per_h2: f64) -> Self {
        Self {
            drift_deg_per_h: variance_deg2_per_h2.sqrt(),
            ..self
        }
    }

    fn of_record(&self) -> Option<&OfRecord> {
        let solve = || {
            let solved = Solved::of(self, 0.0)?;
            let (parts, freedom) = solved.weight_parts(self, 0);
            Some(OfRecord {
                solved,
                parts,
                freedom,
            })
        };
        self.of_record.get_or_init(solve).as_ref()
    }

    /// Number of stretches of the record.
    #[must_use]
    pub(crate) fn stretches(&self) -> usize {
        self.moments.len() - self.warm_up
    }

    /// What each stretch adds to the mean weights from the stretch `from` of the record on.
    ///
    /// None where the words do not determine the weights.
    pub(crate) fn weights_from(&self, from: usize) -> Option<LearnedWeights> {
        let whole = self.of_record()?;
        let solved = &whole.solved;
        let (parts, freedom) = match from {
            0 => (whole.parts.clone(), whole.freedom),
            _ => solved.weight_parts(self, from),
        };
        let drift = self.weights_by_drift(solved, from)?;
        Some(LearnedWeights {
            parts: std::iter::once(drift).chain(parts).collect(),
            warm_up: self.warm_up + 1,
            freedom,
        })
    }

    /// How far the mean sum of the weights over the record moves from seed to seed by slow noise.
    pub(crate) fn gain_by_drift(&self) -> Option<f64> {
        let whole = self.of_record()?;
        Some(self.weights_by_drift(&whole.solved, 0)?.sum())
    }

    /// What a rate that all words share by slow noise adds to the mean weights from the stretch `from` of
    /// the record on.
    fn weights_by_drift(&self, solved: &Solved, from: usize) -> Option<DVector<f64>> {
        let shift = self.drift_deg_per_h;
        let drift = if shift > 0.0 {
            let moved = Solved::of(self, shift)?;
            moved.mean_weights(self, from) - solved.mean_weights(self, from)
        } else {
            DVector::zeros(solved.last.len())
        };
        Some(self.unfolded(drift))
    }

    /// What each stretch adds to the gain for a constant rate that is there from the first word on,
    /// the filter free to adapt to it: `(G' (m + r) - G m) / r` with the gains G without and G' with
    /// the rate r, and the mean m of the record.
    ///
    /// None where the words' power changes within the record, as over steps.
    pub(crate) fn adapted_gain(&self, rate: f64) -> Option<Learned> {
        if !self.is_even() {
            return None;
        }
        let (without, with) = (self.of_record()?, Solved::of(self, rate)?);
        let (moved, _) = with.weight_parts(self, 0);
        let means = self.mean_parts();
        let mean = self.mean();
        let gain = |solved: &Solved| self.gain(&solved.last);
        let by_mean = gain(&with) - gain(&without.solved);
        let stretches = without.parts.iter().zip(&moved).zip(&means);
        let stretches = stretches.map(|((own, moved), part)| {
            let by_weights = moved.sum() * (mean + rate) - own.sum() * mean;
            (by_weights + part * by_mean) / rate
        });
        // The gain at another mean, which differs by the slow noise.
        let drift = self.drift_deg_per_h;
        let adapted = |shift: f64| {
            let (own, other) = (Solved::of(self, shift)?, Solved::of(self, shift + rate)?);
            let moved = mean + shift;
            Some((gain(&other) * (moved + rate) - gain(&own) * moved) / rate)
        };
        let by_drift = adapted(drift)? - adapted(0.0)?;
        Some(Learned {
            parts: std::iter::once(by_drift).chain(stretches).collect(),
            warm_up: self.warm_up + 1,
            freedom: without.freedom,
        })
    }

    /// What each stretch adds to the mean output of the filter over the record, through its weights
    /// and through the mean of its input.
    ///
    /// * `with_input`: whether the input is at rest, so that its mean is noise and no motion.
    pub(crate) fn output_mean(&self, with_input: bool) -> Option<Learned> {
        let OfRecord {
            solved, freedom, ..
        } = self.of_record()?;
        let last = self.taps + 1;
        let count = self.moments.len();
        let record = self.warm_up..count;
        let total: f64 = self.moments[record].iter().map(|it| it[(last, last)]).sum();
        let sums = |stretch: usize| {
            let moments = &self.moments[stretch];
            let sums = DVector::from_fn(self.taps, |tap, _| moments[(tap, last)] / total);
            if self.is_dc_gain_one {
                fold(self.taps).transpose() * sums
            } else {
                sums
            }
        };
        // The weights of a stretch are the mean of those at its ends.
        let mut inputs = vec![DVector::zeros(solved.last.len()); count];
        for stretch in self.warm_up..count {
            let before = solved.before(stretch);
            let half = sums(stretch) * 0.5;
            inputs[before] += &half;
            inputs[stretch] += half;
        }
        let gain = self.gain(&solved.last);
        let means = self.mean_parts();
        let free = solved.last.len();
        let mut reach = DVector::zeros(free);
        let mut by_weights = DMatrix::zeros(free, free);
        let mut parts = vec![0.0; count];
        for stretch in (0..count).rev() {
            reach *= self.kept;
            by_weights *= self.kept;
            if let Some(inverse) = &solved.inverses[stretch] {
                let own = inverse * &inputs[stretch];
                by_weights += &solved.weights[stretch] * own.transpose();
                reach += own;
            }
            let by_input = if with_input {
                gain * means[stretch]
            } else {
                0.0
            };
            let (normal, right) = &solved.noise[stretch];
            parts[stretch] = reach.dot(right) - normal.dot(&by_weights.transpose()) + by_input;
        }
        Some(Learned {
            parts,
            warm_up: self.warm_up,
            freedom: *freedom,
        })
    }

    /// What each stretch adds to the mean output over the mean input of the record.
    ///
    /// Output and input share the noise of the input, which cancels; of the weights the part remains.
    /// None where the words' power changes within the record: the weights then move within a stretch.
    pub(crate) fn mean_ratio(&self, mean: f64) -> Option<Learned> {
        if !self.is_even() {
            return None;
        }
        let mut learned = self.output_mean(false)?.scaled(1.0 / mean);
        // A rate that all words share by slow noise moves the weights as well.
        let drift = self.drift_deg_per_h;
        let gains = [0.0, drift].map(|shift| Some(self.gain(&Solved::of(self, shift)?.last)));
        if let [Some(own), Some(moved)] = gains {
            learned.parts.insert(0, (moved - own) * self.mean() / mean);
            learned.warm_up += 1;
        }
        Some(learned)
    }

    /// Whether the words have about the same power in all stretches; else the weights move within one.
    #[must_use]
    pub fn is_even(&self) -> bool {
        let last = self.taps + 1;
        let powers = self
            .moments
            .iter()
            .map(|own| own[(0, 0)] / own[(last, last)]);
        let (least, most) = powers.fold((f64::INFINITY, 0.0_f64), |(least, most), power| {
            (least.min(power), most.max(power))
        });
        most <= POWER_RATIO_MAX * least
    }

    /// Mean of the newest regressor over the record.
    fn mean(&self) -> f64 {
        let last = self.taps + 1;
        let record = &self.moments[self.warm_up..];
        let sum = |column: usize| record.iter().map(|it| it[(column, last)]).sum::<f64>();
        sum(0) / sum(last)
    }

    /// What each stretch adds to that mean.
    fn mean_parts(&self) -> Vec<f64> {
        let last = self.taps + 1;
        let record = &self.moments[self.warm_up..];
        let total: f64 = record.iter().map(|it| it[(last, last)]).sum();
        let parts = self
            .deviations
            .iter()
            .enumerate()
            .map(|(stretch, deviations)| {
                let own = deviations[(0, last)] / total;
                if stretch < self.warm_up { 0.0 } else { own }
            });
        parts.collect()
    }

    /// Sum of the weights of these free ones.
    fn gain(&self, free: &DVector<f64>) -> f64 {
        let base = if self.is_dc_gain_one { 1.0 } else { 0.0 };
        base + self.unfolded(free.clone()).sum()
    }

    /// Normal equations of a stretch in the free weights, with `shift` added to every word.
    fn problem(&self, moments: &DMatrix<f64>, shift: f64) -> (DMatrix<f64>, DVector<f64>) {
        let p = self.taps;
        let number = moments[(p + 1, p + 1)];
        let sum = |row: usize| moments[(row, p + 1)];
        let moved = |row: usize, column: usize| {
            moments[(row, column)] + shift * (sum(row) + sum(column)) + shift * shift * number
        };
        let normal = DMatrix::from_fn(p, p, moved);
        let right = DVector::from_fn(p, |row, _| moved(row, p));
        if !self.is_dc_gain_one {
            return (normal, right);
        }
        // w = 1/p + T v: the free weights v act on differences of neighbours.
        let fold = fold(p);
        let right = right - &normal * DVector::from_element(p, 1.0 / p as f64);
        (fold.transpose() * normal * &fold, fold.transpose() * right)
    }

    fn unfolded(&self, free: DVector<f64>) -> DVector<f64> {
        if self.is_dc_gain_one {
            fold(self.taps) * free
        } else {
            free
        }
    }
}

/// The weights of a filter at the end of every stretch, in the free ones.
#[derive(Clone, Debug, PartialEq)]
struct Solved {
    /// `R_c^-1`; none before the words determine the weights.
    inverses: Vec<Option<DMatrix<f64>>>,
    /// Number of stretches that count.
    numbers: Vec<f64>,
    /// Normal equations of the noise of each stretch: its score at the weights w is `p - R w`.
    noise: Vec<(DMatrix<f64>, DVector<f64>)>,
    /// Weights at the end of each stretch; zero before the words determine them.
    weights: Vec<DVector<f64>>,
    /// Those of all words.
    last: DVector<f64>,
}

impl Solved {
    /// With `shift` added to every word.
    fn of(learning: &Learning, shift: f64) -> Option<Self> {
        let moments = learning.moments.iter();
        let problems: Vec<(DMatrix<f64>, DVector<f64>)> = moments
            .map(|moments| learning.problem(moments, shift))
            .collect();
        let free = problems[0].1.len();
        let (mut normal, mut right) = (DMatrix::zeros(free, free), DVector::zeros(free));
        let (mut inverses, mut numbers, mut weights) = (Vec::new(), Vec::new(), Vec::new());
        let mut number = 0.0;
        for (own, product) in &problems {
            normal = normal * learning.kept + own;
            right = right * learning.kept + product;
            number = number * learning.kept + 1.0;
            let inverse = normal.clone().cholesky().map(|factors| factors.inverse());
            weights.push(match &inverse {
                Some(inverse) => inverse * &right,
                None => DVector::zeros(free),
            });
            inverses.push(inverse);
            numbers.push(number);
        }
        inverses.last()?.as_ref()?;
        let last = weights.last()?.clone();
        let deviations = learning.deviations.iter();
        Some(Self {
            noise: deviations.map(|own| learning.problem(own, shift)).collect(),
            inverses,
            numbers,
            weights,
            last,
        })
    }

    /// The checkpoint at the start of a stretch, or its end where there is none.
    fn before(&self, stretch: usize) -> usize {
        let before = stretch.checked_sub(1);
        before
            .filter(|&at| self.inverses[at].is_some())
            .unwrap_or(stretch)
    }

    /// How much the checkpoints count for in the mean weights from the stretch `from` of the record on.
    fn shares(&self, learning: &Learning, from: usize) -> Vec<f64> {
        let count = self.inverses.len();
        let mut shares = vec![0.0; count];
        for stretch in learning.warm_up + from..count {
            shares[stretch] += 0.5;
            shares[self.before(stretch)] += 0.5;
        }
        let total: f64 = shares.iter().sum();
        shares.iter().map(|share| share / total).collect()
    }

    /// Mean weights from the stretch `from` of the record on.
    fn mean_weights(&self, learning: &Learning, from: usize) -> DVector<f64> {
        let shares = self.shares(learning, from);
        let weighted = self.weights.iter().zip(shares);
        weighted.map(|(weights, share)| weights * share).sum()
    }

    /// What each stretch adds to these, and the degrees of freedom of their scatter.
    ///
    /// The scores are those at the weights of each checkpoint: before a step they are others than behind.
    fn weight_parts(&self, learning: &Learning, from: usize) -> (Vec<DVector<f64>>, f64) {
        let shares = self.shares(learning, from);
        let count = self.inverses.len();
        let free = self.last.len();
        let weighed: Vec<DMatrix<f64>> = self
            .inverses
            .iter()
            .zip(&shares)
            .map(|(inverse, share)| match inverse {
                Some(inverse) => inverse * *share,
                None => DMatrix::zeros(free, free),
            })
            .collect();
        let (mut profile, mut squares, mut fourths) = (0.0_f64, 0.0, 0.0);
        let mut parts = vec![DVector::zeros(learning.taps); count];
        for stretch in (0..count).rev() {
            profile *= learning.kept;
            if self.inverses[stretch].is_some() {
                profile += shares[stretch] / self.numbers[stretch];
            }
            squares += profile.powi(2);
            fourths += profile.powi(4);
            let (normal, right) = &self.noise[stretch];
            let mut part = DVector::zeros(free);
            let mut kept = 1.0;
            for (weights, inverse) in self.weights.iter().zip(&weighed).skip(stretch) {
                let score = right - normal * weights;
                part.gemv(kept, inverse, &score, 1.0);
                kept *= learning.kept;
            }
            parts[stretch] = learning.unfolded(part);
        }
        let freedom = squares * squares / fourths - free as f64;
        (parts, freedom.max(1.0))
    }
}

/// Moments less their mean per word.
fn deviations(moments: Vec<DMatrix<f64>>) -> Vec<DMatrix<f64>> {
    let number = |moments: &DMatrix<f64>| moments[(moments.nrows() - 1, moments.nrows() - 1)];
    let total: f64 = moments.iter().map(number).sum();
    let mean = moments.iter().sum::<DMatrix<f64>>() / total;
    let about = |own: DMatrix<f64>| {
        let words = number(&own);
        own - &mean * words
    };
    moments.into_iter().map(about).collect()
}

/// `T` with `(T v)_i = v_i - v_(i-1)`: weights that sum to nothing.
fn fold(taps: usize) -> DMatrix<f64> {
    DMatrix::from_fn(taps, taps - 1, |row, column| {
        f64::from(u8::from(row == column)) - f64::from(u8::from(row == column + 1))
    })
}

impl LearnedWeights {
    /// What each stretch adds to a function of the mean weights, whose value at them is `of(weights)`.
    pub(crate) fn scatter(&self, weights: &[f64], of: impl Fn(&[f64]) -> f64) -> Learned {
        let value = of(weights);
        let parts = self.parts.iter().map(|part| {
            let moved: Vec<f64> = weights
                .iter()
                .zip(part.iter())
                .map(|(w, d)| w + d)
                .collect();
            of(&moved) - value
        });
        Learned {
            parts: parts.collect(),
            warm_up: self.warm_up,
            freedom: self.freedom,
        }
    }
}
