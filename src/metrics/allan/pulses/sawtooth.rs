//! The angle that pulses have not told yet, and its Allan variance.

use std::f64::consts::{PI, SQRT_2, TAU};

use statrs::function::erf::erf;

/// Variance of the number of pulses below which the autocorrelation has a closed form, and harmonics that
/// are left above it: of the next one less than 1e-14.
const CLOSED_FORM_BELOW: f64 = 0.01;
const HARMONICS: u32 = 12;

/// Exponent at which the first harmonic has fallen to a hundredth: errors so far apart are independent.
const DEPHASED: f64 = 4.605;

/// The error of an angle that is counted in whole pulses, its remainder carried: a sawtooth of the
/// angle, which grows at a mean rate and walks.
///
/// Of an angle that starts anywhere within a pulse the error has the autocovariance
/// `R(u) = sum L^2/(2 pi^2 k^2) cos(2 pi k v u/L) exp(-2 pi^2 k^2 N^2 u/L^2)` over the harmonics k,
/// and no covariance with the angle's own increments. Its Allan variance `(3 R(0) - 4 R(tau) +
/// R(2 tau))/tau^2` is `3 Q^2/tau^2` with `Q = L/sqrt(12)` only once the walk has dephased it.
///
/// Source: derived (Fourier series of the sawtooth, characteristic function of the walk).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sawtooth {
    /// Angle of a pulse L, arcsec.
    pub(crate) step_arcsec: f64,
    /// Mean rate v, arcsec/s (deg/h).
    pub(crate) rate_deg_per_h: f64,
    /// Square of the angle random walk N^2, (deg/h)^2 s (arcsec^2/s).
    pub(crate) white: f64,
}

impl Sawtooth {
    /// `3 Q^2`, arcsec^2: the Allan variance times `tau^2` of errors that are independent.
    pub(crate) fn three_squares(step_arcsec: f64) -> f64 {
        step_arcsec * step_arcsec / 4.0
    }

    /// Averaging time from which on the errors at its ends are independent, s; infinite without a walk.
    pub(crate) fn dephasing_time_s(&self) -> f64 {
        let step = self.step_arcsec;
        DEPHASED * step * step / (2.0 * PI * PI * self.white.max(0.0))
    }

    /// Phases of the error that a record sees, each as good as one draw.
    pub(crate) fn phases(&self, duration_s: f64) -> f64 {
        let turns = self.rate_deg_per_h.abs() / self.step_arcsec;
        duration_s * (turns + DEPHASED / self.dephasing_time_s())
    }

    /// Allan variance of the error, (deg/h)^2.
    pub(crate) fn allan_variance(&self, tau_s: f64) -> f64 {
        let step = self.step_arcsec;
        let turns = self.rate_deg_per_h * tau_s / step;
        let walked = self.white.max(0.0) * tau_s / (step * step);
        let [once, twice] = [1.0, 2.0].map(|times| autocorrelation(times * turns, times * walked));
        let variance = step * step / 12.0;
        variance * (3.0 - 4.0 * once + twice).max(0.0) / (tau_s * tau_s)
    }
}

/// Autocorrelation of the error after so many pulses on average, with such a variance of their number.
fn autocorrelation(turns: f64, walked: f64) -> f64 {
    let turns = turns - turns.round();
    if walked < CLOSED_FORM_BELOW {
        // The mean of 1 - 6 |x| + 6 x^2, smooth at half a pulse, over a normal x.
        let spread = walked.sqrt();
        let distance = if spread > 0.0 {
            let normal = turns / spread;
            spread * (2.0 / PI).sqrt() * (-normal * normal / 2.0).exp()
                + turns * erf(normal / SQRT_2)
        } else {
            turns.abs()
        };
        return 1.0 - 6.0 * distance + 6.0 * (turns * turns + walked);
    }
    let harmonics = (1..=HARMONICS).map(f64::from).map(|order| {
        let fall = (-2.0 * PI * PI * order * order * walked).exp();
        (TAU * order * turns).cos() * fall / (order * order)
    });
    6.0 / (PI * PI) * harmonics.sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    const WALKING: Sawtooth = Sawtooth {
        step_arcsec: 1.0,
        rate_deg_per_h: 8.47,
        white: 0.1296,
    };

    fn close(got: f64, wanted: f64, rtol: f64) {
        assert!((got / wanted - 1.0).abs() < rtol, "{got} {wanted}");
    }

    #[test]
    fn errors_that_the_walk_has_dephased_are_a_quantisation() {
        close(WALKING.dephasing_time_s(), 1.8, 0.01);
        let tau_s = 3.0 * WALKING.dephasing_time_s();
        let wanted = Sawtooth::three_squares(1.0) / (tau_s * tau_s);
        close(WALKING.allan_variance(tau_s), wanted, 1e-4);
        // Twice as much walk needs a quarter of the time of twice the pulse.
        let other = Sawtooth {
            step_arcsec: 2.0,
            white: 4.0 * WALKING.white,
            ..WALKING
        };
        close(other.dephasing_time_s(), WALKING.dephasing_time_s(), 1e-12);
    }

    #[test]
    fn the_closed_form_meets_the_series() {
        for turns in [0.0, 0.1, 0.37, 0.5] {
            let [below, above] =
                [1.0 - 1e-9, 1.0].map(|part| autocorrelation(turns, CLOSED_FORM_BELOW * part));
            assert!((below - above).abs() < 1e-5, "{turns}: {below} {above}");
        }
    }

    #[test]
    fn rare_pulses_of_a_steady_rate_are_rare_words() {
        // One word in `rarity` has a pulse: half the mean square difference of words in a row is the
        // square of the word that a pulse makes over the words between two.
        let steady = Sawtooth {
            white: 0.0,
            ..WALKING
        };
        let rarity = 40.0;
        let tau_s = 1.0 / 8.47 / rarity;
        let word = 1.0 / tau_s;
        close(steady.allan_variance(tau_s), word * word / rarity, 0.05);
        // Over whole pulses nothing is left.
        assert!(steady.allan_variance(1.0 / 8.47) < 1e-3 * word * word / rarity);
    }
}
