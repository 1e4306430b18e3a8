//! Noise coefficients from an Allan variance curve.

use super::coefficients::NoiseCoefficients;
use super::covariance::{CORRELATED, FLICKER, INVERSE_SQUARE, RAMP, TERMS, WALK, WHITE};
use super::judge::choice::{Choice, Search};
use super::judge::goodness::Goodness;
use super::least_squares::{Mix, Problem, Solution};
use super::limits::Limits;
use super::overlapping::AllanPoint;
use super::pulses::answer::PulseAnswer;
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
.lower_is_better()
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
.lower_is_better()
.synonyms(&["b", "flicker", "flicker_floor", "bias_instability"])
.heading("bias instability")
.needs(Needs::SlowNoiseFit)
.pooled(Pool::AllanFit)
.echoing("gyro.slow_noise.bias_instability_deg_per_h")
.tables(&[Table::Rest]);

/// Rate random walk.
pub static RATE_RANDOM_WALK: MetricKey = MetricKey::new(
    "rate_random_walk_deg_per_h_per_sqrt_h",
    "deg/h/sqrt(h)",
    Applies::Steady,
    "K of the fit to the overlapping Allan variance, K^2 tau/3",
)
.lower_is_better()
.synonyms(&["k", "rate_random_walk"])
.heading("rate random walk")
.needs(Needs::SlowNoiseFit)
.pooled(Pool::AllanFit)
.echoing("gyro.slow_noise.rate_random_walk_deg_per_h_per_sqrt_h")
.closing_tables();

/// Rate ramp.
pub static RATE_RAMP: MetricKey = MetricKey::new(
    "rate_ramp_deg_per_h_per_h",
    "deg/h/h",
    Applies::Steady,
    "R of the fit to the overlapping Allan variance, R^2 tau^2/2",
)
.lower_is_better()
.synonyms(&["r", "rate_ramp", "drift_rate"])
.heading("rate ramp")
.needs(Needs::SlowNoiseFit)
.pooled(Pool::AllanFit)
.closing_tables();

/// Quantisation.
pub static QUANTISATION: MetricKey = MetricKey::new(
    "quantisation_arcsec",
    "arcsec",
    Applies::Steady,
    "Q of the fit to the overlapping Allan variance, 3 Q^2/tau^2; of counted pulses their step over sqrt(12)",
)
.lower_is_better()
.synonyms(&["q", "quantisation", "quantisation_noise"])
.heading("quantisation")
.needs(Needs::AllanFit)
.pooled(Pool::AllanFit)
.closing_tables();

/// Standard errors that K must exceed for predictions to count on it: flicker explains the same
/// averaging times.
const WALK_SIGNIFICANCE: f64 = 3.0;

/// Variance of the mean of a record over `B^2`, flicker with correlation times up to `m` records:
/// `(ln m + 3/2 - gamma) / pi` for m = 100.
const FLICKER_MEAN_VARIANCE: f64 = 1.760;

/// Fewest points and least ratio of longest to shortest tau that a fit accepts.
const POINTS_MIN: usize = 8;
const TAU_RATIO_MIN: f64 = 8.0;

/// The largest part of the record that an averaging time of the fit may be.
pub const FIT_TAU_PER_RECORD_MAX: f64 = 1.0 / 9.0;

/// What a fit says about one coefficient.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Term {
    /// Square of the coefficient as fitted, of either sign: its mean over records is the true one.
    pub square: f64,
    /// Standard error of the square.
    pub standard_error: f64,
    root: Estimate,
}

impl Term {
    /// A term whose square has this 95 % interval, none of whose ends is negative.
    pub(crate) fn new(square: f64, standard_error: f64, [low, high]: [f64; 2]) -> Self {
        let value = square.max(0.0);
        Self {
            square,
            standard_error,
            root: Estimate::with_interval(
                value.sqrt(),
                low.min(value).sqrt(),
                high.max(value).sqrt(),
            ),
        }
    }

    /// The coefficient: root of the square, zero where that is negative, with its 95 % interval; the
    /// upper end is infinite where the record does not bound it.
    #[must_use]
    pub fn estimate(&self) -> Estimate {
        self.root
    }

    /// The coefficient, zero where the square is negative.
    #[must_use]
    pub fn value(&self) -> f64 {
        self.root.value
    }

    /// Whether the record bounds the coefficient from above.
    #[must_use]
    pub fn is_bounded(&self) -> bool {
        self.root.high.is_finite()
    }
}

/// Exponentially correlated (Gauss-Markov) noise.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CorrelatedNoise {
    /// Its standard deviation, deg/h.
    pub deviation_deg_per_h: Term,
    /// Its correlation time, s.
    pub correlation_time_s: Estimate,
}

/// A sine in the words.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Sine {
    /// Its amplitude, deg/h.
    pub amplitude_deg_per_h: Estimate,
    /// Its period, s.
    pub period_s: Estimate,
    /// Independent frequencies among which it was found.
    pub frequencies_tried: usize,
}

impl Sine {
    /// Allan variance, (deg/h)^2.
    #[must_use]
    pub fn allan_variance(&self, tau_s: f64) -> f64 {
        let amplitude = self.amplitude_deg_per_h.value;
        amplitude * amplitude * sine_allan_variance(tau_s, self.period_s.value)
    }
}

/// Allan variance of a sine of unit amplitude: `(sin^2(pi tau/P) / (pi tau/P))^2`.
///
/// Source: IEEE Std 952-1997 annex C.
#[must_use]
pub fn sine_allan_variance(tau_s: f64, period_s: f64) -> f64 {
    let turn = std::f64::consts::PI * tau_s / period_s;
    let sine = turn.sin();
    (sine * sine / turn).powi(2)
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
    /// Exponentially correlated noise, where the curve asks for it.
    pub correlated: Option<CorrelatedNoise>,
    /// A sine that was taken out of the words before the rest was fitted.
    pub sine: Option<Sine>,
    /// What is told of words that count pulses: their quantisation is that of the pulses by construction,
    /// and the other terms are those of the noise below it.
    pub pulses: Option<PulseAnswer>,
    /// Whether the curve asks for a ramp; without one the others are fitted as if there were none.
    pub has_ramp: bool,
    /// How well the terms describe the curve.
    pub goodness: Goodness,
    /// Shortest and longest averaging time used, s.
    pub tau_range_s: [f64; 2],
    /// The fit, deg/h and s; the column of quantisation is `1/tau^2`.
    mix: Mix,
    /// The same for predictions: without a walk that is not significant.
    settled: Mix,
}

impl NoiseFit {
    /// The coefficients as plain numbers for predictions: K only where it is significant.
    #[must_use]
    pub fn coefficients(&self) -> NoiseCoefficients {
        let root = |term: usize| self.settled.squares[term].max(0.0).sqrt();
        NoiseCoefficients {
            quantisation_arcsec: match self.counted_pulses() {
                Some(_) => self.quantisation_arcsec.value(),
                None => root(INVERSE_SQUARE) / 3.0_f64.sqrt(),
            },
            angle_random_walk_deg_per_h_sqrt_s: root(WHITE),
            bias_instability_deg_per_h: root(FLICKER),
            rate_random_walk_deg_per_h_per_sqrt_s: root(WALK),
            rate_ramp_deg_per_h_per_s: root(RAMP),
        }
    }

    /// Variance that the slow terms give to the mean over a record of this length, (deg/h)^2.
    ///
    /// `1.76 B^2 + K^2 T/3 + R^2 T^2/4`, of those whose intervals do not begin at zero. Flicker has no
    /// variance of its own; `1.76 = (ln 100 + 3/2 - gamma)/pi` counts drift that is correlated over
    /// up to a hundred records, what is slower still being the bias itself. The walk starts at zero
    /// with the record, the ramp too. Exponentially correlated noise adds
    /// `s^2 (2 Tc/T) (1 - (Tc/T) (1 - exp(-T/Tc)))` and at most
    /// `2 s^2 T/(3 Tc)`, the walk that begins with the record, counted pulses `2 Q^2/T^2`. No term of a fit that does
    /// not describe the curve counts.
    ///
    /// Source: derived, flicker as a superposition of Gauss-Markov processes of equal variance per
    /// octave of correlation time (van der Ziel, Physica 16 (1950)).
    #[must_use]
    pub fn slow_mean_variance(&self, duration_s: f64) -> f64 {
        if !self.goodness.is_adequate() {
            return 0.0;
        }
        let square = |term: &Term| {
            let root = term.estimate();
            if root.low > 0.0 {
                root.value.powi(2)
            } else {
                0.0
            }
        };
        let correlated = self.correlated.as_ref().map_or(0.0, |noise| {
            let x = duration_s / noise.correlation_time_s.value;
            let square = square(&noise.deviation_deg_per_h);
            let stationary = square * 2.0 / x * (1.0 + (-x).exp_m1() / x);
            // Of a correlation that outlasts the record, the record shows a random walk and no more: how
            // far that strays in the end is not in it.
            stationary.min(square * 2.0 * x / 3.0)
        });
        // The angle at either end is known to a pulse.
        let pulses = self.counted_pulses().map_or(0.0, |_| {
            2.0 * self.quantisation_arcsec.square / (duration_s * duration_s)
        });
        FLICKER_MEAN_VARIANCE * square(&self.bias_instability_deg_per_h)
            + square(&self.rate_random_walk_deg_per_h_per_sqrt_s) * duration_s / 3.0
            + square(&self.rate_ramp_deg_per_h_per_s) * duration_s * duration_s / 4.0
            + correlated
            + pulses
    }

    /// Averaging time from which on a quantisation is `3 Q^2/tau^2`, s: that of pulses only once they have
    /// lost their phase.
    pub(crate) fn quantisation_is_white_from_s(&self) -> f64 {
        let pulses = self.pulses.as_ref();
        pulses.map_or(0.0, |pulses| pulses.sawtooth.dephasing_time_s())
    }

    /// The answer of words that are pulses themselves.
    pub(crate) fn counted_pulses(&self) -> Option<&PulseAnswer> {
        self.pulses.as_ref().filter(|it| it.counts)
    }

    /// Whether the record is one of a gyro at rest, whose white noise shows and which the five terms
    /// describe: else, as behind weights that wander, nothing may be expected from them.
    #[must_use]
    pub fn shows_white_noise(&self) -> bool {
        self.goodness.is_adequate()
            && self.correlated.is_none()
            && self.sine.is_none()
            && self.settled.squares[WHITE] > 0.0
    }

    /// Fitted Allan deviation, deg/h, with its signed terms; never below zero.
    #[must_use]
    pub fn deviation_deg_per_h(&self, tau_s: f64) -> f64 {
        let sine = self.sine.map_or(0.0, |sine| sine.allan_variance(tau_s));
        let pulses = self
            .counted_pulses()
            .map_or(0.0, |pulses| pulses.sawtooth.allan_variance(tau_s));
        (self.mix.variance(tau_s).max(0.0) + sine + pulses).sqrt()
    }

    /// The fit of a record from which a sine was taken.
    pub(crate) fn beside(self, sine: Sine) -> Self {
        Self {
            sine: Some(sine),
            ..self
        }
    }

    /// The fit to the noise below pulses: of words that are such the quantisation is theirs, and
    /// the `1/tau^2` term of the record that was fitted gives way to the sawtooth.
    pub(crate) fn of_pulses(mut self, pulses: Option<PulseAnswer>) -> Self {
        self.pulses = pulses;
        if let Some(pulses) = self.counted_pulses() {
            let step = pulses.step_arcsec();
            let square = step * step / 12.0;
            self.quantisation_arcsec = Term::new(square, 0.0, [square; 2]);
            self.mix.squares[INVERSE_SQUARE] = 0.0;
            self.settled.squares[INVERSE_SQUARE] = 0.0;
        }
        self
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

/// Fits the noise terms to an Allan variance curve, and judges the fit.
///
/// `AVAR = 3Q^2/tau^2 + N^2/tau + 0.4413 B^2 + K^2 tau/3 + R^2 tau^2/2` is linear in the squares;
/// they are found by generalised least squares. The covariance of the points, which overlap and
/// repeat each other, is that of the fitted mix in a record of this length, found in a few rounds.
///
/// No square is held at zero, so that the mean of each over records is the true one. The
/// `1/tau^2` term, too, is free in sign. Noise whose correlation dies out within the shortest
/// tau (a loop's bandwidth, a filter's taps) has `AVAR = N^2/tau - 3 sum k R(k) T^2/tau^2` exactly,
/// so that a fit with positive Q only would put N low by as much as 2 % at ten samples; where it is
/// negative the record says nothing of a quantisation below it.
///
/// Q, N, B and K are always fitted. A ramp, and exponentially correlated noise with a correlation
/// time from five shortest averaging times to a tenth of the record, join them where the curve asks
/// for them (criterion of Bayes and Schwarz). R has otherwise the value that it has beside the others.
/// A sine is sought in the words, not here.
///
/// Intervals hold all true values, none negative, under which the estimate lies between its
/// quantiles 0.025 and 0.975. No end of one lies where the term alone would exceed the curve at
/// some averaging time of the fit: none above a 99 % band of the whole curve, what the loop takes
/// from it given back.
///
/// # Errors
/// The reason, in words, if fewer than eight points or less than a factor of eight in tau lie in
/// range.
///
/// Source: IEEE Std 952-1997 annex C (model); derived: covariance, signed terms, judgement.
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
    ChosenFit::new(points, range, records).map(|chosen| chosen.judged())
}

/// As [`fit_noise`] where the `1/tau^2` term is known, arcsec^2 (AVAR times `tau^2`).
pub(crate) fn fit_beside_known(
    points: &[AllanPoint],
    range: FitRange,
    inverse_square: Option<f64>,
) -> Result<NoiseFit, Unavailable> {
    ChosenFit::beside_known(points, range, inverse_square).map(|chosen| chosen.judged())
}

/// A fit of the terms that a curve asks for, not judged yet: that takes most of the time.
pub(crate) struct ChosenFit {
    points: Vec<AllanPoint>,
    choice: Choice,
}

impl ChosenFit {
    /// Chooses the terms of a curve, the mean of so many independent records.
    ///
    /// # Errors
    /// As for [`fit_noise`].
    pub(crate) fn new(
        points: &[AllanPoint],
        range: FitRange,
        records: f64,
    ) -> Result<Self, Unavailable> {
        let points = usable(points, range)?;
        let problem = Problem::new(&points, records);
        Self::of(points, &problem)
    }

    /// As [`new`](Self::new) of one record, whose `1/tau^2` term may be known, arcsec^2.
    ///
    /// # Errors
    /// As for [`fit_noise`].
    pub(crate) fn beside_known(
        points: &[AllanPoint],
        range: FitRange,
        inverse_square: Option<f64>,
    ) -> Result<Self, Unavailable> {
        let points = usable(points, range)?;
        let problem = Problem::new(&points, 1.0).with_inverse_square(inverse_square);
        Self::of(points, &problem)
    }

    fn of(points: Vec<AllanPoint>, problem: &Problem) -> Result<Self, Unavailable> {
        let search = Search {
            points: &points,
            near: None,
        };
        match search.choose(problem) {
            Some(choice) => Ok(Self { points, choice }),
            None => Err("the scatter of the Allan variances cannot be worked out".into()),
        }
    }

    /// Two-sided density of the fitted noise, (deg/h)^2/Hz, that of the slow terms raised by two
    /// standard errors: a line must stand above noise that the record does not rule out.
    pub(crate) fn cautious_density(&self, frequency_hz: f64) -> f64 {
        let angular = std::f64::consts::TAU * frequency_hz;
        let limits = Limits::new(&self.choice);
        let raised = |term: usize| {
            let [square, error] = limits.square(term);
            square.max(0.0) + 2.0 * error
        };
        let problem = &self.choice.problem;
        let correlated = self.choice.allowed[CORRELATED].then(|| {
            let time = problem.correlation().unwrap_or(0.0) * problem.sample_period_s();
            let turn = angular * time;
            2.0 * raised(CORRELATED) * time / (1.0 + turn * turn)
        });
        let [white, _] = limits.square(WHITE);
        white.max(0.0)
            + raised(FLICKER) / angular
            + raised(WALK) / (angular * angular)
            + correlated.unwrap_or(0.0)
    }

    /// The terms as noise can have them, s: without those whose square came out negative, the others
    /// fitted again; the `1/tau^2` term may be of either sign beside white noise.
    pub(crate) fn non_negative(&self) -> Mix {
        let problem = &self.choice.problem;
        let mut allowed = self.choice.allowed;
        loop {
            let solution = problem.solve(&allowed);
            let is_impossible = |term: usize| {
                let is_smooth = term == INVERSE_SQUARE && solution.squares[WHITE] > 0.0;
                allowed[term] && solution.squares[term] < 0.0 && !is_smooth
            };
            let excess =
                |term: usize| solution.squares[term] / problem.standard_error(&solution, term);
            let worst = (0..TERMS)
                .filter(|&term| is_impossible(term))
                .min_by(|&a, &b| excess(a).total_cmp(&excess(b)));
            match worst {
                Some(term) => allowed[term] = false,
                None => return in_seconds(problem, &solution.squares),
            }
        }
    }

    /// The fit in coefficients and intervals, judged.
    pub(crate) fn judged(&self) -> NoiseFit {
        report(&self.points, &self.choice)
    }
}

/// The points of a curve that a fit uses, if they are enough.
fn usable(points: &[AllanPoint], range: FitRange) -> Result<Vec<AllanPoint>, Unavailable> {
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
    let reach = match (used.first(), used.last()) {
        (Some(first), Some(last)) => last.tau_s / first.tau_s,
        _ => 0.0,
    };
    if used.len() < POINTS_MIN || reach < TAU_RATIO_MIN {
        return Err(format!(
            "the record offers {} averaging times from {:.4} s to {:.4} s, a ninth of its length; a \
             fit needs {POINTS_MIN} that span a factor of {TAU_RATIO_MIN}",
            used.len(),
            range.tau_min_s,
            range.tau_max_s,
        )
        .into());
    }
    Ok(thinned(used))
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

/// Puts the chosen fit into coefficients and intervals.
fn report(points: &[AllanPoint], choice: &Choice) -> NoiseFit {
    let limits = Limits::new(choice);
    let term = |index: usize| limits.term(index, 1.0);
    let correlated = choice.allowed[CORRELATED].then(|| CorrelatedNoise {
        deviation_deg_per_h: term(CORRELATED),
        correlation_time_s: limits.correlation_time_s(),
    });
    NoiseFit {
        quantisation_arcsec: limits.term(INVERSE_SQUARE, 1.0 / 3.0),
        angle_random_walk_deg_per_h_sqrt_s: term(WHITE),
        bias_instability_deg_per_h: term(FLICKER),
        rate_random_walk_deg_per_h_per_sqrt_s: term(WALK),
        rate_ramp_deg_per_h_per_s: term(RAMP),
        correlated,
        sine: None,
        pulses: None,
        has_ramp: choice.allowed[RAMP],
        goodness: Goodness::of(points, choice),
        tau_range_s: [points[0].tau_s, points[points.len() - 1].tau_s],
        mix: in_seconds(&choice.problem, &choice.squares),
        settled: settled(choice, limits.solution()),
    }
}

fn in_seconds(problem: &Problem, squares: &[f64; TERMS]) -> Mix {
    let time = problem.correlation();
    Mix {
        squares: std::array::from_fn(|term| problem.in_seconds(term, squares[term])),
        correlation_time: time.map(|time| time * problem.sample_period_s()),
    }
}

/// The fit that predictions rest on.
///
/// * `whole`: the fit of all chosen terms.
fn settled(choice: &Choice, whole: &Solution) -> Mix {
    let problem = &choice.problem;
    let mut allowed = choice.allowed;
    allowed[WALK] = problem.significance(whole, WALK) >= WALK_SIGNIFICANCE;
    let solution = if allowed[WALK] {
        whole
    } else {
        &problem.solve(&allowed)
    };
    in_seconds(problem, &solution.squares)
}
