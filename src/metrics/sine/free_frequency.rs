//! Sine fit of unknown frequency.

use std::f64::consts::TAU;

use nalgebra::{Matrix4, Vector4};

use super::fit::{SwingClock, fit_sine};

/// Newton steps after which a fit that still moves is given up.
const STEPS_MAX: usize = 30;

/// Change of the phase at the ends of the record below which the fit stands, rad.
const TOLERANCE_RAD: f64 = 1e-12;

/// Samples over which sine and cosine are turned on from the last ones, before they are computed afresh.
const TURNS: usize = 64;

/// `offset + amplitude cos(2 pi f (t - centre) + phase)`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FreeSineFit {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Amplitude, in the unit of the samples.
    pub amplitude: f64,
    /// Phase at the centre of the record, rad, in (-pi, pi].
    pub phase_rad: f64,
    /// Offset, in the unit of the samples.
    pub offset: f64,
    /// Stamp of the centre of the record, s.
    pub centre_s: f64,
}

impl FreeSineFit {
    /// Phase at a time, rad, not reduced.
    ///
    /// At the centre it is as certain as with the frequency known; the error of the frequency adds
    /// with the distance, and makes the standard deviation at either end twice as large.
    #[must_use]
    pub fn phase_at_rad(&self, time_s: f64) -> f64 {
        self.phase_rad + TAU * self.frequency_hz * (time_s - self.centre_s)
    }
}

/// Least-squares sine of unknown frequency, from `clock.frequency_hz` as first guess.
///
/// Newton steps on the four columns `cos wt, sin wt, 1, t (b cos wt - a sin wt)`, t counted from the
/// centre of the record, where phase and frequency do not mix. The guess must be right to about half
/// a cycle over the record. `None` if the steps do not converge.
///
/// # Source
/// IEEE Std 1057, four-parameter fit; Cramer-Rao bounds: Kay, Fundamentals of Statistical Signal
/// Processing, vol. I, example 3.14. Known answer K23.
#[must_use]
pub fn fit_sine_free_frequency(values: &[f64], clock: &SwingClock) -> Option<FreeSineFit> {
    fit_sine_to(values, clock, TOLERANCE_RAD)
}

/// The same up to a change of the phase at the ends of the record, rad: a sine that hardly stands out of
/// its noise takes many steps to the last digit.
pub(crate) fn fit_sine_to(
    values: &[f64],
    clock: &SwingClock,
    tolerance_rad: f64,
) -> Option<FreeSineFit> {
    let middle = (values.len() as f64 - 1.0) / 2.0;
    let half_s = middle * clock.sample_period_s;
    let centred = SwingClock {
        first_stamp_s: -half_s,
        ..*clock
    };
    let start = fit_sine(values, &centred)?;
    let mut angular = TAU * clock.frequency_hz;
    let (sine, cosine) = start.phase_rad.sin_cos();
    let (mut a, mut b) = (start.amplitude * cosine, -start.amplitude * sine);
    for _ in 0..STEPS_MAX {
        let (normal, right) = normal_equations(values, angular * half_s, (a, b));
        let solved = normal.cholesky()?.solve(&right);
        (a, b) = (solved[0], solved[1]);
        let step_rad = solved[3];
        angular += step_rad / half_s;
        if !step_rad.is_finite() || angular <= 0.0 {
            return None;
        }
        if step_rad.abs() < tolerance_rad.max(f64::EPSILON * angular * half_s) {
            return Some(FreeSineFit {
                frequency_hz: angular / TAU,
                amplitude: a.hypot(b),
                phase_rad: (-b).atan2(a),
                offset: solved[2],
                centre_s: clock.first_stamp_s + half_s,
            });
        }
    }
    None
}

/// Normal equations of a Newton step: `half_rad` is the phase from the centre of the record to its ends,
/// `a cos + b sin` the sine so far.
fn normal_equations(
    values: &[f64],
    half_rad: f64,
    (a, b): (f64, f64),
) -> (Matrix4<f64>, Vector4<f64>) {
    let middle = (values.len() as f64 - 1.0) / 2.0;
    let (step_sine, step_cosine) = (half_rad / middle).sin_cos();
    let (mut normal, mut right) = (Matrix4::zeros(), Vector4::zeros());
    for (chunk, part) in values.chunks(TURNS).enumerate() {
        let first = (chunk * TURNS) as f64 - middle;
        let (mut s, mut c) = (half_rad * (first / middle)).sin_cos();
        for (index, value) in part.iter().enumerate() {
            // From -1 to 1 over the record, so that the columns have one scale.
            let from_centre = (first + index as f64) / middle;
            let column = Vector4::new(c, s, 1.0, from_centre * (b * c - a * s));
            normal += column * column.transpose();
            right += column * *value;
            (s, c) = (
                s * step_cosine + c * step_sine,
                c * step_cosine - s * step_sine,
            );
        }
    }
    (normal, right)
}
