//! Closed-loop fibre-optic gyro, from the optics to the rate word.
//!
//! Invariant: the optical feedback loop closes inside this folder and nowhere else.
//!
//! ```text
//! motion segment -> Sagnac phase (coil) --(+)--> raised cosine (detector, source, modulator)
//!                                          |-       |  + noise, converter
//!        2 pi ramp, converter (modulator) -+        v
//!                 ^------------ integrator <- demodulation (controller)
//!                                   |
//!                                   v  mean over an output sample, rounding (rate word)
//! ```
//!
//! Two models share every part above: [`LoopModel`] runs each half modulation period;
//! [`RateModel`] advances the same loop, linearised, by one output sample at a time with the same
//! mean, bandwidth, delay and noise colour. [`Gyro`] is either of them; [`cautions`] says where
//! their assumptions end.
//!
//! Vibration of the case reaches the loop as phases and as powers per half period, through a
//! kernel of its own.
//!
//! Symbols: `tau` = transit time of the coil = half modulation period, `T_L = 2 tau` = loop
//! period, `Ks` = Sagnac scale factor, `g` = integrator gain, `d` = pipeline latency in loop
//! periods, `r` = step of the ramp per `tau` (the register), `phi_m` = modulation depth.

mod coil;
mod controller;
mod detector;
mod error;
mod instrument;
mod limits;
mod loop_kernel;
mod loop_model;
mod modulator;
mod noise_budget;
mod parts;
mod rate_matrices;
mod rate_model;
mod rate_word;
mod sampler;
mod slow_noise;
mod source;
mod vibration;

pub use coil::Coil;
pub use controller::{Controller, gain_limit};
pub use detector::{CurrentNoise, Detector};
pub use error::GyroError;
pub use instrument::{Gyro, facts, sample_period_s};
pub use limits::{MotionExtremes, cautions};
pub use loop_model::LoopModel;
pub use modulator::{Modulator, optimum_depth_rad};
pub use noise_budget::NoiseBudget;
pub use rate_model::RateModel;
pub use slow_noise::SlowNoise;
pub use source::relative_intensity_noise_per_hz;
