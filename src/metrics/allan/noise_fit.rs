//! Noise coefficients from an Allan variance curve.

use super::covariance::{FLICKER, INVERSE_SQUARE, RAMP, TERMS, WALK, WHITE};
use super::least_squares::{Problem, basis, fitted_variance};
use super::overlapping::{AllanPoint, NoiseType, degrees_of_freedom};
use crate::metrics::estimate::reason::Unavailable;
use crate::metrics::estimate::value::Estimate;
use crate::metrics::key::metric::{Applies, Headline, MetricKey, Needs, Pool, Table};

/// Angle random walk.
pub static ANGLE_RANDOM_WALK: MetricKey = MetricKey::new(
    "angle_random_walk_deg_per_sqrt_h",
    "deg/sqrt(h)",
    Applies::Steady,
    "N of the fit to the overlapping Allan variance, N^2/tau",
)
.synonyms(&["n", "angle_random_walk", "angular_random_walk"])
.heading("ARW")
.slow_noise()
.needs(Needs::AllanFit)
.pooled(Pool::AllanFit)
.run_column(7)
.tables(&[Table::Rest])
.headlines(&[Headline::Rest]);

/// Bias instability.
pub static BIAS_INSTABILITY: MetricKey = MetricKey::new(
    "bias_instability_deg_per_h",
    "deg/h",
    Applies::Steady,
    "B of the fit to the overlapping Allan variance, (0.664 B)^2: the flicker floor over 0.664",
)
.synonyms(&["b", "flicker", "flicker_floor", "bias_instability"])
.heading("bias instability")
.needs(Needs::SlowNoiseFit)
.pooled(Pool::AllanFit)
.tables(&[Table::Rest]);

/// Rate random walk.
pub static RATE_RANDOM_WALK: MetricKey = MetricKey::new(
    "rate_random_walk_deg_per_h_per_sqrt_h",
    "deg/h/sqrt(h)",
    Applies::Steady,
    "K of the fit to the overlapping Allan variance, K^2 tau/3",
)
.synonyms(&["k", "rate_random_walk"])
.heading("rate random walk")
.needs(Needs::SlowNoiseFit)
.pooled(Pool::AllanFit)
.closing_tables();

/// Rate ramp.
pub static RATE_RAMP: MetricKey = MetricKey::new(
    "rate_ramp_deg_per_h_per_h",
    "deg/h/h",
    Applies::Steady,
    "R of the fit to the overlapping Allan variance, R^2 tau^2/2",
)
.synonyms(&["r", "rate_ramp", "drift", "drift_rate"])
.heading("rate ramp")
.needs(Needs::SlowNoiseFit)
.pooled(Pool::AllanFit)
.closing_tables();

/// Quantisation.
pub static QUANTISATION: MetricKey = MetricKey::new(
    "quantisation_arcsec",
    "arcsec",
    Applies::Steady,
    "Q of the fit to the overlapping Allan variance, 3 Q^2/tau^2",
)
.synonyms(&["q", "quantisation", "quantisation_noise"])
.heading("quantisation")
.needs(Needs::AllanFit)
.pooled(Pool::AllanFit)
.closing_tables();

/// Q is said to be found from this many standard errors on; N and B as soon as they are positive,
/// with an interval that may begin at zero.
const SIGNIFICANCE: f64 = 1.645;

/// K and R must exceed this many: B explains the same averaging times, and the few independent
/// differences at the longest of them scatter with a long upper tail.
const STEEP_SIGNIFICANCE: f64 = 3.0;

/// Standard errors added to the slow terms where a prediction must not trust a lucky record.
const CAUTION: f64 = 0.5;

/// Variance of the mean of a record over `B^2`, flicker with correlation times up to `m` records:
/// `(ln m + 3/2 - gamma) / pi` for m = 100.
const FLICKER_MEAN_VARIANCE: f64 = 1.760;

/// Fewest points and least ratio of longest to shortest tau that a fit accepts.
const POINTS_MIN: usize = 8;
const TAU_RATIO_MIN: f64 = 8.0;

/// The largest part of the record that an averaging time of the fit may be.
pub const FIT_TAU_PER_RECORD_MAX: f64 = 1.0 / 9.0;

/// Coefficients of the five classical noise terms of a rate, in deg/h and s; 0 = term left out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NoiseCoefficients {
    /// Angle quantisation Q, arcsec (1 arcsec = 1 deg/h times 1 s).
    pub quantisation_arcsec: f64,
    /// Angle random walk N, (deg/h) sqrt(s).
    pub angle_random_walk_deg_per_h_sqrt_s: f64,
    /// Bias instability B, deg/h.
    pub bias_instability_deg_per_h: f64,
    /// Rate random walk K, (deg/h)/sqrt(s).
    pub rate_random_walk_deg_per_h_per_sqrt_s: f64,
    /// Rate ramp R, (deg/h)/s.
    pub rate_ramp_deg_per_h_per_s: f64,
}

impl NoiseCoefficients {
    /// `3Q^2/tau^2 + N^2/tau + (2 ln2/pi) B^2 + K^2 tau/3 + R^2 tau^2/2`, (deg/h)^2.
    ///
    /// Source: IEEE Std 952-1997 annex C.
    #[must_use]
    pub fn allan_variance(&self, tau_s: f64) -> f64 {
        let squares = [
            self.angle_random_walk_deg_per_h_sqrt_s,
            self.bias_instability_deg_per_h,
            self.rate_random_walk_deg_per_h_per_sqrt_s,
            self.rate_ramp_deg_per_h_per_s,
            self.quantisation_arcsec,
        ]
        .map(|value| value * value);
        let quantisation = 3.0 * squares[4] / (tau_s * tau_s);
        let rest: f64 = (0..4).map(|term| squares[term] * basis(term, tau_s)).sum();
        quantisation + rest
    }
}

/// What a fit says about one coefficient.
#[derive(Clone, Debug, PartialEq)]
pub enum Term {
    /// The coefficient (not its square) with its 95 % interval.
    Found(Estimate),
    /// Left out, and why; the interval begins at zero.
    LeftOut {
        /// The reason, in words, with the upper end of the interval.
        reason: String,
        /// What the record still allows: value 0, 95 % interval from 0 on.
        allowed: Estimate,
    },
}

impl Term {
    /// The estimate; value 0 if left out.
    #[must_use]
    pub fn estimate(&self) -> Estimate {
        match self {
            Self::Found(estimate) => *estimate,
            Self::LeftOut { allowed, .. } => *allowed,
        }
    }

    /// The value, 0 if left out.
    #[must_use]
    pub fn value(&self) -> f64 {
        match self {
            Self::Found(estimate) => estimate.value,
            Self::LeftOut { .. } => 0.0,
        }
    }
}

/// A fitted noise model.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct NoiseFit {
    /// Q, arcsec.
    pub quantisation_arcsec: Term,
    /// N, (deg/h) sqrt(s).
    pub angle_random_walk_deg_per_h_sqrt_s: Term,
    /// B, deg/h.
    pub bias_instability_deg_per_h: Term,
    /// K, (deg/h)/sqrt(s).
    pub rate_random_walk_deg_per_h_per_sqrt_s: Term,
    /// R, (deg/h)/s.
    pub rate_ramp_deg_per_h_per_s: Term,
    /// Shortest and longest averaging time used, s.
    pub tau_range_s: [f64; 2],
    /// Coefficients of the columns N^2, B^2, K^2, R^2, `1/tau^2`.
    squares: [f64; TERMS],
    /// Standard errors of the same, 0 where a term is not in the model.
    standard_errors: [f64; TERMS],
}

impl NoiseFit {
    /// The coefficients as plain numbers, those included that are too faint to be reported.
    #[must_use]
    pub fn coefficients(&self) -> NoiseCoefficients {
        let root = |term: usize| self.squares[term].max(0.0).sqrt();
        NoiseCoefficients {
            quantisation_arcsec: root(INVERSE_SQUARE) / 3.0_f64.sqrt(),
            angle_random_walk_deg_per_h_sqrt_s: root(WHITE),
            bias_instability_deg_per_h: root(FLICKER),
            rate_random_walk_deg_per_h_per_sqrt_s: root(WALK),
            rate_ramp_deg_per_h_per_s: root(RAMP),
        }
    }

    /// Variance of the mean over a record of this length about the true rate, (deg/h)^2.
    ///
    /// `N^2/T + 1.76 B^2 + K^2 T/3 + R^2 T^2/4`, the slow squares each raised by half a standard error:
    /// a record that does not show flicker bounds it, it does not rule it out. Flicker has no
    /// variance of its own; `1.76 = (ln 100 + 3/2 - gamma)/pi` counts drift that is correlated over
    /// up to a hundred records, what is slower still being the bias itself. The walk starts at zero
    /// with the record, the ramp too.
    ///
    /// Source: derived, flicker as a superposition of Gauss-Markov processes of equal variance per
    /// octave of correlation time (van der Ziel, Physica 16 (1950)).
    #[must_use]
    pub fn mean_variance(&self, duration_s: f64) -> f64 {
        let cautious =
            |term: usize| self.squares[term].max(0.0) + CAUTION * self.standard_errors[term];
        self.squares[WHITE].max(0.0) / duration_s
            + FLICKER_MEAN_VARIANCE * cautious(FLICKER)
            + cautious(WALK) * duration_s / 3.0
            + cautious(RAMP) * duration_s * duration_s / 4.0
    }

    /// Whether the record shows white noise, as that of a gyro does: where it does not, the five terms
    /// do not describe it, as behind weights that wander, and nothing may be expected from them.
    #[must_use]
    pub fn shows_white_noise(&self) -> bool {
        matches!(self.angle_random_walk_deg_per_h_sqrt_s, Term::Found(_))
    }

    /// Fitted Allan deviation, deg/h, the signed `1/tau^2` term included; never below zero.
    #[must_use]
    pub fn deviation_deg_per_h(&self, tau_s: f64) -> f64 {
        fitted_variance(&self.squares, tau_s).max(0.0).sqrt()
    }
}

/// Averaging times a fit uses: from `tau_min_s` to a ninth of the record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitRange {
    /// Shortest averaging time, s; shorter ones see the bandwidth of the channel.
    pub tau_min_s: f64,
    /// Longest averaging time, s.
    pub tau_max_s: f64,
}

/// Fits the five noise terms to an Allan variance curve.
///
/// `AVAR = 3Q^2/tau^2 + N^2/tau + 0.4413 B^2 + K^2 tau/3 + R^2 tau^2/2` is linear in the squares;
/// they are found by generalised least squares. The covariance of the points, which overlap and
/// repeat each other, is that of the fitted mix in a record of this length, found in a few rounds.
///
/// No square is held at zero while it is fitted: a bound on B would put N low on white noise. The
/// `1/tau^2` term, too, is free in sign. Noise whose correlation dies out within the shortest
/// tau (a loop's bandwidth, a filter's taps) has `AVAR = N^2/tau - 3 sum k R(k) T^2/tau^2` exactly,
/// so that a fit with positive Q only would put N low by as much as 2 % at ten samples.
///
/// R, then K leave the model unless they exceed 3 of the standard errors they would have if they
/// were zero. Intervals are those of the terms in the model and hold all true values, none negative,
/// under which the estimate lies between its quantiles 0.025 and 0.975: where that begins at zero
/// the upper end alone bounds the coefficient. A term left out has the interval it has beside the
/// others. Where K is left out, the intervals of the others are widened to what they are beside it:
/// an hour cannot always tell a faint walk from flicker.
///
/// # Errors
/// The reason, in words, if fewer than eight points or less than a factor of eight in tau lie in
/// range.
///
/// Source: IEEE Std 952-1997 annex C (model); derived: covariance, signed terms.
pub fn fit_noise(points: &[AllanPoint], range: FitRange) -> Result<NoiseFit, Unavailable> {
    fit_pooled_noise(points, range, 1.0)
}

/// As [`fit_noise`] for the mean of the curves of so many independent records.
///
/// # Errors
/// As for [`fit_noise`].
pub fn fit_pooled_noise(
    points: &[AllanPoint],
    range: FitRange,
    records: f64,
) -> Result<NoiseFit, Unavailable> {
    // A hair of slack keeps a point whose tau equals the limit up to rounding.
    let used: Vec<AllanPoint> = points
        .iter()
        .copied()
        .filter(|point| {
            point.tau_s >= range.tau_min_s * (1.0 - 1e-9)
                && point.tau_s <= range.tau_max_s * (1.0 + 1e-9)
                && point.deviation_deg_per_h.value > 0.0
        })
        .collect();
    let reach = |used: &[AllanPoint]| match (used.first(), used.last()) {
        (Some(first), Some(last)) => last.tau_s / first.tau_s,
        _ => 0.0,
    };
    let enough = |used: &[AllanPoint]| used.len() >= POINTS_MIN && reach(used) >= TAU_RATIO_MIN;
    if !enough(&used) {
        return Err(format!(
            "the record offers {} averaging times between {:.4} s and a ninth of its length \
             ({:.4} s); a fit needs at least {POINTS_MIN} over a factor of {TAU_RATIO_MIN}",
            used.len(),
            range.tau_min_s,
            range.tau_max_s,
        )
        .into());
    }
    let used = thinned(used);
    let problem = Problem::new(&used, records);
    let range = [used[0].tau_s, used[used.len() - 1].tau_s];
    Ok(report(range, &problem))
}

/// Every second point and the last of a dense curve: neighbours a fifth of tau apart correlate by 0.9
/// and more.
fn thinned(used: Vec<AllanPoint>) -> Vec<AllanPoint> {
    if used.len() < 2 * POINTS_MIN {
        return used;
    }
    let last = used.len() - 1;
    let kept = used.into_iter().enumerate();
    kept.filter(|(index, _)| index % 2 == 0 || *index == last)
        .map(|(_, point)| point)
        .collect()
}

/// The terms the points ask for.
fn choose_terms(problem: &Problem) -> [bool; TERMS] {
    let mut active = [true; TERMS];
    // R first, then K: each must be needed although the gentler ones may explain the same times.
    for term in [RAMP, WALK] {
        active[term] = problem.significance(&problem.solve(&active), term) >= STEEP_SIGNIFICANCE;
    }
    active
}

/// Degrees of freedom of every point given a fitted mix of noise types.
///
/// The reciprocal is interpolated between the types' own reciprocals by their share of the Allan
/// variance at that tau, so that a point where one type rules has exactly that type's number.
#[must_use]
pub fn mixed_degrees_of_freedom(
    points: &[AllanPoint],
    coefficients: &NoiseCoefficients,
    angle_count: usize,
) -> Vec<AllanPoint> {
    let squares = [
        coefficients.angle_random_walk_deg_per_h_sqrt_s,
        coefficients.bias_instability_deg_per_h,
        coefficients.rate_random_walk_deg_per_h_per_sqrt_s,
        coefficients.rate_ramp_deg_per_h_per_s,
    ]
    .map(|value| value * value);
    let types = [
        NoiseType::White,
        NoiseType::Flicker,
        NoiseType::RandomWalk,
        NoiseType::RandomWalk,
    ];
    let quantisation = coefficients.quantisation_arcsec.powi(2);
    points
        .iter()
        .map(|point| {
            let mut total = 0.0;
            let mut reciprocal = 0.0;
            let mut add = |variance: f64, noise: NoiseType| {
                total += variance;
                reciprocal +=
                    variance / degrees_of_freedom(noise, angle_count, point.averaged_samples);
            };
            for (term, noise) in types.into_iter().enumerate() {
                add(squares[term] * basis(term, point.tau_s), noise);
            }
            add(
                3.0 * quantisation / (point.tau_s * point.tau_s),
                NoiseType::Quantisation,
            );
            if total > 0.0 {
                point.with_degrees_of_freedom(total / reciprocal)
            } else {
                *point
            }
        })
        .collect()
}

/// Puts the solution into words and intervals.
fn report(range: [f64; 2], problem: &Problem) -> NoiseFit {
    let active = choose_terms(problem);
    let solution = problem.solve(&active);
    let mut walking = active;
    walking[WALK] = true;
    let beside_walk = problem.solve(&walking);
    let term = |index: usize, factor: f64, name: &str| -> Term {
        let mut with = active;
        with[index] = true;
        let own = match index {
            WALK => beside_walk.clone(),
            _ if active[index] => solution.clone(),
            _ => problem.solve(&with),
        };
        let nothing = || Estimate::with_interval(0.0, 0.0, f64::INFINITY);
        let mut square = problem.interval(&own, index).unwrap_or_else(nothing);
        if active[index] && !active[WALK] {
            // A walk too faint to be told from flicker may still be there.
            let wider = problem
                .interval(&beside_walk, index)
                .unwrap_or_else(nothing);
            square.low = square.low.min(wider.low);
            square.high = square.high.max(wider.high);
        }
        let root = |square: f64| (problem.in_seconds(index, square) * factor).sqrt();
        let needed = match index {
            WALK | RAMP => STEEP_SIGNIFICANCE,
            INVERSE_SQUARE => SIGNIFICANCE,
            _ => 0.0,
        };
        let [value, low, high] = [square.value, square.low, square.high].map(root);
        if active[index] && value > 0.0 && problem.significance(&own, index) >= needed {
            return Term::Found(Estimate::with_interval(value, low, high));
        }
        let asked = if needed > 0.0 {
            format!("its square must exceed {needed} standard errors")
        } else {
            "its square comes out below zero".to_owned()
        };
        Term::LeftOut {
            reason: format!(
                "the Allan variance between {:.2} s and {:.2} s does not show {name}: {asked}",
                range[0], range[1],
            ),
            allowed: Estimate::with_interval(0.0, 0.0, high),
        }
    };
    let square = |index: usize| {
        let square = solution.square(index);
        let bound = if index == INVERSE_SQUARE {
            square
        } else {
            square.max(0.0)
        };
        problem.in_seconds(index, bound)
    };
    NoiseFit {
        quantisation_arcsec: term(INVERSE_SQUARE, 1.0 / 3.0, "quantisation"),
        angle_random_walk_deg_per_h_sqrt_s: term(WHITE, 1.0, "angle random walk"),
        bias_instability_deg_per_h: term(FLICKER, 1.0, "bias instability"),
        rate_random_walk_deg_per_h_per_sqrt_s: term(WALK, 1.0, "rate random walk"),
        rate_ramp_deg_per_h_per_s: term(RAMP, 1.0, "rate ramp"),
        tau_range_s: range,
        squares: std::array::from_fn(square),
        standard_errors: std::array::from_fn(|index| {
            problem.in_seconds(index, problem.standard_error(&solution, index))
        }),
    }
}
