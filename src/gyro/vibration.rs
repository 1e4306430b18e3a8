//! Vibration of the gyro's case: what it puts on the loop, and the linear loop's answer.
//!
//! A vibration is a sum of tones, each of which is a rate about the input axis (true rotation of
//! the case and the rate error of the acceleration) and a change of the detected power. Complex
//! amplitudes stand for `Re(A e^(j w t))`, t from the start of the run.
//!
//! The case moves on the table: truth stays the rate of the table's axis, as an encoder has it, so
//! that a vibration in band is seen as noise and one beyond the output's Nyquist as an alias.

use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::Complex;

use crate::gyro::parts::Parts;
use crate::gyro::{RandomVibrationConfig, SineVibrationConfig, VibrationConfig, VibrationMotion};
use crate::random::{Stream, Streams};
use crate::units::{deg_per_h_to_rad_per_s, deg_per_s_to_rad_per_s, deg_to_rad};

/// Half periods whose tones are found from one sine and cosine each.
const BLOCK: usize = 64;
/// Fraction of the golden section: multiples of it spread evenly and never repeat.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// One tone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tone {
    pub(super) frequency_hz: f64,
    /// Relative change of the detected power.
    power: Complex<f64>,
    /// Rate on the input axis, rad/s.
    pub(super) rate_rad_per_s: Complex<f64>,
}

impl Tone {
    /// A tone of the acceleration (g) and of the rate (rad/s).
    fn new(
        config: &VibrationConfig,
        frequency_hz: f64,
        acceleration_g: Complex<f64>,
        rate_rad_per_s: Complex<f64>,
    ) -> Self {
        let error_per_g = deg_per_h_to_rad_per_s(config.rate_error_deg_per_h_per_g);
        Self {
            frequency_hz,
            power: acceleration_g * config.intensity_per_g,
            rate_rad_per_s: rate_rad_per_s + acceleration_g * error_per_g,
        }
    }

    /// Cycles in a time, whole ones left out, as a unit vector.
    fn turned(&self, time_s: f64) -> Complex<f64> {
        Complex::from_polar(1.0, TAU * (self.frequency_hz * time_s).fract())
    }
}

/// The tones of a vibration; empty when it is off.
///
/// A band of one-sided density S is cut into n equal parts with one tone of amplitude
/// `sqrt(2 S df)` and random phase each, the tones of incoherent rate and acceleration at different
/// frequencies so that no pair of them has a lasting product. A tone stands at a golden-section
/// point of its part, so that the sum has no period. The power is exact, the spectrum a comb: the
/// density shows only in bands wider than a few parts.
///
/// # Source
/// Shinozuka, Deodatis, Simulation of stochastic processes by spectral representation, Applied
/// Mechanics Reviews 44 (1991) 191.
pub(super) fn tones(config: &VibrationConfig, streams: &Streams) -> Vec<Tone> {
    match &config.motion {
        VibrationMotion::Off(_) => Vec::new(),
        VibrationMotion::Sine(sine) => vec![sine_tone(config, sine)],
        VibrationMotion::Random(random) => {
            random_tones(config, random, &mut streams.stream("vibration"))
        }
    }
}

fn sine_tone(config: &VibrationConfig, sine: &SineVibrationConfig) -> Tone {
    let rate = deg_per_s_to_rad_per_s(sine.rate_amplitude_deg_per_s);
    let lead = deg_to_rad(sine.rate_phase_deg);
    Tone::new(
        config,
        sine.frequency_hz,
        Complex::from_polar(sine.acceleration_g, -FRAC_PI_2),
        Complex::from_polar(rate, lead - FRAC_PI_2),
    )
}

fn random_tones(
    config: &VibrationConfig,
    random: &RandomVibrationConfig,
    stream: &mut Stream,
) -> Vec<Tone> {
    let part_hz = (random.to_hz - random.from_hz) / f64::from(random.tones);
    let acceleration = (2.0 * random.acceleration_psd_g2_per_hz * part_hz).sqrt();
    let rate = deg_per_s_to_rad_per_s((2.0 * random.rate_psd_deg2_per_s2_per_hz * part_hz).sqrt());
    let lead = Complex::from_polar(1.0, deg_to_rad(random.rate_phase_deg));
    let zero = Complex::new(0.0, 0.0);
    let mut tones = Vec::new();
    for part in 0..random.tones {
        let frequency_hz = |shift: f64| {
            let inside = (f64::from(part) * GOLDEN + shift).fract();
            random.from_hz + (f64::from(part) + inside) * part_hz
        };
        // The direction of two normals is a uniform angle.
        let mut phase = || Complex::from_polar(1.0, stream.normal().atan2(stream.normal()));
        let (first, second) = (phase(), phase());
        if random.coherent {
            let rate = first * lead * rate;
            tones.push(Tone::new(
                config,
                frequency_hz(0.25),
                first * acceleration,
                rate,
            ));
        } else {
            tones.push(Tone::new(
                config,
                frequency_hz(0.25),
                first * acceleration,
                zero,
            ));
            tones.push(Tone::new(config, frequency_hz(0.75), zero, second * rate));
        }
    }
    tones
}

/// Vibration as the loop meets it, half period after half period.
#[derive(Clone, Debug)]
pub(super) struct Vibration {
    tones: Vec<Tone>,
    /// Unit vector of each tone at each half period of a block.
    turns: Vec<[Complex<f64>; BLOCK]>,
    half_period_s: f64,
    /// Half periods since the start of the run.
    index: u64,
}

impl Vibration {
    /// The vibration of a configuration at half periods of `half_period_s`, `None` if it is off.
    pub(super) fn new(
        config: &VibrationConfig,
        half_period_s: f64,
        streams: &Streams,
    ) -> Option<Self> {
        let tones = tones(config, streams);
        let turn = |tone: &Tone| std::array::from_fn(|h| tone.turned(h as f64 * half_period_s));
        (!tones.is_empty()).then(|| Self {
            turns: tones.iter().map(turn).collect(),
            tones,
            half_period_s,
            index: 0,
        })
    }

    /// Adds the rate of the next half periods times `phase_per_rate` to `phases` and sets `powers`
    /// to the detected power over its mean, both at the start of each half period.
    pub(super) fn next_half_periods(
        &mut self,
        phase_per_rate: f64,
        phases: &mut [f64],
        powers: &mut [f64],
    ) {
        powers.fill(1.0);
        for (phases, powers) in phases.chunks_mut(BLOCK).zip(powers.chunks_mut(BLOCK)) {
            let start_s = self.index as f64 * self.half_period_s;
            for (tone, turns) in self.tones.iter().zip(&self.turns) {
                let start = tone.turned(start_s);
                let (rate, power) = (
                    tone.rate_rad_per_s * start * phase_per_rate,
                    tone.power * start,
                );
                for ((phase, change), turn) in phases.iter_mut().zip(powers.iter_mut()).zip(turns) {
                    *phase += rate.re * turn.re - rate.im * turn.im;
                    *change += power.re * turn.re - power.im * turn.im;
                }
            }
            self.index += phases.len() as u64;
        }
    }
}

/// The linear loop's answer to a vibration, to second order.
///
/// With `zeta = e^(j w tau)`, tau the half period (of a mismatched gyro too, if its spikes are
/// gated), Q the power and P the Sagnac phase of a tone, a pair demodulates
///
/// ```text
/// e = (x0 + x1)/2 + B (q1 - q0) + (q0 x0 + q1 x1)/2 - cot(phi_m) (x1^2 - x0^2)/4
/// x0 = p0 - r,  x1 = p1 - r,  B = (1 + V cos phi_m) / (2 V sin phi_m)
/// ```
///
/// where q0, q1 are the relative changes of power in the two halves: the level of the bias point,
/// B, cancels only as long as the power stands still. To first order the loop is driven by
/// `F = P (1 + zeta)/2 + B Q (zeta - 1)` and answers `H F`. The integrator holds the mean of e at
/// zero, which leaves in the mean of the register, by the second-order terms,
///
/// ```text
/// b = Re{Q* P (1 - H cos^2(w tau/2))}/2 + B |Q|^2 sin(w tau) Im{H}/2
///   + cot(phi_m)/4 (|P|^2 sin(w tau) Im{H} + 4 B sin^2(w tau/2) Re{P* Q H})
/// ```
///
/// Left out are third-order terms and the second-order beats, at sums and differences of the
/// tones' frequencies.
///
/// # Source
/// Derived from the loop model's equations.
#[derive(Clone, Debug)]
pub(super) struct VibrationResponse {
    /// Tones and the complex amplitude of the mean register of a word, rad, at the word's start.
    tones: Vec<(Tone, Complex<f64>)>,
    mean_rad: f64,
    sample_period_s: f64,
    /// Words since the start of the run.
    index: u64,
}

impl VibrationResponse {
    /// The settled answer of a gyro to `tones`, `None` if there are none.
    pub(super) fn new(tones: Vec<Tone>, parts: &Parts) -> Option<Self> {
        let (coil, detector) = (&parts.coil, &parts.detector);
        let periods = 0.5 * f64::from(parts.half_periods);
        if tones.is_empty() {
            return None;
        }
        let (sine, cosine) = parts.modulator.depth_rad.sin_cos();
        let level = (1.0 + detector.visibility * cosine) / (2.0 * detector.visibility * sine);
        let cotangent = cosine / sine;
        let mut mean_rad = 0.0;
        let mut answers = Vec::with_capacity(tones.len());
        for tone in tones {
            let half_angle = 0.5 * TAU * tone.frequency_hz * parts.half_period_s;
            let zeta = Complex::from_polar(1.0, 2.0 * half_angle);
            let (re, im) = parts.controller.response(tone.frequency_hz);
            let response = Complex::new(re, im);
            let phase = tone.rate_rad_per_s * coil.scale_factor_s;
            let (chord, turn) = (half_angle.sin().powi(2), (2.0 * half_angle).sin());
            let residual = 1.0 - response * half_angle.cos().powi(2);
            mean_rad += 0.5 * (tone.power.conj() * phase * residual).re
                + 0.5 * level * tone.power.norm_sqr() * turn * response.im
                + 0.25
                    * cotangent
                    * (phase.norm_sqr() * turn * response.im
                        + 4.0 * level * chord * (phase.conj() * tone.power * response).re);
            let drive = phase * (1.0 + zeta) * 0.5 + tone.power * (zeta - 1.0) * level;
            // Mean of z^1 .. z^n, z = zeta^2: the register is read after each update.
            let angle = 2.0 * half_angle;
            // A cycle beyond the least number there is does not turn at all.
            let ratio = if angle.sin().abs() > 0.0 {
                (periods * angle).sin() / (periods * angle.sin())
            } else {
                1.0
            };
            let boxcar = Complex::from_polar(ratio, (periods + 1.0) * angle);
            answers.push((tone, response * drive * boxcar));
        }
        Some(Self {
            tones: answers,
            mean_rad,
            sample_period_s: periods * parts.controller.loop_period_s,
            index: 0,
        })
    }

    /// Mean of the register beyond the motion, rad.
    pub(super) fn mean_rad(&self) -> f64 {
        self.mean_rad
    }

    /// Mean register of the next word beyond the motion, rad.
    pub(super) fn next_rad(&mut self) -> f64 {
        let start_s = self.index as f64 * self.sample_period_s;
        self.index += 1;
        let tones = self.tones.iter();
        let swing: f64 = tones
            .map(|(tone, word)| (word * tone.turned(start_s)).re)
            .sum();
        self.mean_rad + swing
    }
}
