//! One sine of rate.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::declare::table;
use crate::turntable::motion::checks::MotionChecks;
use crate::turntable::motion::course::{Course, Instant};
use crate::turntable::motion::kind::{CommandExtremes, Motion, MotionClass, Surroundings};
use crate::turntable::motion::samples::first_measured_index;
use crate::turntable::motion::soft_start::SoftStart;
use crate::units::{deg_per_s_to_rad_per_s, deg_to_rad};

table! {
    /// Swing about the table axis: a sine of rate.
    pub struct SwingConfig,
    one "amplitude" of rate_amplitude_deg_per_s | angle_amplitude_deg
    {
        /// Rate amplitude; give this or angle_amplitude_deg.
        rate_amplitude_deg_per_s: Option<f64>, example 1.0, in 1e-9..=2000.0, "deg/s";
        /// Angle amplitude; the rate amplitude is 2 pi f times this.
        angle_amplitude_deg: Option<f64>, example 1.0, in 1e-9..=360.0, "deg";
        /// Swing frequency; a cycle must span at least 4 output samples.
        frequency_hz: f64, example 5.0, in 1e-6..=1000.0, "Hz";
        /// Raised-cosine start of the motion, inside the warm-up. Source of the default: assumed.
        soft_start_s: f64 = 1.0, in 0.0..=1.0, "s";
        /// The table rests through the warm-up and swings from the start of the record, at once: how long do
        /// filters that learned at rest take? soft_start_s must then be 0.
        from_rest: bool = false;
    }
}

impl SwingConfig {
    /// Rate amplitude, rad/s; `A = 2 pi f theta` where the angle amplitude is given.
    ///
    /// A swing of 1 deg/s at 5 Hz has an angle amplitude of only 114.6 arcsec.
    ///
    /// # Panics
    /// If neither or both amplitudes are set; the scenario reader refuses such a swing.
    #[must_use]
    pub fn rate_amplitude_rad_per_s(&self) -> f64 {
        match (self.rate_amplitude_deg_per_s, self.angle_amplitude_deg) {
            (Some(rate), None) => deg_per_s_to_rad_per_s(rate),
            (None, Some(angle)) => TAU * self.frequency_hz * deg_to_rad(angle),
            (rate, angle) => {
                panic!("a swing has one amplitude, not rate {rate:?} and angle {angle:?}")
            }
        }
    }
}

impl Motion for SwingConfig {
    fn class(&self) -> MotionClass<'_> {
        MotionClass::Swing {
            frequency_hz: self.frequency_hz,
            is_from_rest: self.from_rest,
        }
    }

    fn rate_max_rad_per_s(&self) -> f64 {
        self.rate_amplitude_rad_per_s().abs()
    }

    fn frequency_max_hz(&self) -> f64 {
        self.frequency_hz
    }

    fn extremes(&self, _: Surroundings) -> CommandExtremes {
        CommandExtremes {
            jump_rad_per_s: 0.0,
            acceleration_rad_per_s2: TAU * self.frequency_hz * self.rate_max_rad_per_s(),
        }
    }

    /// Refuses a soft start inside the record and a frequency that the output cannot follow.
    fn check(&self, checks: &mut MotionChecks) {
        checks.soft_start("turntable.swing.soft_start_s", self.soft_start_s);
        checks.frequency("turntable.swing.frequency_hz", self.frequency_hz);
        if self.from_rest && self.soft_start_s > 0.0 {
            let message = format!(
                "turntable.swing.from_rest = true swings from the start of the record, at once: give \
                 turntable.swing.soft_start_s = 0.0 s (is {:?} s)",
                self.soft_start_s
            );
            checks.complain("turntable.swing.from_rest", message);
        }
    }

    fn course(&self, warm_up_s: f64, sample_period_s: f64) -> Arc<dyn Course> {
        Arc::new(Swing {
            amplitude: self.rate_amplitude_rad_per_s(),
            cycles_per_sample: self.frequency_hz * sample_period_s,
            soft_start: SoftStart::new(self.soft_start_s, warm_up_s, sample_period_s),
            first: if self.from_rest {
                first_measured_index(warm_up_s, sample_period_s) as f64
            } else {
                0.0
            },
        })
    }
}

/// Command `amplitude sin(2 pi f t)`, ramped, t counted from `first` samples on.
#[derive(Clone, Copy, Debug)]
struct Swing {
    /// rad/s.
    amplitude: f64,
    cycles_per_sample: f64,
    soft_start: SoftStart,
    first: f64,
}

impl Course for Swing {
    fn at(&self, instant: f64) -> Instant {
        let instant = instant - self.first;
        if instant < 0.0 {
            return Instant::REST;
        }
        // Whole cycles are dropped before the sine, which keeps full precision for hours.
        let (sine, cosine) = (TAU * (self.cycles_per_sample * instant).fract()).sin_cos();
        let (ramp, ramp_slope) = self.soft_start.at(instant);
        Instant {
            rate: self.amplitude * ramp * sine,
            slope: self.amplitude
                * (ramp * TAU * self.cycles_per_sample * cosine + ramp_slope * sine),
        }
    }
}
