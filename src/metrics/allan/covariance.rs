//! How overlapping Allan variances at different averaging times scatter and go together.

use std::collections::VecDeque;
use std::f64::consts::PI;
use std::sync::{Arc, Mutex, PoisonError};

/// `AVAR / B^2` of flicker noise, `2 ln 2 / pi`; its square root is the familiar 0.664.
pub const FLICKER_ALLAN_VARIANCE: f64 = 2.0 * std::f64::consts::LN_2 / std::f64::consts::PI;

/// Terms of the model, in the order of the fit's columns.
pub(crate) const TERMS: usize = 6;
pub(crate) const WHITE: usize = 0;
pub(crate) const FLICKER: usize = 1;
pub(crate) const WALK: usize = 2;
pub(crate) const RAMP: usize = 3;
pub(crate) const INVERSE_SQUARE: usize = 4;
pub(crate) const CORRELATED: usize = 5;

/// Terms with a smooth covariance function, in the order of [`smooth_covariances`].
const SMOOTH_TERMS: [usize; SMOOTH] = [WHITE, FLICKER, WALK, CORRELATED];
const SMOOTH: usize = 4;

/// Lags in a panel up to which they are summed one by one; wider panels are integrated.
const SUMMED_LAGS: usize = 8;

/// Abscissae and weights of Gauss and Legendre on [-1, 1], five nodes.
const NODES: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// Weights of the angles in a second difference.
const SECOND: [f64; 3] = [1.0, -2.0, 1.0];

/// Covariances of a record's Allan variances, as a quadratic form in the squares of the terms.
///
/// `z = x(t + 2m) - 2 x(t + m) + x(t)` is Gaussian with cross-covariance `C12(s)` between two
/// averaging factors, the sum of the terms' own; `AVAR = mean z^2 / 2 m^2` over the n starts of the
/// record, so that `cov(AVAR_1, AVAR_2) = sum W(s) C12(s)^2 / (2 n1 n2 m1^2 m2^2)` with W(s) the pairs
/// of starts s apart. A term's C12 is the fourth difference of its generalised angle covariance:
/// `-|u|/2` for white rate noise, `u^2 ln|u| / 2 pi` for flicker, `|u|^3/12` for a walk,
/// `-T^2 (|u|/T - 1 + exp(-|u|/T))` for noise with a correlation time T, an impulse for white angle
/// noise. A ramp has no scatter of its own; it adds `R^2 mean C12`.
///
/// All in units of one sample period, coefficients included. White, walk and the short averaging
/// times are exact, the rest as good as five-node quadrature between the corners.
///
/// Source: derived (Isserlis); the diagonal agrees with NIST SP 1065 table 4.
#[derive(Clone, Debug)]
pub(crate) struct Structure {
    points: usize,
    /// For every pair of points: products of two terms, first not above second.
    products: Vec<[[f64; TERMS]; TERMS]>,
}

/// What a structure follows from: averaging factors, numbers of second differences, correlation time in
/// samples.
#[derive(Clone, Debug, PartialEq)]
struct Lengths {
    factors: Vec<usize>,
    counts: Vec<usize>,
    correlation: Option<f64>,
}

/// Structures asked for last, newest first: channels, repeats and points of a sweep have records of one
/// length, and each of their fits asks for the same.
static LAST: Mutex<VecDeque<(Lengths, Arc<Structure>)>> = Mutex::new(VecDeque::new());

/// Most of them, of some 300 kB each.
const LAST_MAX: usize = 32;

impl Structure {
    /// The structure of these lengths, as [`Structure::new`] makes it, or made a moment ago.
    pub(crate) fn shared(
        factors: Vec<usize>,
        counts: Vec<usize>,
        correlation: Option<f64>,
    ) -> Arc<Self> {
        let lengths = Lengths {
            factors,
            counts,
            correlation,
        };
        let last = || LAST.lock().unwrap_or_else(PoisonError::into_inner);
        {
            let mut last = last();
            let known = last.iter().position(|(known, _)| *known == lengths);
            if let Some(entry) = known.and_then(|at| last.remove(at)) {
                let structure = Arc::clone(&entry.1);
                last.push_front(entry);
                return structure;
            }
        }
        // Not under the lock: two threads may make the same one, neither waits.
        let made = Arc::new(Self::new(&lengths.factors, &lengths.counts, correlation));
        let mut last = last();
        last.truncate(LAST_MAX - 1);
        last.push_front((lengths, Arc::clone(&made)));
        made
    }

    /// For averaging factors and numbers of second differences of one record; the correlation time,
    /// in samples, is that of the exponentially correlated noise, which without one has no products.
    fn new(factors: &[usize], counts: &[usize], correlation: Option<f64>) -> Self {
        let points = factors.len();
        let mut products = vec![[[0.0; TERMS]; TERMS]; points * points];
        for first in 0..points {
            for second in first..points {
                let pair = pair(
                    [factors[first] as f64, factors[second] as f64],
                    [counts[first] as f64, counts[second] as f64],
                    correlation,
                );
                products[first * points + second] = pair;
                products[second * points + first] = pair;
            }
        }
        Self { points, products }
    }

    /// Covariance of two points given the squares of the terms (in units of the sample period).
    pub(crate) fn covariance(&self, first: usize, second: usize, squares: &[f64; TERMS]) -> f64 {
        let table = &self.products[first * self.points + second];
        let mut sum = 0.0;
        for a in 0..TERMS {
            // Most terms are not in a fit.
            if squares[a] == 0.0 {
                continue;
            }
            for b in a..TERMS {
                sum += table[a][b] * squares[a] * squares[b];
            }
        }
        sum
    }

    /// Variance of `sum g AVAR` over all points, as a quadratic in one term's
    /// square, the others given: the coefficients of its powers 0, 1, 2.
    pub(crate) fn combined(&self, g: &[f64], squares: &[f64; TERMS], term: usize) -> [f64; 3] {
        let mut powers = [0.0; 3];
        let there: Vec<usize> = (0..TERMS)
            .filter(|&other| other == term || squares[other] != 0.0)
            .collect();
        for (first, g1) in g.iter().enumerate() {
            for (second, g2) in g.iter().enumerate() {
                let table = &self.products[first * self.points + second];
                let weight = g1 * g2;
                for (at, &a) in there.iter().enumerate() {
                    for &b in &there[at..] {
                        let product = weight * table[a][b];
                        match (a == term, b == term) {
                            (true, true) => powers[2] += product,
                            (true, false) => powers[1] += product * squares[b],
                            (false, true) => powers[1] += product * squares[a],
                            (false, false) => powers[0] += product * squares[a] * squares[b],
                        }
                    }
                }
            }
        }
        powers
    }
}

/// Products of two terms for one pair of averaging factors.
fn pair([m1, m2]: [f64; 2], [n1, n2]: [f64; 2], correlation: Option<f64>) -> [[f64; TERMS]; TERMS] {
    let overlap = |s: f64| (n1.min(n2 - s) - (-s).max(0.0)).max(0.0);
    let mut squares = [[0.0; TERMS]; TERMS];
    let mut means = [0.0; TERMS];
    for panel in panels([m1, m2], [n1, n2]).windows(2) {
        visit(panel[0], panel[1], |s, weight| {
            let c = smooth_covariances(m1, m2, s, correlation);
            let pairs = weight * overlap(s);
            for (first, &a) in SMOOTH_TERMS.iter().enumerate() {
                means[a] += pairs * c[first];
                for (second, &b) in SMOOTH_TERMS.iter().enumerate().skip(first) {
                    squares[a][b] += pairs * c[first] * c[second];
                }
            }
        });
    }
    // White angle noise of variance 1/3 has AVAR = 1/m^2; it correlates at the corners alone.
    let impulses = impulses(m1, m2);
    for &(s, height) in &impulses {
        let c = smooth_covariances(m1, m2, s, correlation);
        let pairs = overlap(s);
        means[INVERSE_SQUARE] += pairs * height / 3.0;
        squares[INVERSE_SQUARE][INVERSE_SQUARE] += pairs * (height / 3.0) * (height / 3.0);
        for (first, &a) in SMOOTH_TERMS.iter().enumerate() {
            let (low, high) = (a.min(INVERSE_SQUARE), a.max(INVERSE_SQUARE));
            squares[low][high] += pairs * c[first] * height / 3.0;
        }
    }
    let scale = 1.0 / (2.0 * n1 * n2 * m1 * m1 * m2 * m2);
    let mut table = [[0.0; TERMS]; TERMS];
    for a in 0..TERMS {
        for b in a..TERMS {
            let twice = if a == b { 1.0 } else { 2.0 };
            table[a][b] = scale * twice * squares[a][b];
        }
    }
    for a in [WHITE, FLICKER, WALK, INVERSE_SQUARE, CORRELATED] {
        table[a.min(RAMP)][a.max(RAMP)] = means[a] / (n1 * n2);
    }
    table
}

/// Corners of the cross-covariance and of the number of pairs, with a tail on either side.
fn panels([m1, m2]: [f64; 2], [n1, n2]: [f64; 2]) -> Vec<f64> {
    let both = m1 + m2;
    let mut corners = vec![0.0, n2 - n1];
    for a in [0.0, 1.0, 2.0] {
        for b in [0.0, 1.0, 2.0] {
            corners.push(a * m1 - b * m2);
        }
    }
    for reach in [1.0, 3.0, 9.0] {
        corners.push(2.0 * m1 + reach * both);
        corners.push(-2.0 * m2 - reach * both);
    }
    for corner in &mut corners {
        *corner = corner.clamp(-n1, n2);
    }
    corners.sort_by(f64::total_cmp);
    corners.dedup_by(|a, b| (*a - *b).abs() < 0.5);
    corners
}

/// Calls with the lags of a panel and their weights: every lag, or the nodes of a quadrature.
fn visit(from: f64, to: f64, mut call: impl FnMut(f64, f64)) {
    let width = to - from;
    if width <= SUMMED_LAGS as f64 {
        let steps = crate::metrics::estimate::interval::round_to_count(width);
        for step in 0..=steps {
            let end = step == 0 || step == steps;
            call(from + step as f64, if end { 0.5 } else { 1.0 });
        }
    } else {
        for (node, weight) in NODES {
            call(from + width * (1.0 + node) / 2.0, weight * width / 2.0);
        }
    }
}

/// Cross-covariances of the second differences of unit white, flicker and walk noise, and of that
/// with a correlation time.
fn smooth_covariances(m1: f64, m2: f64, s: f64, correlation: Option<f64>) -> [f64; SMOOTH] {
    // A parabola of the lag has no fourth difference: without it small lags keep their digits.
    let is_short = correlation.is_some_and(|time| m1 + m2 < time);
    let mut sums = [0.0; SMOOTH];
    for (a, weight_1) in SECOND.iter().enumerate() {
        for (b, weight_2) in SECOND.iter().enumerate() {
            let u = (s + b as f64 * m2 - a as f64 * m1).abs();
            let weight = weight_1 * weight_2;
            sums[0] -= weight * u / 2.0;
            if u > 0.0 {
                sums[1] += weight * u * u * u.ln() / (2.0 * PI);
            }
            sums[2] += weight * u * u * u / 12.0;
            if let Some(time) = correlation {
                sums[3] -= weight * time * time * correlated_angle(u / time, is_short);
            }
        }
    }
    sums
}

/// `x - 1 + exp(-x)`, on request without its `x^2/2`.
fn correlated_angle(x: f64, without_square: bool) -> f64 {
    if !without_square {
        return x + (-x).exp_m1();
    }
    if x < 0.1 {
        let cube = x * x * x;
        return -cube / 6.0 * (1.0 - x / 4.0 * (1.0 - x / 5.0 * (1.0 - x / 6.0 * (1.0 - x / 7.0))));
    }
    x + (-x).exp_m1() - x * x / 2.0
}

/// Lags at which second differences of white angle noise correlate, and by how much.
fn impulses(m1: f64, m2: f64) -> Vec<(f64, f64)> {
    let mut found: Vec<(f64, f64)> = Vec::new();
    for (a, weight_1) in SECOND.iter().enumerate() {
        for (b, weight_2) in SECOND.iter().enumerate() {
            let s = a as f64 * m1 - b as f64 * m2;
            match found.iter_mut().find(|(lag, _)| (*lag - s).abs() < 0.5) {
                Some((_, height)) => *height += weight_1 * weight_2,
                None => found.push((s, weight_1 * weight_2)),
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::allan::overlapping::{NoiseType, degrees_of_freedom};

    #[test]
    fn the_diagonal_gives_the_degrees_of_freedom_of_every_noise_type() {
        let samples = 20_000_usize;
        let factors = [1, 4, 30, 200, 1500];
        let counts = factors.map(|m| samples + 1 - 2 * m);
        let structure = Structure::new(&factors, &counts, None);
        // The formulas of NIST SP 1065 for flicker and walk are empirical, good to some per cent;
        // at one sample they mean point samples of the rate, not its means.
        for (term, noise, rtol, first) in [
            (WHITE, NoiseType::White, 0.02, 0),
            (FLICKER, NoiseType::Flicker, 0.08, 1),
            (WALK, NoiseType::RandomWalk, 0.08, 2),
            (INVERSE_SQUARE, NoiseType::Quantisation, 0.12, 1),
        ] {
            let mut squares = [0.0; TERMS];
            squares[term] = 1.0;
            for (index, &factor) in factors.iter().enumerate().skip(first) {
                let m = factor as f64;
                let value: f64 = match term {
                    WHITE => 1.0 / m,
                    FLICKER => 2.0 * std::f64::consts::LN_2 / PI,
                    WALK => m / 3.0,
                    _ => 1.0 / (m * m),
                };
                let got = 2.0 * value * value / structure.covariance(index, index, &squares);
                let wanted = degrees_of_freedom(noise, samples + 1, factor);
                assert!(
                    (got / wanted - 1.0).abs() < rtol,
                    "{noise:?} {m}: {got} {wanted}"
                );
            }
        }
    }

    #[test]
    fn lengths_asked_for_again_have_the_structure_made_before() {
        let factors = vec![1, 2, 5];
        let counts = vec![99, 97, 91];
        let of = |time| Structure::shared(factors.clone(), counts.clone(), time);
        let (without, with) = (of(None), of(Some(7.0)));
        assert!(Arc::ptr_eq(&without, &of(None)) && Arc::ptr_eq(&with, &of(Some(7.0))));
        assert_ne!(without.products, with.products);
        assert_eq!(
            with.products,
            Structure::new(&factors, &counts, Some(7.0)).products
        );
    }

    #[test]
    fn points_far_apart_correlate_less() {
        let factors = [100, 120, 200, 400, 1600];
        let counts = factors.map(|m| 20_001 - 2 * m);
        let structure = Structure::new(&factors, &counts, None);
        for term in [WHITE, FLICKER, WALK] {
            let mut squares = [0.0; TERMS];
            squares[term] = 1.0;
            let covariance = |a, b| structure.covariance(a, b, &squares);
            let falling: Vec<f64> = (0..factors.len())
                .map(|b| covariance(0, b) / (covariance(0, 0) * covariance(b, b)).sqrt())
                .collect();
            assert!((falling[0] - 1.0).abs() < 1e-12);
            assert!(
                falling.windows(2).all(|pair| pair[0] > pair[1]),
                "{falling:?}"
            );
            assert!(falling[1] > 0.85 && falling[4] > 0.0);
        }
    }
}
