//! The five classical noise terms of a rate as plain numbers.

use super::least_squares::basis;
use super::overlapping::{AllanPoint, NoiseType, degrees_of_freedom};

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
