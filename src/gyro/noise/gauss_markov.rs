//! Gauss-Markov process as its mean over equal intervals, or at their ends.

use crate::random::Stream;

/// Interval over the correlation time below which the integrals are taken to first order.
const SHORT: f64 = 1e-3;

/// One Gauss-Markov process of given standard deviation, drawn interval by interval.
///
/// Its mean over an interval of `a` correlation times is no Gauss-Markov process: its covariance is
/// `2 (a - 1 + exp(-a)) / a^2` of the variance, and `exp(-(k - 1) a) ((1 - exp(-a)) / a)^2` between
/// intervals k apart. `m <- exp(-a) m + e + c e'` has exactly that, with one normal deviate e per
/// interval, e' the one before, and `c / (1 + c^2)` the correlation of neighbours of
/// `u = m - exp(-a) m'`. In units of the process driven by white noise, u is the integral over the
/// interval and the one before of `f(v) = (1 - exp(-a v)) / a` and `g(v) = (exp(-a v) - exp(-a)) / a`.
///
/// # Source
/// Derived; an ARMA(1, 1) process as in Box and Jenkins, Time Series Analysis, chapter 3.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct GaussMarkov {
    value: f64,
    decay: f64,
    innovation: f64,
    /// c.
    carry: f64,
    /// The last innovation.
    last: f64,
}

impl GaussMarkov {
    /// A process in its stationary distribution, taken at instants `exponent` correlation times apart.
    pub(super) fn at_instants(deviation: f64, exponent: f64, stream: &mut Stream) -> Self {
        Self {
            value: deviation * stream.normal(),
            decay: (-exponent).exp(),
            innovation: deviation * (-(-2.0 * exponent).exp_m1()).sqrt(),
            carry: 0.0,
            last: 0.0,
        }
    }

    /// A process in its stationary distribution, as its mean over intervals of `exponent` correlation
    /// times. The first interval takes a deviate of `start` as well.
    pub(super) fn mean_over(
        deviation: f64,
        exponent: f64,
        stream: &mut Stream,
        start: &mut Stream,
    ) -> Self {
        let a = exponent;
        let [now, before, both] = integrals(a);
        let correlation = both / (now + before);
        // At most 1/4, which a long correlation time reaches.
        let carry = 2.0 * correlation / (1.0 + (1.0 - 4.0 * correlation * correlation).sqrt());
        let power = 2.0 * a * (now + before) / (1.0 + carry * carry);
        let variance = if a < SHORT {
            1.0 - a / 3.0
        } else {
            2.0 * (a + (-a).exp_m1()) / (a * a)
        };
        let innovation = deviation * power.sqrt();
        let rest = deviation * (variance - power).max(0.0).sqrt();
        let last = innovation * start.normal();
        Self {
            value: rest * stream.normal() + last,
            decay: (-a).exp(),
            innovation,
            carry,
            last,
        }
    }

    /// Value over the present interval.
    #[inline]
    pub(super) fn value(&self) -> f64 {
        self.value
    }

    /// Whether there is anything to draw.
    pub(super) fn is_on(&self) -> bool {
        self.innovation > 0.0
    }

    /// Goes on to the next interval.
    #[inline]
    pub(super) fn redraw(&mut self, stream: &mut Stream) {
        let innovation = self.innovation * stream.normal();
        self.value = self.decay * self.value + innovation + self.carry * self.last;
        self.last = innovation;
    }
}

/// Integrals over v from 0 to 1 of `f^2`, `g^2` and `f g`.
fn integrals(a: f64) -> [f64; 3] {
    if a < SHORT {
        return [
            1.0 / 3.0 - a / 4.0,
            1.0 / 3.0 - 5.0 * a / 12.0,
            1.0 / 6.0 - a / 6.0,
        ];
    }
    let end = (-a).exp();
    let once = -(-a).exp_m1() / a;
    let twice = -(-2.0 * a).exp_m1() / (2.0 * a);
    [
        1.0 - 2.0 * once + twice,
        twice - 2.0 * end * once + end * end,
        once - twice - end + end * once,
    ]
    .map(|integral| integral / (a * a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Streams;

    #[test]
    fn the_recursion_has_the_covariance_of_the_mean() {
        for a in [1e-6_f64, 9.9e-4, 1.1e-3, 0.1, 1.0, 7.0, 300.0] {
            let mut stream = Streams::new(1, 0).stream("test");
            let mut start = Streams::new(2, 0).stream("test");
            let process = GaussMarkov::mean_over(1.0, a, &mut stream, &mut start);
            let GaussMarkov {
                decay,
                innovation,
                carry,
                ..
            } = process;
            // Variance and covariance of neighbours of an ARMA(1, 1) process.
            let power = innovation * innovation;
            let rise = (decay + carry).powi(2) / -(-2.0 * a).exp_m1();
            let variance = power * (1.0 + rise);
            let neighbours = power * (carry + decay * (1.0 + rise));
            let wanted = if a < 1e-2 {
                1.0 - a / 3.0 + a * a / 12.0
            } else {
                2.0 * (a - 1.0 + (-a).exp()) / (a * a)
            };
            assert!((variance / wanted - 1.0).abs() < 1e-6, "{a} {variance}");
            let wanted = (-(-a).exp_m1() / a).powi(2);
            assert!(
                (neighbours - wanted).abs() < 1e-6 * wanted,
                "{a} {neighbours}"
            );
        }
    }
}
