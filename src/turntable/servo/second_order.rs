//! The reduced model of a table: a second-order low pass of the commanded rate.

use std::f64::consts::TAU;

use crate::signal::MotionSegment;
use crate::turntable::SecondOrderServoConfig;

/// `H(s) = wn^2 / (s^2 + 2 zeta wn s + wn^2)`, advanced exactly over cubic commands.
///
/// In time `u` counted in samples the table obeys `y + a y' + b y'' = c(u)` with
/// `a = 2 zeta / (wn T)`, `b = 1 / (wn T)^2`. For a cubic `c` the forced part is a cubic as well;
/// the rest is a free decay from the initial conditions that the forced part leaves over. Both are
/// closed forms, so that neither step size nor order of an integrator enters the truth.
///
/// # Source
/// Derived; the reduced model of a rate-table servo. Known answer:
/// `known_answer_k29_the_servo_lags_its_command_by_its_transfer_function`.
#[derive(Clone, Debug)]
pub(in crate::turntable) struct SecondOrder {
    decay: FreeDecay,
    /// `2 zeta / (wn T)`.
    a: f64,
    /// `1 / (wn T)^2`.
    b: f64,
    /// Actual rate, rad/s.
    rate: f64,
    /// Actual slope, rad/s per sample.
    slope: f64,
}

impl SecondOrder {
    pub(super) fn new(
        config: &SecondOrderServoConfig,
        initial_rate: f64,
        sample_period_s: f64,
    ) -> Self {
        let angle = TAU * config.natural_frequency_hz * sample_period_s;
        Self {
            decay: FreeDecay::new(angle, config.damping_ratio),
            a: 2.0 * config.damping_ratio / angle,
            b: 1.0 / (angle * angle),
            rate: initial_rate,
            slope: 0.0,
        }
    }

    pub(super) fn follow(&mut self, command: MotionSegment) -> MotionSegment {
        let [c0, c1, c2, c3] = command.rate_rad_per_s;
        // Coefficients of the forced cubic, highest power first.
        let p3 = c3;
        let p2 = c2 - 3.0 * self.a * p3;
        let p1 = c1 - 2.0 * self.a * p2 - 6.0 * self.b * p3;
        let p0 = c0 - self.a * p1 - 2.0 * self.b * p2;
        let (free_rate, free_slope) = self.decay.advance(self.rate - p0, self.slope - p1);
        let rate = p0 + p1 + p2 + p3 + free_rate;
        let slope = p1 + 2.0 * p2 + 3.0 * p3 + free_slope;
        let motion = MotionSegment::hermite(self.rate, self.slope, rate, slope);
        self.rate = rate;
        self.slope = slope;
        motion
    }
}

/// Free response over one sample: `[y, y'] -> matrix [y, y']`.
#[derive(Clone, Debug)]
struct FreeDecay {
    matrix: [[f64; 2]; 2],
}

impl FreeDecay {
    /// `angle` is `wn T`; every damping ratio above 0 is served, 1 included.
    ///
    /// With `alpha = zeta wn T` and `beta^2 = (wn T)^2 - alpha^2`:
    /// `y(1) = e^-alpha (y C + (y' + alpha y) S)`,
    /// `y'(1) = e^-alpha (y' C - ((wn T)^2 y + alpha y') S)`, where `C = cos beta` and
    /// `S = sin(beta) / beta` (hyperbolic for `beta^2 < 0`).
    fn new(angle: f64, damping_ratio: f64) -> Self {
        /// Below this `|beta^2|` three terms of the series of `S` are exact to rounding.
        const SERIES_LIMIT: f64 = 1e-4;
        let alpha = damping_ratio * angle;
        let beta_squared = angle * angle - alpha * alpha;
        let beta = beta_squared.abs().sqrt();
        let (cosine, sine) = if beta_squared < 0.0 {
            (beta.cosh(), beta.sinh())
        } else {
            (beta.cos(), beta.sin())
        };
        let sinc = if beta_squared.abs() < SERIES_LIMIT {
            1.0 - beta_squared / 6.0 * (1.0 - beta_squared / 20.0)
        } else {
            sine / beta
        };
        let decay = (-alpha).exp();
        Self {
            matrix: [
                [decay * (cosine + alpha * sinc), decay * sinc],
                [
                    -decay * angle * angle * sinc,
                    decay * (cosine - alpha * sinc),
                ],
            ],
        }
    }

    fn advance(&self, rate: f64, slope: f64) -> (f64, f64) {
        let [[m00, m01], [m10, m11]] = self.matrix;
        (m00 * rate + m01 * slope, m10 * rate + m11 * slope)
    }
}
