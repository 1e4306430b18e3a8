//! Which terms a curve asks for.

use nalgebra::{DMatrix, DVector};

use super::scatter::Scatter;
use crate::metrics::allan::covariance::{
    CORRELATED, FLICKER, INVERSE_SQUARE, RAMP, TERMS, WALK, WHITE,
};
use crate::metrics::allan::least_squares::{Problem, correlated_allan_variance};
use crate::metrics::allan::overlapping::AllanPoint;

/// Terms that every fit has: a bound on one, or its absence, would pull the others.
pub(crate) const BASE: [bool; TERMS] = {
    let mut base = [false; TERMS];
    base[WHITE] = true;
    base[FLICKER] = true;
    base[WALK] = true;
    base[INVERSE_SQUARE] = true;
    base
};

/// Deviance that a ramp must save at least, three standard errors, and a correlated term, whose
/// correlation time is sought: one record in a hundred without it would ask for less.
const RAMP_GAIN_MIN: f64 = 9.0;
const CORRELATED_GAIN_MIN: f64 = 9.0;

/// Logarithm of the range of correlation times up to which that holds; over a wider one, as of a long
/// record, chance has more to choose from.
const CORRELATION_LOG_RANGE: f64 = 4.0;

/// Correlation times looked at: from so many shortest averaging times to such a part of the record.
const CORRELATION_PER_TAU_MIN: f64 = 5.0;
const CORRELATION_PER_RECORD: f64 = 0.1;

/// Ratio of one correlation time looked at to the next, and steps that refine the best.
const CORRELATION_RATIO: f64 = 1.3;
const REFINEMENTS: usize = 6;

/// A fit with the terms that the curve asks for.
pub(crate) struct Choice {
    pub(crate) problem: Problem,
    pub(crate) allowed: [bool; TERMS],
    pub(crate) squares: [f64; TERMS],
    pub(crate) scatter: Scatter,
    pub(crate) scores: DVector<f64>,
    pub(crate) chi_squared: f64,
    /// Minus twice the logarithm of the likelihood with the penalty of the terms added.
    pub(crate) criterion: f64,
}

impl Choice {
    /// The fit with given terms.
    fn of(
        problem: Problem,
        allowed: [bool; TERMS],
        squares: [f64; TERMS],
        penalty: f64,
    ) -> Option<Self> {
        let scatter = Scatter::new(&problem, &squares)?;
        let scores = scatter.scores(&problem.variance);
        let chi_squared = scatter.chi_squared(&scores);
        let criterion = scatter.deviance(chi_squared) + penalty;
        Some(Self {
            problem,
            allowed,
            squares,
            scatter,
            scores,
            chi_squared,
            criterion,
        })
    }

    /// Terms, of which a correlated one has its correlation time too.
    pub(crate) fn coefficients(&self) -> usize {
        let terms = self.allowed.iter().filter(|allowed| **allowed).count();
        terms + usize::from(self.allowed[CORRELATED])
    }
}

/// What a search for terms needs to know of the curve's record.
#[derive(Clone, Copy)]
pub(crate) struct Search<'a> {
    /// Points of the curve, whose deviations are not looked at.
    pub(crate) points: &'a [AllanPoint],
    /// Squares that are near, with the correlation time of the problem.
    pub(crate) near: Option<&'a [f64; TERMS]>,
}

impl Search<'_> {
    /// Samples of the record.
    fn samples(&self) -> f64 {
        let last = self.points.last();
        last.map_or(0.0, |point| {
            (point.count + 2 * point.averaged_samples - 1) as f64
        })
    }

    /// Deviance that coefficients must save which show at such a time, samples: the observations of
    /// the criterion are the independent means at it.
    fn price(&self, coefficients: f64, time: f64, least: f64) -> f64 {
        (coefficients * (self.samples() / time).max(1.0).ln()).max(least)
    }

    fn solve(&self, problem: &Problem, allowed: &[bool; TERMS]) -> [f64; TERMS] {
        match self.near {
            Some(near) => problem.squares_from(allowed, near),
            None => problem.solve(allowed).squares,
        }
    }

    /// The fit with the terms that the criterion of Bayes and Schwarz asks for: N, B, K and
    /// quantisation always, a ramp and exponentially correlated noise where each saves more deviance
    /// than its coefficients cost.
    ///
    /// Source: Schwarz, Annals of Statistics 6 (1978) 461.
    pub(crate) fn choose(&self, problem: &Problem) -> Option<Choice> {
        self.base(problem).map(|base| self.extend(base))
    }

    /// The fit with the terms that every fit has.
    pub(crate) fn base(&self, problem: &Problem) -> Option<Choice> {
        let mut base = BASE;
        base[INVERSE_SQUARE] = !problem.knows_inverse_square();
        Choice::of(problem.clone(), base, self.solve(problem, &base), 0.0)
    }

    /// A fit with the terms added that the criterion asks for.
    pub(crate) fn extend(&self, base: Choice) -> Choice {
        let mut best = base;
        let mut penalty = 0.0;
        for _ in 0..2 {
            let Some(found) = self.best_addition(&best) else {
                break;
            };
            let price = found.price;
            let mut allowed = best.allowed;
            allowed[found.term] = true;
            let problem = match found.correlation {
                None => best.problem.clone(),
                Some(time) if best.problem.correlation().is_some() => {
                    best.problem.with_near_correlation(time)
                }
                Some(time) => best.problem.with_correlation(self.points, time),
            };
            let squares = self.solve(&problem, &allowed);
            let with = Choice::of(problem, allowed, squares, penalty + price);
            match with {
                Some(with) if with.squares[found.term] > 0.0 && with.criterion < best.criterion => {
                    best = with;
                    penalty += price;
                }
                _ => break,
            }
        }
        best
    }

    /// The term whose column would take most out of the residuals beyond its price.
    fn best_addition(&self, fit: &Choice) -> Option<Addition> {
        let space = Residuals::new(fit)?;
        let mut best: Option<Addition> = None;
        let mut offer = |term: usize, correlation: Option<f64>, gain: f64, price: f64| {
            if gain > price
                && best
                    .as_ref()
                    .is_none_or(|it| it.gain - it.price < gain - price)
            {
                best = Some(Addition {
                    term,
                    correlation,
                    gain,
                    price,
                });
            }
        };
        if !fit.allowed[RAMP] {
            let gain = space.gain(&fit.scatter, |row| fit.problem.column(RAMP, row));
            let longest = fit.problem.tau()[fit.problem.points() - 1];
            offer(RAMP, None, gain, self.price(1.0, longest, RAMP_GAIN_MIN));
        }
        if !fit.allowed[CORRELATED]
            && let Some((time, gain)) = self.best_correlation(fit, &space)
        {
            // Means over two correlation times are independent.
            let price = self.price(2.0, 2.0 * time, self.correlated_gain_min(&fit.problem));
            offer(CORRELATED, Some(time), gain, price);
        }
        best
    }

    /// Shortest and longest correlation time looked at, samples.
    fn correlation_range(&self, problem: &Problem) -> [f64; 2] {
        let shortest = CORRELATION_PER_TAU_MIN * problem.tau()[0];
        [shortest, CORRELATION_PER_RECORD * self.samples()]
    }

    /// Deviance that a correlated term must save at least, the correlation times tried counted: the
    /// probability that chance saves so much halves with every `2 ln 2`.
    fn correlated_gain_min(&self, problem: &Problem) -> f64 {
        let [shortest, longest] = self.correlation_range(problem);
        let range = (longest / shortest).ln() / CORRELATION_LOG_RANGE;
        CORRELATED_GAIN_MIN + 2.0 * range.max(1.0).ln()
    }

    /// Correlation time, samples, whose column takes most out of the residuals.
    fn best_correlation(&self, fit: &Choice, space: &Residuals) -> Option<(f64, f64)> {
        let tau = fit.problem.tau();
        let [least, most] = self.correlation_range(&fit.problem);
        if least >= most {
            return None;
        }
        let gain = |time: f64| {
            space.gain(&fit.scatter, |row| {
                correlated_allan_variance(tau[row], time)
            })
        };
        let mut best = (least, gain(least));
        let mut time = least;
        while time < most {
            time = (time * CORRELATION_RATIO).min(most);
            let found = gain(time);
            if found > best.1 {
                best = (time, found);
            }
        }
        let mut step = CORRELATION_RATIO.sqrt();
        for _ in 0..REFINEMENTS {
            for time in [best.0 / step, best.0 * step] {
                if (least..=most).contains(&time) {
                    let found = gain(time);
                    if found > best.1 {
                        best = (time, found);
                    }
                }
            }
            step = step.sqrt();
        }
        Some(best)
    }
}

/// A term that may be added.
struct Addition {
    term: usize,
    correlation: Option<f64>,
    gain: f64,
    price: f64,
}

/// Residuals of a fit and the directions that its terms take, whitened.
struct Residuals {
    residuals: DVector<f64>,
    taken: DMatrix<f64>,
}

impl Residuals {
    fn new(fit: &Choice) -> Option<Self> {
        let terms: Vec<usize> = (0..TERMS).filter(|&term| fit.allowed[term]).collect();
        let scatter = &fit.scatter;
        let mut columns = Vec::with_capacity(terms.len());
        for term in terms {
            let column = scatter.whitened_column(|row| fit.problem.column(term, row))?;
            columns.push(column.normalize());
        }
        let variance = &fit.problem.variance;
        let residuals =
            scatter.whitened_column(|row| variance[row] - fit.problem.fitted(&fit.squares, row))?;
        Some(Self {
            residuals,
            taken: DMatrix::from_columns(&columns).qr().q(),
        })
    }

    /// Fall of the sum of squares when a column with a positive coefficient joins the fit.
    fn gain(&self, scatter: &Scatter, column: impl Fn(usize) -> f64) -> f64 {
        let Some(column) = scatter.whitened_column(column) else {
            return 0.0;
        };
        let own = &column - &self.taken * self.taken.tr_mul(&column);
        let along = own.dot(&self.residuals);
        let length = own.norm_squared();
        // A column that the others make up has nothing of its own.
        if along > 0.0 && length > 1e-10 * column.norm_squared() {
            along * along / length
        } else {
            0.0
        }
    }
}
