//! The commanded rate as a function of the sample count.

use std::f64::consts::TAU;

use super::campaign::Campaign;
use super::chirp::Chirp;
use super::kind::swing_rate_amplitude_rad_per_s;
use super::multi_sine::{Tone, sum_at, tones};
use super::samples::{first_measured_index, step_indices};
use super::script::Script;
use super::soft_start::SoftStart;
use super::trapezoid::Trapezoids;
use crate::scenario::{MotionConfig, Stairs};
use crate::units::deg_per_s_to_rad_per_s;

/// Commanded rate at one instant and its slope per sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instant {
    /// rad/s.
    pub(super) rate: f64,
    /// rad/s per sample.
    pub(super) slope: f64,
}

impl Instant {
    /// Standing still.
    pub(super) const REST: Self = Self {
        rate: 0.0,
        slope: 0.0,
    };
}

/// Shape of a command.
#[derive(Clone, Debug)]
pub(super) enum Shape {
    /// `rate`, ramped.
    Rotation { rate: f64, soft_start: SoftStart },
    /// `amplitude sin(2 pi f t)`, ramped, t counted from `first` samples on.
    Swing {
        amplitude: f64,
        cycles_per_sample: f64,
        soft_start: SoftStart,
        first: f64,
    },
    /// A sum of sines, ramped.
    MultiSine {
        tones: Vec<Tone>,
        soft_start: SoftStart,
    },
    /// Rates, rad/s, and the index of the first sample of each but the first.
    Steps { rates: Vec<f64>, changes: Vec<u64> },
    /// Trapezoids in a row.
    Trapezoids(Trapezoids),
    /// A swing whose frequency sweeps.
    Chirp(Chirp),
    /// Tabulated rates or angles.
    Script(Script),
    /// Groups of constant rate.
    Campaign(Campaign),
}

impl Shape {
    /// The shape of a configured motion; see [`Turntable::new`](crate::turntable::Turntable::new).
    pub(super) fn new(motion: &MotionConfig, warm_up_s: f64, sample_period_s: f64) -> Self {
        let soft_start = |length_s| SoftStart::new(length_s, warm_up_s, sample_period_s);
        match motion {
            MotionConfig::Static(_) => Self::Rotation {
                rate: 0.0,
                soft_start: soft_start(0.0),
            },
            MotionConfig::Rotation(rotation) => Self::Rotation {
                rate: deg_per_s_to_rad_per_s(rotation.rate_deg_per_s),
                soft_start: soft_start(rotation.soft_start_s),
            },
            MotionConfig::Swing(swing) => Self::Swing {
                amplitude: swing_rate_amplitude_rad_per_s(swing),
                cycles_per_sample: swing.frequency_hz * sample_period_s,
                soft_start: soft_start(swing.soft_start_s),
                first: if swing.from_rest {
                    first_measured_index(warm_up_s, sample_period_s) as f64
                } else {
                    0.0
                },
            },
            MotionConfig::MultiSine(multi_sine) => Self::MultiSine {
                tones: tones(multi_sine, sample_period_s),
                soft_start: soft_start(multi_sine.soft_start_s),
            },
            MotionConfig::Trapezoid(config) => {
                Self::Trapezoids(Trapezoids::new(config, warm_up_s, sample_period_s))
            }
            MotionConfig::Chirp(config) => {
                Self::Chirp(Chirp::new(config, warm_up_s, sample_period_s))
            }
            MotionConfig::Script(config) => {
                Self::Script(Script::new(&config.points, warm_up_s, sample_period_s))
            }
            MotionConfig::Calibration(config) => {
                Self::Campaign(Campaign::new(config, warm_up_s, sample_period_s))
            }
            MotionConfig::Steps(steps) => Self::stairs(&steps.into(), warm_up_s, sample_period_s),
            MotionConfig::ScaleFactorTest(test) => {
                Self::stairs(&test.into(), warm_up_s, sample_period_s)
            }
        }
    }

    fn stairs(stairs: &Stairs, warm_up_s: f64, sample_period_s: f64) -> Self {
        let rates = stairs.rates_deg_per_s.iter();
        assert!(!stairs.rates_deg_per_s.is_empty(), "a staircase has a rate");
        Self::Steps {
            rates: rates.copied().map(deg_per_s_to_rad_per_s).collect(),
            changes: step_indices(stairs, warm_up_s, sample_period_s),
        }
    }

    /// Command at `instant` samples from the start; staircases have no such single value.
    pub(super) fn at(&self, instant: f64) -> Instant {
        match self {
            Self::Rotation { rate, soft_start } => {
                let (ramp, ramp_slope) = soft_start.at(instant);
                Instant {
                    rate: rate * ramp,
                    slope: rate * ramp_slope,
                }
            }
            Self::Swing {
                amplitude,
                cycles_per_sample,
                soft_start,
                first,
            } => {
                let instant = instant - first;
                if instant < 0.0 {
                    return Instant::REST;
                }
                // Whole cycles are dropped before the sine, which keeps full precision for hours.
                let (sine, cosine) = (TAU * (cycles_per_sample * instant).fract()).sin_cos();
                let (ramp, ramp_slope) = soft_start.at(instant);
                Instant {
                    rate: amplitude * ramp * sine,
                    slope: amplitude
                        * (ramp * TAU * cycles_per_sample * cosine + ramp_slope * sine),
                }
            }
            Self::MultiSine { tones, soft_start } => {
                let (rate, slope) = sum_at(tones, instant);
                let (ramp, ramp_slope) = soft_start.at(instant);
                Instant {
                    rate: ramp * rate,
                    slope: ramp * slope + ramp_slope * rate,
                }
            }
            Self::Trapezoids(trapezoids) => trapezoids.at(instant),
            Self::Chirp(chirp) => chirp.at(instant),
            Self::Script(script) => script.at(instant),
            Self::Campaign(campaign) => campaign.at(instant),
            Self::Steps { rates, .. } => Instant {
                rate: rates[0],
                slope: 0.0,
            },
        }
    }
}
