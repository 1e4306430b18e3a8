//! A test of the whole curve against the fitted terms.

use super::choice::{Choice, Search};
use super::draws::Draws;
use super::scatter::HARMLESS;
use crate::metrics::allan::overlapping::AllanPoint;

/// Curves that are drawn to tell a small probability.
const CURVES: u32 = 1000;

/// Curves with a worse misfit after which no more are drawn: of all of them two in a hundred and more
/// would have one, so that the decision at one in a hundred is taken.
const WORSE_ENOUGH: u32 = 20;

/// Probability below which a fit is in doubt.
const REJECTED_BELOW: f64 = 0.01;

/// Score from which on an averaging time is said to miss: quantile 0.995 of the normal distribution.
const SCORE_MISSED: f64 = 2.576;

/// Whether a curve is one that the fitted terms give.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Goodness {
    /// Sum of squares of the misfits, made independent.
    pub chi_squared: f64,
    /// Points less coefficients.
    pub degrees_of_freedom: f64,
    /// Share of the curves drawn under the fitted terms, terms chosen and fitted anew, that fit worse.
    pub p_value: f64,
    /// Share of them that fit worse once misfits up to 2 % of a deviation count as none.
    pub p_value_beyond_harmless: f64,
    /// Curves drawn.
    pub curves: u32,
    /// Largest misfit: deviation over the fitted one, minus 1, where it misses; anywhere if nowhere.
    pub largest_misfit: f64,
    /// Averaging time of it, s.
    pub largest_misfit_tau_s: f64,
    /// Averaging times, s, at which the curve lies outside the 99 % band of the fit by more than 2 % of
    /// the deviation.
    pub missed_tau_s: Vec<f64>,
}

impl Goodness {
    /// False where the misfit is beyond chance (p < 0.01) and would be so without a harmless 2 % of the
    /// deviation.
    #[must_use]
    pub fn is_adequate(&self) -> bool {
        self.p_value >= REJECTED_BELOW || self.p_value_beyond_harmless >= REJECTED_BELOW
    }

    /// Judges a fit by a parametric bootstrap of fixed seed.
    ///
    /// Curves are drawn from the distribution that the fitted terms give them (chi-square points that
    /// correlate as the points of a record do), and each goes through choice and fit of the terms.
    pub(crate) fn of(points: &[AllanPoint], choice: &Choice) -> Self {
        let harmful = |choice: &Choice| {
            let scores = choice.scatter.harmful_scores(&choice.problem.variance);
            choice.scatter.chi_squared(&scores)
        };
        let found = [choice.chi_squared, harmful(choice)];
        let search = Search {
            points,
            near: Some(&choice.squares),
        };
        let mut draws = Draws::new(&choice.scatter);
        let mut problem = choice.problem.clone();
        let mut worse = [0_u32; 2];
        let mut curves = 0;
        while curves < CURVES && worse[0] < WORSE_ENOUGH {
            problem.variance = draws.next();
            curves += 1;
            let Some(plain) = search.base(&problem) else {
                continue;
            };
            // A term more makes no curve fit worse.
            if plain.chi_squared < found[0] && harmful(&plain) < found[1] {
                continue;
            }
            let drawn = search.extend(plain);
            worse[0] += u32::from(drawn.chi_squared >= found[0]);
            worse[1] += u32::from(harmful(&drawn) >= found[1]);
        }
        let share = |worse: u32| f64::from(worse + 1) / f64::from(curves + 1);
        let mut goodness = Self {
            chi_squared: choice.chi_squared,
            degrees_of_freedom: choice.problem.points() as f64 - choice.coefficients() as f64,
            p_value: share(worse[0]),
            p_value_beyond_harmless: share(worse[1]),
            curves,
            largest_misfit: 0.0,
            largest_misfit_tau_s: 0.0,
            missed_tau_s: Vec::new(),
        };
        goodness.find_misses(choice);
        goodness
    }

    fn find_misses(&mut self, choice: &Choice) {
        let period = choice.problem.sample_period_s();
        let misfit = |row: usize| {
            (choice.problem.variance[row] / choice.scatter.expected()[row]).sqrt() - 1.0
        };
        let tau = choice.problem.tau();
        let all: Vec<usize> = (0..tau.len()).collect();
        let misses =
            |row: &usize| misfit(*row).abs() > HARMLESS && choice.scores[*row].abs() > SCORE_MISSED;
        let missed: Vec<usize> = all.iter().copied().filter(misses).collect();
        self.missed_tau_s = missed.iter().map(|&row| tau[row] * period).collect();
        let looked_at = if missed.is_empty() { all } else { missed };
        for row in looked_at {
            if misfit(row).abs() >= self.largest_misfit.abs() {
                self.largest_misfit = misfit(row);
                self.largest_misfit_tau_s = tau[row] * period;
            }
        }
    }
}
