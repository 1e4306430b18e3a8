//! A swing whose frequency sweeps.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;

use crate::declare::table;
use crate::turntable::motion::checks::MotionChecks;
use crate::turntable::motion::course::{Course, Instant};
use crate::turntable::motion::kind::{CommandExtremes, Motion, MotionClass, Surroundings};
use crate::turntable::motion::samples::first_measured_index;
use crate::turntable::motion::soft_start::SoftStart;
use crate::units::{deg_per_s_to_rad_per_s, deg_to_rad};
use crate::vocabulary::words;

table! {
    /// A swing whose frequency sweeps: at the first frequency through the warm-up, from the start of the
    /// record to the last one in sweep_s, then the soft stop and rest.
    pub struct ChirpConfig,
    one "amplitude" of rate_amplitude_deg_per_s | angle_amplitude_deg
    {
        /// Rate amplitude; give this or angle_amplitude_deg.
        rate_amplitude_deg_per_s: Option<f64>, example 1.0, in 1e-9..=2000.0, "deg/s";
        /// Angle amplitude; the rate amplitude is 2 pi f times this at every frequency.
        angle_amplitude_deg: Option<f64>, example 0.01, in 1e-9..=360.0, "deg";
        /// Frequency through the warm-up and at the start of the sweep.
        start_frequency_hz: f64, example 1.0, in 1e-6..=1000.0, "Hz";
        /// Frequency at the end of the sweep; a cycle must span at least 4 output samples.
        end_frequency_hz: f64, example 50.0, in 1e-6..=1000.0, "Hz";
        /// Length of the sweep; it must fit into the duration.
        sweep_s: f64, example 20.0, in 1e-6..=1e7, "s";
        /// Frequency moves by as many hertz, or by the same factor, in every second. Source of the default:
        /// customary, as many cycles in every octave.
        progression: Progression = "logarithmic";
        /// Raised-cosine start of the motion, inside the warm-up. Source of the default: assumed.
        soft_start_s: f64 = 1.0, in 0.0..=1.0, "s";
        /// Raised-cosine end of the motion, after the sweep. Source of the default: assumed.
        soft_stop_s: f64 = 1.0, in 0.0..=1e6, "s";
    }
}

words! {
    /// How the frequency of a sweep moves.
    pub enum Progression {
        /// By as many hertz in every second.
        Linear = "linear",
        /// By the same factor in every second.
        Logarithmic = "logarithmic",
    }
}

impl Motion for ChirpConfig {
    fn class(&self) -> MotionClass<'_> {
        MotionClass::General
    }

    fn frequency_max_hz(&self) -> f64 {
        frequency_max(self)
    }

    fn rate_max_rad_per_s(&self) -> f64 {
        match amplitude(self) {
            Amplitude::Rate(rate) => rate,
            Amplitude::Angle(angle) => TAU * frequency_max(self) * angle,
        }
    }

    fn extremes(&self, _: Surroundings) -> CommandExtremes {
        let rate = self.rate_max_rad_per_s();
        let shortest_s = self.soft_start_s.min(self.soft_stop_s);
        let is_soft = shortest_s > 0.0;
        // The steepest envelope and the fastest sine need not meet: their sum is a bound.
        let envelope = if is_soft { FRAC_PI_2 / shortest_s } else { 0.0 };
        let turning = TAU * frequency_max(self);
        CommandExtremes {
            jump_rad_per_s: if is_soft { 0.0 } else { rate },
            acceleration_rad_per_s2: rate * (turning + envelope) + widening_max(self),
        }
    }

    /// Refuses frequencies that the output cannot follow and a sweep that outlasts the record.
    fn check(&self, checks: &mut MotionChecks) {
        checks.soft_start("turntable.chirp.soft_start_s", self.soft_start_s);
        checks.ramp("turntable.chirp.soft_stop_s", self.soft_stop_s);
        checks.frequency(
            "turntable.chirp.start_frequency_hz",
            self.start_frequency_hz,
        );
        checks.frequency("turntable.chirp.end_frequency_hz", self.end_frequency_hz);
        checks.fits("turntable.chirp.sweep_s", self.sweep_s);
    }

    fn is_idle(&self, key: &str, duration_s: f64) -> bool {
        match key {
            "turntable.chirp.progression" => {
                (self.end_frequency_hz - self.start_frequency_hz).abs() <= 0.0
            }
            "turntable.chirp.soft_stop_s" => self.sweep_s >= duration_s,
            _ => false,
        }
    }

    fn course(&self, warm_up_s: f64, sample_period_s: f64) -> Arc<dyn Course> {
        Arc::new(Chirp::new(self, warm_up_s, sample_period_s))
    }
}

/// Swing at the first frequency, sweep from the start of the record, end at the last frequency.
///
/// With `t` from the start of the record, `D` the length of the sweep, `f0` and `f1` its ends, the
/// phase in cycles is `f0 t` before the sweep and in it `f0 t + (f1 - f0) t^2 / 2D` (linear) or
/// `f0 (e^(L t) - 1) / L` with `L = ln(f1 / f0) / D` (logarithmic): closed forms, so that no phase
/// error builds up. The rate is `A sin(phase)`; where the angle amplitude is given `A = 2 pi f(t)
/// theta`, which makes the angle `theta (1 - cos(phase))` exactly.
#[derive(Clone, Debug)]
struct Chirp {
    amplitude: Amplitude,
    start_hz: f64,
    end_hz: f64,
    sweep_s: f64,
    progression: Progression,
    soft_start: SoftStart,
    /// Soft stop, read backwards.
    soft_stop: SoftStart,
    /// Where the record begins, samples.
    first: f64,
    sample_period_s: f64,
}

/// How far a chirp swings.
#[derive(Clone, Copy, Debug)]
enum Amplitude {
    /// rad/s.
    Rate(f64),
    /// rad.
    Angle(f64),
}

/// Phase and frequency at one time.
struct Phase {
    cycles: f64,
    /// Hz.
    frequency: f64,
    /// Hz/s.
    slope: f64,
}

impl Chirp {
    fn new(config: &ChirpConfig, warm_up_s: f64, sample_period_s: f64) -> Self {
        Self {
            amplitude: amplitude(config),
            start_hz: config.start_frequency_hz,
            end_hz: config.end_frequency_hz,
            sweep_s: config.sweep_s,
            progression: config.progression,
            soft_start: SoftStart::new(config.soft_start_s, warm_up_s, sample_period_s),
            soft_stop: SoftStart::of(config.soft_stop_s, sample_period_s),
            first: first_measured_index(warm_up_s, sample_period_s) as f64,
            sample_period_s,
        }
    }

    /// Share of the amplitude at `instant` samples from the start, and its slope per sample.
    fn envelope(&self, instant: f64) -> (f64, f64) {
        let after_sweep = instant - self.first - self.sweep_s / self.sample_period_s;
        if after_sweep >= 0.0 {
            let (gone, slope) = self.soft_stop.at(after_sweep);
            (1.0 - gone, -slope)
        } else {
            self.soft_start.at(instant)
        }
    }

    /// Phase `time_s` after the start of the record.
    fn phase(&self, time_s: f64) -> Phase {
        if time_s < 0.0 {
            return Phase {
                cycles: self.start_hz * time_s,
                frequency: self.start_hz,
                slope: 0.0,
            };
        }
        let within_s = time_s.min(self.sweep_s);
        let mut phase = self.swept(within_s);
        if time_s > self.sweep_s {
            phase.cycles += self.end_hz * (time_s - self.sweep_s);
            phase.slope = 0.0;
        }
        phase
    }

    /// Phase inside the sweep.
    fn swept(&self, time_s: f64) -> Phase {
        let growth = (self.end_hz / self.start_hz).ln() / self.sweep_s;
        match self.progression {
            // A logarithmic sweep between equal ends is a linear one.
            Progression::Logarithmic if growth.abs() > 0.0 => {
                let risen = (growth * time_s).exp_m1();
                let frequency = self.start_hz * (1.0 + risen);
                Phase {
                    cycles: self.start_hz * risen / growth,
                    frequency,
                    slope: growth * frequency,
                }
            }
            Progression::Linear | Progression::Logarithmic => {
                let slope = (self.end_hz - self.start_hz) / self.sweep_s;
                Phase {
                    cycles: (self.start_hz + 0.5 * slope * time_s) * time_s,
                    frequency: self.start_hz + slope * time_s,
                    slope,
                }
            }
        }
    }
}

impl Course for Chirp {
    fn at(&self, instant: f64) -> Instant {
        let since = instant - self.first;
        let phase = self.phase(since * self.sample_period_s);
        let (envelope, envelope_slope) = self.envelope(instant);
        let (amplitude, amplitude_slope) = match self.amplitude {
            Amplitude::Rate(rate) => (rate, 0.0),
            Amplitude::Angle(angle) => (
                TAU * phase.frequency * angle,
                TAU * phase.slope * angle * self.sample_period_s,
            ),
        };
        // Whole cycles are dropped before the sine, which keeps full precision for hours.
        let (sine, cosine) = (TAU * phase.cycles.fract()).sin_cos();
        let turning = TAU * phase.frequency * self.sample_period_s;
        Instant {
            rate: amplitude * envelope * sine,
            slope: amplitude * (envelope * turning * cosine + envelope_slope * sine)
                + amplitude_slope * envelope * sine,
        }
    }
}

/// The amplitude that is given.
fn amplitude(config: &ChirpConfig) -> Amplitude {
    match (config.rate_amplitude_deg_per_s, config.angle_amplitude_deg) {
        (Some(rate), None) => Amplitude::Rate(deg_per_s_to_rad_per_s(rate)),
        (None, Some(angle)) => Amplitude::Angle(deg_to_rad(angle)),
        (rate, angle) => panic!("a chirp has one amplitude, not rate {rate:?} and angle {angle:?}"),
    }
}

/// Highest frequency of a chirp, Hz.
fn frequency_max(config: &ChirpConfig) -> f64 {
    config.start_frequency_hz.max(config.end_frequency_hz)
}

/// Bound on how fast the rate amplitude of a chirp grows, rad/s^2: `2 pi theta |f'|`, where the
/// frequency moves fastest at its upper end, by at most `f_max / f_min` times its mean.
fn widening_max(config: &ChirpConfig) -> f64 {
    match amplitude(config) {
        Amplitude::Rate(_) => 0.0,
        Amplitude::Angle(angle) => {
            let (start, end) = (config.start_frequency_hz, config.end_frequency_hz);
            let mean_slope = (end - start).abs() / config.sweep_s;
            TAU * angle * mean_slope * (start.max(end) / start.min(end))
        }
    }
}
