//! Filters on fixed-point words: each signal a signed Qm.n of its own.
//!
//! ```text
//!              +---------------------------------------------+
//!  in_valid -->|  FixedSequencer  handshake, clock edge      |--> out_valid
//!  x, d ------>|  FixedMachine    states, registers, steps   |--> y
//!  in_ready <--|  FixedDatapath   RAMA  RAMB   x  +  /       |
//!              +---------------------------------------------+
//! ```
//!
//! Sums and products are exact, in 128 bits; a value is rounded once, where it is stored into a word.
//! As of the floating-point pipelines there is a machine with its clocks and an engine without, which share
//! no control; what an exact value becomes stands in the constants of a pipeline, which both have.
//!
//! * [`format`](Format): words and their rounding; [`Signal`]: the signals, and their words beyond the ends;
//!   [`TapFormats`]: those of every filter.
//! * [`FixedSequencer`], [`FixedDatapath`], [`FixedRegisters`]: what clocks a machine, and what it clocks.
//! * [`rls`], [`lms`], [`sign_lms`]: states and steps of a pipeline, its engine.
//! * [`FixedPipeline`]: what a pipeline declares of itself; [`FixedConfig`]: one of any kind.
//! * [`FixedFrontEnd`], [`fixed_board_usage`], [`fixed_usage`]: what stands around a core, and clocks.
//!
//! Checked by `fixed_point`, `fixed_lms`, `fixed::format::tests`.

mod board;
mod datapath;
mod exact;
mod format;
mod kinds;
pub mod lms;
mod pipeline;
mod registers;
pub mod rls;
mod sequencer;
pub mod sign_lms;
mod signal;
mod step;
mod taps;
mod usage;

pub use board::{FixedFrontEnd, fixed_board_usage};
pub use datapath::{FixedDatapath, PortAccess, UnitUse};
pub use format::{Format, Stored};
pub use kinds::{FIXED_KINDS, FixedConfig, FixedCoreSettings};
pub use pipeline::{
    CodeMatrix, FixedEngine, FixedHealth, FixedKind, FixedParameters, FixedPipeline,
};
pub use registers::FixedRegisters;
pub use sequencer::{FixedClock, FixedClocked, FixedMachine, FixedSequencer};
pub use signal::{Overflows, Signal, SignalName};
pub use step::LmsFormats;
pub use taps::TapFormats;
pub use usage::{fixed_clearing_clocks, fixed_usage};

pub use crate::vocabulary::{Overflow, Rounding};

/// One pair of words for the filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CodePair {
    /// Code of the regressor word x.
    pub input: i64,
    /// Code of the desired word d.
    pub desired: i64,
}
