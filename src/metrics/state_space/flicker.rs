//! Flicker noise as a bank of exponentially correlated noises.

use std::f64::consts::PI;

use crate::metrics::allan::covariance::FLICKER_ALLAN_VARIANCE;
use crate::metrics::allan::least_squares::correlated_allan_variance;

/// Poles in a decade of correlation time.
const POLES_PER_DECADE: f64 = 2.0;

/// Relative error of the Allan deviation that a bank is built to.
const BUILT_TO: f64 = 0.01;

/// Averaging times looked at in a decade.
const LOOKED_AT_PER_DECADE: f64 = 20.0;

/// Decades beyond either end of the averaging times that a bank may reach.
const DECADES_BEYOND_MAX: f64 = 3.0;

/// Exponentially correlated noises that add up to flicker over a range of averaging times.
///
/// Noises of equal variance `B^2/pi ln r`, their correlation times a ratio r apart, have the spectrum
/// `B^2/(2 pi f)` between their corners; those shorter than the shortest are taken as white.
///
/// Source: van der Ziel, Physica 16 (1950) 359.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FlickerBank {
    /// Correlation times, s, rising.
    pub correlation_times_s: Vec<f64>,
    /// Variance of each, (deg/h)^2.
    pub variance: f64,
    /// Two-sided density of what is faster, `(deg/h)^2 s`.
    pub white_density: f64,
    /// Poles in a decade.
    pub poles_per_decade: f64,
    /// Shortest and longest averaging time, s, between which the Allan deviation is flat within 3 %.
    pub tau_range_s: [f64; 2],
}

impl FlickerBank {
    /// Relative error of the Allan deviation within the range that is stated.
    pub const STATED: f64 = 0.03;

    /// The bank of this `B^2`, (deg/h)^2, flat within 1 % between these averaging times, s.
    pub(super) fn new(square: f64, tau_min_s: f64, tau_max_s: f64) -> Self {
        let ratio = 10.0_f64.powf(1.0 / POLES_PER_DECADE);
        let reach = 10.0_f64.powf(DECADES_BEYOND_MAX);
        let (mut shortest, mut longest) = (tau_min_s, tau_min_s);
        while longest < tau_max_s {
            longest *= ratio;
        }
        let mut bank = Self::between(square, shortest, longest);
        while bank.error(tau_min_s) > BUILT_TO && shortest > tau_min_s / reach {
            shortest /= ratio;
            bank = Self::between(square, shortest, longest);
        }
        while bank.error(tau_max_s) > BUILT_TO && longest < tau_max_s * reach {
            longest *= ratio;
            bank = Self::between(square, shortest, longest);
        }
        bank.tau_range_s = bank.flat_around(tau_min_s, tau_max_s);
        bank
    }

    fn between(square: f64, shortest_s: f64, longest_s: f64) -> Self {
        let ratio = 10.0_f64.powf(1.0 / POLES_PER_DECADE);
        let mut times = vec![shortest_s];
        while times[times.len() - 1] * ratio.sqrt() < longest_s {
            times.push(times[times.len() - 1] * ratio);
        }
        Self {
            correlation_times_s: times,
            variance: square / PI * ratio.ln(),
            // The integral of the densities `2 Tc B^2/pi d ln Tc` below the shortest.
            white_density: 2.0 * square / PI * shortest_s / ratio.sqrt(),
            poles_per_decade: POLES_PER_DECADE,
            tau_range_s: [shortest_s, longest_s],
        }
    }

    /// Allan variance, (deg/h)^2.
    pub(super) fn allan_variance(&self, tau_s: f64) -> f64 {
        let times = self.correlation_times_s.iter();
        let poles: f64 = times
            .map(|&time_s| correlated_allan_variance(tau_s, time_s))
            .sum();
        self.variance * poles + self.white_density / tau_s
    }

    /// Relative error of the Allan deviation.
    fn error(&self, tau_s: f64) -> f64 {
        let ratio = 10.0_f64.powf(1.0 / POLES_PER_DECADE);
        let square = self.variance * PI / ratio.ln();
        let flat = FLICKER_ALLAN_VARIANCE * square;
        ((self.allan_variance(tau_s) / flat).sqrt() - 1.0).abs()
    }

    /// Averaging times on either side of a range up to which the deviation is flat.
    fn flat_around(&self, tau_min_s: f64, tau_max_s: f64) -> [f64; 2] {
        let step = 10.0_f64.powf(1.0 / LOOKED_AT_PER_DECADE);
        let middle = (tau_min_s * tau_max_s).sqrt();
        let reach = 10.0_f64.powf(DECADES_BEYOND_MAX);
        let (mut low, mut high) = (middle, middle);
        while low > tau_min_s / reach && self.error(low / step) < Self::STATED {
            low /= step;
        }
        while high < tau_max_s * reach && self.error(high * step) < Self::STATED {
            high *= step;
        }
        [low, high]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bank_is_flat_where_it_says_and_nowhere_else() {
        for (tau_min_s, tau_max_s) in [(0.02, 360.0), (2.0, 7.0), (5e-4, 8640.0)] {
            let bank = FlickerBank::new(0.04, tau_min_s, tau_max_s);
            let [low, high] = bank.tau_range_s;
            assert!(low <= tau_min_s && tau_max_s <= high, "{bank:?}");
            let mut tau_s = low;
            while tau_s < high {
                let flat = FLICKER_ALLAN_VARIANCE * 0.04;
                let deviation = (bank.allan_variance(tau_s) / flat).sqrt();
                assert!((deviation - 1.0).abs() < 0.03, "{tau_s}: {deviation}");
                tau_s *= 1.07;
            }
            assert!(bank.error(1.13 * high) > 0.029);
        }
    }
}
