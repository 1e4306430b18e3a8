//! Bit- and clock-exact models of the filter pipelines in the FPGA.
//!
//! Bits in, bits out: this module imports nothing of the crate but its words, converts no units and knows no
//! gyro. Each filter exists twice, as a pipeline that advances clock by clock over explicit
//! memories and registers, and as a clock-less engine with the same words. They share neither
//! control nor storage, and the tests hold them together to the last bit.
//!
//! * [`float_unit`]: number formats and their rounding; [`memory`]: single-port RAM.
//! * [`front_end`]: from a sample stream to the pairs a core takes.
//! * [`board`]: front end, core and output register, clocked together.
//! * [`machine`]: the sequencer under every pipeline; [`registers`], [`datapath`]: what it clocks.
//! * [`rls`], [`lms`], [`sign_lms`]: states and steps of the pipelines, their clock-less engines.
//! * [`fixed`]: fixed-point words, and the pipelines on them.
//! * [`pipeline`]: what a pipeline declares of itself; [`kinds`]: the list of them; [`engine`].
//! * [`health`]: what goes wrong inside and when. [`timing`]: clocks, units, rates.
//! * [`probe`], [`trace`]: test points and per-clock records. [`export`]: vectors, waveforms, RTL.

pub mod board;
mod check;
pub mod datapath;
pub mod engine;
pub mod error;
#[cfg(feature = "hdl")]
pub mod export;
pub mod fixed;
pub mod float_unit;
pub mod front_end;
pub mod health;
pub mod kinds;
mod line;
pub mod lms;
pub mod machine;
#[doc(hidden)]
pub mod memory;
pub mod pipeline;
#[doc(hidden)]
pub mod probe;
pub mod registers;
pub mod rls;
pub mod sign_lms;
mod steps;
pub mod timing;
#[doc(hidden)]
pub mod trace;

pub use error::FpgaError;
