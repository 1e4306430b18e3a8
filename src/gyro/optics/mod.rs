//! Optics of the gyro, from the coil to the converter behind the photodetector.
//!
//! ```text
//! Sagnac phase (coil) --(+)--> raised cosine of the phase difference (detector) --> converter
//! bias wave (modulation) + ramp (modulator) --'
//! ```
//!
//! `second_order` has what departs from the ideal modulator and ramp, in closed form.

pub(in crate::gyro) mod coil;
pub(in crate::gyro) mod converter;
pub(in crate::gyro) mod detector;
pub(in crate::gyro) mod modulation;
pub(in crate::gyro) mod modulator;
pub(in crate::gyro) mod receiver;
pub(in crate::gyro) mod second_order;
pub(in crate::gyro) mod source;
