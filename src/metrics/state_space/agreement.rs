//! Whether a system has the Allan variance of the words that it was made for, and the taps that give it that.

use super::model::StateSpace;
use super::taps::Taps;
use crate::metrics::allan::overlapping::AllanPoint;
use crate::metrics::estimate::interval;
use crate::metrics::noise::autocovariance::CURVE_LAGS;

/// Part of a deviation by which a system may be off, and standard errors of the words' own beside it.
const STATED: f64 = 0.03;
const STANDARD_ERRORS: f64 = 3.0;

/// Part of that at which taps are enough: fewer of them make a smaller filter.
const ENOUGH: f64 = 0.5;

/// Most taps before the present one, and words that an averaging time has at least.
const TAPS_MAX: usize = CURVE_LAGS - 10;
const WORDS_MIN: usize = 2;

/// What the words show at averaging times below the fit.
pub(super) struct Shown {
    /// Overlapping Allan curve.
    pub(super) points: Vec<AllanPoint>,
    /// Autocovariance of what is neither correlated noise nor a sine; slow noise is the same at all lags.
    pub(super) autocovariance: Vec<f64>,
    /// Shortest averaging time of the fit, s.
    pub(super) fit_from_s: f64,
}

impl Shown {
    /// Distance of a system from the words at a point, in that which is allowed.
    fn off(system: &StateSpace, point: &AllanPoint) -> f64 {
        let own = system.allan_deviation_deg_per_h(point.tau_s);
        let error = 1.0 / (2.0 * point.degrees_of_freedom).sqrt();
        let allowed = STATED + STANDARD_ERRORS * error;
        (own / point.deviation_deg_per_h.value - 1.0).abs() / allowed
    }

    /// Averaging time from which on a system has the Allan variance of the words, s: that of the fit, or
    /// shorter.
    pub(super) fn holds_from_s(&self, system: &StateSpace) -> f64 {
        let below = self.points.iter().rev().filter(|point| {
            point.tau_s <= self.fit_from_s * (1.0 + 1e-9) && point.averaged_samples >= WORDS_MIN
        });
        let held = below.take_while(|point| Self::off(system, point) <= 1.0);
        held.last().map_or(self.fit_from_s, |point| point.tau_s)
    }

    /// Whether that is so from the shortest averaging time on.
    fn is_whole(&self, system: &StateSpace) -> bool {
        let mut points = self.points.iter();
        let first = points.find(|point| point.averaged_samples >= WORDS_MIN);
        first.is_none_or(|first| self.holds_from_s(system) <= first.tau_s)
    }

    /// The plain system where it has the words' Allan variance, else that with the fewest taps that has.
    ///
    /// * `with`: the system whose white noise has these taps; `white_variance`: that of a word if its
    ///   neighbours were as white.
    pub(super) fn best(
        &self,
        plain: StateSpace,
        with: impl Fn(Taps) -> StateSpace,
        white_variance: f64,
    ) -> StateSpace {
        if self.is_whole(&plain) {
            return plain;
        }
        let mut best: Option<(f64, StateSpace)> = None;
        let most = TAPS_MAX.min(self.autocovariance.len().saturating_sub(2));
        for taps in 1..=most {
            let slow = interval::mean(&self.autocovariance[taps + 1..]);
            let fast: Vec<f64> = self.autocovariance[..=taps]
                .iter()
                .map(|it| it - slow)
                .collect();
            // Its level by the words themselves, or by the fit: whichever meets the curve.
            let own = Taps::of(&fast);
            let of_fit = own.as_ref().and_then(|own| own.scaled_to(white_variance));
            for taps in own.into_iter().chain(of_fit) {
                let system = with(taps);
                // Beyond some times their number the taps are white noise, which the fit knows.
                let seen = self
                    .points
                    .iter()
                    .filter(|point| (WORDS_MIN..=2 * CURVE_LAGS).contains(&point.averaged_samples));
                let worst = seen
                    .map(|point| Self::off(&system, point))
                    .fold(0.0, f64::max);
                if best.as_ref().is_none_or(|(least, _)| worst < *least) {
                    best = Some((worst, system));
                }
            }
            if best.as_ref().is_some_and(|(worst, _)| *worst <= ENOUGH) {
                break;
            }
        }
        match best {
            Some((_, system)) if self.holds_from_s(&system) < self.holds_from_s(&plain) => system,
            _ => plain,
        }
    }
}
