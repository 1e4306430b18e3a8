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
//! their assumptions end. The loop model has two kernels: a plain one, and a full one with the
//! second-order effects of modulator and ramp, which runs only when one of them is on.
//!
//! Symbols: `tau` = transit time of the coil = half modulation period, `T_L = 2 tau` = loop
//! period, `Ks` = Sagnac scale factor, `g` = integrator gain, `d` = pipeline latency in loop
//! periods, `r` = step of the ramp per `tau` (the register), `phi_m` = modulation depth.

mod coil;
mod controller;
mod detector;
mod error;
mod full_kernel;
mod instrument;
mod limits;
mod limits_optics;
mod loop_faults;
mod loop_kernel;
mod loop_model;
mod modulation;
mod modulator;
mod noise_budget;
mod optics;
mod parts;
mod rate_matrices;
mod rate_model;
mod rate_optics;
mod rate_word;
mod sampler;
mod slow_noise;
mod source;

pub use coil::Coil;
pub use controller::{Controller, gain_limit};
pub use detector::{CurrentNoise, Detector};
pub use error::GyroError;
pub use instrument::{Gyro, facts, sample_period_s};
pub use limits::{MotionExtremes, cautions};
pub use loop_faults::LoopFaults;
pub use loop_model::LoopModel;
pub use modulator::{Modulator, optimum_depth_rad};
pub use noise_budget::NoiseBudget;
pub use optics::{expected_mean_rate_rad_per_s, spike_share};
pub use rate_model::RateModel;
pub use slow_noise::SlowNoise;
pub use source::relative_intensity_noise_per_hz;
